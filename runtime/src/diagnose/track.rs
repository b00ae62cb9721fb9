//! A log as the diagnosis sees it: the motion at its full rate, for columns that need it, and the
//! decimated rows of every joint.

use std::ops::Range;

use rayon::prelude::*;

use super::catalogue::{ColumnsAlong, Hypothesis, Signals, TorqueColumn};
use super::rest::Rested;
use crate::log::{Companion, Recording, resolution};
use crate::model::{ColumnKind, IdentificationModel, Output};
use crate::observe::{
    Equations, Filtering, ModelKind, Motion, ObserveError, check_torque, contract, equations_at,
};
use crate::settings::Edges;
use crate::signal::{Decimator, SignalError};

/// What rows beside a standstill count for: friction at rest is any torque below its limit, and the
/// filters spread what it does there.
const NEAR_REST: f64 = 0.25;

/// Standard deviations of the velocity's noise within which its sign is not certain.
const UNCERTAIN: f64 = 3.0;

/// Share of the largest velocity below which the sign is not certain either.
const SLOW: f64 = 1e-3;

/// Torque of an effect along a log, decimated.
#[derive(Clone, Debug)]
pub(super) struct Decimated {
    /// Name and SI unit of the parameter.
    pub name: String,
    pub unit: &'static str,
    /// Joint, and rows.
    pub torque: Vec<(usize, Vec<f64>)>,
}

/// A log, filtered.
#[derive(Clone, Debug)]
pub(super) struct Track {
    pub motion: Motion,
    /// Seconds since the beginning of the log.
    t: Vec<f64>,
    decimator: Decimator,
    /// Samples at which the rows stand.
    kept: Vec<usize>,
    /// W and Y of each joint.
    pub equations: Vec<Equations>,
    /// What each row counts for, by joint.
    pub weights: Vec<Vec<f64>>,
    dead_band: Vec<f64>,
    /// Whether the logged torque is held from each sample to the next.
    held: bool,
}

/// The torques that the present model predicts along a track, at its full rate.
#[derive(Clone, Debug)]
pub(super) struct Predicted {
    pub parameters: Vec<f64>,
    pub model: Vec<Vec<f64>>,
    pub rigid: Vec<Vec<f64>>,
}

impl Track {
    /// Filters a log.
    pub fn new(
        model: &dyn IdentificationModel,
        recording: &Recording,
        companion: &Companion,
        filtering: &Filtering,
    ) -> Result<Track, ObserveError> {
        check_torque(recording)?;
        let mut motion = Motion::full(recording, model, filtering)?;
        let fail = |source: SignalError| ObserveError::Filter {
            log: recording.name.clone(),
            step: "parallel filter",
            source,
        };
        let decimator = filtering.decimator(motion.rate_hz).map_err(fail)?;
        let kept = inner(&motion, filtering, &decimator);
        if kept.len() < 20 {
            let (log, has) = (recording.name.clone(), motion.len);
            return Err(ObserveError::NothingLeft {
                log,
                cut: has - kept.len(),
                has,
                unit: "samples",
            });
        }
        if companion.controller.is_some() {
            motion.tau.iter_mut().flatten().for_each(|tau| held(tau));
        }
        let steps: Vec<f64> = match companion.encoder_resolution {
            Some(step) => vec![step; recording.q.len()],
            None => recording.q.iter().map(|q| resolution(q)).collect(),
        };
        let dead_band = dead_band(&motion, &steps, filtering);
        let qd = motion.qd.iter_mut().zip(&dead_band);
        qd.for_each(|(qd, band)| through_rest(qd, *band));
        let rested = Rested::new(model, dead_band.clone());
        let made = equations_at(&rested, ModelKind::Explicit, &motion, &decimator, &kept);
        let reach = filtering.reach(motion.rate_hz);
        Ok(Track {
            t: (0..motion.len).map(|k| k as f64 / motion.rate_hz).collect(),
            weights: weights(&motion, &kept, &dead_band, reach),
            equations: made.map_err(fail)?.blocks,
            motion,
            decimator,
            kept,
            dead_band,
            held: companion.controller.is_some(),
        })
    }

    /// Number of rows of each joint.
    pub fn rows(&self) -> usize {
        self.kept.len()
    }

    /// Seconds between two rows.
    pub fn step(&self) -> f64 {
        self.decimator.ratio() as f64 / self.motion.rate_hz
    }

    /// A torque along the motion as the log has it: what a controller holds from one sample to the
    /// next stands in the log at its beginning.
    pub fn as_logged(&self, torque: &mut [f64]) {
        if self.held {
            for k in 1..torque.len() {
                torque[k - 1] = 0.5 * (torque[k - 1] + torque[k]);
            }
        }
    }

    /// Time of a row since the beginning of the log, s.
    pub fn row_time(&self, row: usize) -> f64 {
        self.kept.get(row).map_or(0.0, |&sample| self.t[sample])
    }

    /// Signals at the rows.
    pub fn at_rows(&self, series: &[f64]) -> Vec<f64> {
        self.kept.iter().map(|&sample| series[sample]).collect()
    }

