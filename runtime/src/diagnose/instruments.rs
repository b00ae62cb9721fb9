//! Motions beside the measured ones, without their noise: what columns along them explain, neither
//! the noise of the positions nor what the loop makes of the noise of the torques can imitate.

use super::closed_loop::simulated;
use super::joined::Joined;
use super::repeats::elsewhere;
use super::track::{Instead, Track, predict};
use crate::model::IdentificationModel;
use crate::observe::Motion;

/// Cut-off of the low-pass that stands in for a simulation, Hz.
pub(super) const SMOOTH_HZ: f64 = 12.0;

/// How far a simulated motion may be from the measured one, as a part of the measured one's
/// standard deviation: beyond, its controller is not the one that ran.
const NEAR: f64 = 0.05;

/// For each track the same rows along another motion: where the log repeats itself, that of its
/// other periods, in which everything is that the robot does and the model may not know; else that
/// of the model with the np `parameters` under the log's own reference and controller; where it has
/// none, or they do not reproduce the motion, the smooth part of what was measured.
pub(super) fn beside(
    model: &dyn IdentificationModel,
    joined: &Joined,
    parameters: &[f64],
) -> Joined {
    let of_track = |track: &Track| {
        let instead = elsewhere(track)
            .or_else(|| of_model(model, track, parameters))
            .map_or(Instead::Below(SMOOTH_HZ), Instead::Positions);
        let beside = track.beside(model, &instead);
        beside.unwrap_or_else(|_| track.clone())
    };
    Joined {
        tracks: joined.tracks.iter().map(of_track).collect(),
        segments: joined.segments.clone(),
        weights: joined.weights.clone(),
    }
}

/// Positions of the model in closed loop, if they are near the measured ones.
fn of_model(
    model: &dyn IdentificationModel,
    track: &Track,
    parameters: &[f64],
) -> Option<Vec<Vec<f64>>> {
    let torque = |motion: &Motion, band: &[f64]| predict(model, parameters, motion, band).model;
    simulated(track, model, parameters, &torque).filter(|q| is_near(&track.motion.q, q))
}

fn is_near(measured: &[Vec<f64>], simulated: &[Vec<f64>]) -> bool {
    measured.iter().zip(simulated).all(|(q, s)| {
        let mean = q.iter().sum::<f64>() / q.len().max(1) as f64;
        let spread: f64 = q.iter().map(|q| (q - mean).powi(2)).sum();
        let apart: f64 = q.iter().zip(s).map(|(q, s)| (q - s).powi(2)).sum();
        apart <= NEAR * NEAR * spread.max(1e-6 * q.len() as f64)
    })
}
