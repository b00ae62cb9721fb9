//! How the result came about: logs, filters, weights, and the command that gives it again.

use super::markup::{Element, classed, el};
use super::words::{count, list, number};
use crate::report::{Diagnosis, Identification};
use crate::settings::{Derivatives, Edges, Velocity, Weights};

/// A table of the settings, each with a word on what it does.
pub(super) fn table(id: &Identification) -> Element {
    let filter = &id.filter;
    let row = |key: &str, title: &str, value: String| {
        let origin = if filter.chosen.contains(&key) {
            "chosen from the data"
        } else {
            ""
        };
        el("tr")
            .child(el("th").text(title))
            .child(el("td").text(value))
            .child(classed("td", "note").text(origin))
    };
    let cut = 0.4 * id.rate_hz / filter.nd.max(1) as f64;
    let low_pass = match filter.nd {
        1 => "none, every sample kept".to_owned(),
        nd => format!("below {} Hz, then 1 sample in {nd} kept", number(cut, 3)),
    };
    let body = [
        row("", "training logs", id.logs.join(", ")),
        row("", "samples", samples(id)),
        row("fq_hz", "prefilter", prefilter(id)),
        row("velocity", "velocity", velocity(id).to_owned()),
        row("nd", "parallel filter of torque and regressor", low_pass),
        row("trim", "trimmed at either end", trim(id)),
        row("edges", "edge rule", edges(id).to_owned()),
        row("weights", "weights", weights(id).to_owned()),
    ];
    el("table").child(el("tbody").children(body))
}

/// The logs and filters of a diagnosis.
pub(super) fn of_diagnosis(diagnosis: &Diagnosis) -> Element {
    let filter = &diagnosis.filter;
    let row = |title: &str, value: String| {
        el("tr")
            .child(el("th").text(title))
            .child(el("td").text(value))
    };
    let validation = match diagnosis.validation.is_empty() {
        true => "none".to_owned(),
        false => diagnosis.validation.join(", "),
    };
    let low_pass = match filter.nd {
        1 => "none, every sample kept".to_owned(),
        nd => format!("1 sample in {nd} kept"),
    };
    let q = format!(
        "q below {} Hz, Butterworth of order {}, forwards and backwards; central differences",
        filter.fq_hz, filter.order
    );
    el("table").child(el("tbody").children([
        row("fitted on", diagnosis.logs.join(", ")),
        row("confirmed and proven on", validation),
        row("prefilter", q),
        row("parallel filter of torque and regressor", low_pass),
    ]))
}

/// Samples, rate and duration of the training logs.
pub(super) fn samples(id: &Identification) -> String {
    let seconds = id.samples as f64 / id.rate_hz;
    format!(
        "{} at {} Hz, {} s",
        count(id.samples, "sample"),
        number(id.rate_hz, 4),
        number(seconds, 3)
    )
}

fn prefilter(id: &Identification) -> String {
    let signals = if id.filter.prefilter_torque {
        "q and torque"
    } else {
        "q"
    };
    let (hz, order) = (id.filter.fq_hz, id.filter.order);
    format!("{signals} below {hz} Hz, Butterworth of order {order}, forwards and backwards")
}

fn velocity(id: &Identification) -> &'static str {
    match id.filter.velocity {
        Velocity::Derived if id.filter.derivatives == Derivatives::Eighth => {
            "differences of eighth order of the filtered q; zero where it is uncertain"
        }
        Velocity::Derived => "central differences of the filtered q",
        Velocity::Measured => "the log's own, filtered like q",
    }
}

fn trim(id: &Identification) -> String {
    let unit = match id.filter.edges {
        Edges::Scipy => "samples before the parallel filter",
        Edges::Matlab => "rows after the parallel filter",
    };
    match id.filter.border {
        (0, 0) => format!("{} {unit}", id.filter.trim),
        (start, end) => format!(
            "{} {unit}, and {start} + {end} samples first",
            id.filter.trim
        ),
    }
}

fn edges(id: &Identification) -> &'static str {
    match id.filter.edges {
        Edges::Scipy => "as SciPy (sosfiltfilt, decimate)",
        Edges::Matlab => "as Matlab (filtfilt, decimate)",
    }
}

fn weights(id: &Identification) -> &'static str {
    match id.weights {
        Weights::None => "none (ordinary least squares)",
        Weights::Joint => "each joint by its residual's standard deviation",
        Weights::Robust => "each joint by its residual, outliers less (Huber)",
    }
}

/// The command line, ready to be copied.
pub(super) fn command(id: &Identification) -> Option<Element> {
    let command = id.command.as_ref()?;
    Some(el("pre").child(el("code").text(command)))
}

/// All warnings.
pub(super) fn warnings(id: &Identification) -> Element {
    match id.warnings.is_empty() {
        true => el("p").text("None."),
        false => el("ul").children(id.warnings.iter().map(|text| el("li").text(text))),
    }
}

/// Logs in a few words.
pub(super) fn logs(id: &Identification) -> String {
    list(&id.logs, 3)
}
