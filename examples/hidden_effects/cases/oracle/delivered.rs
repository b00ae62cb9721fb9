//! Between what is commanded and what drives deliver, on average: commands chatter with the steps of
//! the encoders, so that a dead zone or a level has no sharp edge.

use idim::runtime::signal::central_difference;
use idim::runtime::simulate::Drive;

use crate::cases::hidden::Hidden;
use crate::cases::logs::{Simulated, late};
use crate::cases::motion::RATE_HZ;

/// Gauss-Hermite nodes in standard deviations, and their weights.
const NODES: [(f64, f64); 5] = [
    (-2.856_970_013_872_806, 0.011_257_411_327_720_69),
    (-1.355_626_179_974_266, 0.222_075_922_005_612_6),
    (0.0, 0.533_333_333_333_333_3),
    (1.355_626_179_974_266, 0.222_075_922_005_612_6),
    (2.856_970_013_872_806, 0.011_257_411_327_720_69),
];

/// Halvings of the interval in which a command is looked for.
const HALVINGS: usize = 30;

/// Turns what drives deliver into what is logged, one series per driven joint.
pub fn command(hidden: &Hidden, log: &Simulated, tau: &mut [Vec<f64>]) {
    match *hidden {
        Hidden::Late { by } => {
            for series in tau {
                *series = late(series, by * RATE_HZ);
            }
        }
        Hidden::Drive { joint, drive } => {
            let rate = central_difference(&tau[joint], RATE_HZ);
            for (tau, rate) in tau[joint].iter_mut().zip(rate) {
                *tau = commanded(&drive, *tau + drive.lag * rate, log.chatter[joint]);
            }
        }
        _ => {}
    }
}

/// The mean command whose chatter comes to a torque.
fn commanded(drive: &Drive, torque: f64, chatter: f64) -> f64 {
    let delivers = |command: f64| -> f64 {
        let part = |(node, weight): &(f64, f64)| weight * drive.delivers(command + node * chatter);
        NODES.iter().map(part).sum()
    };
    let far = 10.0 * (torque.abs() + drive.dead_zone + chatter) / drive.gain.min(1.0);
    let (mut low, mut high) = (-far, far);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if delivers(middle) < torque {
            low = middle
        } else {
            high = middle
        }
    }
    0.5 * (low + high)
}

/// Turns what is logged into what happened: encoders put right, torques as they were delivered,
/// with the noise of the log.
pub fn undo(hidden: &Hidden, log: &Simulated, q: &mut [Vec<f64>], tau: &mut [Vec<f64>]) {
    match *hidden {
        Hidden::Late { by } => {
            for series in tau {
                *series = late(series, -by * RATE_HZ);
            }
        }
        Hidden::Drive { joint, .. } => tau[joint].clone_from(&log.delivered[joint]),
        Hidden::Eccentric {
            joint,
            wave: (times, sine, cosine),
        } => {
            for q in &mut q[joint] {
                let (sin, cos) = (times * *q).sin_cos();
                *q -= sine * sin + cosine * cos;
            }
        }
        _ => {}
    }
}
