//! What acts on a simulated robot beyond the columns of its model.

use super::dynamics::{check_joints, check_parameters};
use super::error::SimulateError;
use super::lanes::Lanes;
use crate::model::{ColumnKind, Entry, IdentificationModel, Output};
use std::ops::Range;

/// A robot at a sample.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'m> {
    /// Time, s.
    pub t: f64,
    /// Positions of the n joints of the model, rad or m.
    pub q: &'m [f64],
    /// Velocities.
    pub qd: &'m [f64],
    /// Mean accelerations since the sample before; zero at the first.
    pub qdd: &'m [f64],
}

/// Something that acts on a robot and that no column of its model holds: a force from outside, a
/// parameter that changes, a disturbance.
pub trait Influence {
    /// What happens at a sample, before the robot moves on to the next: own states advance,
    /// parameters of the model (np, in the order of its columns) may change. A parameter that is
    /// zero when the simulation begins stays without effect.
    fn begin(&mut self, _moment: &Moment<'_>, _parameters: &mut [f64]) {}

    /// Adds to `torque` (n values, N m or N) what the drives have to overcome at a state, at time
    /// `t` (s).
    fn torque(&mut self, _t: f64, _q: &[f64], _qd: &[f64], _torque: &mut [f64]) {}
}

/// The torque that another model of the same joints has standing still at the positions of the
/// robot, D(q, 0, 0) X: the force on a point is the weight of a unit mass there under a gravity
/// that is the force. All the time, or in a window of it (a contact).
pub struct Weight<'a> {
    model: &'a dyn IdentificationModel,
    entries: Vec<(Entry, f64)>,
    lanes: Lanes,
    window: Option<Range<f64>>,
}

impl<'a> Weight<'a> {
    /// From the model with its np `parameters`; `window` in s.
    ///
    /// # Errors
    /// [`SimulateError::Parameters`], [`SimulateError::NotFinite`].
    pub fn new(
        model: &'a dyn IdentificationModel,
        parameters: &[f64],
        window: Option<Range<f64>>,
    ) -> Result<Weight<'a>, SimulateError> {
        check_parameters(model, parameters)?;
        let entries = &model.pattern(Output::Explicit).entries;
        let used = entries
            .iter()
            .map(|entry| (*entry, parameters[entry.column]));
        Ok(Weight {
            entries: used.filter(|(_, value)| *value != 0.0).collect(),
            lanes: Lanes::new(model, Output::Explicit, 1),
            model,
            window,
        })
    }
}

impl Influence for Weight<'_> {
    fn torque(&mut self, t: f64, q: &[f64], _: &[f64], torque: &mut [f64]) {
        if self
            .window
            .as_ref()
            .is_some_and(|window| !window.contains(&t))
        {
            return;
        }
        self.lanes.fill(1, q, &vec![0.0; q.len()]);
        self.lanes.run(self.model, &[]);
        for (entry, value) in &self.entries {
            torque[entry.row] += value * self.lanes.signal(entry.signal, 0);
        }
    }
}

/// Parameters that approach other values, \\( x + \Delta (1 - e^{-t/T}) \\): friction that warms up.
#[derive(Clone, Debug)]
pub struct Drift {
    /// T, s.
    pub time: f64,
    /// Column, value at the beginning, what is added in the end.
    pub changes: Vec<(usize, f64, f64)>,
}

impl Influence for Drift {
    fn begin(&mut self, moment: &Moment<'_>, parameters: &mut [f64]) {
        let warm = -(-moment.t / self.time).exp_m1();
        for &(column, value, change) in &self.changes {
            parameters[column] = value + warm * change;
        }
    }
}

/// Coulomb friction of a joint that grows with the load on it,
/// \\( F_S + c |\tau_{rigid}| \\), by the torque of the rigid bodies and rotors at the sample.
pub struct LoadFriction<'a> {
    model: &'a dyn IdentificationModel,
    /// Entries of the joint's row of D with their parameters.
    entries: Vec<(Entry, f64)>,
    lanes: Lanes,
    coulomb: usize,
    level: f64,
    /// c.
    factor: f64,
}

impl<'a> LoadFriction<'a> {
    /// On `joint` (from 0) of a model with its np `parameters`, by the parameter of the column
    /// `coulomb`; `factor` is c.
    ///
    /// # Errors
    /// [`SimulateError::Parameters`], [`SimulateError::NotFinite`], [`SimulateError::Joints`] for a
    /// joint or column that the model has not.
    pub fn new(
        model: &'a dyn IdentificationModel,
        parameters: &[f64],
        (joint, coulomb): (usize, usize),
        factor: f64,
    ) -> Result<LoadFriction<'a>, SimulateError> {
        check_parameters(model, parameters)?;
        let known = joint < model.joints().len() && coulomb < parameters.len();
        check_joints(
            model,
            "loaded joint",
            if known {
                model.joints().len()
            } else {
                joint + 1
            },
        )?;
        let rigid = |entry: &&Entry| {
            let kind = model.columns()[entry.column].kind;
            entry.row == joint && matches!(kind, ColumnKind::Inertial | ColumnKind::Drive)
        };
        let pattern = model.pattern(Output::Explicit);
        let entries = pattern.entries.iter().filter(rigid);
        Ok(LoadFriction {
            entries: entries
                .map(|entry| (*entry, parameters[entry.column]))
                .collect(),
            lanes: Lanes::new(model, Output::Explicit, 1),
            model,
            coulomb,
            level: parameters[coulomb],
            factor,
        })
    }
}

impl Influence for LoadFriction<'_> {
    fn begin(&mut self, moment: &Moment<'_>, parameters: &mut [f64]) {
        self.lanes.fill(1, moment.q, moment.qd);
        self.lanes.accelerate(moment.qdd);
        self.lanes.run(self.model, &[]);
        let terms = self.entries.iter();
        let load: f64 = terms
            .map(|(entry, value)| value * self.lanes.signal(entry.signal, 0))
            .sum();
        parameters[self.coulomb] = self.level + self.factor * load.abs();
    }
}

/// Torques that come from outside, sample by sample, and act along with the drives: N m or N, one
/// series per joint of the model.
#[derive(Clone, Debug)]
pub struct Disturbance<'a> {
    series: &'a [Vec<f64>],
    now: usize,
}

impl<'a> Disturbance<'a> {
    /// From its series, of which the last value stays.
    pub fn new(series: &'a [Vec<f64>]) -> Disturbance<'a> {
        Disturbance { series, now: 0 }
    }
}

impl Influence for Disturbance<'_> {
    fn begin(&mut self, _: &Moment<'_>, _: &mut [f64]) {
        self.now += 1;
    }

    fn torque(&mut self, _: f64, _: &[f64], _: &[f64], torque: &mut [f64]) {
        for (torque, series) in torque.iter_mut().zip(self.series) {
            let now = series.get(self.now.saturating_sub(1)).or(series.last());
            *torque -= now.copied().unwrap_or(0.0);
        }
    }
}
