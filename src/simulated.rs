//! The motion of a log simulated in closed loop, with the model as a diagnosis found it described
//! and with what was found.
//!
//! Effects that a description can ask for are columns of the extended model; a turned base, other
//! lengths and gears that yield change the simulated robot itself. Errors of drives and encoders,
//! friction under load and friction that drifts are parts of the plant around it.

use idim_codegen::base::BaseError;
use idim_runtime::diagnose::Log;
use idim_runtime::log::{Controller, Reference, Start};
use idim_runtime::model::{IdentificationModel, JointKind};
use idim_runtime::report::{Change, Diagnosis, FoundEffect, GapCurves, Rms};
use idim_runtime::simulate::{
    ClosedLoop, Drift, Drive, Encoder, Grid, LoadFriction, Method, Options, Plant, SimulateError,
    State, Trajectory, beginning, controlled, feedforward_of, inverse_dynamics, off_reference,
};

use crate::catalogue::{Effects, Extension, Gear, Whole};
use crate::interpreted::Interpreter;

/// Step of the integration, s: far below what a controlled robot does, and a log's rate.
const STEP_S: f64 = 1e-3;

/// Step against the stops of a gear.
const STOPS_STEP_S: f64 = 2.5e-4;

/// A motion without and with the effects, one series per joint on the grid of the log; rad or m.
#[derive(Clone, Debug, PartialEq)]
pub struct Motions {
    /// With the model as it is described, refitted.
    pub before: Vec<Vec<f64>>,
    /// With what was found.
    pub after: Vec<Vec<f64>>,
    /// What of it could not be simulated, in a sentence each.
    pub left_out: Vec<String>,
}

/// Why there is no simulation of a log that has a reference and a controller.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoMotion {
    /// The simulation itself.
    #[error("{log}: its motion cannot be simulated: {source}")]
    Simulate {
        /// The log.
        log: String,
        /// Why not.
        source: SimulateError,
    },
    /// The reference is not that of the log.
    #[error(
        "{log}: it leaves its reference at {second:.3} s, so its motion is not simulated: the \
         reference is not that of this log, or the robot did not follow it"
    )]
    Elsewhere {
        /// The log.
        log: String,
        /// Where, s.
        second: f64,
    },
    /// The robot with what was found.
    #[error("{log}: its motion is not simulated: {source}")]
    Robot {
        /// The log.
        log: String,
        /// Why not.
        source: BaseError,
    },
}

/// What of a diagnosis the simulation does not hold, in a sentence each.
fn left_out(diagnosis: &Diagnosis, whole: &Whole) -> Vec<String> {
    let effects = whole.left_out.iter();
    let effects = effects.filter_map(|place| diagnosis.effects.get(*place));
    let sentence = |effect: &FoundEffect| match effect.effect.as_str() {
        "joint_elasticity" | "backlash" => format!(
            "the simulated motion is without {}: the inertia of the rotor before the gear is not \
             described; state it in [parameters] (IA) and ask for the effect `rotor_inertia`",
            effect.effect
        ),
        other => format!("the simulated motion is without {other}, which has no simulation"),
    };
    effects.map(sentence).collect()
}

