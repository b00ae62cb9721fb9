//! A log's motion as its own reference, its own controller and a model make it.

use super::track::{Source, Track};
use crate::log::Start;
use crate::model::IdentificationModel;
use crate::observe::Motion;
use crate::simulate::{
    Grid, Relaxed, SimulateError, Trajectory, feedforward_of, inverse_dynamics, relaxed,
};

/// How much steeper than the controller's damping friction may run through rest; rounds over the
/// whole motion would not settle with a jump.
const STEEP: f64 = 1.0;

/// Torque of every joint along a motion, with the dead bands of its velocities.
pub(super) type Torque<'a> = &'a dyn Fn(&Motion, &[f64]) -> Vec<Vec<f64>>;

/// Positions, at the samples of a log, of a robot with the mass matrix of a model with the np
/// `parameters` that needs a `torque`: noise-free; `None` if the log has no reference or no controller, or this robot does not
/// follow it.
pub(super) fn simulated(
    track: &Track,
    model: &dyn IdentificationModel,
    parameters: &[f64],
    torque: Torque<'_>,
) -> Option<Vec<Vec<f64>>> {
    let Source {
        recording,
        companion,
        ..
    } = &*track.source;
    let (reference, controller) = companion
        .reference
        .as_ref()
        .zip(companion.controller.as_ref())?;
    // A slip state has no place in rounds over a whole motion; gains of another robot are none.
    if !model.presliding().is_empty() || controller.kd.len() != track.dead_band.len() {
        return None;
    }
    let begin: Vec<f64> = recording.q.iter().map(|q| q[0]).collect();
    let soft = softened(track, model, parameters, &controller.kd).ok()?;
    let plan = Relaxed {
        model,
        parameters,
        rigid: &feedforward_of(model, parameters),
        reference,
        controller,
        grid: Grid::of(recording),
        friction: &soft,
        start: (controller.start == Start::Log).then_some(&begin),
    };
    let band: Vec<f64> = soft.iter().map(|(band, _)| *band).collect();
    let needed = |trajectory: &Trajectory| torque(&moving(trajectory, track), &band);
    relaxed(&plan, &needed).ok().map(|motion| motion.q)
}

/// A simulated motion in the place of a measured one.
fn moving(trajectory: &Trajectory, track: &Track) -> Motion {
    let Trajectory { q, qd, qdd } = trajectory.clone();
    Motion {
        log: track.motion.log.clone(),
        rate_hz: track.motion.rate_hz,
        len: track.motion.len,
        q,
        qd,
        qdd,
        slip: Vec::new(),
        tau: None,
        doubtful: Vec::new(),
        resting: Vec::new(),
    }
}

/// Dead bands in which friction runs from one side to the other, and half its jump.
fn softened(
    track: &Track,
    model: &dyn IdentificationModel,
    parameters: &[f64],
    damping: &[f64],
) -> Result<Vec<(f64, f64)>, SimulateError> {
    let still = |values: &Vec<f64>| vec![values[values.len() / 2]; 2];
    let none: Vec<Vec<f64>> = track.motion.q.iter().map(|_| vec![0.0; 2]).collect();
    let mut soft = Vec::with_capacity(damping.len());
    for (joint, band) in track.dead_band.iter().enumerate() {
        let mut qd = none.clone();
        qd[joint] = vec![-band, *band];
        let both = Trajectory {
            q: track.motion.q.iter().map(still).collect(),
            qd,
            qdd: none.clone(),
        };
        let torque = inverse_dynamics(model, parameters, &both)?;
        let jump = 0.5 * (torque[joint][1] - torque[joint][0]).abs();
        let least = match damping[joint] > 0.0 {
            true => jump / (STEEP * damping[joint]),
            false => 0.0,
        };
        soft.push((band.max(least), jump));
    }
    Ok(soft)
}
