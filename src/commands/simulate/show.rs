//! What a simulation did, in words and as a CSV.

use std::fmt::Write;
use std::path::Path;

use idim::runtime::log;
use idim::runtime::model::{IdentificationModel, JointKind};
use idim::runtime::simulate::{Simulation, parting};

use super::super::{fits, output};
use super::{Failure, Run};

/// Share of a joint's range that a log may be away from its simulation before they are said to part.
const APART: f64 = 0.1;

/// Writes t, q1.., qd1.., tau1.. to a file, or to standard output.
///
/// # Errors
/// [`Failure::Log`] or [`Failure::Write`] if it cannot be written.
pub fn save(result: &Simulation, path: Option<&Path>) -> Result<(), Failure> {
    let t: Vec<f64> = (0..result.grid.len).map(|k| result.grid.time(k)).collect();
    let groups = [("q", &result.q), ("qd", &result.qd), ("tau", &result.tau)];
    let mut columns = vec![("t".to_owned(), t.as_slice())];
    for (name, series) in groups {
        let named = series.iter().enumerate();
        columns.extend(named.map(|(j, values)| (format!("{name}{}", j + 1), values.as_slice())));
    }
    if let Some(path) = path {
        let columns: Vec<(&str, &[f64])> = columns
            .iter()
            .map(|(name, values)| (name.as_str(), *values))
            .collect();
        return Ok(log::write(path, &columns)?);
    }
    let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
    let mut text = names.join(",");
    text.push('\n');
    for row in 0..result.grid.len {
        for (place, (_, values)) in columns.iter().enumerate() {
            let comma = if place == 0 { "" } else { "," };
            let _ = write!(text, "{comma}{}", values[row]);
        }
        text.push('\n');
    }
    output::print(&text)
}

/// A table of the joints: range, torque, distance from the reference and from the log.
pub fn describe(model: &dyn IdentificationModel, run: &Run) -> String {
    let Simulation { grid, q, tau, .. } = &run.result;
    let seconds = (grid.len - 1) as f64 / grid.rate_hz;
    let mut text = format!(
        "{}: {}; {seconds:.3} s at {} Hz.\n",
        model.name(),
        run.driven,
        grid.rate_hz
    );
    let width = model
        .joints()
        .iter()
        .map(|joint| joint.name.chars().count())
        .max()
        .unwrap_or(5);
    let width = width.max(5);
    let _ = write!(
        text,
        "\n{:<width$} {:>5} {:>20} {:>10}",
        "joint", "unit", "range of q", "max |tau|"
    );
    for (_, what) in run.compared() {
        let _ = write!(text, " {what:>24}");
    }
    text.push('\n');
    for (j, joint) in model.joints().iter().enumerate() {
        let unit = match joint.kind {
            JointKind::Revolute => "rad",
            JointKind::Prismatic => "m",
        };
        let (low, high) = range(&q[j]);
        let largest = tau[j].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let range = format!("{low:.4} .. {high:.4}");
        let _ = write!(
            text,
            "{:<width$} {unit:>5} {range:>20} {largest:>10.4}",
            joint.name
        );
        for (other, _) in run.compared() {
            let _ = write!(text, " {:>24.3e}", rms(&q[j], &other[j]));
        }
        text.push('\n');
    }
    let warnings = run.warnings.iter().cloned().chain(apart(model, run));
    for (k, warning) in warnings.enumerate() {
        let gap = if k == 0 { "\n" } else { "" };
        let _ = writeln!(text, "{gap}warning: {warning}");
    }
    text
}

/// Says where a log leaves its simulation.
fn apart(model: &dyn IdentificationModel, run: &Run) -> Option<String> {
    let part = parting(run.log.as_ref()?, &run.result.q, &run.result.grid, APART)?;
    let (joint, unit, _) = fits::joint(model, &part);
    let cause = match (run.open, run.misfit) {
        (true, _) => "The parameters are not those of this log, or it is too long for an open loop",
        (false, true) => "See above for what does not belong to this log",
        (false, false) => {
            "Reference and controller fit this log, so the parameters do not: the model lacks \
             something, or it is another robot's"
        }
    };
    Some(format!(
        "Log and simulation part at {:.3} s: {joint} is more than {:.0} % of its range away, up to \
         {:.3} {unit}. {cause}.",
        part.second,
        100.0 * APART,
        part.largest,
    ))
}

fn range(values: &[f64]) -> (f64, f64) {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    (
        low,
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    )
}

fn rms(one: &[f64], other: &[f64]) -> f64 {
    let sum: f64 = one.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum();
    (sum / one.len().max(1) as f64).sqrt()
}
