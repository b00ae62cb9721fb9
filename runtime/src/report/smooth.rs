//! The shape of a torque that has no name.

use serde::Serialize;

use super::Change;

/// Torque of a joint that no effect explains, as a smooth function of two variables: linear between
/// the places of a grid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Smooth {
    /// Name of the joint.
    pub joint: String,
    /// Unit of the torque.
    pub unit: String,
    /// The two variables that explain most of it, with their places on the grid.
    pub variables: [SmoothVariable; 2],
    /// Torque at the places, a row for each of the first variable; `None` where the log was not.
    pub torque: Vec<Vec<Option<f64>>>,
    /// Share of the variance that it explains on blocks of the training logs that it was not fitted
    /// on, percent.
    pub explained_pct: f64,
    /// The same on the logs that the gap is measured on, if those are not the training logs.
    pub proven_pct: Option<f64>,
    /// Root mean square of the residual there, without and with it.
    pub rmse: Change<f64>,
}

/// A variable of a [`Smooth`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SmoothVariable {
    /// Name, such as `velocity of elbow`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Places, ascending.
    pub at: Vec<f64>,
}

impl Smooth {
    /// The torque at values of the two variables; constant beyond the grid, `None` where the log
    /// was not.
    pub fn torque_at(&self, values: [f64; 2]) -> Option<f64> {
        let [one, other] = [0, 1].map(|k| hats(&self.variables[k].at, values[k]));
        let mut sum = 0.0;
        for (i, a) in one {
            for (k, b) in other {
                if a * b != 0.0 {
                    sum += a * b * (*self.torque.get(i)?.get(k)?)?;
                }
            }
        }
        Some(sum)
    }
}

/// The two places beside a value on an ascending grid and their weights; at its ends beyond it.
pub(crate) fn hats(at: &[f64], value: f64) -> [(usize, f64); 2] {
    let above = at.partition_point(|place| *place <= value);
    match (above.checked_sub(1), at.get(above)) {
        (Some(below), Some(high)) => {
            let part = (value - at[below]) / (high - at[below]);
            [(below, 1.0 - part), (above, part)]
        }
        (Some(last), None) => [(last, 1.0), (last, 0.0)],
        (None, _) => [(0, 1.0), (0, 0.0)],
    }
}