/// Simulates the motion of a log under its reference and controller; `None` if it has not both.
///
/// # Errors
/// [`NoMotion`]: the log does not follow its reference, or the simulation is not possible.
pub fn motions(
    model: &dyn IdentificationModel,
    diagnosis: &Diagnosis,
    (catalogue, extension): (&Effects, &Extension),
    log: &Log,
) -> Result<Option<Motions>, NoMotion> {
    let (Some(reference), Some(controller)) = (&log.companion.reference, &log.companion.controller)
    else {
        return Ok(None);
    };
    let name = || log.recording.name.clone();
    let failed = |source| NoMotion::Simulate {
        log: name(),
        source,
    };
    if let Some(part) = off_reference(model, &log.recording, reference).map_err(failed)? {
        return Err(NoMotion::Elsewhere {
            log: name(),
            second: part.second,
        });
    }
    let before: Vec<f64> = diagnosis
        .parameters
        .iter()
        .map(|p| p.before.value)
        .collect();
    let course = Course {
        model,
        rigid: feedforward_of(model, &before),
        reference,
        controller,
        log,
    };
    let whole = catalogue.whole(diagnosis, extension, &largest(log));
    let whole = whole.map_err(|source| NoMotion::Robot {
        log: name(),
        source,
    })?;
    let robot = Interpreter::new(&whole.robot);
    let run_before = || course.run(Plant::ideal(model, &before), &[]);
    let run_after = || {
        let mut plant = plant(&robot, diagnosis, extension, &whole)?;
        let more = catalogue.influences(diagnosis, extension, &whole);
        plant.influences.extend(more);
        course.run(plant, &whole.gears)
    };
    let (before, after) = match diagnosis.effects.is_empty() {
        true => {
            let only = run_before();
            (only.clone(), only)
        }
        false => std::thread::scope(|scope| {
            let other = scope.spawn(run_before);
            let after = run_after();
            // A thread that does not come back has panicked, which this one then does too.
            let before = other.join();
            (
                before.unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
                after,
            )
        }),
    };
    Ok(Some(Motions {
        before: before.map_err(failed)?,
        after: after.map_err(failed)?,
        left_out: left_out(diagnosis, &whole),
    }))
}

/// Largest torque of each joint in a log, N m or N.
fn largest(log: &Log) -> Vec<f64> {
    let top = |tau: &Vec<f64>| tau.iter().fold(0.0, |top: f64, tau| top.max(tau.abs()));
    log.recording.tau.iter().flatten().map(top).collect()
}

/// What both simulations follow.
struct Course<'a> {
    model: &'a dyn IdentificationModel,
    rigid: Vec<f64>,
    reference: &'a Reference,
    controller: &'a Controller,
    log: &'a Log,
}

impl Course<'_> {
    /// What the encoders of a plant with gears read.
    fn run(&self, mut plant: Plant<'_>, gears: &[Gear]) -> Result<Vec<Vec<f64>>, SimulateError> {
        for encoder in &mut plant.encoders {
            encoder.resolution = self.log.companion.encoder_resolution;
        }
        let grid = Grid::of(&self.log.recording);
        let start = match gears {
            [] => None,
            gears => Some(self.behind_gears(&plant, gears, &grid)?),
        };
        let logged: State = beginning(&self.log.recording);
        let logged = (self.controller.start == Start::Log).then_some(&logged);
        let plan = ClosedLoop {
            reference: self.reference,
            controller: self.controller,
            rigid: &self.rigid,
            grid,
            start: start.as_ref().or(logged),
        };
        let stops = gears.iter().any(|gear| gear.gap > 0.0);
        let options = Options {
            method: Method::Fixed {
                step_s: if stops { STOPS_STEP_S } else { STEP_S },
            },
            ..Options::default()
        };
        Ok(controlled(plant, self.model, &plan, &options)?.q)
    }

    /// Where a plant begins: drives as in the log or on the reference, links where their load bends
    /// the gears to.
    fn behind_gears(
        &self,
        plant: &Plant<'_>,
        gears: &[Gear],
        grid: &Grid,
    ) -> Result<State, SimulateError> {
        let first = Grid { len: 8, ..*grid };
        let reference = Trajectory::of(self.reference, &first)?;
        let driven = match self.controller.start {
            Start::Log => beginning(&self.log.recording),
            Start::Reference => State {
                q: reference.q.iter().map(|q| q[0]).collect(),
                qd: reference.qd.iter().map(|qd| qd[0]).collect(),
            },
        };
        let load = inverse_dynamics(self.model, &self.rigid, &reference)?;
        let joints = plant.model.joints().len();
        let mut start = State {
            q: vec![0.0; joints],
            qd: vec![0.0; joints],
        };
        for (place, &joint) in plant.driven.iter().enumerate() {
            (start.q[joint], start.qd[joint]) = (driven.q[place], driven.qd[place]);
            for gear in gears.iter().filter(|gear| gear.link == joint + 1) {
                let load = load[place][0];
                let bent = load / gear.stiffness + 0.5 * gear.gap * load.signum();
                start.q[gear.link] = -bent;
            }
        }
        Ok(start)
    }
}

