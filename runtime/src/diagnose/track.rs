//! A log as the diagnosis sees it: the motion at its full rate, for columns that need it, and the
//! decimated rows of every joint.

use std::sync::Arc;

use rayon::prelude::*;

use super::catalogue::{ColumnsAlong, Hypothesis, Signals, TorqueColumn};
use super::rest::Rested;
use super::still::{dead_band, reversals, weights};
use super::thin::Thin;
use crate::log::{Companion, Recording, resolution};
use crate::model::{ColumnKind, IdentificationModel, Output};
use crate::observe::{
    Equations, Filtering, ModelKind, Motion, ObserveError, check_torque, contract, equations_at,
};
use crate::settings::{Edges, Velocity};
use crate::signal::Decimator;

/// Reaches of the filters until what rings on from the ends of a log is below its noise, and the
/// share of a log that is spared for it at most.
const RINGING: usize = 6;
const SPARED: f64 = 0.05;

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
    /// Which samples of the log the motion has.
    pub thin: Thin,
    /// Seconds since the beginning of the log.
    t: Vec<f64>,
    decimator: Decimator,
    /// Samples at which the rows stand.
    kept: Vec<usize>,
    /// W and Y of each joint.
    pub equations: Vec<Equations>,
    /// What each row counts for, by joint.
    pub weights: Vec<Vec<f64>>,
    pub dead_band: Vec<f64>,
    /// Step of each joint's encoder, rad or m.
    pub steps: Vec<f64>,
    /// What it was made of.
    pub source: Arc<Source>,
}

/// A log with everything that is known of it.
#[derive(Clone, Debug)]
pub(super) struct Source {
    pub recording: Recording,
    pub companion: Companion,
    pub filtering: Filtering,
}

