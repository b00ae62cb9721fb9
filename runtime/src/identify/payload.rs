//! A load on a link: its ten parameters relative to a robot whose own are known.

use super::corrected::corrected;
use super::other_columns::{OtherColumns, column};
use super::{IdentifyError, Observed, Options, Progress, score};
use crate::estimate::{Estimate, estimate};
use crate::evidence::{Cut, Evidence};
use crate::knowledge::{STANDARD, STANDARD_UNITS};
use crate::log::Recording;
use crate::model::{Column, ColumnKind, IdentificationModel};
use crate::observe::{Equations, ModelKind, Observations};
use crate::report::{LoadParameter, Payload, Physical};

/// Identifies the ten standard parameters of a load fixed to a link (counted from 0), in the
/// frame of that link, from `logs` with the load and the np parameters `nominal` of the robot
/// without it: weighted least squares of \\( Y - W X = W K_l X_{load} \\), where the columns of
/// \\( K_l \\) are the regrouping relations of the link's own parameters (Khalil, Gautier and
/// Lemoine, "Identification of the payload inertial parameters of industrial manipulators", 2007).
///
/// # Errors
/// [`IdentifyError::NoLink`] for a link that is not there or whose relations are not known;
/// [`IdentifyError::Parameters`]; those of [`super::identify`].
pub fn payload(
    model: &dyn IdentificationModel,
    logs: &[Recording],
    (nominal, link): (&[f64], usize),
    options: &Options,
    progress: &dyn Progress,
) -> Result<Payload, IdentifyError> {
    let np = model.columns().len();
    check(model, nominal)?;
    let carried = carried(model, link)?;
    let asked = Options {
        models: vec![ModelKind::Explicit],
        ..options.clone()
    };
    let plan = asked.resolve(model, logs)?;
    let observe = |log: &Recording| Observed::kept(model, log, &plan, progress);
    let observed = Observed::join(logs.iter().map(observe))?;
    let kind = ModelKind::Explicit;
    let robot = &observed.of(kind)?.evidence;
    let blocks = observed.rows(kind)?.blocks.iter();
    let load = Observations {
        model: kind,
        blocks: blocks.map(|block| seen(block, nominal, &carried)).collect(),
    };
    let found = estimate(&load.blocks, STANDARD.len(), plan.weights).map_err(|source| {
        IdentifyError::Estimate {
            model: kind,
            source,
        }
    })?;
    let on_load = OtherColumns::new(model, columns(link).collect());
    let evidence = Evidence::from_observations(&on_load, &load, &[], Cut::default())
        .map_err(IdentifyError::evidence(kind))?;
    let sigmas = corrected(&on_load, &evidence, plan.weights);
    let parameters = parameters(&found, &sigmas);
    let all: Vec<f64> = (0..np)
        .map(|k| nominal[k] + along(&carried, k, &found.solution))
        .collect();
    Ok(Payload {
        robot: model.name().to_owned(),
        link: link + 1,
        rows: found.rows,
        rank: found.rank,
        condition: found.condition,
        physical: Physical::of(&parameters),
        parameters,
        before: score::torque(model, robot, nominal),
        after: score::torque(model, robot, &all),
        warnings: logs.iter().flat_map(|log| log.warnings.clone()).collect(),
        logs: observed.logs,
        filter: plan.filtering,
    })
}

/// Whether the parameters of the robot without load are as many as it has.
fn check(model: &dyn IdentificationModel, nominal: &[f64]) -> Result<(), IdentifyError> {
    let np = model.columns().len();
    match nominal.len() == np {
        true => Ok(()),
        false => Err(IdentifyError::Parameters {
            robot: model.name().to_owned(),
            has: nominal.len(),
            needs: np,
        }),
    }
}

/// The columns of K of the link, if a joint feels any of them.
pub(super) fn carried(
    model: &dyn IdentificationModel,
    link: usize,
) -> Result<[Vec<f64>; 10], IdentifyError> {
    let carried = model.knowledge().carried(link, model.columns().len());
    match carried.iter().flatten().all(|factor| *factor == 0.0) {
        true => Err(IdentifyError::NoLink {
            robot: model.name().to_owned(),
            link: link + 1,
            links: model.joints().len(),
        }),
        false => Ok(carried),
    }
}

fn parameters(found: &Estimate, sigmas: &[Option<f64>]) -> Vec<LoadParameter> {
    let parameter = |k: usize| LoadParameter {
        name: STANDARD[k].to_owned(),
        unit: STANDARD_UNITS[k].to_owned(),
        value: found.determined[k].then_some(found.solution[k]),
        sigma: found.sigma[k],
        sigma_corrected: sigmas[k].filter(|_| found.determined[k]),
    };
    (0..STANDARD.len()).map(parameter).collect()
}

/// What the load adds to base parameter `k`.
fn along(carried: &[Vec<f64>; 10], k: usize, load: &[f64]) -> f64 {
    let terms = carried.iter().zip(load);
    terms.map(|(column, value)| column[k] * value).sum()
}

/// The equations of the load in those of a joint: \\( W K_l \\), and what the robot leaves of Y.
/// Parameters of the load that the joint cannot see have no column.
fn seen(block: &Equations, nominal: &[f64], carried: &[Vec<f64>; 10]) -> Equations {
    let mut equations = Equations {
        columns: Vec::new(),
        rows: block.rows,
        w: Vec::new(),
        y: block.y.as_ref().map(|_| block.residual(nominal)),
    };
    for (parameter, factors) in carried.iter().enumerate() {
        if felt(block, factors) {
            equations.columns.push(parameter);
            equations.w.extend(block.product(factors));
        }
    }
    equations
}

/// Whether a joint sees a parameter of the load.
pub(super) fn felt(block: &Equations, factors: &[f64]) -> bool {
    block.columns.iter().any(|column| factors[*column] != 0.0)
}

/// The ten columns of a load on a link.
pub(super) fn columns(link: usize) -> impl Iterator<Item = Column> {
    let named = STANDARD.iter().zip(STANDARD_UNITS);
    named.map(move |(name, unit)| {
        column(
            (name, unit),
            (link + 1, ColumnKind::Inertial),
            "of the load",
        )
    })
}