/// The robot that was found with what its drives, encoders and friction do.
fn plant<'a>(
    model: &'a Interpreter,
    diagnosis: &Diagnosis,
    extension: &Extension,
    whole: &'a Whole,
) -> Result<Plant<'a>, SimulateError> {
    let mut plant = Plant {
        drives: vec![Drive::IDEAL; whole.driven.len()],
        encoders: vec![Encoder::default(); whole.driven.len()],
        driven: whole.driven.clone(),
        ..Plant::ideal(model, &whole.parameters)
    };
    for (place, _) in &extension.elsewhere {
        if let Some(effect) = diagnosis.effects.get(*place) {
            put(effect, &mut plant, whole)?;
        }
    }
    Ok(plant)
}

/// Adds an effect to a plant, if it is one of drives, encoders and friction.
fn put(effect: &FoundEffect, plant: &mut Plant<'_>, whole: &Whole) -> Result<(), SimulateError> {
    let value = |k: usize| effect.parameters.get(k).map_or(0.0, |found| found.value);
    let shape = |name: &str| effect.shape.get(name).copied().unwrap_or(0.0);
    let column = |name: &str, joint: usize| {
        let name = format!("{name}{}", whole.driven[joint] + 1);
        let mut columns = whole.robot.base.parameters.iter();
        columns.position(|parameter| parameter.name == name)
    };
    for joint in effect
        .joints
        .iter()
        .filter_map(|joint| joint.checked_sub(1))
    {
        let (drive, encoder) = (&mut plant.drives[joint], &mut plant.encoders[joint]);
        match effect.effect.as_str() {
            // The log has more torque than acts by this share.
            "drive_gain" => drive.gain = 1.0 / (1.0 + value(0)),
            "drive_saturation" => {
                drive.saturation = Some((shape("level").abs(), 1.0 / (1.0 + value(0))));
            }
            "drive_dead_zone" => drive.dead_zone = value(0),
            // Torque that is logged early acts late.
            "time_shift" => drive.lag = value(0).max(0.0),
            // The effect is what has to be added to a reading.
            "encoder_eccentricity" => {
                encoder.eccentricity = Some((shape("N"), -value(0), -value(1)));
            }
            "friction_drift" => {
                let changes = [("FS", 0), ("FV", 1)].into_iter().filter_map(|(name, k)| {
                    let column = column(name, joint)?;
                    Some((column, whole.parameters[column], value(k)))
                });
                plant.influences.push(Box::new(Drift {
                    time: shape("T"),
                    changes: changes.collect(),
                }));
            }
            "load_dependent_friction" => {
                if let Some(coulomb) = column("FS", joint) {
                    let on = (whole.driven[joint], coulomb);
                    let load = LoadFriction::new(plant.model, plant.parameters, on, value(0))?;
                    plant.influences.push(Box::new(load));
                }
            }
            _ => {}
        }
    }
    Ok(())
}

/// Root mean square distance of the simulated positions from those of the log.
pub fn gap(log: &Log, motions: &Motions) -> Change<Rms> {
    let rms = |simulated: &[Vec<f64>]| {
        let pairs = simulated.iter().zip(&log.recording.q);
        let joint = |(a, b): (&Vec<f64>, &Vec<f64>)| {
            let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
            (square / a.len().max(1) as f64).sqrt()
        };
        Rms {
            rms: pairs.map(joint).collect(),
        }
    };
    Change {
        before: rms(&motions.before),
        after: rms(&motions.after),
    }
}

/// The positions as a page draws them.
pub fn curves(model: &dyn IdentificationModel, log: &Log, motions: &Motions) -> Vec<GapCurves> {
    let grid = Grid::of(&log.recording);
    let t: Vec<f64> = (0..grid.len).map(|k| grid.time(k)).collect();
    let joints = model.joints().iter().enumerate();
    joints
        .map(|(j, joint)| {
            let unit = match joint.kind {
                JointKind::Revolute => "rad",
                JointKind::Prismatic => "m",
            };
            let series = [&log.recording.q[j], &motions.before[j], &motions.after[j]];
            GapCurves::new((&joint.name, unit), &t, series.map(Vec::as_slice))
        })
        .collect()
}
