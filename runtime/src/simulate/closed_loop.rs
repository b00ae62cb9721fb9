//! Closed loop: the reference and the controller of a log, the dynamics of the identified model.

use super::advance::Simulator;
use super::controller::Regulator;
use super::dynamics::{Dynamics, check_joints};
use super::error::SimulateError;
use super::options::{Grid, Options, State};
use super::plant::{Driving, Encoder, Plant};
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

/// What a controlled robot does and what its controller knows of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The true motion of every joint of the plant's model, and the torque at it.
    pub motion: Simulation,
    /// What the encoders read, one series per driven joint, rad or m.
    pub q: Vec<Vec<f64>>,
    /// What the controller commands, one series per driven joint, N m or N.
    pub tau: Vec<Vec<f64>>,
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
    let mut plant = Plant::ideal(model, parameters);
    let encoder = Encoder {
        resolution: options.encoder_resolution,
        ..Encoder::default()
    };
    plant.encoders.fill(encoder);
    Ok(controlled(plant, model, plan, options)?.motion)
}

/// Simulates a plant under the controller of a robot, which knows the `nominal` model and the
/// plant's driven joints. As [`closed_loop`], with the plant's own encoders; a start is that of all
/// joints of the plant, and joints without a drive begin at rest in zero.
///
/// # Errors
/// As [`closed_loop`].
pub fn controlled(
    mut plant: Plant<'_>,
    nominal: &dyn IdentificationModel,
    plan: &ClosedLoop<'_>,
    options: &Options,
) -> Result<Measured, SimulateError> {
    options.check()?;
    check_joints(nominal, "reference", plan.reference.joints())?;
    check_plant(&plant, nominal)?;
    let reference = Trajectory::of(plan.reference, &plan.grid)?;
    let control = (plan.controller, &reference);
    let mut regulator = Regulator::new(nominal, control, plan.rigid, &plan.grid)?;
    let start = match plan.start {
        Some(start) => start.clone(),
        None => on_reference(&plant, &reference),
    };
    check_joints(plant.model, "start", start.q.len())?;
    check_joints(plant.model, "start", start.qd.len())?;
    let mut dynamics = Dynamics::new(plant.model, plant.parameters)?;
    dynamics.influences = std::mem::take(&mut plant.influences);
    let mut robot = Simulator::new(dynamics, options.method, &start);
    let mut driving = Driving::new(&plant);
    let mut log = Log::new(&plant, &plan.grid);
    for k in 0..plan.grid.len {
        let now = plan.grid.time(k);
        log.look(&plant, &robot);
        regulator.torque(k, (&log.q, &log.qd), &mut log.command);
        driving.command(now, &log.command);
        log.write(&robot, &driving, now);
        if k + 1 == plan.grid.len {
            break;
        }
        robot.begin(now);
        let torque = |t: f64, tau: &mut [f64]| driving.at(t, tau);
        robot.advance(&torque, now, plan.grid.time(k + 1))?;
        let seen = plant.driven.iter().map(|&joint| robot.q()[joint]);
        let aims = reference.q.iter().map(|series| series[k + 1]);
        let far =
            |(q, aim): (f64, f64)| (q - aim).is_nan() || (q - aim).abs() > options.tracking_limit;
        if let Some(place) = seen.zip(aims).position(far) {
            return Err(SimulateError::Diverged {
                joint: nominal.joints()[place].name.to_string(),
                what: "its reference",
                second: plan.grid.time(k + 1),
            });
        }
    }
    Ok(log.measured)
}

/// The log of a controlled robot, with what is seen and commanded at the present sample.
struct Log {
    measured: Measured,
    q: Vec<f64>,
    qd: Vec<f64>,
    command: Vec<f64>,
    tau: Vec<f64>,
}

impl Log {
    fn new(plant: &Plant<'_>, grid: &Grid) -> Log {
        let (joints, driven) = (plant.model.joints().len(), plant.driven.len());
        let series = || vec![Vec::with_capacity(grid.len); driven];
        Log {
            measured: Measured {
                motion: Simulation::new(grid, joints),
                q: series(),
                tau: series(),
            },
            q: vec![0.0; driven],
            qd: vec![0.0; driven],
            command: vec![0.0; driven],
            tau: vec![0.0; joints],
        }
    }

    /// Reads the encoders; velocities are the true ones.
    fn look(&mut self, plant: &Plant<'_>, robot: &Simulator<'_>) {
        for (place, &joint) in plant.driven.iter().enumerate() {
            self.q[place] = plant.encoders[place].reads(robot.q()[joint]);
            self.qd[place] = robot.qd()[joint];
        }
    }

    fn write(&mut self, robot: &Simulator<'_>, driving: &Driving<'_>, now: f64) {
        driving.at(now, &mut self.tau);
        self.measured.motion.push(robot.q(), robot.qd(), &self.tau);
        for place in 0..self.q.len() {
            self.measured.q[place].push(self.q[place]);
            self.measured.tau[place].push(self.command[place]);
        }
    }
}

/// Whether a plant has what the robot that its controller knows has.
fn check_plant(plant: &Plant<'_>, nominal: &dyn IdentificationModel) -> Result<(), SimulateError> {
    check_joints(nominal, "plant", plant.driven.len())?;
    check_joints(nominal, "list of drives", plant.drives.len())?;
    check_joints(nominal, "list of encoders", plant.encoders.len())?;
    let highest = plant.driven.iter().map(|joint| joint + 1).max();
    match highest {
        Some(joints) if joints > plant.model.joints().len() => {
            check_joints(plant.model, "list of driven joints", joints)
        }
        _ => Ok(()),
    }
}

/// Driven joints where the reference begins, all others at rest in zero.
fn on_reference(plant: &Plant<'_>, reference: &Trajectory) -> State {
    let joints = plant.model.joints().len();
    let mut start = State {
        q: vec![0.0; joints],
        qd: vec![0.0; joints],
    };
    for (place, &joint) in plant.driven.iter().enumerate() {
        start.q[joint] = reference.q[place][0];
        start.qd[joint] = reference.qd[place][0];
    }
    start
}
