//! What the search makes small: the criterion, and how far a motion is beyond its limits.

use super::criterion::Criterion;
use super::family::Sampled;
use super::regressor::Regressor;
use super::space::{Path, Space};

/// Share of a limit that a motion may use at the instants of the search, so that it keeps to the
/// limit between them.
const SHARE: f64 = 0.99;

/// How sharply condition numbers are taken and how much a violated limit costs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stage {
    pub sharpness: f64,
    pub penalty: f64,
}

/// The cost of motions at the instants of the search.
pub(super) struct Cost<'a> {
    pub space: &'a Space<'a>,
    pub sampled: Sampled,
    pub regressor: Regressor<'a>,
    pub criterion: &'a Criterion,
    /// The columns of [`Criterion::Separate`] among those of W.
    pub separate: Vec<usize>,
    /// The parameters of the present model, where efforts are limited.
    pub parameters: Option<&'a [f64]>,
}

impl Cost<'_> {
    /// ln of the criterion plus the penalty; `None` where W is singular.
    pub fn value(&self, z: &[f64], stage: Stage) -> Option<f64> {
        let path = self.space.path(z, &self.sampled);
        let signals = self.regressor.evaluate(&path);
        let mut excess = Excess::new(stage.penalty / path.len as f64);
        self.motion(&path, &mut excess);
        self.effort(&signals, path.len, &mut excess);
        let w = self.regressor.matrix(&signals, path.len);
        let gram = w.transpose() * &w;
        let slope = self
            .criterion
            .slope(&gram, stage.sharpness, &self.separate)?;
        Some(slope.value + excess.sum)
    }

    /// The same with its slopes.
    pub fn slopes(&self, z: &[f64], stage: Stage) -> Option<(f64, Vec<f64>)> {
        let path = self.space.path(z, &self.sampled);
        let len = path.len;
        let signals = self.regressor.evaluate(&path);
        let w = self.regressor.matrix(&signals, len);
        let gram = w.transpose() * &w;
        let slope = self
            .criterion
            .slope(&gram, stage.sharpness, &self.separate)?;
        let of_w = (w * slope.of_gram) * faer::Scale(2.0);
        let mut of_signals = vec![0.0; signals.len()];
        self.regressor.pull_matrix(&of_w, len, &mut of_signals);
        let mut excess = Excess::new(stage.penalty / len as f64);
        let of_limits = self.motion(&path, &mut excess);
        if let Some(parameters) = self.parameters {
            let of_tau = self.effort(&signals, len, &mut excess);
            let to = &mut of_signals;
            self.regressor.pull_torque(parameters, &of_tau, len, to);
        }
        let mut of_path = self.regressor.pull_path(&path, &signals, &of_signals);
        for (order, limits) in of_limits.iter().enumerate() {
            let pairs = of_path.derivative(order).iter_mut().zip(limits);
            pairs.for_each(|(slope, more)| *slope += more);
        }
        let slopes = self.space.slopes(&of_path, &self.sampled);
        let value = slope.value + excess.sum;
        let finite = value.is_finite() && slopes.iter().all(|slope| slope.is_finite());
        finite.then_some((value, slopes))
    }

    /// Adds what positions, velocities and accelerations are beyond their limits; the slopes.
    fn motion(&self, path: &Path, excess: &mut Excess) -> [Vec<f64>; 3] {
        let limits = self.space.limits;
        let mut beyond = |series: &[f64], order: usize| -> Vec<f64> {
            let joints = series.chunks(path.len).zip(limits);
            let slopes = joints.flat_map(|(series, limits)| {
                let (middle, size) = match order {
                    0 => (limits.middle(), 0.5 * (limits.upper - limits.lower)),
                    1 => (0.0, limits.velocity),
                    _ => (0.0, limits.acceleration),
                };
                let values = series.iter().map(|value| excess.add(value - middle, size));
                values.collect::<Vec<f64>>()
            });
            slopes.collect()
        };
        [
            beyond(&path.q, 0),
            beyond(&path.qd, 1),
            beyond(&path.qdd, 2),
        ]
    }

    /// The same of the torque; empty without parameters.
    fn effort(&self, signals: &[f64], len: usize, excess: &mut Excess) -> Vec<f64> {
        let Some(parameters) = self.parameters else {
            return Vec::new();
        };
        let tau = self.regressor.torque(parameters, signals, len);
        let joints = tau.chunks(len).zip(self.space.limits);
        let slopes = joints.flat_map(|(tau, limits)| {
            let values = tau.iter().map(|tau| excess.add(*tau, limits.effort));
            values.collect::<Vec<f64>>()
        });
        slopes.collect()
    }
}

/// Sum of squares of what is beyond limits.
struct Excess {
    weight: f64,
    sum: f64,
}

impl Excess {
    fn new(weight: f64) -> Excess {
        Excess { weight, sum: 0.0 }
    }

    /// Adds a value with limits of a size on both sides; the slope.
    fn add(&mut self, value: f64, size: f64) -> f64 {
        let beyond = value.abs() / size - SHARE;
        if beyond.is_nan() || beyond <= 0.0 {
            return 0.0;
        }
        self.sum += self.weight * beyond * beyond;
        2.0 * self.weight * beyond * value.signum() / size
    }
}
