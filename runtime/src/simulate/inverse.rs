//! Inverse dynamics along a trajectory: the torque that a motion needs.

use super::dynamics::{check_joints, check_parameters};
use super::error::SimulateError;
use super::trajectory::{Trajectory, check_series};
use crate::model::{IdentificationModel, Output, States};

/// Samples that are evaluated at once.
const BLOCK: usize = 256;

/// \\( \tau = D(q, \dot q, \ddot q) X \\) at every sample of a trajectory: one series per joint, N m
/// or N, with dry friction at rest counted as zero.
///
/// # Errors
/// [`SimulateError::Parameters`], [`SimulateError::NotFinite`], [`SimulateError::Joints`],
/// [`SimulateError::Length`].
pub fn inverse_dynamics(
    model: &dyn IdentificationModel,
    parameters: &[f64],
    trajectory: &Trajectory,
) -> Result<Vec<Vec<f64>>, SimulateError> {
    check_parameters(model, parameters)?;
    let series = [&trajectory.q, &trajectory.qd, &trajectory.qdd];
    let samples = trajectory.q.first().map_or(0, Vec::len);
    for part in series {
        check_joints(model, "trajectory", part.len())?;
        check_series("trajectory", part, samples)?;
    }
    let pattern = model.pattern(Output::Explicit);
    let mut signals = vec![0.0; pattern.signals * BLOCK];
    let mut tau = vec![Vec::with_capacity(samples); model.joints().len()];
    for start in (0..samples).step_by(BLOCK) {
        let end = samples.min(start + BLOCK);
        let len = end - start;
        let block = |part: &[Vec<f64>]| -> Vec<f64> {
            part.iter()
                .flat_map(|joint| &joint[start..end])
                .copied()
                .collect()
        };
        let [q, qd, qdd] = series.map(|part| block(part));
        let states = States {
            len,
            q: &q,
            qd: &qd,
            qdd: &qdd,
            slip: &[],
        };
        let signals = &mut signals[..pattern.signals * len];
        model.evaluate(Output::Explicit, &states, signals);
        tau.iter_mut().for_each(|joint| joint.resize(end, 0.0));
        for entry in pattern.entries.iter() {
            let signal = &signals[entry.signal * len..][..len];
            super::linear::add(
                &mut tau[entry.row][start..],
                parameters[entry.column],
                signal,
            );
        }
    }
    Ok(tau)
}
