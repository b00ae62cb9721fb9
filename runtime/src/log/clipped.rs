//! Torque that sits at its limit while the joint moves on: the drive could not follow, or the
//! channel ends there, and what the log says is not what the joint felt.

use std::ops::Range;

use super::doubt::{quantile, resolution};
use crate::signal::extent;

/// Rows at the limit that are no accident.
const ROWS: usize = 6;

/// A quantised peak that is as flat as a fourth-order parabola leaves its top by 6 steps on
/// average over half of its length; a limit is left faster than by this many.
const STEPS_OFF: f64 = 10.0;

/// A joint slower than this share of a fast motion rests, and its torque may well be constant.
const REST_OF_FAST: f64 = 0.003;

/// Runs of the highest or the lowest value of a torque that end as sharply as a limit does, while
/// one of the joints `q` moves. Zero is no limit, but a drive that is off.
pub(super) fn clipped(tau: &[f64], q: &[&[f64]]) -> Vec<Range<usize>> {
    let (low, high) = extent(tau);
    // Most signals touch their extremes only now and then.
    let at_extremes = tau.iter().filter(|x| (**x == low) | (**x == high)).count();
    if at_extremes < ROWS || low == high {
        return Vec::new();
    }
    let at_limit = |value: f64| (value == low || value == high) && value != 0.0;
    let runs: Vec<Range<usize>> = runs(tau)
        .into_iter()
        .filter(|run| run.len() >= ROWS && at_limit(tau[run.start]))
        .collect();
    if runs.is_empty() {
        return Vec::new();
    }
    let step = resolution(tau);
    let fast: Vec<f64> = q.iter().map(|q| fast(q)).collect();
    let moves = |run: &Range<usize>| {
        let mut joints = q.iter().zip(&fast);
        joints.any(|(q, fast)| span(&q[run.clone()]) > REST_OF_FAST * fast * run.len() as f64)
    };
    runs.into_iter()
        .filter(|run| sharp(tau, run, step) && moves(run))
        .collect()
}

/// Whether a run is left, and was reached, by more than the steps of a rounded peak.
fn sharp(tau: &[f64], run: &Range<usize>, step: f64) -> bool {
    let (half, level) = (run.len() / 2, tau[run.start]);
    let before = &tau[run.start.saturating_sub(half)..run.start];
    let after = &tau[run.end..tau.len().min(run.end + half)];
    let away = |side: &[f64]| {
        let sum: f64 = side.iter().map(|x| (x - level).abs()).sum();
        side.len() < half || sum > STEPS_OFF * step * half as f64
    };
    !(before.len() < half && after.len() < half) && away(before) && away(after)
}

/// A fast step of a joint.
fn fast(q: &[f64]) -> f64 {
    let steps: Vec<f64> = q.windows(2).map(|p| (p[1] - p[0]).abs()).collect();
    quantile(&steps, 0.95)
}

fn span(q: &[f64]) -> f64 {
    let (low, high) = extent(q);
    high - low
}

/// Consecutive rows with one value.
fn runs(values: &[f64]) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut start = 0;
    for i in 1..=values.len() {
        if i == values.len() || values[i] != values[start] {
            runs.push(start..i);
            start = i;
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(rows: usize, period: f64, size: f64) -> Vec<f64> {
        let phase = |i| std::f64::consts::TAU * i as f64 / period;
        (0..rows).map(|i| size * phase(i).sin()).collect()
    }

    fn quantised(series: &[f64], step: f64) -> Vec<f64> {
        series.iter().map(|x| (x / step).round() * step).collect()
    }

    #[test]
    fn torque_at_its_limit_is_found_on_either_side() {
        let q = wave(2000, 700.0, 1.0);
        let full = wave(2000, 500.0, 10.0);
        for channel in [full.clone(), quantised(&full, 0.05)] {
            let tau: Vec<f64> = channel.iter().map(|x| x.clamp(-9.0, 8.0)).collect();
            let found = clipped(&tau, &[&q]);
            assert_eq!(found.len(), 8, "{found:?}");
            for range in &found {
                assert!(tau[range.clone()].iter().all(|x| *x == 8.0 || *x == -9.0));
                assert!((60..110).contains(&range.len()), "{range:?}");
            }
        }
    }

    #[test]
    fn rounded_peaks_of_a_quantised_torque_are_no_limit() {
        let q = wave(4000, 700.0, 1.0);
        for period in [40.0, 100.0, 1000.0] {
            for step in [1e-6, 0.01, 0.1, 1.0, 2.5] {
                let tau = quantised(&wave(4000, period, 10.0), step);
                assert_eq!(clipped(&tau, &[&q]), [], "{period} rows, step {step}");
                // Flatter than a sine.
                let flat = |x: &f64| 10.0 * (1.0 - (1.0 - x.abs() / 10.0).powi(2)) * x.signum();
                let flat: Vec<f64> = wave(4000, period, 10.0).iter().map(flat).collect();
                assert_eq!(clipped(&quantised(&flat, step), &[&q]), [], "flat, {step}");
            }
        }
    }

    #[test]
    fn one_saturated_sample_or_five_are_no_limit() {
        let q = wave(2000, 700.0, 1.0);
        let mut tau = wave(2000, 500.0, 10.0);
        tau[300] = 12.0;
        tau[900..905].fill(-12.0);
        assert_eq!(clipped(&tau, &[&q]), []);
        tau[900..906].fill(-12.0);
        assert_eq!(clipped(&tau, &[&q]), vec![900..906]);
    }

    #[test]
    fn constant_torque_of_a_robot_at_rest_is_no_limit() {
        // Holds its weight, then moves, again and again; no noise at all.
        let mut q: Vec<f64> = Vec::new();
        for k in 0..8 {
            let s = |i: i32| f64::from(i) / 200.0;
            let from = f64::from(k % 2);
            let sign = 1.0 - 2.0 * from;
            q.extend((0..200).map(|i| from + sign * s(i).powi(2) * (3.0 - 2.0 * s(i))));
            q.extend([from + sign; 200]);
        }
        let tau: Vec<f64> = q.iter().map(|q| 20.0 * q.cos()).collect();
        assert_eq!(clipped(&tau, &[&q]), []);
    }

    #[test]
    fn drive_that_is_off_is_no_limit() {
        let q = wave(2000, 700.0, 1.0);
        let mut tau: Vec<f64> = wave(2000, 500.0, 3.0).iter().map(|x| 5.0 + x).collect();
        tau[700..1200].fill(0.0);
        assert_eq!(clipped(&tau, &[&q]), []);
    }

    #[test]
    fn commanded_square_wave_is_no_limit() {
        let q = wave(2000, 700.0, 1.0);
        let tau: Vec<f64> = q.iter().map(|q| 5.0 * q.signum()).collect();
        assert_eq!(clipped(&tau, &[&q]), []);
    }
}
