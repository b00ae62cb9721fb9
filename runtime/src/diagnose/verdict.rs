//! Is there anything, is there still anything, and where.

use rayon::prelude::*;

use super::generic;
use super::noise::{ORDER, effective};
use super::null::Null;
use super::repeats::{Lack, lack_of_fit, pure_error};
use super::state::{Bench, State};
use super::system::Sparse;

/// Standard deviations beyond which a lack of fit is significant.
const SIGNIFICANT: f64 = 6.0;

/// A generic model takes slow noise for something more readily than quick noise: without repetition
/// a lack of fit must be so many times larger. On simulated logs with nothing hidden it reached 1.5
/// times [`SIGNIFICANT`].
const UNEVEN: f64 = 2.0;

/// Excess of the residual's variance over the noise's below which a lack of fit, however
/// significant, is left to the noise model.
const MEANINGFUL: f64 = 0.06;

/// Width of the Gaussian kernel over the rows, one standard deviation: a model error is slower than
/// most of the noise.
const WIDTH: f64 = 1.0;

/// Degrees of freedom that smoothing leaves of each row: one over the effective width of its kernel.
const SMOOTH_FREEDOM: f64 = 0.28;

/// Share of a generic column that must be its own: there are many, and some are nearly alike.
const GENERIC_OWN: f64 = 1e-3;

/// Rows about a standstill that do not take part.
const AROUND_REST: usize = 3;

/// Share of the lack of fit that naming must close, if what is left is significant.
const CLOSED: f64 = 0.9;

/// What that may leave of a joint's excess, in variances of the noise; where more is left, because
/// there was far more, naming must close this share.
const LEFT: f64 = 10.0;
const CLOSED_MOST: f64 = 0.97;

/// Share of what is not explained that a variable must explain to be mentioned.
const MENTIONED: f64 = 0.15;

/// Lack of fit of each joint.
pub(super) fn lacks(bench: &Bench<'_>, null: &Null, state: &State) -> Vec<Lack> {
    let joints = (0..bench.train.joints()).into_par_iter();
    if null.repeats.is_empty() {
        return joints
            .map(|joint| against_generic(&null.generic[joint], bench, state, joint))
            .collect();
    }
    joints
        .map(|joint| {
            let weights = whole_weights(bench, joint);
            let residual = smoothed(state.system.residual(joint));
            let mut error = pure_error(&residual, &weights, &null.repeats);
            error.repeated.1 *= SMOOTH_FREEDOM;
            error.between.1 *= SMOOTH_FREEDOM;
            lack_of_fit(&error, state.system.leverage(joint))
        })
        .collect()
}

/// Rows without what changes from one to the next.
fn smoothed(rows: &[f64]) -> Vec<f64> {
    let kernel: Vec<f64> = (0..6)
        .map(|k| (-0.5 * (f64::from(k) / WIDTH).powi(2)).exp())
        .collect();
    let total: f64 = kernel[0] + 2.0 * kernel[1..].iter().sum::<f64>();
    let last = rows.len().saturating_sub(1);
    let at = |t: usize| {
        let sides = kernel.iter().enumerate().skip(1);
        let sum: f64 = sides
            .map(|(k, w)| w * (rows[t.saturating_sub(k)] + rows[(t + k).min(last)]))
            .sum();
        (kernel[0] * rows[t] + sum) / total
    };
    (0..rows.len()).map(at).collect()
}

/// What the whitened rows of a joint count for, one or nothing: those about a standstill do not.
pub(super) fn whole_weights(bench: &Bench<'_>, joint: usize) -> Vec<f64> {
    away_from_rest(&effective_weights(bench, joint))
}

/// Weights with the rows about those that count for less left out.
fn away_from_rest(weights: &[f64]) -> Vec<f64> {
    let near = |t: usize| t.saturating_sub(AROUND_REST)..(t + AROUND_REST + 1).min(weights.len());
    let weight = |t: usize| {
        if weights[near(t)].iter().all(|w| *w >= 1.0) {
            1.0
        } else {
            0.0
        }
    };
    (0..weights.len()).map(weight).collect()
}

