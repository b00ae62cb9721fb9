//! What is to be said about the logs: validation logs that can confirm nothing.

use super::joined::Joined;
use super::proof;
use super::state::{Bench, State};
use super::{DiagnoseError, Log};

/// Torque error, percent, from which a validation log is not believed to be of the same robot, if
/// it also is so many times that of the training logs.
const STRANGE_PCT: f64 = 40.0;
const STRANGE: f64 = 4.0;

/// Correlation of measured and predicted torque from which a joint is the same but for a factor, and
/// how far that has to be from one.
const ALIKE: f64 = 0.95;
const FACTOR: f64 = 1.8;

/// Something about a validation log that the user ought to know.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
enum Doubt {
    /// There is none.
    #[error(
        "no validation log: what was found is not confirmed on another motion, and nothing is \
         proven; give one with --validate"
    )]
    Missing,
    /// It is the training log.
    #[error("{log} is the training log {other} itself: it confirms and proves nothing")]
    Same {
        /// The validation log.
        log: String,
        /// The training log.
        other: String,
    },
    /// It shares samples with the training log.
    #[error(
        "{log} shares {seconds:.1} s with the training log {other}: there it confirms and proves \
         nothing"
    )]
    Shared {
        /// The validation log.
        log: String,
        /// The training log.
        other: String,
        /// How much, s.
        seconds: f64,
    },
}

/// Everything that is to be said about logs; `kept` if a part of those to fit on confirms and proves.
pub(super) fn warnings((train, validate): (&[Log], &[Log]), kept: bool) -> Vec<String> {
    let logs = train.iter().chain(validate);
    let mut all: Vec<String> = logs
        .flat_map(|log| log.recording.warnings.clone())
        .collect();
    let mut doubts: Vec<Doubt> = validate
        .iter()
        .flat_map(|log| train.iter().filter_map(|other| known(log, other)))
        .collect();
    if validate.is_empty() && !kept {
        doubts.push(Doubt::Missing);
    }
    all.extend(doubts.iter().map(Doubt::to_string));
    all
}

/// Places of the validation logs that are no training log: those that can confirm and prove.
pub(super) fn fresh((train, validate): (&[Log], &[Log])) -> Vec<usize> {
    let trained = |log: &Log| {
        let mut doubts = train.iter().filter_map(|other| known(log, other));
        doubts.any(|doubt| matches!(doubt, Doubt::Same { .. }))
    };
    let places = 0..validate.len();
    places.filter(|&place| !trained(&validate[place])).collect()
}

/// Whether a validation log is a training log, or a part of one.
fn known(log: &Log, other: &Log) -> Option<Doubt> {
    let (a, b) = (&log.recording, &other.recording);
    let names = (a.name.clone(), b.name.clone());
    if a.q == b.q && a.tau == b.tau {
        return Some(Doubt::Same {
            log: names.0,
            other: names.1,
        });
    }
    let file = |name: &str| name.split('@').next().unwrap_or(name).to_owned();
    let ends = |k: usize, len: usize, start: f64, rate: f64| start + k.min(len) as f64 / rate;
    let end = f64::min(
        ends(a.len, a.len, a.start, a.rate_hz),
        ends(b.len, b.len, b.start, b.rate_hz),
    );
    let seconds = end - a.start.max(b.start);
    (file(&a.name) == file(&b.name) && seconds > 0.0).then_some(Doubt::Shared {
        log: names.0,
        other: names.1,
        seconds,
    })
}

/// Whether the validation logs can be of the robot of the training logs; `before` is the model as it
/// is described, refitted. What is far from it would confirm anything.
///
/// # Errors
/// [`DiagnoseError::OtherUnit`], [`DiagnoseError::OtherRobot`].
pub(super) fn check(
    bench: &Bench<'_>,
    before: &State,
    other: &Joined,
) -> Result<(), DiagnoseError> {
    let own = proof::fit(bench, before, bench.train);
    for track in &other.tracks {
        let log = Joined::new(vec![track.clone()]);
        let fit = proof::fit(bench, before, &log);
        if !(fit.total_pct > STRANGE_PCT && fit.total_pct > STRANGE * own.total_pct) {
            continue;
        }
        let name = track.motion.log.clone();
        let rows = bench.rows(before, &log);
        let mut scaled = rows.iter().zip(&fit.joints).enumerate();
        let scaled = scaled.find_map(|(joint, (predicted, about))| {
            let factor = factor(&log.measured(joint), predicted)?;
            Some((about.name.clone(), factor))
        });
        return Err(match scaled {
            Some((joint, factor)) => DiagnoseError::OtherUnit {
                log: name,
                joint,
                factor,
            },
            None => DiagnoseError::OtherRobot {
                log: name,
                pct: fit.total_pct,
                train_pct: own.total_pct,
            },
        });
    }
    Ok(())
}

/// The factor between measured and predicted torque, where they are alike but for one.
fn factor(measured: &[f64], predicted: &[f64]) -> Option<f64> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (yy, pp, yp) = (
        dot(measured, measured),
        dot(predicted, predicted),
        dot(measured, predicted),
    );
    let factor = yp / pp;
    let alike = yp.abs() / (yy * pp).sqrt() > ALIKE;
    let far = factor.abs() > FACTOR || factor.abs() < 1.0 / FACTOR || factor < 0.0;
    (alike && far && factor.is_finite()).then_some(factor)
}

#[cfg(test)]
mod tests {
    use super::factor;

    #[test]
    fn a_factor_is_found_where_there_is_one() {
        let p: Vec<f64> = (0..500).map(|i| (f64::from(i) * 0.1).sin() * 3.0).collect();
        let times = |by: f64| -> Vec<f64> { p.iter().map(|p| by * p).collect() };
        assert!((factor(&times(1000.0), &p).unwrap() - 1000.0).abs() < 1e-9);
        assert!((factor(&times(-1.0), &p).unwrap() + 1.0).abs() < 1e-12);
        assert_eq!(factor(&times(1.1), &p), None);
        let other: Vec<f64> = (0..500).map(|i| (f64::from(i) * 0.37).cos()).collect();
        assert_eq!(factor(&other, &p), None);
    }
}
