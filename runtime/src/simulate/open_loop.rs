//! Open loop: a torque signal drives the identified model.

use super::advance::Simulator;
use super::dynamics::{Dynamics, check_joints};
use super::error::SimulateError;
use super::options::{Grid, Options, State};
use super::result::Simulation;
use super::trajectory::check_series;
use crate::model::IdentificationModel;

/// What drives an open-loop simulation.
#[derive(Clone, Copy, Debug)]
pub struct OpenLoop<'a> {
    /// Torque of each joint at every sample, N m or N; linear in between.
    pub tau: &'a [Vec<f64>],
    /// The samples.
    pub grid: Grid,
    /// Where the robot begins.
    pub start: &'a State,
}

/// Simulates a robot with the np `parameters` of the model under a sampled torque. An open loop
/// drifts: on a real log, compare it over seconds, not minutes.
///
/// # Errors
/// [`SimulateError::Joints`], [`SimulateError::Length`] for a torque or start of another robot;
/// [`SimulateError::Parameters`], [`SimulateError::NotFinite`], [`SimulateError::NotPositive`],
/// [`SimulateError::Empty`] for impossible input; [`SimulateError::NotPositiveDefinite`];
/// [`SimulateError::Diverged`] when a position or velocity passes 1e6;
/// [`SimulateError::StepTooSmall`].
pub fn open_loop(
    model: &dyn IdentificationModel,
    parameters: &[f64],
    plan: &OpenLoop<'_>,
    options: &Options,
) -> Result<Simulation, SimulateError> {
    options.check()?;
    plan.grid.check()?;
    check_joints(model, "torque", plan.tau.len())?;
    check_series("torque", plan.tau, plan.grid.len)?;
    check_joints(model, "start", plan.start.q.len())?;
    check_joints(model, "start", plan.start.qd.len())?;
    let dynamics = Dynamics::new(model, parameters)?;
    let mut robot = Simulator::new(dynamics, options.method, plan.start);
    let mut result = Simulation::new(&plan.grid, model.joints().len());
    let mut now = vec![0.0; model.joints().len()];
    for k in 0..plan.grid.len {
        now.iter_mut()
            .zip(plan.tau)
            .for_each(|(now, series)| *now = series[k]);
        result.push(robot.q(), robot.qd(), &now);
        if k + 1 == plan.grid.len {
            break;
        }
        let (from, to) = (plan.grid.time(k), plan.grid.time(k + 1));
        let between = |t: f64, tau: &mut [f64]| {
            let share = (t - from) * plan.grid.rate_hz;
            for (tau, series) in tau.iter_mut().zip(plan.tau) {
                *tau = series[k] + share * (series[k + 1] - series[k]);
            }
        };
        robot.advance(&between, from, to)?;
    }
    Ok(result)
}

/// Simulates a robot that nothing drives.
///
/// # Errors
/// As [`open_loop`].
pub fn free_motion(
    model: &dyn IdentificationModel,
    parameters: &[f64],
    (start, grid): (&State, Grid),
    options: &Options,
) -> Result<Simulation, SimulateError> {
    let tau = vec![vec![0.0; grid.len]; model.joints().len()];
    open_loop(
        model,
        parameters,
        &OpenLoop {
            tau: &tau,
            grid,
            start,
        },
        options,
    )
}
