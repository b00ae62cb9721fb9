//! Exciting motions: trajectories along which the parameters of a model can be told apart.
//!
//! The data go one way: limits and a [`Family`] make a space of motions; along each, the explicit
//! model gives W; a [`Criterion`] of W'W says how exciting it is, and its slope with respect to W is
//! pulled back through D, by differences of D at all instants together, to the coefficients of the
//! motion. Quasi-Newton descent from many random starts, limits as penalties, and in the end an
//! exact scaling of each joint, so that every limit holds. The best start is the [`Excitation`]:
//! with the condition of W, the standard deviation of each parameter to expect, and what no motion
//! determines.
//!
//! Sources: B. Armstrong, "On finding exciting trajectories for identification experiments involving
//! systems with nonlinear dynamics", Int. J. Robotics Research 8, 1989; M. Gautier and W. Khalil,
//! "Exciting trajectories for the identification of base inertial parameters of robots", IJRR 11,
//! 1992; J. Swevers, C. Ganseman, D. B. Tukel, J. De Schutter and H. Van Brussel, "Optimal robot
//! excitation and identification", IEEE Trans. Robotics and Automation 13, 1997.

mod cost;
mod criterion;
mod descent;
mod error;
mod expect;
mod family;
mod feasible;
mod limits;
mod motion;
mod random;
mod regressor;
mod report;
mod result;
mod search;
mod space;
mod stated;
#[cfg(test)]
mod tests;
mod within;

use faer::Mat;

pub use criterion::Criterion;
pub use error::ExciteError;
pub use expect::Noise;
pub use family::{Family, Start};
pub use limits::JointLimits;
pub use result::{ByChance, Excitation, Expected, JointUse, Search, Undetermined};
pub use stated::{Stated, StatedLimits, settle};

use crate::model::IdentificationModel;
use cost::Cost;
use family::{Basis, Sampled};
use regressor::Regressor;
use search::Effort;
use space::Space;
use within::Within;

/// Instants of a period at which the search looks, at least, and for each harmonic or point.
const INSTANTS: (usize, usize) = (80, 10);

/// Instants of a period at which limits and condition are checked, at least, and for each harmonic
/// or point.
const FINE: (usize, usize) = (1000, 100);

/// Random motions that the one found is compared to.
const CHANCES: usize = 100;

/// The robot, and what its motion must keep to.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// The model whose parameters are to be identified.
    pub model: &'a dyn IdentificationModel,
    /// Limits of each joint.
    pub limits: &'a [JointLimits],
    /// Centres of the motion, rad or m; searched if absent.
    pub center: Option<&'a [f64]>,
    /// Present values of the np parameters, for efforts and relative standard deviations.
    pub parameters: Option<&'a [f64]>,
}

/// What motion is looked for, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Family.
    pub family: Family,
    /// How it begins.
    pub start: Start,
    /// What is minimised.
    pub criterion: Criterion,
    /// One period, s.
    pub period_s: f64,
    /// How often it is repeated.
    pub periods: usize,
    /// How much is searched.
    pub search: Search,
    /// Noise of the torque.
    pub noise: Noise,
    /// Relative standard deviation that is wanted of each parameter, %.
    pub wanted_pct: Option<f64>,
}

/// How many times `done` will be called by [`excite`].
pub fn stages(settings: &Settings) -> usize {
    search::stages(settings.search.starts)
}

/// Looks for a motion; `done` is called now and then, from any thread, for a bar of progress.
///
/// # Errors
/// [`ExciteError`]: limits that no motion keeps to, a family without freedom, parameters that the
/// model does not take, a criterion that no motion can meet.
pub fn excite(
    task: &Task<'_>,
    settings: &Settings,
    done: &(dyn Fn() + Sync),
) -> Result<Excitation, ExciteError> {
    motion::check(task, settings)?;
    let within = Within::new(task)?;
    let separate = within.separate(task, &settings.criterion)?;
    let basis = Basis::new(settings.family, settings.start, settings.period_s);
    let space = Space::new(basis, task.limits, task.center);
    let fine = instants(&space, FINE, true);
    let weighted = settings.criterion.is_weighted();
    let cost = Cost {
        sampled: instants(&space, INSTANTS, false),
        regressor: regressor(task, settings, &within, weighted),
        space: &space,
        criterion: &settings.criterion,
        separate,
        parameters: task.parameters,
    };
    let Search {
        seed,
        starts,
        steps,
    } = settings.search;
    let effort = Effort {
        seed,
        starts,
        steps,
    };
    let found =
        search::search(&cost, &fine, effort, done).map_err(|beyond| motion::none(task, beyond))?;
    let chances = search::by_chance(&cost, &fine, (seed, CHANCES));
    let outcome = report::Outcome {
        task,
        settings,
        within: &within,
        space: &space,
        fine: &fine,
        z: &found.z,
    };
    outcome.excitation(found.value, &chances)
}

/// A basis at instants, as many as its family needs.
fn instants(space: &Space<'_>, (least, each): (usize, usize), ends: bool) -> Sampled {
    let parts = match space.basis.family {
        Family::Fourier { harmonics } => harmonics,
        Family::ViaPoints { points } => points + 1,
    };
    space.basis.sample(least.max(each * parts), ends)
}

fn regressor<'a>(
    task: &Task<'a>,
    settings: &Settings,
    within: &Within,
    weighted: bool,
) -> Regressor<'a> {
    let weight = match weighted {
        true => settings
            .noise
            .sigma
            .iter()
            .map(|sigma| 1.0 / sigma)
            .collect(),
        false => vec![1.0; task.limits.len()],
    };
    Regressor::new(task.model, &within.independent, weight)
}

/// W along a path.
fn matrix(regressor: &Regressor<'_>, path: &space::Path) -> Mat<f64> {
    regressor.matrix(&regressor.evaluate(path), path.len)
}
