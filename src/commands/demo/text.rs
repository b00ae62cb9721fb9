//! What the demo says.

use std::fmt::Write;
use std::path::Path;

use idim::demo::Experiment;
use idim::demo::hidden::SECRET;
use idim::runtime::report::{Diagnosis, Identification, ModelResult, diagnosed, parameter, place};

use super::hidden::command;

/// Table 1 of the paper: estimates and relative errors of the three models.
pub fn table(experiment: &Experiment, result: &Identification) -> String {
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
         1.1 %."
    );
    out
}

/// What was hidden and what was found, and what to do next.
pub fn found(folder: &Path, diagnosis: &Diagnosis) -> String {
    let mut out = format!(
        "\nNow the same robot under its controller, with encoders and noise, and with\n{SECRET}\n\
         that its description does not have. What is missing?\n\n{}",
        diagnosed(diagnosis)
    );
    let _ = writeln!(
        out,
        "\nWritten to {0}/: report.html (open it), scara_found.toml (the description with what was\n\
         found), the logs, result.json and diagnosis.json. Next:\n\
         \x20 {1}\n\
         \x20 idim identify {0}/scara_found.toml {0}/train.csv --validate {0}/valid.csv --fq 50\n\
         \x20 idim describe scara                      the robot and its parameters\n\
         \x20 idim generate scara                      its specialised Rust code",
        folder.display(),
        command(folder)
    );
    out
}

/// What the page says at its top.
pub fn about(diagnosis: &Diagnosis) -> Vec<String> {
    let effects = diagnosis.effects.iter();
    let values: Vec<String> = effects
        .map(|effect| {
            let all: Vec<String> = effect.parameters.iter().map(parameter).collect();
            format!(
                "{}{} ({})",
                effect.effect,
                place(effect.joint.as_deref(), &effect.joints),
                all.join(", ")
            )
        })
        .collect();
    let found = match values.is_empty() {
        true => "nothing".to_owned(),
        false => values.join(", "),
    };
    vec![
        "This page is what \u{201c}idim demo\u{201d} makes of a robot that it simulates. Two questions are asked, \
         and since the robot is simulated, the true answers are known."
            .to_owned(),
        format!(
            "What is the model missing? The simulated robot has {SECRET}; its description has not. \
             From two logs the diagnosis finds: {found}."
        ),
        "What are its parameters? The experiment of the paper that idim starts from, by the \
         explicit, the implicit and the power model."
            .to_owned(),
    ]
}

fn footer(
    out: &mut String,
    name: &str,
    result: &Identification,
    value: impl Fn(&ModelResult) -> String,
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
