//! `idim demo`: the paper's study of systematic errors, on built-in data.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use idim::demo::{self, Experiment};
use idim::robots;
use idim::runtime::identify::{Options, identify};
use idim::runtime::log;
use idim::runtime::report::{Identification, Truth, html};

use super::progress::Spinner;
use super::{Failure, identify::draw, output};

/// What the report says at its top.
const ABOUT: &str = "The planar SCARA of M. Gautier, \"A comparison of filtered models for dynamic \
    identification of robots\" (1996), section 7.2: simulated without noise, so the true values \
    are known, and every error is one of the filters and the differentiation.";

/// Arguments of `idim demo`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Folder for the simulated log and the result.
    #[arg(long, value_name = "DIR", default_value = "idim-demo")]
    folder: PathBuf,
    /// Print nothing.
    #[arg(long)]
    quiet: bool,
}

/// Simulates, identifies by three models, compares with the truth.
///
/// # Errors
/// [`Failure::Write`] when the folder cannot be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let spinner = Spinner::new(arguments.quiet);
    let experiment = demo::experiment()?;
    let train = std::slice::from_ref(&experiment.recording);
    let mut result = identify(
        &robots::scara::Model,
        train,
        &[],
        &Options::default(),
        &spinner,
    )?;
    result.command = Some(output::command_line());
    result.truth = Some(Truth {
        title: "The paper's SCARA: identified parameters against the true ones".to_owned(),
        about: ABOUT.to_owned(),
        values: experiment.truth.clone(),
    });
    draw(&robots::scara::Model, train, &[], &mut result)?;
    save(&arguments.folder, &experiment, &result)?;
    spinner.finish();
    if arguments.quiet {
        return Ok(());
    }
    output::print(&text(&arguments.folder, &experiment, &result))
}

fn save(folder: &Path, experiment: &Experiment, result: &Identification) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|source| Failure::Write {
        path: folder.to_owned(),
        source,
    })?;
    let recording = &experiment.recording;
    let mut columns: Vec<(&str, &[f64])> = vec![("t", &recording.stamps)];
    let (q, tau) = (&recording.q, recording.tau.as_deref().unwrap_or_default());
    columns.extend(["q1", "q2"].into_iter().zip(q.iter().map(Vec::as_slice)));
    columns.extend(
        ["tau1", "tau2"]
            .into_iter()
            .zip(tau.iter().map(Vec::as_slice)),
    );
    log::write(&folder.join("scara.csv"), &columns)?;
    output::text(&folder.join("report.html"), &html(result))?;
    // The curves are in the page; the file for other programs stays short.
    let short = Identification {
        series: Vec::new(),
        ..result.clone()
    };
    output::json(&folder.join("result.json"), &short)
}

/// Table 1 of the paper: estimates and relative errors of the three models.
fn text(folder: &Path, experiment: &Experiment, result: &Identification) -> String {
    let mut out = String::new();
    let _ = writeln!(
        out,
        "The planar SCARA of Gautier (1996), section 7.2: {} samples at {} Hz, no noise.\n\
         What the filters and the differentiation alone do to each model (the paper's table 1):\n",
        result.samples, result.rate_hz
    );
    let _ = write!(out, "{:<6} {:<10} {:>8}", "", "unit", "true");
    for model in &result.models {
        let _ = write!(out, " | {:>10} {:>9}", model.name.name(), "error %");
    }
    out.push('\n');
    let width = 26 + 23 * result.models.len();
    let _ = writeln!(out, "{}", "-".repeat(width));
    for (index, truth) in experiment.truth.iter().enumerate() {
        let Some(first) = result.models.first().map(|model| &model.parameters[index]) else {
            continue;
        };
        let _ = write!(out, "{:<6} {:<10} {truth:>8}", first.name, first.unit);
        for model in &result.models {
            let value = model.parameters[index].solution;
            let error = 100.0 * (value - truth).abs() / truth.abs();
            let _ = write!(out, " | {value:>10.5} {error:>9.3}");
        }
        out.push('\n');
    }
    let _ = writeln!(out, "{}", "-".repeat(width));
    footer(&mut out, "equations", result, |model| {
        model.rows.to_string()
    });
    footer(&mut out, "Cond(W)", result, |model| {
        format!("{:.1}", model.condition)
    });
    let _ = writeln!(
        out,
        "\nPaper: 800, 800 and 400 equations, Cond(W) 28, 28 and 93, errors up to 0.2, 0.6 and \
         1.1 %.\n\n\
         Written: {0}/scara.csv (the log), {0}/report.html (open it) and {0}/result.json. Next:\n\
         \x20 idim identify scara {0}/scara.csv        the same from the file\n\
         \x20 idim describe scara                      the robot and its parameters\n\
         \x20 idim generate scara                      its specialised Rust code",
        folder.display()
    );
    out
}

fn footer(
    out: &mut String,
    name: &str,
    result: &Identification,
    value: impl Fn(&idim::runtime::report::ModelResult) -> String,
) {
    let _ = write!(out, "{name:<26}");
    for model in &result.models {
        let _ = write!(out, " | {:>10} {:>9}", value(model), "");
    }
    while out.ends_with(' ') {
        out.pop();
    }
    out.push('\n');
}
