//! What a diagnosis finds, as one serialisable value.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{Changed, Fit, Pictures, Smooth};
use crate::observe::Filtering;

/// What a diagnosis comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Effects were found that explain the gap.
    Named,
    /// Nothing is established.
    Nothing,
    /// Something is missing that no entry of the catalogue explains.
    Unknown,
}

/// The result of a diagnosis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Diagnosis {
    /// The robot's name.
    pub robot: String,
    /// Names of the logs that parameters and effects were fitted on.
    pub logs: Vec<String>,
    /// Names of the logs of other motions, which confirm and prove.
    pub validation: Vec<String>,
    /// The filters.
    pub filter: Filtering,
    /// What it comes to.
    pub verdict: Verdict,
    /// The effects found, strongest first; with the verdict `unknown` they help and do not
    /// explain.
    pub effects: Vec<FoundEffect>,
    /// What came nearest in each step of the search, best first.
    pub ranking: Vec<RankedEffect>,
    /// What was looked at closely and not taken.
    pub rejected: Vec<RejectedEffect>,
    /// The joints whose torque the model without them does not explain.
    #[serde(rename = "where")]
    pub located: Vec<Located>,
    /// What the torque looks like that no effect explains, joint by joint; absent where there is
    /// none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub smooths: Vec<Smooth>,
    /// The gap before and after.
    pub gap: Gap,
    /// The parameters of the model, fitted without and with the effects.
    pub parameters: Vec<Refitted>,
    /// What else has changed, where the parameters are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub changed: Option<Changed>,
    /// What is to be said about the logs.
    pub warnings: Vec<String>,
    /// The command line that gives this result, if one did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub command: Option<String>,
    /// What is drawn; absent unless asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pictures: Option<Pictures>,
}

/// A parameter of the model, fitted without and with the effects that were found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Refitted {
    /// Name, such as `ZZR1`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Without them.
    pub before: Estimated,
    /// With them.
    pub after: Estimated,
}

/// A value and how far it may be off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimated {
    /// Value, SI.
    pub value: f64,
    /// Standard deviation under coloured noise; `None` where the log does not determine it.
    pub sigma: Option<f64>,
}

/// A parameter of an effect.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EffectParameter {
    /// Name, such as `FST3`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Value.
    pub value: f64,
    /// Standard deviation under coloured noise; `None` where the log does not determine it.
    pub sigma: Option<f64>,
}

/// An effect that was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FoundEffect {
    /// Name in the catalogue.
    pub effect: String,
    /// Name of the joint; `None` for several or the whole robot.
    pub joint: Option<String>,
    /// Joints, counted from 1; empty for the whole robot.
    pub joints: Vec<usize>,
    /// What it is.
    pub meaning: String,
    /// Its torque.
    pub formula: String,
    /// Its parameters.
    pub parameters: Vec<EffectParameter>,
    /// Its shape, SI, by name.
    pub shape: BTreeMap<String, f64>,
    /// Probability of such a gain by chance, corrected for the number of hypotheses tried.
    pub p_value: f64,
    /// By how much it lowers the torque error, percent of the error without it.
    pub gain_pct: f64,
    /// Other explanations.
    pub alternatives: Vec<Alternative>,
    /// The log that would tell it from what it is often taken for.
    pub experiment: String,
}

/// Another explanation of what an effect explains.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Alternative {
    /// Name in the catalogue.
    pub effect: String,
    /// Name of the joint; `None` for several or the whole robot.
    pub joint: Option<String>,
    /// Joints, counted from 1.
    pub joints: Vec<usize>,
    /// As of the effect.
    pub p_value: f64,
    /// Whether this log tells the two apart.
    pub separable: bool,
}

/// A hypothesis as it stood in a step of the search.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RankedEffect {
    /// How many effects the model had by then.
    pub step: usize,
    /// Name in the catalogue.
    pub effect: String,
    /// Name of the joint; `None` for several or the whole robot.
    pub joint: Option<String>,
    /// Joints, counted from 1.
    pub joints: Vec<usize>,
    /// By how much the sum of squares falls, in units of the noise's variance.
    pub gain: f64,
    /// The same less what so many parameters, and a search among so many hypotheses, gain by
    /// chance. Below zero nothing is established.
    pub margin: f64,
    /// Probability of such a gain by chance, corrected for the number of hypotheses tried.
    pub p_value: f64,
}

/// A hypothesis that was not taken.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RejectedEffect {
    /// Name in the catalogue.
    pub effect: String,
    /// Name of the joint; `None` for several or the whole robot.
    pub joint: Option<String>,
    /// Joints, counted from 1.
    pub joints: Vec<usize>,
    /// Why not.
    pub why: String,
}

/// A joint whose torque is not explained.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Located {
    /// Name of the joint.
    pub joint: String,
    /// Share of the residual's variance that is no noise, percent.
    pub unexplained_pct: f64,
    /// What it varies with.
    pub varies_with: Vec<String>,
}

/// The gap before and after.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Gap {
    /// Torque predicted from the logged motion.
    pub torque: Change<Fit>,
    /// Position of the closed-loop simulation; absent without reference and controller.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub simulation: Option<Change<Rms>>,
    /// What it was measured on.
    pub on: String,
}

/// Something before and after.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change<T> {
    /// Without the effects.
    pub before: T,
    /// With them.
    pub after: T,
}

/// Root mean square of each joint, rad or m.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rms {
    /// By joint.
    pub rms: Vec<f64>,
}
