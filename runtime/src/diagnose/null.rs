//! The null model: the parameters that the robot's description asks for, refitted where the log
//! decides and held by the description's tolerances where it does not.

use rayon::prelude::*;

use super::generic;
use super::joined::Joined;
use super::likelihood::{self, left};
use super::linear::dot;
use super::noise::{Noise, of_rows};
use super::repeats::{Repeats, find, pure_error};
use super::rounding::Rounding;
use super::system::{Pair, Sparse, System};
use super::track::Predicted;
use crate::knowledge::Knowledge;
use crate::model::{ColumnKind, IdentificationModel};

/// Passes of fit, noise, fit.
const PASSES: usize = 3;

/// Rows of prior knowledge \\( A X = b + \epsilon \\), errors of variance one, by columns.
#[derive(Clone, Debug, Default)]
pub(super) struct Prior {
    pub columns: Vec<Vec<f64>>,
    pub right: Vec<f64>,
}

impl Prior {
    /// Of a description's tolerances, friction left open: it changes from day to day.
    pub fn of(model: &dyn IdentificationModel, knowledge: &Knowledge) -> Prior {
        let columns = model.columns();
        let np = columns.len();
        let inertial = |row: &&[f64]| {
            let mut used = row[..np].iter().zip(columns).filter(|(a, _)| **a != 0.0);
            used.any(|(_, column)| column.kind != ColumnKind::Friction)
        };
        let rows: Vec<&[f64]> = knowledge
            .prior
            .chunks_exact(np + 1)
            .filter(inertial)
            .collect();
        Prior {
            columns: (0..np)
                .map(|k| rows.iter().map(|row| row[k]).collect())
                .collect(),
            right: rows.iter().map(|row| row[np]).collect(),
        }
    }
}

/// The null model of logs.
#[derive(Clone, Debug)]
pub(super) struct Null {
    pub noise: Vec<Noise>,
    pub system: System,
    pub repeats: Vec<Repeats>,
    /// Columns of the generic model of each joint, whitened; empty where the log repeats itself.
    pub generic: Vec<Vec<Sparse>>,
}

/// Parameters by least squares alone, good enough to simulate with.
pub(super) fn first_guess(
    model: &dyn IdentificationModel,
    joined: &Joined,
    prior: &Prior,
) -> Vec<f64> {
    let noise = unknown_noise(joined);
    parameters(model, &fit(model, (joined, joined), &noise, prior))
}

/// The np parameters of the model; behind them stand those of the reversals, one per joint.
pub(super) fn parameters(model: &dyn IdentificationModel, system: &System) -> Vec<f64> {
    let mut all = system.solution();
    all.truncate(model.columns().len());
    all
}

/// Noise before anything is known of it: a part of the torque.
pub(super) fn unknown_noise(joined: &Joined) -> Vec<Noise> {
    let of_joint = |joint: usize| {
        let y = joined.measured(joint);
        Noise::white(0.05 * (dot(&y, &y) / y.len().max(1) as f64).sqrt())
    };
    (0..joined.joints()).map(of_joint).collect()
}

/// Fits the null model and its noise along logs and the motions of their instruments.
pub(super) fn null(
    model: &dyn IdentificationModel,
    (joined, instruments): (&Joined, &Joined),
    prior: &Prior,
) -> Null {
    let segments = joined.tracks.iter().zip(joined.segments.clone());
    let repeats: Vec<Repeats> = segments
        .filter_map(|(track, rows)| find(track, rows))
        .collect();
    let mut noise = unknown_noise(joined);
    let of_motion = match repeats.is_empty() {
        true => generic_of_motion(model, instruments),
        false => Vec::new(),
    };
    let mut generic: Vec<Vec<Vec<f64>>> = Vec::new();
    // What changes slowly does not repeat and is no noise either.
    let slow = match repeats.is_empty() {
        true => Vec::new(),
        false => slow_columns(joined),
    };
    let rounding = Rounding::of(model, joined);
    let mut system = fit(model, (joined, instruments), &noise, prior);
    for _ in 0..PASSES {
        let parameters = parameters(model, &system);
        let product = joined.product(&parameters);
        if repeats.is_empty() {
            let predicted = instruments.predict(model, &parameters);
            generic = with_torque(&of_motion, instruments, &predicted);
        }
        noise.par_iter_mut().enumerate().for_each(|(joint, noise)| {
            let y = joined.measured(joint);
            let residual: Vec<f64> = y
                .iter()
                .zip(&product[joint])
                .map(|(y, wx)| y - wx)
                .collect();
            let weights = &joined.weights[joint];
            let found = if repeats.is_empty() {
                likelihood::noise(&generic[joint], &residual, weights, &joined.segments)
            } else {
                let error = pure_error(&residual, weights, &repeats);
                let slow = slow[joint]
                    .iter()
                    .map(|c| pure_error(c, weights, &repeats).rows);
                let mut left = left(slow.chain([error.rows]).collect());
                if let Some(rounding) = &rounding {
                    let hidden = rounding.hidden(&parameters, &product, joint);
                    left.iter_mut().zip(hidden).for_each(|(a, b)| *a += b);
                }
                of_rows(&left, &error.weights, &joined.segments, 1.0)
            };
            *noise = found.credible(&y);
        });
        system = fit(model, (joined, instruments), &noise, prior);
    }
    let whiten = |(joint, columns): (usize, Vec<Vec<f64>>)| -> Vec<Sparse> {
        let column = |rows: Vec<f64>| joined.whiten(&[(joint, rows)], &noise);
        columns.into_iter().map(column).collect()
    };
    Null {
        generic: generic.into_iter().enumerate().map(whiten).collect(),
        noise,
        system,
        repeats,
    }
}

