//! What a solution says of gains and load, and what is to be said about it.

use super::super::corrected::corrected;
use super::super::other_columns::{OtherColumns, column};
use super::super::{IdentifyError, payload};
use super::KnownLoad;
use super::system::{Solved, System, joined};
use crate::estimate::Estimate;
use crate::evidence::{Cut, Evidence};
use crate::knowledge::{STANDARD, STANDARD_UNITS};
use crate::model::{ColumnKind, IdentificationModel};
use crate::observe::{Filtering, ModelKind, Observations};
use crate::report::{DriveGains, GainFactor, LoadParameter, Physical};

/// A factor that is not at least this many of its standard deviations is not told.
const TOLD: f64 = 3.0;

/// A factor is said to be uncertain from this share of it.
const UNCERTAIN: f64 = 0.05;

/// What was found.
pub(super) struct Found<'a> {
    model: &'a dyn IdentificationModel,
    load: &'a KnownLoad,
    /// With all torques as logged.
    start: Estimate,
    solved: Solved,
    pub factors: Vec<GainFactor>,
    parameters: Vec<LoadParameter>,
}

impl<'a> Found<'a> {
    /// Solves the equations.
    pub fn new(
        model: &'a dyn IdentificationModel,
        load: &'a KnownLoad,
        system: &System,
    ) -> Result<Self, IdentifyError> {
        let failed = |source| IdentifyError::Estimate {
            model: ModelKind::Explicit,
            source,
        };
        let start = system.as_logged().map_err(failed)?;
        let solved = system.solve(&start).map_err(failed)?;
        let sigmas = sigmas(model, load, system, &solved)?;
        Ok(Found {
            model,
            load,
            start,
            factors: factors(model, system, &solved, &sigmas),
            parameters: parameters(system, &solved, &sigmas),
            solved,
        })
    }

    /// Everything but what is to be said about it.
    pub fn report(
        self,
        (unloaded, loaded): (Vec<String>, Vec<String>),
        filter: Filtering,
    ) -> DriveGains {
        let mass = self.model.columns().len() + STANDARD.len() - 1;
        let open = self.factors.iter().filter(|found| found.factor.is_none());
        DriveGains {
            robot: self.model.name().to_owned(),
            unloaded,
            loaded,
            filter,
            link: self.load.link + 1,
            mass: self.load.mass,
            mass_as_logged: self.start.determined[mass].then_some(self.start.solution[mass]),
            rows: self.solved.estimate.rows,
            rank: self.solved.estimate.rank,
            condition: self.solved.estimate.condition,
            rounds: self.solved.rounds,
            converged: self.solved.converged,
            not_reached: open.map(|found| found.joint).collect(),
            physical: Physical::of(&self.parameters),
            load: self.parameters,
            factors: self.factors,
            warnings: Vec::new(),
        }
    }

    /// What is to be said about the factors.
    pub fn doubts(&self) -> Vec<String> {
        let named = |holds: &dyn Fn(&GainFactor) -> bool| {
            let these = self.factors.iter().filter(|found| holds(found));
            let names = these.map(|found| format!("{} ({})", found.joint, found.name));
            names.collect::<Vec<_>>().join(", ")
        };
        let open = named(&|found| found.factor.is_none());
        let uncertain = named(&|found| {
            let sigma = found.sigma_corrected.or(found.sigma).unwrap_or(0.0);
            found.factor.is_some_and(|value| sigma > UNCERTAIN * value)
        });
        let mut doubts = Vec::new();
        if !open.is_empty() {
            doubts.push(format!(
                "what is known of the load does not reach joint {open}: no factor can be told \
                 there."
            ));
        }
        if !uncertain.is_empty() {
            doubts.push(format!(
                "the factor of joint {uncertain} has a sigma of more than {} %; a heavier load, \
                 one further from the axis, or its centre of mass would tell more.",
                100.0 * UNCERTAIN
            ));
        }
        if !self.solved.converged {
            doubts.push("the factors did not come to rest: do not rely on them.".to_owned());
        }
        doubts
    }
}

/// Of all columns, from the evidence of the linearised equations.
fn sigmas(
    model: &dyn IdentificationModel,
    load: &KnownLoad,
    system: &System,
    solved: &Solved,
) -> Result<Vec<Option<f64>>, IdentifyError> {
    let robot = model.columns().iter().cloned();
    let factors = (1..=system.joints).map(|joint| {
        let name = format!("g{joint}");
        column((&name, ""), (joint, ColumnKind::Drive), "factor of torque")
    });
    let columns = robot.chain(payload::columns(load.link)).chain(factors);
    let named = OtherColumns::new(model, columns.collect());
    let of = |log: &Observations| Evidence::from_observations(&named, log, &[], Cut::default());
    let mut together: Option<Evidence> = None;
    for log in system.linearised(&solved.point, &solved.reached) {
        let evidence = of(&log).and_then(|evidence| match &mut together {
            Some(together) => together.merge(&evidence),
            None => {
                together = Some(evidence);
                Ok(())
            }
        });
        evidence.map_err(IdentifyError::evidence(ModelKind::Explicit))?;
    }
    let together = together.ok_or(IdentifyError::NoLogs)?;
    Ok(corrected(&named, &together, system.weights))
}

fn factors(
    model: &dyn IdentificationModel,
    system: &System,
    solved: &Solved,
    sigmas: &[Option<f64>],
) -> Vec<GainFactor> {
    let logged = joined(&system.logs);
    let names = model.joints().iter().map(|joint| joint.name.to_string());
    let factor = |(joint, name): (usize, String)| {
        let place = system.factor(joint);
        let told = solved.reached[joint] && solved.estimate.determined[place];
        let (sigma, corrected) = (solved.estimate.sigma[place], sigmas[place]);
        let value = solved.point.factors[joint];
        let largest = sigma.unwrap_or(0.0).max(corrected.unwrap_or(0.0));
        let told = told && TOLD * largest <= value;
        let block = &logged.blocks[joint];
        let norm = |values: &[f64]| values.iter().map(|x| x * x).sum::<f64>().sqrt();
        let left = norm(&block.residual(&solved.point.along[joint]));
        let all = norm(block.y.as_deref().unwrap_or_default());
        GainFactor {
            joint: joint + 1,
            name,
            factor: told.then_some(value),
            sigma: sigma.filter(|_| told),
            sigma_corrected: corrected.filter(|_| told),
            error_pct: if all > 0.0 { 100.0 * left / all } else { 0.0 },
        }
    };
    names.enumerate().map(factor).collect()
}

fn parameters(system: &System, solved: &Solved, sigmas: &[Option<f64>]) -> Vec<LoadParameter> {
    let parameter = |k: usize| {
        let place = system.np + k;
        let found = solved.estimate.determined[place];
        let free = found && system.known[k].is_none();
        LoadParameter {
            name: STANDARD[k].to_owned(),
            unit: STANDARD_UNITS[k].to_owned(),
            value: system.known[k].or(found.then_some(solved.estimate.solution[place])),
            sigma: solved.estimate.sigma[place].filter(|_| free),
            sigma_corrected: sigmas[place].filter(|_| free),
        }
    };
    (0..STANDARD.len()).map(parameter).collect()
}
