//! The estimate with prior knowledge, beside the classical one.

use super::observed::{Gathered, Observed};
use super::{IdentifyError, score};
use crate::estimate::{Estimate, row_factors};
use crate::evidence::{Cut, Evidence, EvidenceError, Posterior, Weighting};
use crate::model::IdentificationModel;
use crate::observe::{Equations, ModelKind, Observations};
use crate::report::{ModelResult, PriorValue, Validation, WithPrior};
use crate::settings::Weights;

/// Adds to the result of a model what the log and the tolerances of the description say together.
/// Nothing happens without tolerances.
///
/// The equations count with the error levels of their joints (with robust weights those of the
/// rows, too), widened by as much as correlated residuals widen the standard deviations of the
/// classical estimate: the prior's rows are in standard deviations, and so must they be.
///
/// # Errors
/// [`IdentifyError`] if the equations together with the prior cannot be solved.
pub(super) fn add(
    model: &dyn IdentificationModel,
    (kind, weights): (ModelKind, Weights),
    estimate: &Estimate,
    (train, validate): (&Observed, &[Observed]),
    result: &mut ModelResult,
) -> Result<(), IdentifyError> {
    let prior = &model.knowledge().prior;
    if prior.is_empty() {
        return Ok(());
    }
    let inflation = inflation(result);
    let posterior = posterior(
        model,
        train.of(kind)?,
        (weights, estimate),
        inflation,
        prior,
    );
    let posterior = posterior.map_err(|source| IdentifyError::prior(kind, source))?;
    for (k, parameter) in result.parameters.iter_mut().enumerate() {
        let sigma = posterior.sigma[k];
        parameter.with_prior = Some(PriorValue {
            value: sigma.map(|_| posterior.mean[k]),
            sigma,
            sigma_before: posterior.before[k],
            filled: sigma.is_some() && parameter.value.is_none(),
        });
    }
    let x = &posterior.mean;
    let scored = validate.iter().map(|observed| {
        Ok(Validation {
            log: observed.logs.join(" + "),
            fit: score::torque(model, &observed.torque(kind)?.evidence, x),
        })
    });
    result.with_prior = Some(WithPrior {
        from_prior: posterior.from_prior,
        misfit: posterior.misfit,
        inflation,
        fit: score::torque(model, &train.torque(kind)?.evidence, x),
        validation: scored.collect::<Result<Vec<_>, IdentifyError>>()?,
        solution: posterior.mean,
    });
    Ok(())
}

fn posterior(
    model: &dyn IdentificationModel,
    gathered: &Gathered,
    (weights, estimate): (Weights, &Estimate),
    inflation: f64,
    prior: &[f64],
) -> Result<Posterior, EvidenceError> {
    match (weights, &gathered.rows) {
        (Weights::Robust, Some(rows)) => {
            let levels = Weighting::Given(estimate.joint_sigma.clone());
            let rows = reweighted(rows, estimate);
            Evidence::from_observations(model, &rows, &[], Cut::Blocks(1))?
                .posterior(&levels, inflation, prior)
        }
        _ => {
            let evidence = &gathered.evidence;
            evidence.posterior(&Weighting::Residual, inflation, prior)
        }
    }
}

/// The equations with the factors that the robust estimate gave their rows.
fn reweighted(observations: &Observations, estimate: &Estimate) -> Observations {
    let block = |(block, scale): (&Equations, &f64)| {
        let factors = row_factors(block, &estimate.solution, *scale);
        let times = |values: &[f64]| -> Vec<f64> {
            let rows = values.iter().zip(factors.iter().cycle());
            rows.map(|(value, factor)| value * factor).collect()
        };
        Equations {
            w: times(&block.w),
            y: block.y.as_deref().map(times),
            ..block.clone()
        }
    };
    let blocks = observations.blocks.iter().zip(&estimate.joint_sigma);
    Observations {
        model: observations.model,
        blocks: blocks.map(block).collect(),
    }
}

/// How much wider the corrected standard deviations are than the classical ones: the median over
/// the parameters, at least 1.
fn inflation(result: &ModelResult) -> f64 {
    let ratio = |(corrected, classical): (f64, f64)| corrected / classical;
    let parameters = result.parameters.iter();
    let mut ratios: Vec<f64> = parameters
        .filter_map(|p| p.sigma_corrected.zip(p.sigma).map(ratio))
        .filter(|ratio| ratio.is_finite())
        .collect();
    ratios.sort_unstable_by(f64::total_cmp);
    let median = ratios.get(ratios.len() / 2).copied();
    median.unwrap_or(1.0).max(1.0)
}
