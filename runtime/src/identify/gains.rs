//! Drive gains from a load of known mass: the factor between logged and true torque of each joint.

mod result;
mod system;

use super::{IdentifyError, Observed, Options, Progress, payload};
use crate::log::Recording;
use crate::model::IdentificationModel;
use crate::observe::{ModelKind, Observations};
use crate::report::DriveGains;
use crate::settings::Weights;
use result::Found;
use system::{System, beside};

/// A load of which something is known beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownLoad {
    /// Link that carries it, counted from 0.
    pub link: usize,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the MDH frame of the link, m, if it is known.
    pub com: Option<[f64; 3]>,
}

/// Identifies by which factor the logged torque of each joint must be multiplied, from logs
/// without and with a load of known mass, together with all np parameters of the robot and what is
/// not known of the load:
/// \\( g_j \tau_j = W_j X \\) without the load, \\( g_j \tau_j = W_j X + W_j K_l X_{load} \\) with
/// it. Only what is known of the load sets the scale (Gautier and Briot, "Global identification of
/// joint drive gains and dynamic parameters of robots", 2014). The noise is that of
/// \\( \tau_j \\), which stands on the side of the unknowns: the sum of
/// \\( \|\tau_j - (W_j X + W_j K_l X_{load}) / g_j\|^2 / \sigma_j^2 \\) is minimised, which is
/// total least squares with noise in the columns of the torques alone. Weights of single rows
/// ([`Weights::Robust`]) are those of their joint here.
///
/// # Errors
/// [`IdentifyError::LoadMass`], [`IdentifyError::LoadCentre`] for a load that cannot be;
/// [`IdentifyError::NoLink`], [`IdentifyError::LoadUnfelt`] for one that no joint feels;
/// [`IdentifyError::JointRests`]; those of [`super::identify`].
pub fn gains(
    model: &dyn IdentificationModel,
    (unloaded, loaded): (&[Recording], &[Recording]),
    load: &KnownLoad,
    options: &Options,
    progress: &dyn Progress,
) -> Result<DriveGains, IdentifyError> {
    let known = known(load)?;
    let carried = payload::carried(model, load.link)?;
    if !felt(&known, &carried) {
        return Err(unfelt(model, load));
    }
    if unloaded.is_empty() || loaded.is_empty() {
        return Err(IdentifyError::NoLogs);
    }
    let asked = Options {
        models: vec![ModelKind::Explicit],
        ..options.clone()
    };
    let logs: Vec<Recording> = unloaded.iter().chain(loaded).cloned().collect();
    let plan = asked.resolve(model, &logs)?;
    let observe = |log: &Recording| Observed::kept(model, log, &plan, progress);
    let observed = logs.iter().map(observe).collect::<Result<Vec<_>, _>>()?;
    moving(model, &observed)?;
    progress.step("solving for gains, robot and load");
    let system = System {
        np: model.columns().len(),
        joints: model.joints().len(),
        known,
        weights: match plan.weights {
            Weights::None => Weights::None,
            Weights::Joint | Weights::Robust => Weights::Joint,
        },
        logs: equations(model, observed.split_at(unloaded.len()), &carried)?,
    };
    let names = |logs: &[Recording]| logs.iter().map(|log| log.name.clone()).collect();
    let noticed = logs.iter().flat_map(|log| log.warnings.clone());
    let found = Found::new(model, load, &system)?;
    if found.factors.iter().all(|found| found.factor.is_none()) {
        return Err(unfelt(model, load));
    }
    Ok(DriveGains {
        warnings: noticed.chain(found.doubts()).collect(),
        ..found.report((names(unloaded), names(loaded)), plan.filtering)
    })
}

fn unfelt(model: &dyn IdentificationModel, load: &KnownLoad) -> IdentifyError {
    IdentifyError::LoadUnfelt {
        robot: model.name().to_owned(),
        link: load.link + 1,
    }
}

/// The equations of each log, with the load where it is.
fn equations(
    model: &dyn IdentificationModel,
    (unloaded, loaded): (&[Observed], &[Observed]),
    carried: &[Vec<f64>; 10],
) -> Result<Vec<Observations>, IdentifyError> {
    let wide = |log: &Observed, is_loaded| {
        let rows = log.rows(ModelKind::Explicit)?;
        Ok(beside(model, rows, carried, is_loaded))
    };
    let without = unloaded.iter().map(|log| wide(log, false));
    let with = loaded.iter().map(|log| wide(log, true));
    without.chain(with).collect()
}

/// The standard parameters of a load that are known: its mass, and first moments with its centre.
fn known(load: &KnownLoad) -> Result<[Option<f64>; 10], IdentifyError> {
    let mass = load.mass;
    if !(mass.is_finite() && mass > 0.0) {
        return Err(IdentifyError::LoadMass { mass });
    }
    let mut known = [None; 10];
    known[9] = Some(mass);
    if let Some(com) = load.com {
        if com.iter().any(|c| !c.is_finite()) {
            return Err(IdentifyError::LoadCentre);
        }
        for (place, c) in known[6..9].iter_mut().zip(com) {
            *place = Some(mass * c);
        }
    }
    Ok(known)
}

/// Whether anything that is known of the load changes a base parameter.
fn felt(known: &[Option<f64>; 10], carried: &[Vec<f64>; 10]) -> bool {
    let terms = known.iter().zip(carried);
    terms
        .filter(|(known, _)| known.is_some_and(|value| value != 0.0))
        .any(|(_, column)| column.iter().any(|factor| *factor != 0.0))
}

/// Every joint must move in one log at least.
fn moving(model: &dyn IdentificationModel, observed: &[Observed]) -> Result<(), IdentifyError> {
    let everywhere = |joint: &usize| observed.iter().all(|log| log.resting.contains(joint));
    match (0..model.joints().len()).find(everywhere) {
        None => Ok(()),
        Some(joint) => Err(IdentifyError::JointRests {
            joint: joint + 1,
            name: model.joints()[joint].name.to_string(),
            logs: observed
                .iter()
                .flat_map(|log| log.logs.clone())
                .collect::<Vec<_>>()
                .join(", "),
        }),
    }
}
