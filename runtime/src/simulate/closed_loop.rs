//! Closed loop: the reference and the controller of a log, the dynamics of the identified model.

use super::advance::Simulator;
use super::controller::Regulator;
use super::dynamics::{Dynamics, check_joints};
use super::error::SimulateError;
use super::options::{Grid, Options, State};
use super::result::Simulation;
use super::trajectory::Trajectory;
use crate::log::{Controller, Reference};
use crate::model::IdentificationModel;

/// What a closed-loop simulation follows.
#[derive(Clone, Copy, Debug)]
pub struct ClosedLoop<'a> {
    /// The commanded motion.
    pub reference: &'a Reference,
    /// The control law; it runs once per sample and holds its torque until the next.
    pub controller: &'a Controller,
    /// The np parameters of the controller's own model for its feedforward: those of the
    /// description, with neither friction nor rotor inertia.
    pub rigid: &'a [f64],
    /// The samples.
    pub grid: Grid,
    /// Where the robot begins; `None`: on the reference.
    pub start: Option<&'a State>,
}

/// Simulates a controlled robot with the np `parameters` of the model.
///
/// The controller of a robot sees its position (quantised by
/// [`Options::encoder_resolution`]) and its velocity: exact, or the backward difference of the
/// position through the zero-order-hold equivalent of a first-order low-pass, which begins with
/// the true velocity.
///
/// # Errors
/// [`SimulateError::Joints`], [`SimulateError::Length`] for a reference, controller or start of
/// another robot; [`SimulateError::Parameters`], [`SimulateError::NotFinite`],
/// [`SimulateError::NotPositive`], [`SimulateError::Empty`] for impossible input;
/// [`SimulateError::NotPositiveDefinite`]; [`SimulateError::Diverged`] when a joint is further from
/// its reference than [`Options::tracking_limit`]; [`SimulateError::StepTooSmall`].
pub fn closed_loop(
    model: &dyn IdentificationModel,
    parameters: &[f64],
    plan: &ClosedLoop<'_>,
    options: &Options,
) -> Result<Simulation, SimulateError> {
    options.check()?;
    check_joints(model, "reference", plan.reference.joints())?;
    let reference = Trajectory::of(plan.reference, &plan.grid)?;
    let control = (plan.controller, &reference);
    let resolution = options.encoder_resolution;
    let mut regulator = Regulator::new(model, control, plan.rigid, &plan.grid, resolution)?;
    let on_reference = State {
        q: at(&reference.q, 0),
        qd: at(&reference.qd, 0),
    };
    let start = plan.start.unwrap_or(&on_reference);
    check_joints(model, "start", start.q.len())?;
    check_joints(model, "start", start.qd.len())?;
    let dynamics = Dynamics::new(model, parameters)?;
    let mut robot = Simulator::new(dynamics, options.method, start);
    let mut result = Simulation::new(&plan.grid, model.joints().len());
    let mut tau = vec![0.0; model.joints().len()];
    for k in 0..plan.grid.len {
        regulator.torque(k, (robot.q(), robot.qd()), &mut tau);
        result.push(robot.q(), robot.qd(), &tau);
        if k + 1 == plan.grid.len {
            break;
        }
        let (from, to) = (plan.grid.time(k), plan.grid.time(k + 1));
        robot.advance(&|_, held: &mut [f64]| held.copy_from_slice(&tau), from, to)?;
        let near =
            |(q, series): (&f64, &Vec<f64>)| (q - series[k + 1]).abs() <= options.tracking_limit;
        if let Some(joint) = robot
            .q()
            .iter()
            .zip(&reference.q)
            .position(|pair| !near(pair))
        {
            let joint = model.joints()[joint].name.to_string();
            return Err(SimulateError::Diverged {
                joint,
                what: "its reference",
                second: to,
            });
        }
    }
    Ok(result)
}

/// All series at one sample.
fn at(series: &[Vec<f64>], k: usize) -> Vec<f64> {
    series.iter().map(|values| values[k]).collect()
}
