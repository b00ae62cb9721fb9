//! What is drawn of a diagnosis.

use serde::Serialize;

use super::thinned;

/// Points of a curve.
const POINTS: usize = 1000;

/// The curves of a diagnosis: larger than all the rest of it, and there only where they are asked
/// for.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Pictures {
    /// What the residual looks like, for each effect and then for each joint that is not explained.
    pub signatures: Vec<Signature>,
    /// Torque of each joint along the log that the gap is measured on.
    pub torque: Vec<GapCurves>,
    /// Position error of each joint in closed-loop simulation; empty without a simulation.
    pub motion: Vec<GapCurves>,
}

/// Something of one joint over time: as measured, and as the model has it without and with the
/// effects. Thinned so that no peak is lost.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GapCurves {
    /// The joint's name.
    pub joint: String,
    /// Unit of the values.
    pub unit: String,
    /// Time of each point since the beginning of the log, s.
    pub t: Vec<f64>,
    /// As measured.
    pub measured: Vec<f64>,
    /// Without the effects.
    pub before: Vec<f64>,
    /// With them.
    pub after: Vec<f64>,
}

impl GapCurves {
    /// Curves of a joint (name and unit of the values), thinned: over `t` (s) the series measured,
    /// before and after, all of one length.
    pub fn new((joint, unit): (&str, &str), t: &[f64], series: [&[f64]; 3]) -> Self {
        let keep = thinned(&series, POINTS);
        let [measured, before, after] =
            series.map(|values| keep.iter().map(|&k| values[k]).collect());
        GapCurves {
            joint: joint.to_owned(),
            unit: unit.to_owned(),
            t: keep.iter().filter_map(|&k| t.get(k).copied()).collect(),
            measured,
            before,
            after,
        }
    }
}

/// Residual torque of a joint over the variable that explains it best.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Signature {
    /// Place of the effect in the list of those found; `None` for what has no name.
    pub effect: Option<usize>,
    /// The joint's name.
    pub joint: String,
    /// Unit of the residual.
    pub unit: String,
    /// The variable, such as `velocity of elbow`.
    pub variable: String,
    /// Its SI unit.
    pub variable_unit: String,
    /// Values of the variable.
    pub x: Vec<f32>,
    /// Measured minus predicted torque, without this effect and the rest refitted.
    pub before: Vec<f32>,
    /// With it.
    pub after: Vec<f32>,
}
