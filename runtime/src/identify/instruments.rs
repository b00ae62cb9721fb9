//! Instrumental variables: instruments from the closed-loop simulation of the present estimate
//! (Janot, Vandanjon and Gautier 2014).

use super::{IdentifyError, Observed, Plan, Progress, score};
use crate::estimate::{Instrumental, instrumental, long_run};
use crate::evidence::{f_survival, student_quantile};
use crate::log::{Companion, Recording};
use crate::model::IdentificationModel;
use crate::observe::{Equations, ModelKind};
use crate::report::{Identification, InstrumentedFit, InstrumentedValue, ModelResult, Validation};
use crate::simulate::{Options as Simulating, feedforward_of, like};

/// Most simulations of each log.
const ROUNDS: usize = 10;

/// The rounds stop when no parameter moves by more than this share of its sigma.
const SETTLED: f64 = 0.05;

/// Probability of finding a bias where there is none, all parameters together.
const LEVEL: f64 = 0.05;

/// The normal quantile that users multiply a standard deviation with for 95 %.
const NORMAL: f64 = 1.96;

/// Adds to each model of a result its estimate with instruments: W along the simulated logs,
/// through the same filters. `train` are the logs of the result with their companions.
///
/// # Errors
/// [`IdentifyError::NoLoop`] if a log has no reference or controller; [`IdentifyError::Simulate`]
/// if the estimate cannot be simulated; those of [`super::identify`].
pub fn instruments(
    model: &dyn IdentificationModel,
    train: &[(Recording, Companion)],
    validate: &[Recording],
    result: &mut Identification,
    progress: &dyn Progress,
) -> Result<(), IdentifyError> {
    train.iter().try_for_each(in_closed_loop)?;
    let plan = Plan {
        models: result.models.iter().map(|model| model.name).collect(),
        filtering: result.filter.clone(),
        weights: result.weights,
        degrees_of_freedom: model.settings().degrees_of_freedom.unwrap_or_default(),
    };
    let observe = |log: &Recording| Observed::kept(model, log, &plan, progress);
    let measured = Observed::join(train.iter().map(|(log, _)| observe(log)))?;
    let checked = validate
        .iter()
        .map(observe)
        .collect::<Result<Vec<_>, _>>()?;
    let Some(first) = result.models.first() else {
        return Ok(());
    };
    let search = Search {
        model,
        train,
        plan: &plan,
        measured: &measured,
        progress,
    };
    let found = search.run(first)?;
    for result in &mut result.models {
        let estimate = search.solve(result.name, &found.simulated, &result.solution())?;
        let solution = &estimate.solution;
        let fit = score::torque(model, &measured.torque(result.name)?.evidence, solution);
        let validation = checked.iter().map(|observed| {
            Ok(Validation {
                log: observed.logs.join(" + "),
                fit: score::torque(model, &observed.torque(result.name)?.evidence, solution),
            })
        });
        let validation = validation.collect::<Result<Vec<_>, IdentifyError>>()?;
        let values = values(&estimate, &measured.rows(result.name)?.blocks);
        let biased = values.iter().zip(&result.parameters);
        let biased = biased
            .filter(|(value, _)| value.biased)
            .map(|(_, p)| p.name.clone());
        result.instrumented = Some(InstrumentedFit {
            simulations: found.rounds,
            converged: found.converged,
            biased: biased.collect(),
            solution: solution.clone(),
            fit,
            validation,
        });
        for (parameter, value) in result.parameters.iter_mut().zip(values) {
            parameter.instrumented = Some(value);
        }
    }
    Ok(())
}

fn in_closed_loop((log, companion): &(Recording, Companion)) -> Result<(), IdentifyError> {
    let missing = match (&companion.reference, &companion.controller) {
        (Some(_), Some(_)) => return Ok(()),
        (None, Some(_)) => "[reference]",
        (Some(_), None) => "[controller]",
        (None, None) => "[reference] and [controller]",
    };
    let log = log.name.clone();
    Err(IdentifyError::NoLoop { log, missing })
}

/// What the search for instruments goes through.
struct Search<'a> {
    model: &'a dyn IdentificationModel,
    train: &'a [(Recording, Companion)],
    plan: &'a Plan,
    measured: &'a Observed,
    progress: &'a dyn Progress,
}

/// The simulated logs of the last round.
struct Found {
    simulated: Observed,
    rounds: usize,
    converged: bool,
}

