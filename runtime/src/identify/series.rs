//! What is drawn of a log, once its robot is identified.

use super::IdentifyError;
use super::score::unit;
use crate::log::Recording;
use crate::model::{IdentificationModel, Joint};
use crate::observe::{ModelKind, Motion, Torque, check_torque, filtered_torque};
use crate::report::{Identification, JointSeries, LogSeries, ModelSeries, Role, Spectrum, thinned};
use crate::signal::{autocorrelation, density};

/// Points per joint and log: more than a screen has columns.
const POINTS: usize = 2000;

/// Longest window of a spectrum, rows.
const WINDOW: usize = 256;

/// Lags of the autocorrelation, rows.
const LAGS: usize = 60;

/// Torque along a log, measured and as each model of a `result` predicts it, on the filtered,
/// decimated signals that the model was fitted to.
///
/// # Errors
/// [`IdentifyError::Observe`] if the recording does not fit the robot, lacks torque, or is too
/// short for the filters.
pub fn series(
    model: &dyn IdentificationModel,
    recording: &Recording,
    role: Role,
    result: &Identification,
) -> Result<LogSeries, IdentifyError> {
    check_torque(recording)?;
    let motion = Motion::trimmed(recording, model, &result.filter)?;
    let kinds: Vec<ModelKind> = result.models.iter().map(|model| model.name).collect();
    let torques = result
        .models
        .iter()
        .map(|found| {
            filtered_torque(
                model,
                found.name,
                &motion,
                &result.filter,
                &found.solution(),
            )
        })
        .collect::<Result<Vec<Torque>, _>>()?;
    let (start, _) = result.filter.cut_before();
    let begin = recording.start + start as f64 / recording.rate_hz;
    let joints = model.joints().iter().enumerate();
    Ok(LogSeries {
        log: recording.name.clone(),
        role,
        rate_hz: recording.rate_hz / result.filter.nd as f64,
        rows: torques.first().map_or(0, |torque| torque.samples.len()),
        joints: joints
            .map(|(j, joint)| {
                let clock = Clock {
                    begin,
                    rate_hz: recording.rate_hz,
                    nd: result.filter.nd,
                };
                of_joint(joint, j, &clock, &kinds, &torques)
            })
            .collect(),
    })
}

/// How samples of the trimmed log become seconds, and rows per second.
struct Clock {
    begin: f64,
    rate_hz: f64,
    nd: usize,
}

impl Clock {
    /// Time of a sample, to the microsecond.
    fn seconds(&self, sample: usize) -> f64 {
        ((self.begin + sample as f64 / self.rate_hz) * 1e6).round() / 1e6
    }

    fn spectrum(&self, series: &[f64]) -> Spectrum {
        let found = density(series, self.rate_hz / self.nd as f64, WINDOW);
        Spectrum {
            step_hz: found.step_hz,
            windows: found.windows,
            density: single(&found.values),
        }
    }
}

fn of_joint(
    joint: &Joint,
    j: usize,
    clock: &Clock,
    kinds: &[ModelKind],
    torques: &[Torque],
) -> JointSeries {
    let measured = torques
        .first()
        .map_or(&[][..], |torque| &torque.measured[j]);
    let samples = torques.first().map_or(&[][..], |torque| &torque.samples);
    let residuals: Vec<Vec<f64>> = torques
        .iter()
        .map(|torque| difference(measured, &torque.predicted[j]))
        .collect();
    let signals = residuals.iter().map(Vec::as_slice).chain([measured]);
    let keep = thinned(&signals.collect::<Vec<_>>(), POINTS);
    let pick = |series: &[f64]| keep.iter().map(|&row| series[row] as f32).collect();
    let models = kinds.iter().zip(torques).zip(&residuals);
    JointSeries {
        name: joint.name.to_string(),
        unit: unit(joint.kind),
        t: keep
            .iter()
            .map(|&row| clock.seconds(samples[row]))
            .collect(),
        measured: pick(measured),
        spectrum: clock.spectrum(measured),
        models: models
            .map(|((&kind, torque), residual)| ModelSeries {
                model: kind,
                rmse: norm(residual) / (residual.len().max(1) as f64).sqrt(),
                rel_pct: match norm(residual) {
                    0.0 => 0.0,
                    error => 100.0 * error / norm(measured),
                },
                predicted: pick(&torque.predicted[j]),
                spectrum: clock.spectrum(residual),
                autocorrelation: single(&autocorrelation(residual, LAGS)),
            })
            .collect(),
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn single(values: &[f64]) -> Vec<f32> {
    values.iter().map(|&value| value as f32).collect()
}
