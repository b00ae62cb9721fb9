//! Identification: the three models of Gautier 1996 side by side, on the same logs and filters.
//!
//! Logs in, an [`Identification`] out, which is all that reports need. The steps live elsewhere:
//! [`crate::observe`] makes the equations, [`crate::estimate`] solves them; this module decides
//! what is observed, collects what is to be said about it, and scores the result.

mod choice;
mod compare;
mod corrected;
mod error;
mod excited;
mod gains;
mod instruments;
mod observed;
mod options;
mod other_columns;
mod payload;
mod precision;
mod predict;
mod prior;
mod score;
mod series;
mod streamed;
#[cfg(test)]
pub(crate) mod tests;
mod units;
mod warnings;

pub use error::IdentifyError;
pub use gains::{KnownLoad, gains};
pub use instruments::instruments;
pub use options::{Options, Plan, PriorUse};
pub use payload::payload;
pub use predict::predict;
pub use series::series;
pub use units::settle_units;

use crate::estimate::{Estimate, EstimateError, Triangle, estimate, from_triangles};
use crate::evidence::{self, Evidence};
use crate::log::Samples;
use crate::model::{Column, IdentificationModel};
use crate::observe::ModelKind;
use crate::report::{Identification, ModelResult, ParameterResult, Validation};
use crate::settings::Weights;
use observed::Observed;

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
/// [`IdentifyError`]: no logs, a log that does not fit the robot or lacks torque, logs in
/// which nothing moves or that determine no parameter at all, logs too short for the filters or the
/// number of parameters, settings out of range.
pub fn identify<L: Samples>(
    model: &dyn IdentificationModel,
    train: &[L],
    validate: &[L],
    options: &Options,
    progress: &dyn Progress,
) -> Result<Identification, IdentifyError> {
    let plan = options.resolve(model, train)?;
    let observe = |log: &L| Observed::new(model, log, &plan, progress);
    let together = Observed::join(train.iter().map(observe))?;
    let checked = validate
        .iter()
        .map(observe)
        .collect::<Result<Vec<_>, _>>()?;
    let mut models = Vec::with_capacity(plan.models.len());
    let mut warnings = warnings::of_logs(model, train, validate, &plan);
    for &kind in &plan.models {
        progress.step(&format!("solving the {} model", kind.name()));
        let estimate = solved(model, kind, &together, &plan)?;
        if !estimate.determined.is_empty() && !estimate.determined.contains(&true) {
            return Err(excited::nothing_determined(kind, train)?);
        }
        warnings.extend(warnings::of_estimate(
            model,
            kind,
            &estimate,
            &together.resting,
        ));
        let mut found = result(model, kind, &estimate, &together, &checked)?;
        if kind == ModelKind::Explicit {
            found.precision = precision::precision(&together.of(kind)?.evidence, &estimate);
        }
        let sigmas = corrected::corrected(model, &together.of(kind)?.evidence, plan.weights);
        for (parameter, sigma) in found.parameters.iter_mut().zip(sigmas) {
            parameter.sigma_corrected = sigma.filter(|_| parameter.value.is_some());
        }
        if options.prior == PriorUse::Use {
            let observed = (&together, checked.as_slice());
            prior::add(model, (kind, plan.weights), &estimate, observed, &mut found)?;
            warnings.extend(warnings::of_prior(&found));
        }
        models.push(found);
    }
    let disagreements = compare::disagreements(&models);
    let fails = warnings::of_results(&models);
    if fails.is_none() {
        warnings.extend(compare::sentences(&disagreements));
    }
    warnings.extend(fails);
    Ok(Identification {
        robot: model.name().to_owned(),
        samples: train.iter().map(|log| log.len()).sum(),
        rate_hz: train.first().map_or(0.0, |log| log.rate_hz()),
        logs: together.logs,
        filter: plan.filtering,
        weights: plan.weights,
        warnings: warnings::once_each(warnings),
        models,
        disagreements,
        command: None,
        truth: None,
        series: Vec::new(),
    })
}

fn solved(
    model: &dyn IdentificationModel,
    kind: ModelKind,
    observed: &Observed,
    plan: &Plan,
) -> Result<Estimate, IdentifyError> {
    let gathered = observed.of(kind)?;
    let np = model.columns().len();
    let estimate = match &gathered.rows {
        Some(rows) => estimate(&rows.blocks, np, plan.weights),
        None => of_factors(&gathered.evidence, np, plan.weights),
    };
    estimate
        .map(|estimate| estimate.counted(plan.degrees_of_freedom))
        .map_err(|source| IdentifyError::Estimate {
            model: kind,
            source,
        })
}

/// The estimate of equations that were not kept, from their factors.
fn of_factors(evidence: &Evidence, np: usize, weights: Weights) -> Result<Estimate, EstimateError> {
    let columns = &evidence.layout().joints;
    let totals = evidence.totals();
    let triangle = |(columns, total): (&Vec<usize>, &evidence::Triangle)| {
        Triangle::from_upper(columns.clone(), total.rows(), |i, k| total.entry(i, k))
    };
    let triangles: Vec<Triangle> = columns.iter().zip(&totals).map(triangle).collect();
    from_triangles(&triangles, np, weights)
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
            let fit = score::torque(model, &observed.torque(kind)?.evidence, x);
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
        certified_digits: estimate.certified_digits(),
        equation_pct: score::equations(&train.of(kind)?.evidence, x),
        parameters: model
            .columns()
            .iter()
            .enumerate()
            .map(|(k, column)| ParameterResult {
                nominal: model.knowledge().value(k),
                ..parameter(column, k, estimate)
            })
            .collect(),
        fit: score::torque(model, &train.torque(kind)?.evidence, x),
        validation,
        precision: Vec::new(),
        with_prior: None,
        instrumented: None,
    })
}

/// Parameter `k` of an estimate.
fn parameter(column: &Column, k: usize, estimate: &Estimate) -> ParameterResult {
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
        nominal: None,
        with_prior: None,
        instrumented: None,
    }
}