impl Search<'_> {
    /// Simulates and solves until nothing moves; it starts from the estimate with prior knowledge
    /// where there is one, since that can always be simulated.
    fn run(&self, first: &ModelResult) -> Result<Found, IdentifyError> {
        let known = first
            .with_prior
            .as_ref()
            .map(|prior| prior.solution.clone());
        let mut x = known.unwrap_or_else(|| first.solution());
        let mut rounds = 0;
        loop {
            rounds += 1;
            let simulated = self.simulated(&x)?;
            let next = self.solve(first.name, &simulated, &x)?;
            let moved = |k: usize| Some((next.solution[k] - x[k]).abs() / next.sigma[k]?);
            let moved = (0..x.len()).filter_map(moved).fold(0.0, f64::max);
            let converged = moved < SETTLED;
            if converged || rounds == ROUNDS {
                return Ok(Found {
                    simulated,
                    rounds,
                    converged,
                });
            }
            // What the log leaves open stays what it was, so that the robot can be simulated.
            for k in next.columns.iter().filter(|k| next.determined[**k]) {
                x[*k] = next.solution[*k];
            }
        }
    }

    /// The equations along the simulated logs, without any noise.
    fn simulated(&self, x: &[f64]) -> Result<Observed, IdentifyError> {
        let rigid = feedforward_of(self.model, x);
        Observed::join(self.train.iter().map(|(log, companion)| {
            self.progress.step(&format!("simulating {}", log.name));
            let options = Simulating::default();
            let simulated = like(self.model, (x, &rigid), (log, companion), &options);
            let simulated = simulated.map_err(|source| IdentifyError::Simulate {
                log: log.name.clone(),
                source,
            })?;
            let recording = Recording {
                // The same rows must be left out.
                doubtful: log.doubtful.clone(),
                ..simulated.into_recording(&log.name)
            };
            Observed::kept(self.model, &recording, self.plan, self.progress)
        }))
    }

    fn solve(
        &self,
        kind: ModelKind,
        simulated: &Observed,
        x: &[f64],
    ) -> Result<Instrumental, IdentifyError> {
        let np = self.model.columns().len();
        let (w, z) = (
            &self.measured.rows(kind)?.blocks,
            &simulated.rows(kind)?.blocks,
        );
        let estimate = |start: &[f64]| {
            instrumental(w, z, np, start).map_err(|source| IdentifyError::Estimate {
                model: kind,
                source,
            })
        };
        // The joints' error levels are those of the unbiased residual.
        estimate(&estimate(x)?.solution)
    }
}

/// The estimate of each parameter, and whether least squares are biased in it: a Durbin-Wu-Hausman
/// test of each difference, with Holm's correction for their number.
fn values(estimate: &Instrumental, blocks: &[Equations]) -> Vec<InstrumentedValue> {
    let errors: Vec<Vec<f64>> = blocks
        .iter()
        .map(|b| b.residual(&estimate.solution))
        .collect();
    let p = estimate.columns.len();
    let own = long_run(&estimate.influence, &errors, p);
    let difference = long_run(&estimate.influence_of_difference, &errors, p);
    let np = estimate.solution.len();
    let mut values: Vec<InstrumentedValue> = (0..np).map(|k| value(estimate, k)).collect();
    for (place, column) in estimate.columns.iter().enumerate() {
        let value = &mut values[*column];
        value.sigma_corrected = own
            .as_ref()
            .filter(|_| value.value.is_some())
            .map(|(sigma, dof)| sigma[place] * student_quantile(0.95, *dof) / NORMAL);
        if let (Some((sigma, dof)), Some(shift)) = (&difference, value.difference) {
            let t = shift / sigma[place];
            value.p_value = Some(f_survival(t * t, 1.0, *dof)).filter(|p| p.is_finite());
        }
    }
    holm(&mut values);
    values
}

fn value(estimate: &Instrumental, k: usize) -> InstrumentedValue {
    let known = estimate.determined[k];
    InstrumentedValue {
        value: known.then_some(estimate.solution[k]),
        sigma: estimate.sigma[k],
        sigma_corrected: None,
        difference: known.then_some(estimate.ordinary[k] - estimate.solution[k]),
        p_value: None,
        biased: false,
    }
}

/// Holm (1979): the smallest p-value against the level over their number, the next against one
/// less, until one does not pass. A bias below the parameter's sigma is real, but no matter.
fn holm(values: &mut [InstrumentedValue]) {
    let mut order: Vec<(usize, f64)> = values
        .iter()
        .enumerate()
        .filter_map(|(k, value)| Some((k, value.p_value?)))
        .collect();
    order.sort_by(|a, b| a.1.total_cmp(&b.1));
    let count = order.len();
    let passing = order
        .iter()
        .enumerate()
        .take_while(|(place, (_, p))| *p < LEVEL / (count - place) as f64);
    let passing: Vec<usize> = passing.map(|(_, (k, _))| *k).collect();
    for k in passing {
        let value = &mut values[k];
        let beyond = |(shift, sigma): (f64, f64)| shift.abs() > sigma;
        let sigma = value.sigma_corrected.or(value.sigma);
        value.biased = value.difference.zip(sigma).is_some_and(beyond);
    }
}
