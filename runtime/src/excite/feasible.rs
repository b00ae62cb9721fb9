//! The exact last step: a motion made so small that it keeps to all limits.

use super::family::Sampled;
use super::limits::JointLimits;
use super::regressor::Regressor;
use super::space::{Path, Space};

/// Share of the room at a limit that is used at most: the rest is for rounding.
const ROOM: f64 = 1.0 - 1e-9;

/// Share of an effort limit that is used at most between instants.
const EFFORT: f64 = 0.999;

/// Halvings of the interval of a common factor.
const BISECTIONS: usize = 40;

/// Scales each joint's deviation from its centre to at most what position, velocity and
/// acceleration allow, between the instants of `fine`, too. A larger motion is never made smaller
/// than to touch its tightest limit; a smaller one is made to touch it if `enlarge` is wanted.
pub(super) fn to_limits(space: &Space<'_>, z: &mut [f64], fine: &Sampled, enlarge: bool) {
    let path = space.path(z, fine);
    for (joint, limits) in space.limits.iter().enumerate() {
        let factor = ROOM * factor(&path, joint, space.center(z, joint), limits);
        if factor < 1.0 || (enlarge && factor.is_finite()) {
            space.scale(z, joint, factor);
        }
    }
}

/// How many times the deviation of a joint can be as large.
fn factor(path: &Path, joint: usize, center: f64, limits: &JointLimits) -> f64 {
    let own = joint * path.len..(joint + 1) * path.len;
    let deviation: Vec<f64> = path.q[own.clone()].iter().map(|q| q - center).collect();
    let (high, low) = (top(&deviation), top_of_negative(&deviation));
    let more = between(&path.q[own.clone()]);
    let by_position = (limits.upper - center) / (high + more).max(f64::MIN_POSITIVE);
    let by_position =
        by_position.min((center - limits.lower) / (low + more).max(f64::MIN_POSITIVE));
    let rates = [
        (&path.qd, limits.velocity),
        (&path.qdd, limits.acceleration),
    ];
    let by_rates = rates.into_iter().map(|(series, limit)| {
        let own = &series[own.clone()];
        limit / (top(own).max(top_of_negative(own)) + between(own))
    });
    by_rates.fold(by_position, f64::min)
}

fn top(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

fn top_of_negative(values: &[f64]) -> f64 {
    values.iter().map(|value| -value).fold(0.0, f64::max)
}

/// How much a smooth function exceeds its largest sample at most, about: an eighth of its largest
/// second difference.
fn between(values: &[f64]) -> f64 {
    let second = values.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).abs());
    second.fold(0.0, f64::max) / 8.0
}

/// Scales all deviations by one factor until no effort is beyond its limit. The motion must keep
/// to its other limits. The joint and its torque at rest if even holding the centre takes more.
pub(super) fn to_efforts(
    space: &Space<'_>,
    z: &mut [f64],
    fine: &Sampled,
    (regressor, parameters): (&Regressor<'_>, &[f64]),
) -> Result<(), (usize, f64)> {
    let holds = |factor: f64| {
        let mut scaled = z.to_vec();
        (0..space.limits.len()).for_each(|joint| space.scale(&mut scaled, joint, factor));
        worst(space, &scaled, fine, (regressor, parameters))
    };
    if holds(1.0).is_none() {
        return Ok(());
    }
    if let Some(beyond) = holds(0.0) {
        return Err(beyond);
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        match holds(middle) {
            None => low = middle,
            Some(_) => high = middle,
        }
    }
    (0..space.limits.len()).for_each(|joint| space.scale(z, joint, low));
    Ok(())
}

/// The joint that is furthest beyond its effort, with that torque.
fn worst(
    space: &Space<'_>,
    z: &[f64],
    fine: &Sampled,
    (regressor, parameters): (&Regressor<'_>, &[f64]),
) -> Option<(usize, f64)> {
    let path = space.path(z, fine);
    let signals = regressor.evaluate(&path);
    let tau = regressor.torque(parameters, &signals, path.len);
    let joints = tau.chunks(path.len).zip(space.limits).enumerate();
    let beyond = joints.map(|(joint, (tau, limits))| {
        let largest = tau.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        (joint, largest, largest / (EFFORT * limits.effort))
    });
    let worst = beyond.max_by(|a, b| a.2.total_cmp(&b.2));
    worst
        .filter(|(_, _, share)| *share > 1.0)
        .map(|(joint, largest, _)| (joint, largest))
}
