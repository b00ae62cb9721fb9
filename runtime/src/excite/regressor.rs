//! The observation matrix of the explicit model along a path, and how it moves with the path.

use std::borrow::Cow;

use faer::Mat;

use super::space::Path;
use crate::model::{Entry, IdentificationModel, Output};

/// Steps of the one-sided differences. D is linear in the accelerations; the step of a velocity goes
/// away from zero, so that no sign of dry friction changes.
const STEPS: [f64; 3] = [1e-6, 1e-6, 1.0];

/// The columns of D that take part, with the weight of each joint's rows.
pub(super) struct Regressor<'a> {
    pub model: &'a dyn IdentificationModel,
    entries: Cow<'a, [Entry]>,
    signals: usize,
    /// Place of each column of the model among those that take part.
    place: Vec<Option<usize>>,
    columns: usize,
    weight: Vec<f64>,
}

impl<'a> Regressor<'a> {
    /// Of the columns `kept`, counted from 0 in the model; rows of joint j times `weight[j]`.
    pub fn new(model: &'a dyn IdentificationModel, kept: &[usize], weight: Vec<f64>) -> Self {
        let pattern = model.pattern(Output::Explicit);
        let place = |column| kept.iter().position(|&kept| kept == column);
        Regressor {
            model,
            entries: Cow::Borrowed(&pattern.entries),
            signals: pattern.signals,
            place: (0..model.columns().len()).map(place).collect(),
            columns: kept.len(),
            weight,
        }
    }

    pub fn evaluate(&self, path: &Path) -> Vec<f64> {
        let mut signals = vec![0.0; self.signals * path.len];
        self.model
            .evaluate(Output::Explicit, &path.states(), &mut signals);
        signals
    }

    /// W: the rows of joint 1 at all instants, then those of joint 2, ...
    pub fn matrix(&self, signals: &[f64], len: usize) -> Mat<f64> {
        let mut w = Mat::zeros(self.weight.len() * len, self.columns);
        for entry in self.entries.iter() {
            let Some(column) = self.place[entry.column] else {
                continue;
            };
            let from = &signals[entry.signal * len..][..len];
            for (i, value) in from.iter().enumerate() {
                w[(entry.row * len + i, column)] += self.weight[entry.row] * value;
            }
        }
        w
    }

    /// From slopes with respect to W to those with respect to the signals, added to `slopes`.
    pub fn pull_matrix(&self, of_w: &Mat<f64>, len: usize, slopes: &mut [f64]) {
        for entry in self.entries.iter() {
            let Some(column) = self.place[entry.column] else {
                continue;
            };
            let to = &mut slopes[entry.signal * len..][..len];
            for (i, slope) in to.iter_mut().enumerate() {
                *slope += self.weight[entry.row] * of_w[(entry.row * len + i, column)];
            }
        }
    }

    /// Torque of every joint with the parameters of all columns, joint after joint.
    pub fn torque(&self, parameters: &[f64], signals: &[f64], len: usize) -> Vec<f64> {
        let mut tau = vec![0.0; self.weight.len() * len];
        for entry in self.entries.iter() {
            let from = &signals[entry.signal * len..][..len];
            let to = tau[entry.row * len..][..len].iter_mut().zip(from);
            to.for_each(|(to, from)| *to += parameters[entry.column] * from);
        }
        tau
    }

    /// From slopes with respect to the torque to those with respect to the signals.
    pub fn pull_torque(&self, parameters: &[f64], of_tau: &[f64], len: usize, slopes: &mut [f64]) {
        for entry in self.entries.iter() {
            let from = &of_tau[entry.row * len..][..len];
            let to = slopes[entry.signal * len..][..len].iter_mut().zip(from);
            to.for_each(|(to, from)| *to += parameters[entry.column] * from);
        }
    }

    /// From slopes with respect to the signals to those with respect to the path: differences of
    /// the signals for a step of one joint at all instants together.
    pub fn pull_path(&self, path: &Path, signals: &[f64], slopes: &[f64]) -> Path {
        let len = path.len;
        let mut pulled = Path {
            len,
            q: vec![0.0; path.q.len()],
            qd: vec![0.0; path.q.len()],
            qdd: vec![0.0; path.q.len()],
        };
        for joint in 0..self.weight.len() {
            let own = joint * len..(joint + 1) * len;
            for (order, step) in STEPS.into_iter().enumerate() {
                let mut moved = path.clone();
                let values = moved.derivative(order)[own.clone()].iter_mut();
                let steps: Vec<f64> = values
                    .map(|value| {
                        let step = step.copysign(*value);
                        *value += step;
                        step
                    })
                    .collect();
                let other = self.evaluate(&moved);
                let to = &mut pulled.derivative(order)[own.clone()];
                for (s, slopes) in slopes.chunks(len).enumerate() {
                    let from = s * len..(s + 1) * len;
                    let change = other[from.clone()].iter().zip(&signals[from]);
                    let terms = slopes.iter().zip(change);
                    let terms = terms.map(|(slope, (other, signal))| slope * (other - signal));
                    to.iter_mut().zip(terms).for_each(|(to, term)| *to += term);
                }
                let parts = to.iter_mut().zip(steps);
                parts.for_each(|(slope, step)| *slope /= step);
            }
        }
        pulled
    }
}
