//! Whether anything moves in the logs, and how far.

use super::{IdentifyError, choice};
use crate::log::{Recording, Samples, resolution};
use crate::observe::{ModelKind, rests};
use crate::signal::bandwidth;

/// Fewer steps of its encoder than this are the last digits of a joint at rest.
const STEPS: f64 = 4.0;

/// A joint that moves further than this, rad or m, does not do so by noise.
const BEYOND_NOISE: f64 = 0.02;

/// Fewest samples in which noise and motion can be told apart.
const FEWEST: usize = 32;

/// An error unless some joint moves in some log, or part of one.
///
/// # Errors
/// [`IdentifyError::NothingMoves`].
pub(super) fn check(logs: &[Recording]) -> Result<(), IdentifyError> {
    let any = |log: &Recording| log.q.iter().any(|q| moves(q, log.rate_hz));
    if logs.is_empty() || logs.iter().any(any) {
        return Ok(());
    }
    Err(nothing_moves(logs))
}

pub(super) fn nothing_moves(logs: &[Recording]) -> IdentifyError {
    IdentifyError::NothingMoves {
        logs: names(logs),
        seen: seen(logs),
    }
}

/// Logs that determine no parameter of a model.
///
/// # Errors
/// [`IdentifyError::Unreadable`] if the logs cannot be looked at again.
pub(super) fn nothing_determined<L: Samples>(
    model: ModelKind,
    train: &[L],
) -> Result<IdentifyError, IdentifyError> {
    let train: Vec<&dyn Samples> = train.iter().map(|log| log as &dyn Samples).collect();
    let looks = choice::looks(&train)?;
    Ok(IdentifyError::NothingDetermined {
        model,
        logs: names(&looks),
        seen: seen(&looks),
    })
}

/// Names of the logs, in a row.
fn names(logs: &[Recording]) -> String {
    let mut names: Vec<&str> = logs.iter().map(|log| log.name.as_str()).collect();
    names.dedup();
    names.join(", ")
}

/// How far each joint moves in any of the logs, and how many of its encoder's steps that is.
fn seen(logs: &[Recording]) -> String {
    let joints = logs.first().map_or(0, |log| log.q.len());
    let of_joint = |joint: usize| {
        let series = logs.iter().filter_map(|log| log.q.get(joint));
        let (range, step) = series
            .map(|q| (range(q), resolution(q)))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap_or((0.0, 0.0));
        let number = joint + 1;
        if step > 0.0 {
            format!(
                "q{number} within {range:.1e}, {:.0} encoder steps",
                range / step
            )
        } else {
            format!("q{number} constant")
        }
    };
    let all: Vec<String> = (0..joints).map(of_joint).collect();
    all.join("; ")
}

fn moves(q: &[f64], rate_hz: f64) -> bool {
    let range = range(q);
    let noise = || q.len() >= FEWEST && bandwidth(q, rate_hz).is_none();
    !rests(q) && range > STEPS * resolution(q) && (range > BEYOND_NOISE || !noise())
}

fn range(q: &[f64]) -> f64 {
    let low = q.iter().copied().fold(f64::INFINITY, f64::min);
    let high = q.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (high - low).max(0.0)
}