/// What the whitened rows of a joint count for.
fn effective_weights(bench: &Bench<'_>, joint: usize) -> Vec<f64> {
    let weights = &bench.train.weights[joint];
    let mut all: Vec<f64> = (0..weights.len()).map(|t| effective(weights, t)).collect();
    for segment in &bench.train.segments {
        all[segment.clone()]
            .iter_mut()
            .take(ORDER)
            .for_each(|weight| *weight = 0.0);
    }
    all
}

/// The present residual against what the generic model leaves.
fn against_generic(columns: &[Sparse], bench: &Bench<'_>, state: &State, joint: usize) -> Lack {
    let gain = state.system.gain_of(columns, &[], GENERIC_OWN);
    let residual = state.system.residual(joint);
    let square = super::linear::dot(residual, residual);
    let rows = effective_weights(bench, joint)
        .iter()
        .map(|w| w * w)
        .sum::<f64>();
    let above = gain.columns().max(1) as f64;
    let below = (rows - state.system.leverage(joint) - above).max(1.0);
    let noise = (square - gain.square) / below;
    let mut lack = Lack::new(
        gain.square / above / noise.max(f64::MIN_POSITIVE),
        above,
        below,
    );
    lack.z /= UNEVEN;
    // As a share of the noise in all rows, as with repeated logs.
    lack.excess = (gain.square - above * noise) / (noise * below).max(f64::MIN_POSITIVE);
    lack
}

/// Whether the gap is open: some joint lacks fit.
pub(super) fn open(lacks: &[Lack]) -> bool {
    lacks.iter().any(is_open)
}

fn is_open(lack: &Lack) -> bool {
    lack.z > SIGNIFICANT && lack.excess > MEANINGFUL
}

/// Whether effects explain what was open: nothing significant is left, or at least nine tenths of
/// every significant excess are closed, or more where what is left is not of the noise's size.
pub(super) fn closed(before: &[Lack], after: &[Lack]) -> bool {
    let excess = |lacks: &[Lack]| lacks.iter().map(|lack| lack.excess.max(0.0)).sum::<f64>();
    let share = match after.iter().all(|lack| lack.excess <= LEFT) {
        true => CLOSED,
        false => CLOSED_MOST,
    };
    !open(after) || excess(after) <= (1.0 - share) * excess(before)
}

/// The joints whose gap is open, the share of the residual that is no noise (percent), and the
/// variables that it varies with.
pub(super) fn located(
    bench: &Bench<'_>,
    lacks: &[Lack],
    state: &State,
) -> Vec<(usize, f64, Vec<&'static str>)> {
    let lacking = lacks.par_iter().enumerate();
    let lacking = lacking.filter(|(_, lack)| is_open(lack));
    lacking
        .map(|(joint, lack)| {
            let share = lack.excess / (1.0 + lack.excess);
            let residual = state.system.residual(joint);
            let square = share * super::linear::dot(residual, residual);
            (
                joint,
                100.0 * share,
                varies_with(bench, state, joint, square),
            )
        })
        .collect()
}

fn varies_with(bench: &Bench<'_>, state: &State, joint: usize, square: f64) -> Vec<&'static str> {
    let kind = bench.model.joints()[joint].kind;
    let mut columns: Vec<(&'static str, Vec<f64>)> = Vec::new();
    for (track, predicted) in bench.train.tracks.iter().zip(&state.predicted.train) {
        let own = generic::columns(track, predicted, (joint, kind));
        if columns.is_empty() {
            columns = generic::variables()
                .into_iter()
                .map(|name| (name, Vec::new()))
                .collect();
        }
        columns
            .iter_mut()
            .zip(own)
            .for_each(|((_, all), more)| all.extend(more));
    }
    let mut found: Vec<(&'static str, f64)> = Vec::new();
    for name in generic::VARIABLES {
        let of_name = columns.iter().filter(|(variable, _)| variable == &name);
        let white: Vec<Sparse> = of_name
            .map(|(_, rows)| bench.train.whiten(&[(joint, rows.clone())], bench.noise))
            .collect();
        let gain = state.system.gain(&white, &[]);
        found.push((name, gain.square - gain.columns() as f64));
    }
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found.retain(|(_, gain)| *gain > MENTIONED * square);
    found.into_iter().take(3).map(|(name, _)| name).collect()
}