/// What a track may follow instead of its own motion.
pub(super) enum Instead {
    /// Other positions, one series per joint at the log's samples, rad or m.
    Positions(Vec<Vec<f64>>),
    /// Its own behind a prefilter with this cut-off, Hz.
    Below(f64),
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
        let fail = ObserveError::filter(&recording.name, "parallel filter");
        let decimator = filtering.decimator(motion.rate_hz).map_err(&fail)?;
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
        // A controller runs at the rate of the log.
        let thin = match companion.controller {
            Some(_) => Thin::NOT,
            None => Thin::to_enough(filtering, motion.rate_hz, &kept),
        };
        let motion = thin.motion(motion).map_err(&fail)?;
        let left = thin.filtering(filtering);
        let kept: Vec<usize> = kept.into_iter().map(|sample| thin.place(sample)).collect();
        let reach = left.reach(motion.rate_hz);
        let track = Track {
            t: (0..motion.len)
                .map(|k| thin.time(k, motion.rate_hz))
                .collect(),
            decimator: left.decimator(motion.rate_hz).map_err(&fail)?,
            thin,
            weights: weights(&motion, &kept, &dead_band, reach),
            equations: Vec::new(),
            motion,
            kept,
            dead_band,
            steps,
            source: Arc::new(Source {
                recording: recording.clone(),
                companion: companion.clone(),
                filtering: filtering.clone(),
            }),
        };
        track.observed(model)
    }

    /// The same rows along another motion: that of positions `q`, or of those of the log behind a
    /// lower cut-off.
    pub fn beside(
        &self,
        model: &dyn IdentificationModel,
        instead: &Instead,
    ) -> Result<Track, ObserveError> {
        let Source {
            recording,
            filtering,
            ..
        } = &*self.source;
        let mut filtering = Filtering {
            velocity: Velocity::Derived,
            ..filtering.clone()
        };
        let mut recording = Recording {
            qd: None,
            tau: None,
            ..recording.clone()
        };
        match instead {
            Instead::Positions(q) => recording.q.clone_from(q),
            Instead::Below(fq_hz) => filtering.fq_hz = filtering.fq_hz.min(*fq_hz),
        }
        let motion = Motion::full(&recording, model, &filtering)?;
        let motion = self.thin.motion(motion);
        let track = Track {
            motion: motion.map_err(ObserveError::filter(&recording.name, "low-pass"))?,
            ..self.clone()
        };
        track.observed(model)
    }

    /// With W along the motion.
    fn observed(mut self, model: &dyn IdentificationModel) -> Result<Track, ObserveError> {
        let rested = Rested::new(model, self.dead_band.clone());
        let (motion, decimator) = (&self.motion, &self.decimator);
        let made = equations_at(&rested, ModelKind::Explicit, motion, decimator, &self.kept);
        let fail = ObserveError::filter(&motion.log, "parallel filter");
        self.equations = made.map_err(fail)?.blocks;
        Ok(self)
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
        if self.source.companion.controller.is_some() {
            for k in 1..torque.len() {
                torque[k - 1] = 0.5 * (torque[k - 1] + torque[k]);
            }
        }
    }

    /// Time of each sample since the beginning of the log, s.
    pub fn times(&self) -> &[f64] {
        &self.t
    }

    /// Time of a row since the beginning of the log, s.
    pub fn row_time(&self, row: usize) -> f64 {
        self.kept.get(row).map_or(0.0, |&sample| self.t[sample])
    }

    /// Whether each row cannot be believed.
    pub fn doubtful_rows(&self) -> Vec<bool> {
        let doubtful = |sample: &usize| self.motion.doubtful.iter().any(|r| r.contains(sample));
        self.kept.iter().map(doubtful).collect()
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
        predict(model, parameters, &self.motion, &self.dead_band)
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

    /// Pulses at the reversals of each joint, decimated.
    pub fn reversals(&self) -> Vec<Vec<f64>> {
        let joints = self.motion.qd.iter().zip(&self.dead_band);
        let pulses = joints.map(|(qd, band)| reversals(qd, *band, self.motion.rate_hz));
        self.decimate(&pulses.collect::<Vec<_>>())
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

/// Torques of a model with np parameters along a motion.
pub(super) fn predict(
    model: &dyn IdentificationModel,
    parameters: &[f64],
    motion: &Motion,
    dead_band: &[f64],
) -> Predicted {
    let rigid: Vec<f64> = model
        .columns()
        .iter()
        .zip(parameters)
        .map(|(column, value)| match column.kind {
            ColumnKind::Inertial | ColumnKind::Drive => *value,
            ColumnKind::Friction | ColumnKind::Effect => 0.0,
        })
        .collect();
    let model = Rested::new(model, dead_band.to_vec());
    Predicted {
        model: contract(&model, Output::Explicit, motion, parameters),
        rigid: contract(&model, Output::Explicit, motion, &rigid),
        parameters: parameters.to_vec(),
    }
}

/// The samples to keep: not those at the edges, which the filters falsify.
fn inner(motion: &Motion, filtering: &Filtering, decimator: &Decimator) -> Vec<usize> {
    let (start, end) = filtering.cut_before();
    let more = match filtering.edges {
        Edges::Scipy => 0,
        Edges::Matlab => filtering.trim * filtering.nd,
    };
    // What the filters believe beyond the ends of the log reaches in so far; where a log begins or
    // ends in the middle of a motion that is wrong, and rings on.
    let reach = filtering.reach(motion.rate_hz);
    let edge = (RINGING * reach).min((SPARED * motion.len as f64) as usize);
    let edge = edge.max(2 * reach);
    let (start, end) = ((start + more).max(edge), (end + more).max(edge));
    let inside = start..motion.len.saturating_sub(end);
    let mut kept = decimator.kept(motion.len);
    kept.retain(|sample| inside.contains(sample));
    kept
}

/// The torque at each sample of a controller that runs once a sample and holds its torque until the
/// next: the mean of what ends and what begins there.
fn held(tau: &mut [f64]) {
    for k in (1..tau.len()).rev() {
        tau[k] = 0.5 * (tau[k - 1] + tau[k]);
    }
}
