//! Where a log and what it is said to follow part: a reference, a controller, a simulation.

use super::controller::Regulator;
use super::dynamics::check_joints;
use super::error::SimulateError;
use super::options::Grid;
use super::trajectory::{Trajectory, check_series};
use crate::log::{Companion, Recording, Reference};
use crate::model::IdentificationModel;
use crate::signal::central_difference;

/// Share of a joint's range that no tracking error reaches.
const BEYOND_TRACKING: f64 = 0.2;

/// Share of a torque's range by which a control law may be away from the log's torque: friction of
/// the drive, the noise of differences, a feedforward that was rounded.
const BEYOND_CONTROL: f64 = 0.25;

/// A joint that moves less than this share of what the farthest one does is judged by that share.
const LEAST_RANGE: f64 = 0.05;

/// Torques are compared as means over so many seconds: differences of encoder counts are noise.
const MEAN_S: f64 = 0.05;

/// Where a log leaves another motion on the same grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Parting {
    /// Joint, counted from 0.
    pub joint: usize,
    /// First second of the grid's time at which they are apart.
    pub second: f64,
    /// How far apart they are at most, rad or m; of torques N m or N.
    pub largest: f64,
}

/// The first joint and second at which two motions are further apart than a fraction of the range
/// of the first; `None` if they never are. It says whether reference, controller and parameters
/// fit a log. A joint that hardly moves counts with a twentieth of the largest range.
pub fn parting(
    motion: &[Vec<f64>],
    other: &[Vec<f64>],
    grid: &Grid,
    fraction: f64,
) -> Option<Parting> {
    let ranges: Vec<f64> = motion.iter().map(|series| range(series)).collect();
    let least = LEAST_RANGE * ranges.iter().copied().fold(0.0, f64::max);
    let apart = |(joint, (a, b)): (usize, (&Vec<f64>, &Vec<f64>))| {
        let distances = || a.iter().zip(b).map(|(a, b)| (a - b).abs());
        // NaN is apart.
        let limit = fraction * ranges[joint].max(least);
        let sample = distances().position(|d| d.is_nan() || d > limit)?;
        let largest = distances().fold(0.0, f64::max);
        let second = grid.time(sample);
        let part = Parting {
            joint,
            second,
            largest,
        };
        Some((sample, part))
    };
    let pairs = motion.iter().zip(other).enumerate();
    pairs
        .filter_map(apart)
        .min_by_key(|(sample, part)| (*sample, part.joint))
        .map(|(_, part)| part)
}

/// Where a log leaves the reference that it is said to follow by more than a tracking error: a
/// fifth of the joint's range.
///
/// # Errors
/// [`SimulateError::Joints`] and [`SimulateError::Length`] for a reference of another robot or
/// length; as [`Trajectory::of`].
pub fn off_reference(
    model: &dyn IdentificationModel,
    recording: &Recording,
    reference: &Reference,
) -> Result<Option<Parting>, SimulateError> {
    let grid = Grid::of(recording);
    check_joints(model, "log", recording.q.len())?;
    check_joints(model, "reference", reference.joints())?;
    let mut reference = Trajectory::of(reference, &grid)?.q;
    hide_doubtful(recording, &recording.q, &mut reference, 0);
    Ok(parting(&recording.q, &reference, &grid, BEYOND_TRACKING))
}

/// Where the torque of a log leaves that of the controller it is said to be made with, by more than
/// a quarter of the torque's range: the control law along the measured motion, both as means over
/// 0.05 s. `None` also where there is nothing to compare. `rigid` as in
/// [`super::ClosedLoop::rigid`].
///
/// # Errors
/// As [`off_reference`], and for a controller of another robot.
pub fn off_controller(
    model: &dyn IdentificationModel,
    rigid: &[f64],
    (recording, companion): (&Recording, &Companion),
) -> Result<Option<Parting>, SimulateError> {
    let (Some(reference), Some(controller)) = (&companion.reference, &companion.controller) else {
        return Ok(None);
    };
    let Some(tau) = &recording.tau else {
        return Ok(None);
    };
    let grid = Grid::of(recording);
    check_joints(model, "log", recording.q.len())?;
    check_joints(model, "log", tau.len())?;
    check_series("position", &recording.q, grid.len)?;
    let reference = Trajectory::of(reference, &grid)?;
    let control = (controller, &reference);
    let mut regulator = Regulator::new(model, control, rigid, &grid)?;
    let derived = |q: &Vec<f64>| central_difference(q, grid.rate_hz);
    let qd: Vec<Vec<f64>> = recording.q.iter().map(derived).collect();
    let mut law = vec![Vec::with_capacity(grid.len); tau.len()];
    let mut torque = vec![0.0; tau.len()];
    for k in 0..grid.len {
        let at = |series: &[Vec<f64>]| -> Vec<f64> { series.iter().map(|s| s[k]).collect() };
        regulator.torque(k, (&at(&recording.q), &at(&qd)), &mut torque);
        law.iter_mut().zip(&torque).for_each(|(s, x)| s.push(*x));
    }
    let half = (0.5 * MEAN_S * grid.rate_hz) as usize;
    let smooth = |series: &[Vec<f64>]| -> Vec<Vec<f64>> {
        series.iter().map(|values| means(values, half)).collect()
    };
    let (tau, mut law) = (smooth(tau), smooth(&law));
    hide_doubtful(recording, &tau, &mut law, half + 1);
    Ok(parting(&tau, &law, &grid, BEYOND_CONTROL))
}

/// Lets two series agree where the log cannot be believed, and so far around.
fn hide_doubtful(recording: &Recording, log: &[Vec<f64>], other: &mut [Vec<f64>], around: usize) {
    for range in &recording.doubtful {
        for (values, log) in other.iter_mut().zip(log) {
            let to = range.end.saturating_add(around).min(log.len());
            let from = range.start.saturating_sub(around).min(to);
            values[from..to].copy_from_slice(&log[from..to]);
        }
    }
}

/// The mean of each sample and of `half` on either side, fewer at the ends.
fn means(values: &[f64], half: usize) -> Vec<f64> {
    let mut sums = vec![0.0];
    let mut sum = 0.0;
    sums.extend(values.iter().map(|value| {
        sum += value;
        sum
    }));
    let mean = |k: usize| {
        let (from, to) = (k.saturating_sub(half), values.len().min(k + half + 1));
        (sums[to] - sums[from]) / (to - from) as f64
    };
    (0..values.len()).map(mean).collect()
}

fn range(values: &[f64]) -> f64 {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (high - low).max(0.0)
}
