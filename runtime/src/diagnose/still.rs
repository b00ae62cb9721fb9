//! Where a joint stands still or nearly so: how fast it must be for its direction to be certain, and
//! what rows near standstill count for.

use std::ops::Range;

use crate::observe::{Filtering, Motion};
use crate::signal::central_difference;

/// What rows beside a standstill count for: friction at rest is any torque below its limit, and the
/// filters spread what it does there.
const NEAR_REST: f64 = 0.25;

/// Standard deviations of the velocity's noise within which its sign is not certain.
const UNCERTAIN: f64 = 3.0;

/// Share of the largest velocity below which the sign is not certain either.
const SLOW: f64 = 1e-3;

/// Velocity under which the sign is not certain: the noise that quantised positions leave behind
/// prefilter and difference.
pub(super) fn dead_band(motion: &Motion, steps: &[f64], filtering: &Filtering) -> Vec<f64> {
    let cut_off = filtering.fq_hz.min(0.4 * motion.rate_hz);
    let w = 2.0 * std::f64::consts::PI * cut_off;
    let noise = w * (2.0 * cut_off / (3.0 * motion.rate_hz)).sqrt();
    let of_joint = |(qd, step): (&Vec<f64>, &f64)| {
        let top = qd.iter().fold(0.0_f64, |top, v| top.max(v.abs()));
        let white = step / 12f64.sqrt();
        (UNCERTAIN * white * noise).max(SLOW * top)
    };
    motion.qd.iter().zip(steps).map(of_joint).collect()
}

/// A pulse at each reversal of a joint, of area two and the sign of the new direction. A joint that
/// sticks there is held by whatever balances it, and not by a friction that turns round with its
/// velocity; to first order that shifts the turn in time.
pub(super) fn reversals(qd: &[f64], band: f64, rate_hz: f64) -> Vec<f64> {
    let side: Vec<f64> = qd.iter().map(|v| (v / band).clamp(-1.0, 1.0)).collect();
    central_difference(&side, rate_hz)
}

/// What rows count for: nothing near samples that cannot be believed, less near rest.
pub(super) fn weights(
    motion: &Motion,
    kept: &[usize],
    dead_band: &[f64],
    reach: usize,
) -> Vec<Vec<f64>> {
    let half = kept
        .get(1)
        .map_or(1, |second| (second - kept[0]).div_ceil(2));
    let around = |sample: usize, far: usize| -> Range<usize> {
        sample.saturating_sub(far)..(sample + far + 1).min(motion.len)
    };
    let doubted = |sample: usize| {
        let near = around(sample, reach);
        motion
            .doubtful
            .iter()
            .any(|r| r.start < near.end && near.start < r.end)
    };
    let doubted: Vec<bool> = kept.iter().map(|&sample| doubted(sample)).collect();
    let joint = |(qd, band): (&Vec<f64>, &f64)| {
        let slow =
            |sample: usize, far: usize| qd[around(sample, far)].iter().any(|v| v.abs() < *band);
        let weight = |(&sample, &doubted): (&usize, &bool)| match doubted {
            true => 0.0,
            false if slow(sample, half) => 0.0,
            false if slow(sample, 3 * half) => NEAR_REST,
            false => 1.0,
        };
        kept.iter().zip(&doubted).map(weight).collect()
    };
    motion.qd.iter().zip(dead_band).map(joint).collect()
}