    /// Measured torque of a joint.
    pub fn measured(&self, joint: usize) -> &[f64] {
        self.equations[joint].y.as_deref().unwrap_or(&[])
    }

    /// Torques of a model with np parameters.
    pub fn predict(&self, model: &dyn IdentificationModel, parameters: &[f64]) -> Predicted {
        let rigid: Vec<f64> = model
            .columns()
            .iter()
            .zip(parameters)
            .map(|(column, value)| match column.kind {
                ColumnKind::Inertial | ColumnKind::Drive => *value,
                ColumnKind::Friction | ColumnKind::Effect => 0.0,
            })
            .collect();
        let model = Rested::new(model, self.dead_band.clone());
        Predicted {
            model: contract(&model, Output::Explicit, &self.motion, parameters),
            rigid: contract(&model, Output::Explicit, &self.motion, &rigid),
            parameters: parameters.to_vec(),
        }
    }

    /// The signals that columns are made of.
    pub fn signals<'a>(&'a self, predicted: &'a Predicted) -> Signals<'a> {
        Signals {
            rate_hz: self.motion.rate_hz,
            t: &self.t,
            q: &self.motion.q,
            qd: &self.motion.qd,
            qdd: &self.motion.qdd,
            tau_model: &predicted.model,
            tau_rigid: &predicted.rigid,
            parameters: &predicted.parameters,
            dead_band: &self.dead_band,
        }
    }

    /// Low-passes series at the full rate like the torque, and keeps the rows. They are as long as
    /// the motion, which the filters have already run along.
    pub fn decimate(&self, series: &[Vec<f64>]) -> Vec<Vec<f64>> {
        self.decimator
            .values(series, &self.kept)
            .unwrap_or_default()
    }

    /// Columns of a hypothesis for each of `shapes`, decimated.
    pub fn columns(
        &self,
        along: &ColumnsAlong<'_>,
        hypothesis: &Hypothesis,
        shapes: &[Vec<f64>],
    ) -> Vec<Vec<Decimated>> {
        let made: Vec<Vec<TorqueColumn>> = shapes
            .par_iter()
            .map(|shape| along(hypothesis, shape))
            .collect();
        let mut series = Vec::new();
        let mut layout = Vec::new();
        for columns in made {
            let mut names = Vec::new();
            for column in columns {
                let joints: Vec<usize> = column.torque.iter().map(|(joint, _)| *joint).collect();
                series.extend(column.torque.into_iter().map(|(_, values)| values));
                names.push((column.name, column.unit, joints));
            }
            layout.push(names);
        }
        let mut rows = self.decimate(&series).into_iter();
        let mut column = |(name, unit, joints): (String, &'static str, Vec<usize>)| Decimated {
            name,
            unit,
            torque: joints.into_iter().zip(rows.by_ref()).collect(),
        };
        layout
            .into_iter()
            .map(|names| names.into_iter().map(&mut column).collect())
            .collect()
    }
}

/// The samples to keep: not those at the edges, which the filters falsify.
fn inner(motion: &Motion, filtering: &Filtering, decimator: &Decimator) -> Vec<usize> {
    let (start, end) = filtering.cut_before();
    let more = match filtering.edges {
        Edges::Scipy => 0,
        Edges::Matlab => filtering.trim * filtering.nd,
    };
    let inside = start + more..motion.len.saturating_sub(end + more);
    let mut kept = decimator.kept(motion.len);
    kept.retain(|sample| inside.contains(sample));
    kept
}

/// Velocity under which the sign is not certain: the noise that quantised positions leave behind
/// prefilter and difference.
fn dead_band(motion: &Motion, steps: &[f64], filtering: &Filtering) -> Vec<f64> {
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

/// The torque at each sample of a controller that runs once a sample and holds its torque until the
/// next: the mean of what ends and what begins there.
fn held(tau: &mut [f64]) {
    for k in (1..tau.len()).rev() {
        tau[k] = 0.5 * (tau[k - 1] + tau[k]);
    }
}

/// Lets a velocity run straight in time from one side of its dead band to the other. Friction at
/// rest balances whatever the drive pushes with, which grows about so until the joint breaks away;
/// what the velocity's noise does meanwhile says nothing of it.
fn through_rest(qd: &mut [f64], band: f64) {
    let mut start = 0;
    while let Some(first) = (start..qd.len()).find(|&k| qd[k].abs() < band) {
        let end = (first..qd.len())
            .find(|&k| qd[k].abs() >= band)
            .unwrap_or(qd.len());
        start = end;
        let side = |k: usize| qd.get(k).map_or(0.0, |v| v.signum());
        let (from, to) = (first.checked_sub(1).map_or(0.0, side), side(end));
        let steps = (end - first + 1) as f64;
        for (k, v) in qd[first..end].iter_mut().enumerate() {
            let part = (k + 1) as f64 / steps;
            // Never quite the band itself, which counts as moving.
            *v = 0.999 * band * ((1.0 - part) * from + part * to);
        }
    }
}

/// What rows count for: nothing near samples that cannot be believed, less near rest.
fn weights(motion: &Motion, kept: &[usize], dead_band: &[f64], reach: usize) -> Vec<Vec<f64>> {
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
