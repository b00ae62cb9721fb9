//! From a motion that was found to what is said of it.

use super::error::ExciteError;
use super::expect::{self, Noise};
use super::family::Sampled;
use super::regressor::Regressor;
use super::result::{ByChance, Excitation, Expected, JointUse};
use super::space::{Path, Space};
use super::within::Within;
use super::{Settings, Task, matrix, motion, regressor};
use crate::model::Column;

/// Most periods that anyone would want to wait for.
const MOST_PERIODS: f64 = 1e6;

/// Condition number of columns of unit norm above which digits are lost.
const DOUBTFUL: f64 = 1e4;

/// A motion that was found.
pub(super) struct Outcome<'a> {
    pub task: &'a Task<'a>,
    pub settings: &'a Settings,
    pub within: &'a Within,
    pub space: &'a Space<'a>,
    pub fine: &'a Sampled,
    pub z: &'a [f64],
}

impl Outcome<'_> {
    /// All that is said of the motion.
    ///
    /// # Errors
    /// [`ExciteError::NoMotion`], [`ExciteError::Unreachable`].
    pub fn excitation(&self, found: f64, chances: &[f64]) -> Result<Excitation, ExciteError> {
        let (task, settings) = (self.task, self.settings);
        let path = self.space.path(self.z, self.fine);
        let plain = regressor(task, settings, self.within, false);
        let conditions = expect::conditions(&matrix(&plain, &path));
        let (condition, condition_scaled) = conditions.ok_or(ExciteError::NoMotion)?;
        let parameters = self.parameters()?;
        let mut warnings = Vec::new();
        if condition_scaled > DOUBTFUL {
            warnings.push(format!(
                "Even the best motion found leaves some parameters hard to tell apart: the condition \
                 number of W with columns of unit norm is {condition_scaled:.3e}. Give the motion \
                 more harmonics or points, more time, or wider limits."
            ));
        }
        let not_judged = self.within.not_judged(task);
        if !not_judged.is_empty() {
            warnings.push(format!(
                "Nothing is said of {}: friction before sliding has a memory, which the search does \
                 not run along its motions.",
                not_judged.join(", ")
            ));
        }
        Ok(Excitation {
            robot: task.model.name().to_owned(),
            family: settings.family,
            start: settings.start,
            criterion: settings.criterion.clone(),
            period_s: settings.period_s,
            periods: settings.periods,
            search: settings.search,
            condition,
            condition_scaled,
            by_chance: ByChance {
                motions: chances.len(),
                found: found.exp(),
                best: chances.first().map(|value| value.exp()),
                median: chances.get(chances.len() / 2).map(|value| value.exp()),
            },
            joints: self.joints(&plain, &path),
            noise: settings.noise.clone(),
            parameters,
            undetermined: self.within.undetermined(task),
            wanted_pct: settings.wanted_pct,
            warnings,
            motion: motion::reference(self.space, self.z, settings.periods),
        })
    }

    fn joints(&self, regressor: &Regressor<'_>, path: &Path) -> Vec<JointUse> {
        let tau = self
            .task
            .parameters
            .map(|parameters| regressor.torque(parameters, &regressor.evaluate(path), path.len));
        let largest = |series: &[f64]| series.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let joints = self.task.model.joints().iter().zip(self.task.limits);
        let one = |(joint, (it, limits)): (usize, (&crate::model::Joint, &super::JointLimits))| {
            let own = joint * path.len..(joint + 1) * path.len;
            let q = &path.q[own.clone()];
            let low = q.iter().copied().fold(f64::INFINITY, f64::min);
            JointUse {
                name: it.name.to_string(),
                kind: it.kind,
                center: self.space.center(self.z, joint),
                limits: *limits,
                range: [low, q.iter().copied().fold(f64::NEG_INFINITY, f64::max)],
                velocity: largest(&path.qd[own.clone()]),
                acceleration: largest(&path.qdd[own.clone()]),
                effort: tau.as_ref().map(|tau| largest(&tau[own])),
            }
        };
        joints.enumerate().map(one).collect()
    }

    /// What will be known of each parameter.
    fn parameters(&self) -> Result<Vec<Expected>, ExciteError> {
        let (task, settings) = (self.task, self.settings);
        let Noise { rate_hz, .. } = settings.noise;
        let samples = (settings.period_s * rate_hz).round().max(1.0) as usize;
        let path = self
            .space
            .path(self.z, &self.space.basis.sample(samples, false));
        let regressor = regressor(task, settings, self.within, true);
        let gram = expect::gram(&regressor, &path, self.within.independent.len());
        let (variance, alone) = expect::inverse(&gram).ok_or(ExciteError::NoMotion)?;
        let columns = task.model.columns().iter().enumerate();
        let one = |(k, column): (usize, &Column)| {
            let place = self.within.independent.iter().position(|kept| *kept == k);
            let place = place.filter(|_| self.within.determined[k]);
            self.expected(
                k,
                column,
                place.map(|place| (variance[place].sqrt(), alone[place])),
            )
        };
        let all: Vec<Expected> = columns.map(one).collect();
        self.reachable(&all)?;
        Ok(all)
    }

    /// A column with its standard deviation after one period.
    fn expected(&self, k: usize, column: &Column, known: Option<(f64, f64)>) -> Expected {
        let value = self.task.parameters.map(|values| values[k]);
        let sigma = known.map(|(sigma, _)| sigma / (self.settings.periods as f64).sqrt());
        let relative = |sigma: f64| {
            let value = value.filter(|value| *value != 0.0)?;
            Some(100.0 * sigma / value.abs())
        };
        let periods = |pct: f64| {
            let one = relative(known?.0)?;
            Some((one / pct).powi(2).ceil().max(1.0))
        };
        Expected {
            name: column.name.to_string(),
            unit: column.unit.to_string(),
            value,
            sigma,
            sigma_pct: sigma.and_then(relative),
            alone: known.map(|(_, alone)| alone),
            periods: self.settings.wanted_pct.and_then(periods),
        }
    }

    /// # Errors
    /// [`ExciteError::Unreachable`] if nobody would wait for any parameter.
    fn reachable(&self, all: &[Expected]) -> Result<(), ExciteError> {
        let Some(wanted_pct) = self.settings.wanted_pct else {
            return Ok(());
        };
        let needs = all.iter().filter_map(|it| Some((it.periods?, &it.name)));
        let best = needs.min_by(|a, b| a.0.total_cmp(&b.0));
        match best {
            Some((needs, name)) if needs > MOST_PERIODS => Err(ExciteError::Unreachable {
                wanted_pct,
                most: MOST_PERIODS,
                name: name.clone(),
                needs,
            }),
            Some(_) => Ok(()),
            None => Err(ExciteError::NoValues),
        }
    }
}
