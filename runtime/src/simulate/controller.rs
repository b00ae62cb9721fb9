//! The control law of a log's companion, sample by sample.

use std::f64::consts::TAU;

use super::dynamics::check_joints;
use super::error::SimulateError;
use super::inverse::inverse_dynamics;
use super::options::Grid;
use super::trajectory::Trajectory;
use crate::log::{Controller, Feedforward, Law};
use crate::model::IdentificationModel;

/// A controller at work. It reads encoders at every sample and holds its torque until the next.
pub(super) struct Regulator<'a> {
    controller: &'a Controller,
    reference: &'a Trajectory,
    /// One series per joint, or none.
    feedforward: Vec<Vec<f64>>,
    rate_hz: f64,
    /// Share of a new difference in the filtered velocity.
    gain: f64,
    /// Last position read and filtered velocity; the first sample knows no difference.
    last: Vec<(f64, f64)>,
}

impl<'a> Regulator<'a> {
    /// Prepares the control of a robot; `rigid` are the parameters of the feedforward.
    pub(super) fn new(
        model: &dyn IdentificationModel,
        (controller, reference): (&'a Controller, &'a Trajectory),
        rigid: &[f64],
        grid: &Grid,
    ) -> Result<Regulator<'a>, SimulateError> {
        check_joints(model, "controller", controller.kp.len())?;
        check_joints(model, "controller", controller.kd.len())?;
        if let Some(limit) = &controller.torque_limit {
            check_joints(model, "torque limit", limit.len())?;
        }
        // The zero-order-hold equivalent of 1 / (1 + s / w).
        let gain = |cut_off: f64| 1.0 - (-TAU * cut_off / grid.rate_hz).exp();
        Ok(Regulator {
            feedforward: feedforward(model, controller.feedforward, reference, rigid)?,
            gain: controller.velocity_filter_hz.map_or(1.0, gain),
            last: Vec::with_capacity(controller.kp.len()),
            rate_hz: grid.rate_hz,
            controller,
            reference,
        })
    }

    /// Torque at sample `k` for the positions that the encoders read and the true velocities.
    pub(super) fn torque(&mut self, k: usize, (q, qd): (&[f64], &[f64]), tau: &mut [f64]) {
        let Law::Pd = self.controller.law;
        for joint in 0..tau.len() {
            let (position, velocity) = self.measure(k, joint, (q[joint], qd[joint]));
            let mut torque = self.controller.kp[joint] * (self.reference.q[joint][k] - position)
                + self.controller.kd[joint] * (self.reference.qd[joint][k] - velocity);
            if let Some(feedforward) = self.feedforward.get(joint) {
                torque += feedforward[k];
            }
            if let Some(limit) = &self.controller.torque_limit {
                // Written so that a limit can never be in the wrong order.
                torque = torque.min(limit[joint]).max(-limit[joint]);
            }
            tau[joint] = torque;
        }
    }

    /// What the controller takes for position and velocity.
    fn measure(&mut self, k: usize, joint: usize, (position, qd): (f64, f64)) -> (f64, f64) {
        if self.controller.velocity_filter_hz.is_none() {
            return (position, qd);
        }
        if k == 0 {
            self.last.push((position, qd));
            return (position, qd);
        }
        let (before, filtered) = self.last[joint];
        let difference = (position - before) * self.rate_hz;
        let velocity = filtered + self.gain * (difference - filtered);
        self.last[joint] = (position, velocity);
        (position, velocity)
    }
}

/// Feedforward torque along the reference.
fn feedforward(
    model: &dyn IdentificationModel,
    kind: Feedforward,
    reference: &Trajectory,
    rigid: &[f64],
) -> Result<Vec<Vec<f64>>, SimulateError> {
    match kind {
        Feedforward::None => Ok(Vec::new()),
        Feedforward::Rigid => inverse_dynamics(model, rigid, reference),
        Feedforward::Gravity => {
            let still: Vec<Vec<f64>> = reference.q.iter().map(|q| vec![0.0; q.len()]).collect();
            let q = reference.q.clone();
            inverse_dynamics(
                model,
                rigid,
                &Trajectory {
                    q,
                    qd: still.clone(),
                    qdd: still,
                },
            )
        }
    }
}
