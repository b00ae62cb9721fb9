//! An exciting motion, and what an identification along it will know.

use serde::Serialize;

use super::criterion::Criterion;
use super::expect::Noise;
use super::family::{Family, Start};
use super::limits::JointLimits;
use crate::log::Reference;
use crate::model::JointKind;

/// Result of a search: one serialisable value, which is also the JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Excitation {
    /// The robot.
    pub robot: String,
    /// Family of the motion.
    pub family: Family,
    /// How it begins and ends.
    pub start: Start,
    /// What was minimised.
    pub criterion: Criterion,
    /// One period, s.
    pub period_s: f64,
    /// How often it is repeated.
    pub periods: usize,
    /// Seed, number of starts, most steps of each.
    pub search: Search,
    /// Condition number of W of all determined parameters, SI, not weighted.
    pub condition: f64,
    /// The same with columns of unit norm.
    pub condition_scaled: f64,
    /// What motions by chance reach.
    pub by_chance: ByChance,
    /// The joints: limits and what the motion uses of them.
    pub joints: Vec<JointUse>,
    /// Noise of the torque that is counted on.
    pub noise: Noise,
    /// The parameters.
    pub parameters: Vec<Expected>,
    /// Groups of parameters of which no motion within the limits determines more than combinations.
    pub undetermined: Vec<Undetermined>,
    /// What was wanted, %.
    pub wanted_pct: Option<f64>,
    /// What to know.
    pub warnings: Vec<String>,
    /// The motion, as a trajectory file holds it.
    pub motion: Reference,
}

/// How much was searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Search {
    /// Seed: the same seed gives the same motion, on any number of threads.
    pub seed: u64,
    /// Number of starts.
    pub starts: usize,
    /// Most steps downhill from each.
    pub steps: usize,
}

/// The criterion of random motions of the same family within the same limits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ByChance {
    /// Number of motions that could be judged.
    pub motions: usize,
    /// The criterion of the motion that was found.
    pub found: f64,
    /// The best of them.
    pub best: Option<f64>,
    /// Their median.
    pub median: Option<f64>,
}

/// A joint's part of the motion.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointUse {
    /// Name.
    pub name: String,
    /// Revolute or prismatic.
    pub kind: JointKind,
    /// Centre of the motion, rad or m; where it begins, if it begins at rest.
    pub center: f64,
    /// What it must keep to.
    pub limits: JointLimits,
    /// Lowest and highest position, rad or m.
    pub range: [f64; 2],
    /// Largest speed, rad/s or m/s.
    pub velocity: f64,
    /// Largest acceleration, rad/s^2 or m/s^2.
    pub acceleration: f64,
    /// Largest torque or force with the given parameters, N m or N.
    pub effort: Option<f64>,
}

/// What will be known of a parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Expected {
    /// Name.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Its present value, if given.
    pub value: Option<f64>,
    /// Standard deviation after all periods; none if no motion determines it.
    pub sigma: Option<f64>,
    /// The same in % of the value.
    pub sigma_pct: Option<f64>,
    /// Share of its column that the other columns do not explain: 1 is alone.
    pub alone: Option<f64>,
    /// Periods for the wanted relative standard deviation: it falls with their square root.
    pub periods: Option<f64>,
}

/// Parameters that only appear together, or not at all.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Undetermined {
    /// Their names.
    pub names: Vec<String>,
    /// How many combinations of them are determined.
    pub known: usize,
}