/// Weighted fit of the base parameters, with the rows of the prior.
pub(super) fn fit(
    model: &dyn IdentificationModel,
    (joined, instruments): (&Joined, &Joined),
    noise: &[Noise],
    prior: &Prior,
) -> System {
    let joints = joined.joints();
    let mut y = Vec::with_capacity(joints * joined.rows() + prior.right.len());
    for joint in 0..joints {
        let white = joined.whiten(&[(joint, joined.measured(joint))], noise);
        white.0.into_iter().for_each(|(_, rows)| y.extend(rows));
    }
    y.extend_from_slice(&prior.right);
    let column = |along: &Joined, k: usize| {
        let mut column = along.whiten(&along.base(k), noise);
        if let Some(known) = prior.columns.get(k).filter(|rows| !rows.is_empty()) {
            column.0.push((joints, known.clone()));
        }
        column
    };
    let pair = |k: usize| (column(joined, k), column(instruments, k));
    let columns = (0..model.columns().len()).into_par_iter();
    let mut pairs: Vec<Pair> = columns.map(pair).collect();
    // Nobody's parameters: what joints that stick at their reversals do.
    let pulses = joined.reversals().into_iter().zip(instruments.reversals());
    for (joint, (own, beside)) in pulses.enumerate() {
        let white = |rows: Vec<f64>| joined.whiten(&[(joint, rows)], noise);
        pairs.push((white(own), white(beside)));
    }
    System::new(joined.rows(), y).with(&pairs)
}

/// The columns of the generic model that change slowly, of each joint over all logs.
fn slow_columns(joined: &Joined) -> Vec<Vec<Vec<f64>>> {
    let of_joint = |joint: usize| {
        let mut all: Vec<Vec<f64>> = Vec::new();
        for track in &joined.tracks {
            append(&mut all, generic::slow(track, joint));
        }
        all
    };
    (0..joined.joints()).map(of_joint).collect()
}

/// Columns of the null model over all logs, and those of the generic model that the motion decides.
fn generic_of_motion(model: &dyn IdentificationModel, joined: &Joined) -> Vec<Vec<Vec<f64>>> {
    let pulses = joined.reversals();
    let of_joint = |(joint, kind): (usize, &crate::model::Joint)| {
        let base = (0..model.columns().len()).flat_map(|k| joined.base(k));
        let mut all: Vec<Vec<f64>> = base
            .filter(|(on, _)| *on == joint)
            .map(|(_, rows)| rows)
            .collect();
        let mut own: Vec<Vec<f64>> = Vec::new();
        for track in &joined.tracks {
            append(&mut own, generic::of_motion(track, (joint, kind.kind)));
        }
        all.extend(own);
        all.push(pulses[joint].clone());
        all
    };
    let joints = model.joints().par_iter().enumerate();
    joints.map(of_joint).collect()
}

/// These and those that follow a predicted torque.
fn with_torque(
    of_motion: &[Vec<Vec<f64>>],
    joined: &Joined,
    predicted: &[Predicted],
) -> Vec<Vec<Vec<f64>>> {
    let of_joint = |(joint, of_motion): (usize, &Vec<Vec<f64>>)| {
        let mut own: Vec<Vec<f64>> = Vec::new();
        for (track, predicted) in joined.tracks.iter().zip(predicted) {
            append(&mut own, generic::of_torque(track, predicted, joint));
        }
        of_motion.iter().cloned().chain(own).collect()
    };
    of_motion.par_iter().enumerate().map(of_joint).collect()
}

/// Puts the columns of another log below those so far.
fn append(all: &mut Vec<Vec<f64>>, columns: Vec<Vec<f64>>) {
    all.resize(columns.len(), Vec::new());
    all.iter_mut()
        .zip(columns)
        .for_each(|(all, more)| all.extend(more));
}
