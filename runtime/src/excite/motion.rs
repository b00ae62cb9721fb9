//! What is checked before a search, and the motion after it.

use super::error::ExciteError;
use super::family::{Family, Start};
use super::limits::{check as check_limits, for_all_joints};
use super::space::Space;
use super::{Settings, Task};
use crate::log::{Fourier, Reference, ViaPoints};
use crate::simulate::SimulateError;

/// Whether a search can begin.
///
/// # Errors
/// [`ExciteError`].
pub(super) fn check(task: &Task<'_>, settings: &Settings) -> Result<(), ExciteError> {
    check_limits(task.model, task.limits)?;
    check_center(task)?;
    check_parameters(task)?;
    check_family(settings)?;
    for (what, value) in [
        ("the period", settings.period_s),
        ("the sampling rate", settings.noise.rate_hz),
        ("the number of periods", settings.periods as f64),
        ("the number of starts", settings.search.starts as f64),
        ("the number of steps", settings.search.steps as f64),
        (
            "the wanted relative standard deviation",
            settings.wanted_pct.unwrap_or(1.0),
        ),
    ] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(ExciteError::Setting { what, value });
        }
    }
    if settings.wanted_pct.is_some() && task.parameters.is_none() {
        return Err(ExciteError::NoValues);
    }
    check_noise(task, settings)
}

fn check_center(task: &Task<'_>) -> Result<(), ExciteError> {
    let Some(center) = task.center else {
        return Ok(());
    };
    for_all_joints(task.model, "the centre", center.len())?;
    let joints = task.model.joints().iter();
    for ((joint, value), limits) in joints.zip(center).zip(task.limits) {
        if !(limits.lower < *value && *value < limits.upper) {
            return Err(ExciteError::Center {
                joint: joint.name.to_string(),
                value: *value,
                lower: limits.lower,
                upper: limits.upper,
            });
        }
    }
    Ok(())
}

fn check_parameters(task: &Task<'_>) -> Result<(), ExciteError> {
    let columns = task.model.columns();
    let Some(values) = task.parameters else {
        return Ok(());
    };
    if values.len() != columns.len() {
        return Err(ExciteError::Model(SimulateError::Parameters {
            robot: task.model.name().to_owned(),
            has: values.len(),
            needs: columns.len(),
        }));
    }
    let wrong = columns.iter().zip(values);
    let wrong = wrong.into_iter().find(|(_, value)| !value.is_finite());
    wrong.map_or(Ok(()), |(column, value)| {
        Err(ExciteError::Model(SimulateError::NotFinite {
            name: column.name.to_string(),
            value: *value,
        }))
    })
}

fn check_family(settings: &Settings) -> Result<(), ExciteError> {
    let (what, count, least) = match (settings.family, settings.start) {
        (Family::Fourier { harmonics }, Start::Rest) => ("harmonics", harmonics, 3),
        (Family::Fourier { harmonics }, Start::Moving) => ("harmonics", harmonics, 1),
        (Family::ViaPoints { points }, _) => ("via points", points, 1),
    };
    match count < least {
        true => Err(ExciteError::TooFew {
            what: format!("{count} {what}"),
            least,
        }),
        false => Ok(()),
    }
}

fn check_noise(task: &Task<'_>, settings: &Settings) -> Result<(), ExciteError> {
    let noise = &settings.noise;
    for_all_joints(task.model, "the noise", noise.sigma.len())?;
    for (joint, value) in task.model.joints().iter().zip(&noise.sigma) {
        if !(*value > 0.0 && value.is_finite()) {
            return Err(ExciteError::Noise {
                joint: joint.name.to_string(),
                value: *value,
            });
        }
    }
    let samples = (settings.period_s * noise.rate_hz).round() as usize;
    let least = task.model.columns().len();
    match samples < least {
        true => Err(ExciteError::TooFewSamples {
            rate_hz: noise.rate_hz,
            period_s: settings.period_s,
            samples,
            least,
        }),
        false => Ok(()),
    }
}

/// Why no start has a motion: the joint that cannot be held, or W always singular.
pub(super) fn none(task: &Task<'_>, beyond: Option<(usize, f64)>) -> ExciteError {
    let joint = |(joint, torque): (usize, f64)| {
        let name = task.model.joints().get(joint)?.name.to_string();
        Some(ExciteError::Effort {
            joint: name,
            torque,
            effort: task.limits.get(joint)?.effort,
        })
    };
    beyond.and_then(joint).unwrap_or(ExciteError::NoMotion)
}

/// A motion as a trajectory file holds it.
pub(super) fn reference(space: &Space<'_>, z: &[f64], periods: usize) -> Reference {
    let joints = 0..space.limits.len();
    let center: Vec<f64> = joints.clone().map(|joint| space.center(z, joint)).collect();
    let coefficients = |joint: usize| space.basis.coefficients(&space.free(z, joint));
    let all: Vec<Vec<f64>> = joints.map(coefficients).collect();
    let periods = periods as f64;
    match space.basis.family {
        Family::Fourier { harmonics } => {
            let (sin, cos) = all
                .iter()
                .map(|all| all.split_at(harmonics))
                .unzip::<_, _, Vec<_>, Vec<_>>();
            let rows = |parts: Vec<&[f64]>| parts.into_iter().map(<[f64]>::to_vec).collect();
            Reference::Fourier(Fourier {
                f0_hz: 1.0 / space.basis.period_s,
                periods,
                center,
                sin: rows(sin),
                cos: rows(cos),
            })
        }
        Family::ViaPoints { points } => {
            let parts = points + 1;
            let d = space.basis.period_s / parts as f64;
            // At both ends at rest at the centre.
            let row = |order: usize, (all, center): (&Vec<f64>, &f64)| -> Vec<f64> {
                let middle = if order == 0 { *center } else { 0.0 };
                let inner = all
                    .chunks(3)
                    .map(|at| middle + at[order] / d.powi(order as i32));
                let ends = std::iter::once(middle);
                ends.clone().chain(inner).chain(ends).collect()
            };
            let rows = |order: usize| {
                all.iter()
                    .zip(&center)
                    .map(|both| row(order, both))
                    .collect()
            };
            Reference::ViaPoints(ViaPoints {
                times: (0..=parts).map(|m| d * m as f64).collect(),
                periods,
                q: rows(0),
                qd: rows(1),
                qdd: rows(2),
            })
        }
    }
}
