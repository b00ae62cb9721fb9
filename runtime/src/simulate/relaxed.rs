//! A closed loop as a fixed point over whole motions, for torques that are only known along a motion:
//! effects with a memory, or made of the model's own torque.
//!
//! Waveform relaxation (Lelarasmee, Ruehli, Sangiovanni-Vincentelli 1982): the torque that the
//! robot needs along the present motion is compared with the one that its controller would give,
//! and the rest \\( \rho \\) moves it by the solution of \\( M \ddot\delta + c(\delta) = \rho \\),
//! where c is the controller's own answer to a deviation. A stiff controller leaves little for the
//! next round.

use super::controller::Regulator;
use super::dynamics::{Dynamics, check_joints};
use super::error::SimulateError;
use super::linear::{factor, solve};
use super::options::Grid;
use super::trajectory::Trajectory;
use crate::log::{Controller, Reference};
use crate::model::IdentificationModel;

/// Rounds at most.
const ROUNDS: usize = 12;

/// Part of the motion by which the last round may have moved any joint.
const SETTLED: f64 = 1e-4;

/// A mass matrix serves so many samples.
const HELD: usize = 10;

/// What a relaxed closed loop follows.
#[derive(Clone, Copy)]
pub(crate) struct Relaxed<'a> {
    pub model: &'a dyn IdentificationModel,
    /// Parameters of the model, for its mass matrix.
    pub parameters: &'a [f64],
    /// Parameters of the controller's feedforward.
    pub rigid: &'a [f64],
    pub reference: &'a Reference,
    pub controller: &'a Controller,
    /// Dry friction of each joint: the speed within which it runs straight from one side to the
    /// other, rad/s or m/s, and its size, N m or N.
    pub friction: &'a [(f64, f64)],
    pub grid: Grid,
    /// Positions in which the robot begins; `None`: on the reference.
    pub start: Option<&'a [f64]>,
}

/// The torque that a robot needs along a motion: one series per joint, N m or N.
pub(crate) type Needed<'a> = &'a dyn Fn(&Trajectory) -> Vec<Vec<f64>>;

/// The motion of a controlled robot that needs the torque `needed`.
///
/// # Errors
/// Those of [`super::closed_loop`]; [`SimulateError::Diverged`] if the rounds do not settle.
pub(crate) fn relaxed(plan: &Relaxed<'_>, needed: Needed<'_>) -> Result<Trajectory, SimulateError> {
    check_joints(plan.model, "reference", plan.reference.joints())?;
    let reference = Trajectory::of(plan.reference, &plan.grid)?;
    let masses = masses(plan, &reference)?;
    let mut motion = reference.clone();
    let (mut farthest, mut last) = (0, f64::INFINITY);
    for round in 0..ROUNDS {
        let asked = asked(plan, &reference, &motion)?;
        let needed = needed(&motion);
        let rest: Vec<Vec<f64>> = asked
            .iter()
            .zip(&needed)
            .map(|(asked, needed)| asked.iter().zip(needed).map(|(a, n)| a - n).collect())
            .collect();
        let begin = plan.start.filter(|_| round == 0);
        let (joint, moved) = answer(plan, &masses, &rest, begin, &mut motion);
        if moved < SETTLED {
            return Ok(motion);
        }
        let worse = moved > last && round > 3;
        (farthest, last) = (joint, moved);
        if worse || !moved.is_finite() {
            break;
        }
    }
    if last < 10.0 * SETTLED {
        return Ok(motion);
    }
    Err(SimulateError::Diverged {
        joint: plan.model.joints()[farthest].name.to_string(),
        what: "the motion of the round before",
        second: plan.grid.start,
    })
}

/// The mass matrix and its Cholesky factor along the reference, one for every [`HELD`] samples.
fn masses(plan: &Relaxed<'_>, reference: &Trajectory) -> Result<Vec<[Vec<f64>; 2]>, SimulateError> {
    let n = reference.q.len();
    let mut dynamics = Dynamics::new(plan.model, plan.parameters)?;
    let places = (0..plan.grid.len).step_by(HELD);
    let factored = |k: usize| {
        let q: Vec<f64> = reference.q.iter().map(|q| q[k]).collect();
        let mass = dynamics.mass(&q)?.to_vec();
        let mut lower = mass.clone();
        factor(&mut lower, n).map_err(|(row, pivot)| SimulateError::NotPositiveDefinite {
            joint: plan.model.joints()[row].name.to_string(),
            pivot,
            q,
        })?;
        Ok([mass, lower])
    };
    places.map(factored).collect()
}

