//! A simulation like a log: driven by whatever the log says.

use super::closed_loop::{ClosedLoop, closed_loop};
use super::dynamics::check_joints;
use super::error::SimulateError;
use super::inverse::inverse_dynamics;
use super::open_loop::{OpenLoop, open_loop};
use super::options::{Grid, Options, State};
use super::result::Simulation;
use super::trajectory::{Trajectory, check_series};
use crate::log::{Companion, Recording, Reference, Start};
use crate::model::IdentificationModel;

/// Samples from which the state at the beginning of a log is taken: a parabola is fitted.
const BEGINNING: usize = 21;

/// Simulates a log with the np `parameters` of the model: closed loop if its companion has a
/// reference and a controller, otherwise open loop under its torque. `rigid` as in
/// [`ClosedLoop::rigid`].
///
/// An open loop, and a closed one whose controller says `start = "log"`, begins in the state that
/// a parabola through the first samples of the log gives.
///
/// # Errors
/// [`SimulateError::Undriven`] if the log has neither; otherwise as [`closed_loop`] and
/// [`open_loop`].
pub fn like(
    model: &dyn IdentificationModel,
    (parameters, rigid): (&[f64], &[f64]),
    (recording, companion): (&Recording, &Companion),
    options: &Options,
) -> Result<Simulation, SimulateError> {
    let grid = Grid::of(recording);
    grid.check()?;
    check_joints(model, "log", recording.q.len())?;
    check_series("position", &recording.q, grid.len)?;
    let start = beginning(recording);
    if let (Some(reference), Some(controller)) = (&companion.reference, &companion.controller) {
        let start = (controller.start == Start::Log).then_some(&start);
        let plan = ClosedLoop {
            reference,
            controller,
            rigid,
            grid,
            start,
        };
        return closed_loop(model, parameters, &plan, options);
    }
    let Some(tau) = &recording.tau else {
        return Err(SimulateError::Undriven {
            log: recording.name.clone(),
        });
    };
    open_loop(
        model,
        parameters,
        &OpenLoop {
            tau,
            grid,
            start: &start,
        },
        options,
    )
}

/// The reference as a motion that is followed exactly, with the torque that this takes.
///
/// # Errors
/// As [`Trajectory::of`] and [`inverse_dynamics`].
pub fn ideal(
    model: &dyn IdentificationModel,
    parameters: &[f64],
    reference: &Reference,
    grid: &Grid,
) -> Result<Simulation, SimulateError> {
    check_joints(model, "reference", reference.joints())?;
    let motion = Trajectory::of(reference, grid)?;
    let tau = inverse_dynamics(model, parameters, &motion)?;
    Ok(Simulation {
        grid: *grid,
        q: motion.q,
        qd: motion.qd,
        tau,
    })
}

/// Position and velocity at the first sample of a log: least-squares parabola through its
/// first samples.
pub fn beginning(recording: &Recording) -> State {
    let fits = recording
        .q
        .iter()
        .map(|q| parabola(&q[..q.len().min(BEGINNING)], recording.rate_hz));
    let (q, qd) = fits.unzip();
    State { q, qd }
}

/// Value and slope per second at the first of uniform samples.
fn parabola(values: &[f64], rate_hz: f64) -> (f64, f64) {
    let first = values.first().copied().unwrap_or(0.0);
    if values.len() < 3 {
        let rise = values.get(1).map_or(0.0, |second| second - first);
        return (first, rise * rate_hz);
    }
    let mut normal = [0.0; 9];
    let mut right = [0.0; 3];
    for (k, value) in values.iter().enumerate() {
        let x = k as f64;
        let powers = [1.0, x, x * x];
        for (i, power) in powers.iter().enumerate() {
            // Relative to the first value, so that nothing is lost far from zero.
            right[i] += power * (value - first);
            powers
                .iter()
                .enumerate()
                .for_each(|(j, other)| normal[i * 3 + j] += power * other);
        }
    }
    super::linear::eliminate(&mut normal, 3, &mut right);
    (first + right[0], right[1] * rate_hz)
}
