//! How a torque changes when one joint moves otherwise than it did, to first order.

use super::evaluate::{Linear, Motion, Shift};

/// Step of a position in central differences, rad or m.
const STEP: f64 = 1e-5;

/// How a torque changes with the motion of one joint: on every joint, per rad (m) of
/// position, velocity, acceleration.
pub(super) struct Sensitivity {
    pub position: Vec<Vec<f64>>,
    pub velocity: Vec<Vec<f64>>,
    pub acceleration: Vec<Vec<f64>>,
}

/// Central differences: exact for velocity and acceleration, in which the torque of rigid bodies is
/// quadratic and linear.
pub(super) fn sensitivity(
    model: &Linear,
    parameters: &[f64],
    motion: &Motion<'_>,
    joint: usize,
) -> Sensitivity {
    let at = |shift: Shift| {
        let motion = Motion {
            shift: Some(shift),
            ..*motion
        };
        model.torque(&motion, parameters)
    };
    let difference = |shift: fn(usize, f64) -> Shift, step: f64| {
        let (mut up, down) = (at(shift(joint, step)), at(shift(joint, -step)));
        for (up, down) in up.iter_mut().zip(&down) {
            let pairs = up.iter_mut().zip(down);
            pairs.for_each(|(up, down)| *up = (*up - down) / (2.0 * step));
        }
        up
    };
    Sensitivity {
        position: difference(Shift::Position, STEP),
        velocity: difference(Shift::Velocity, 1.0),
        acceleration: difference(Shift::Acceleration, 1.0),
    }
}