/// What the controller asks for along a motion: the mean of the torques that it holds before and
/// after each sample.
fn asked(
    plan: &Relaxed<'_>,
    reference: &Trajectory,
    motion: &Trajectory,
) -> Result<Vec<Vec<f64>>, SimulateError> {
    let n = reference.q.len();
    let control = (plan.controller, reference);
    let mut regulator = Regulator::new(plan.model, control, plan.rigid, &plan.grid)?;
    let mut all = vec![Vec::with_capacity(plan.grid.len); n];
    let (mut q, mut qd, mut tau) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let mut before = vec![0.0; n];
    for k in 0..plan.grid.len {
        for joint in 0..n {
            (q[joint], qd[joint]) = (motion.q[joint][k], motion.qd[joint][k]);
        }
        regulator.torque(k, (&q, &qd), &mut tau);
        for joint in 0..n {
            let held = if k == 0 { tau[joint] } else { before[joint] };
            all[joint].push(0.5 * (held + tau[joint]));
        }
        before.copy_from_slice(&tau);
    }
    Ok(all)
}

/// Moves the motion by the loop's answer to a rest of torque, by Stoermer's and Verlet's rule: the
/// joint that this moved farthest, and how far, as a part of its range.
fn answer(
    plan: &Relaxed<'_>,
    masses: &[[Vec<f64>; 2]],
    rest: &[Vec<f64>],
    begin: Option<&[f64]>,
    motion: &mut Trajectory,
) -> (usize, f64) {
    let n = rest.len();
    let step = 1.0 / plan.grid.rate_hz;
    let Controller {
        kp,
        kd,
        velocity_filter_hz,
        ..
    } = plan.controller;
    let part = velocity_filter_hz.map_or(1.0, |f| 1.0 - (-std::f64::consts::TAU * f * step).exp());
    let range: Vec<f64> = motion.q.iter().map(|q| spread(q)).collect();
    let mut at: Vec<f64> = (0..n)
        .map(|joint| begin.map_or(0.0, |q| q[joint] - motion.q[joint][0]))
        .collect();
    let (mut speed, mut seen, mut before) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let (mut force, mut slope, mut stiff) = (vec![0.0; n], vec![0.0; n], vec![0.0; n * n]);
    let mut farthest = (0, 0.0);
    for k in 0..plan.grid.len {
        for joint in 0..n {
            seen[joint] += part * (speed[joint] - seen[joint]);
            let control = -kp[joint] * at[joint] - kd[joint] * seen[joint];
            slope[joint] = slope_at(plan.friction[joint], motion.qd[joint][k]);
            let held = 0.5 * (before[joint] + control);
            force[joint] = rest[joint][k] + held - slope[joint] * speed[joint];
            before[joint] = control;
        }
        let [mass, lower] = &masses[k / HELD];
        if slope.iter().all(|slope| *slope == 0.0) {
            solve(lower, n, &mut force);
        } else {
            stiff.copy_from_slice(mass);
            (0..n).for_each(|joint| stiff[joint * n + joint] += 0.5 * step * slope[joint]);
            if factor(&mut stiff, n).is_err() {
                return (0, f64::NAN);
            }
            solve(&stiff, n, &mut force);
        }
        for joint in 0..n {
            let next = speed[joint] + step * force[joint];
            motion.q[joint][k] += at[joint];
            motion.qd[joint][k] += 0.5 * (speed[joint] + next);
            motion.qdd[joint][k] += force[joint];
            let far = at[joint].abs() / range[joint];
            if far > farthest.1 || far.is_nan() {
                farthest = (joint, far);
            }
            speed[joint] = next;
            at[joint] += step * next;
        }
    }
    farthest
}

/// How dry friction changes with the velocity there.
fn slope_at((band, size): (f64, f64), qd: f64) -> f64 {
    if qd.abs() < band { size / band } else { 0.0 }
}

fn spread(series: &[f64]) -> f64 {
    let low = series.iter().copied().fold(f64::INFINITY, f64::min);
    let high = series.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (high - low).max(1e-3)
}
