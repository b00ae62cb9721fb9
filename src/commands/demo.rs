//! `idim demo`: the paper's study of systematic errors on built-in data, and an effect that is
//! hidden in a simulated log and found.

mod hidden;
mod text;

use std::path::{Path, PathBuf};

use idim::demo::{self, Experiment};
use idim::robots;
use idim::runtime::identify::{Options, identify};
use idim::runtime::log::{self, Recording};
use idim::runtime::report::{Diagnosis, Identification, Truth, story};

use super::progress::Spinner;
use super::{Failure, identify::draw, output};

/// What the report says at the top of the identification.
const ABOUT: &str = "The planar SCARA of M. Gautier, \"A comparison of filtered models for dynamic \
    identification of robots\" (1996), section 7.2: simulated without noise, so the true values \
    are known, and every error is one of the filters and the differentiation.";

/// Arguments of `idim demo`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Folder for the simulated logs and the results.
    #[arg(long, value_name = "DIR", default_value = "idim-demo")]
    folder: PathBuf,
    /// Print nothing.
    #[arg(long)]
    quiet: bool,
}

/// Simulates, identifies by three models, compares with the truth; hides an effect, finds it.
///
/// # Errors
/// [`Failure::Write`] when the folder cannot be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let folder = &arguments.folder;
    let spinner = Spinner::new(arguments.quiet);
    std::fs::create_dir_all(folder).map_err(|source| Failure::Write {
        path: folder.clone(),
        source,
    })?;
    let experiment = demo::experiment()?;
    let result = identified(&experiment, &spinner)?;
    save_log(&folder.join("scara.csv"), &experiment.recording)?;
    let found = hidden::find(folder, &spinner)?;
    save(folder, &result, &found)?;
    spinner.finish();
    if arguments.quiet {
        return Ok(());
    }
    output::print(&text::table(&experiment, &result))?;
    output::print(&text::found(folder, &found))
}

/// The three models on the paper's experiment.
fn identified(experiment: &Experiment, spinner: &Spinner) -> Result<Identification, Failure> {
    let train = std::slice::from_ref(&experiment.recording);
    let options = Options::default();
    let mut result = identify(&robots::scara::Model, train, &[], &options, spinner)?;
    result.command = Some(output::command_line());
    result.truth = Some(Truth {
        title: "The paper's SCARA: identified parameters against the true ones".to_owned(),
        about: ABOUT.to_owned(),
        values: experiment.truth.clone(),
    });
    draw(&robots::scara::Model, train, &[], &mut result)?;
    Ok(result)
}

/// Writes a log of two joints.
fn save_log(path: &Path, recording: &Recording) -> Result<(), Failure> {
    let mut columns: Vec<(&str, &[f64])> = vec![("t", &recording.stamps)];
    let tau = recording.tau.as_deref().unwrap_or_default();
    for (names, all) in [(["q1", "q2"], &recording.q[..]), (["tau1", "tau2"], tau)] {
        columns.extend(names.into_iter().zip(all.iter().map(Vec::as_slice)));
    }
    Ok(log::write(path, &columns)?)
}

/// The page, and both results for other programs.
fn save(folder: &Path, result: &Identification, diagnosis: &Diagnosis) -> Result<(), Failure> {
    let title = "A simulated SCARA: what its model is missing, and what its parameters are";
    let page = story(title, &text::about(diagnosis), diagnosis, result);
    output::text(&folder.join("report.html"), &page)?;
    // The curves are in the page; the files for other programs stay short.
    let short = Identification {
        series: Vec::new(),
        ..result.clone()
    };
    output::json(&folder.join("result.json"), &short)?;
    let short = Diagnosis {
        pictures: None,
        ..diagnosis.clone()
    };
    output::json(&folder.join("diagnosis.json"), &short)
}
