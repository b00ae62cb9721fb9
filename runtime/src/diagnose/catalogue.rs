//! What the diagnosis knows of effects: their names, where they may act, and the torque columns
//! that they add. It ranks them without knowing any: the root implements [`Catalogue`].

use std::ops::Range;

/// An effect that a robot can have and its model has not.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Name, as printed and written in descriptions, such as `stribeck`.
    pub name: &'static str,
    /// What it is, in one line.
    pub meaning: &'static str,
    /// Its torque, as text, such as `sgn(qd) exp(-(qd/vs)^2)`.
    pub formula: &'static str,
    /// Names and SI units of its linear parameters.
    pub parameters: &'static [(&'static str, &'static str)],
    /// Names and SI units of what enters non-linearly and is searched.
    pub shape: &'static [(&'static str, &'static str)],
    /// What it is often taken for.
    pub confused_with: &'static [&'static str],
    /// The log that separates it from those.
    pub experiment: &'static str,
    /// What its columns are made of.
    pub kind: EntryKind,
    /// Whether base parameters can hide it, so that only knowledge of them ([prior], a nominal
    /// model) shows it.
    pub hidden_by_parameters: bool,
}

/// What the columns of an effect are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EntryKind {
    /// The instantaneous state.
    Static,
    /// The state and the torque that the present model predicts: rebuilt after each refit.
    ModelDependent,
    /// A state equation that runs along the log.
    Memory,
    /// The same, of a link that moves against its drive: the motion itself shows it, and one that
    /// was simulated without it says little of it.
    Yielding,
}

/// One effect on given joints, its shape still open.
#[derive(Clone, Debug, PartialEq)]
pub struct Hypothesis {
    /// Index into [`Catalogue::entries`].
    pub entry: usize,
    /// Joints that it belongs to, counted from 0; empty for what belongs to the whole robot.
    pub joints: Vec<usize>,
    /// The coarse grid of shapes to try, each with a value for each shape parameter; a single
    /// empty one for effects without a shape.
    pub grid: Vec<Vec<f64>>,
    /// Bounds of each shape parameter, for refinement between grid points; one whose ends are
    /// equal (the side of an end stop) is not refined.
    pub bounds: Vec<Range<f64>>,
    /// Size that its only parameter must have to be believed, since the log is no more exact: a
    /// shift in time by a sample or so may be its logger's. Zero where the log does not limit it.
    pub least: f64,
}

/// Signals along a log (or a simulated motion) at its full rate, filtered as the regressor's are.
/// One series per joint, all of one length.
#[derive(Clone, Copy, Debug)]
pub struct Signals<'a> {
    /// Sampling rate, Hz.
    pub rate_hz: f64,
    /// Time since the beginning of the log, s.
    pub t: &'a [f64],
    /// Positions, rad or m.
    pub q: &'a [Vec<f64>],
    /// Velocities.
    pub qd: &'a [Vec<f64>],
    /// Accelerations.
    pub qdd: &'a [Vec<f64>],
    /// Torque that the present model predicts from the motion, never the measured one; N m or N.
    pub tau_model: &'a [Vec<f64>],
    /// Its rigid-body part (with rotor inertia, without friction).
    pub tau_rigid: &'a [Vec<f64>],
    /// The present parameters of the model, np values.
    pub parameters: &'a [f64],
    /// Velocity under which the sign of each joint's velocity is not certain, rad/s or m/s.
    pub dead_band: &'a [f64],
}

/// The torque of one linear parameter of an effect, per unit of it: series on the joints it acts on.
#[derive(Clone, Debug, PartialEq)]
pub struct TorqueColumn {
    /// Name of the parameter, such as `FST3`.
    pub name: String,
    /// SI unit of the parameter.
    pub unit: &'static str,
    /// Joint (from 0) and torque along the signals, N m or N per unit of the parameter.
    pub torque: Vec<(usize, Vec<f64>)>,
}

/// The columns of hypotheses with given shapes along one motion.
pub type ColumnsAlong<'a> = Box<dyn Fn(&Hypothesis, &[f64]) -> Vec<TorqueColumn> + Sync + 'a>;

/// All effects that the diagnosis may name on one robot.
pub trait Catalogue: Sync {
    /// The entries, in a fixed order.
    fn entries(&self) -> &[Entry];

    /// What may be asked of this robot along a motion: every entry on every joint it may act on.
    fn hypotheses(&self, signals: &Signals<'_>) -> Vec<Hypothesis>;

    /// The columns of a hypothesis with a given shape along signals.
    fn columns(
        &self,
        hypothesis: &Hypothesis,
        shape: &[f64],
        signals: &Signals<'_>,
    ) -> Vec<TorqueColumn>;

    /// [`Catalogue::columns`] of many hypotheses along one motion: what several of them are made of,
    /// such as the derivatives of the model's torque, is computed once.
    fn along<'a>(&'a self, signals: Signals<'a>) -> ColumnsAlong<'a> {
        Box::new(move |hypothesis, shape| self.columns(hypothesis, shape, &signals))
    }

    /// How often the torque of a hypothesis repeats per turn of its joint, where that it repeats is
    /// what its name says of it.
    fn repeats_per_turn(&self, _hypothesis: &Hypothesis, _shape: &[f64]) -> Option<f64> {
        None
    }

    /// Whether parameter values of an effect are plausible (sign and size), and if not, why.
    fn implausible(&self, hypothesis: &Hypothesis, shape: &[f64], values: &[f64])
    -> Option<String>;
}
