//! Identification: the three models of Gautier 1996 side by side, on the same logs and filters.
//!
//! Logs in, an [`Identification`] out, which is all that reports need. The steps live elsewhere:
//! [`crate::observe`] makes the equations, [`crate::estimate`] solves them; this module decides
//! what is observed, collects what is to be said about it, and scores the result.

mod choice;
mod error;
mod options;
mod predict;
mod score;
#[cfg(test)]
mod tests;
mod warnings;

pub use error::IdentifyError;
pub use options::{Options, Plan};
pub use predict::predict;

use crate::estimate::{Estimate, estimate};
use crate::log::Recording;
use crate::model::IdentificationModel;
use crate::observe::{ModelKind, Motion, Observations, ObserveError, observe};
use crate::report::{Identification, ModelResult, ParameterResult, Validation};

/// Is told what is being done, for a progress display. `()` ignores it.
pub trait Progress: Sync {
    /// A step begins; `what` is a short phrase such as `filtering log.csv`.
    fn step(&self, what: &str);
}

impl Progress for () {
    fn step(&self, _what: &str) {}
}

/// Identifies the parameters of a robot from logs, with each of the models asked for.
///
/// All of `train` are identified together, the filters running over each log by itself; each of
/// `validate` is scored by itself. Choices that `options` and the robot's settings leave open are
/// made from the data and reported.
///
/// # Errors
/// [`IdentifyError`]: no logs, a log that does not fit the robot or lacks torque, logs too short
/// for the filters or the number of parameters, settings out of range.
pub fn identify(
    model: &dyn IdentificationModel,
    train: &[Recording],
    validate: &[Recording],
    options: &Options,
    progress: &dyn Progress,
) -> Result<Identification, IdentifyError> {
    let plan = options.resolve(model, train)?;
    let observed = train
        .iter()
        .map(|log| Observed::new(model, log, &plan, progress))
        .collect::<Result<Vec<_>, _>>()?;
    let checked = validate
        .iter()
        .map(|log| Observed::new(model, log, &plan, progress))
        .collect::<Result<Vec<_>, _>>()?;
    progress.step("solving the equations");
    let together = Observed::join(&observed);
    let mut models = Vec::with_capacity(plan.models.len());
    let mut warnings = warnings::of_logs(model, train, validate, &plan);
    for &kind in &plan.models {
        let equations = together.of(kind)?;
        let estimate =
            estimate(&equations.blocks, model.columns().len(), plan.weights).map_err(|source| {
                IdentifyError::Estimate {
                    model: kind,
                    source,
                }
            })?;
        warnings.extend(warnings::of_estimate(model, kind, &estimate, &observed));
        models.push(result(model, kind, &estimate, &together, &checked)?);
    }
    Ok(Identification {
        robot: model.name().to_owned(),
        samples: train.iter().map(|log| log.len).sum(),
        rate_hz: train.first().map_or(0.0, |log| log.rate_hz),
        logs: train.iter().map(|log| log.name.clone()).collect(),
        filter: plan.filtering,
        weights: plan.weights,
        warnings: warnings::once_each(warnings),
        models,
    })
}

/// What is observed along one log, or along several together.
struct Observed {
    /// Names of the logs.
    logs: Vec<String>,
    /// Joints that rest in all of the logs, counted from 0.
    resting: Vec<usize>,
    /// Equations of each model that is needed.
    observations: Vec<Observations>,
}

impl Observed {
    fn new(
        model: &dyn IdentificationModel,
        log: &Recording,
        plan: &Plan,
        progress: &dyn Progress,
    ) -> Result<Self, IdentifyError> {
        if log.tau.is_none() {
            return Err(ObserveError::NoTorque {
                log: log.name.clone(),
            }
            .into());
        }
        progress.step(&format!("filtering {}", log.name));
        let motion = Motion::trimmed(log, model.joints().len(), &plan.filtering)?;
        let mut observations = Vec::new();
        for kind in plan.observed() {
            progress.step(&format!("{} model along {}", kind.name(), log.name));
            observations.push(observe(model, kind, &motion, &plan.filtering)?);
        }
        Ok(Observed {
            logs: vec![motion.log],
            resting: motion.resting,
            observations,
        })
    }

    /// The equations of several logs, one log after the other.
    fn join(parts: &[Observed]) -> Observed {
        let mut all = Observed {
            logs: Vec::new(),
            resting: Vec::new(),
            observations: Vec::new(),
        };
        for part in parts {
            if all.logs.is_empty() {
                all.resting = part.resting.clone();
                all.observations = part.observations.clone();
            } else {
                all.resting.retain(|joint| part.resting.contains(joint));
                for (sum, more) in all.observations.iter_mut().zip(&part.observations) {
                    sum.append(more);
                }
            }
            all.logs.extend(part.logs.iter().cloned());
        }
        all
    }

    fn of(&self, kind: ModelKind) -> Result<&Observations, IdentifyError> {
        self.observations
            .iter()
            .find(|o| o.model == kind)
            .ok_or(IdentifyError::NoLogs)
    }

    /// The equations in which torque is predicted with the parameters of a model: its own, or
    /// the explicit ones for the power model, which has none for a single joint.
    fn torque(&self, kind: ModelKind) -> Result<&Observations, IdentifyError> {
        match kind {
            ModelKind::Power => self.of(ModelKind::Explicit),
            ModelKind::Explicit | ModelKind::Implicit => self.of(kind),
        }
    }
}

/// Puts an estimate into words and scores it on the training and the validation logs.
fn result(
    model: &dyn IdentificationModel,
    kind: ModelKind,
    estimate: &Estimate,
    train: &Observed,
    validate: &[Observed],
) -> Result<ModelResult, IdentifyError> {
    let x = &estimate.solution;
    let validation = validate
        .iter()
        .map(|observed| {
            let fit = score::torque(model, observed.torque(kind)?, x);
            Ok(Validation {
                log: observed.logs.join(" + "),
                fit,
            })
        })
        .collect::<Result<Vec<_>, IdentifyError>>()?;
    Ok(ModelResult {
        name: kind,
        rows: estimate.rows,
        condition: estimate.condition,
        condition_unweighted: estimate.condition_unweighted,
        rank: estimate.rank,
        equation_pct: score::equations(train.of(kind)?, x),
        parameters: parameters(model, estimate),
        fit: score::torque(model, train.torque(kind)?, x),
        validation,
    })
}

fn parameters(model: &dyn IdentificationModel, estimate: &Estimate) -> Vec<ParameterResult> {
    let result = |(k, column): (usize, &crate::model::Column)| {
        let value = estimate.determined[k].then_some(estimate.solution[k]);
        let sigma = estimate.sigma[k];
        ParameterResult {
            name: column.name.to_string(),
            unit: column.unit.to_string(),
            joint: column.joint,
            kind: column.kind,
            value,
            sigma,
            sigma_corrected: None,
            sigma_pct: value
                .zip(sigma)
                .map(|(value, sigma)| 100.0 * sigma / value.abs()),
            relation: column.relation.to_string(),
            solution: estimate.solution[k],
        }
    };
    model.columns().iter().enumerate().map(result).collect()
}
