//! What is drawn of a log: torque as measured and as each model predicts it, and what the
//! residual looks like in time and frequency.

use serde::Serialize;

use crate::observe::ModelKind;

/// Whether a log was used to identify.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// The parameters come from this log.
    Training,
    /// The parameters have never seen this log.
    Validation,
}

/// Filtered, decimated torques along one log.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LogSeries {
    /// Name of the log.
    pub log: String,
    /// Whether the parameters come from it.
    pub role: Role,
    /// Rate of the decimated rows, Hz.
    pub rate_hz: f64,
    /// Decimated rows; `joints` may hold fewer points.
    pub rows: usize,
    /// Each joint.
    pub joints: Vec<JointSeries>,
}

/// Torque of one joint. Long series are thinned so that no peak of the measurement or of a
/// residual is lost; values are stored in single precision, which no drawing can exceed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointSeries {
    /// The joint's name.
    pub name: String,
    /// Unit of the torque: `N m` or `N`.
    pub unit: &'static str,
    /// Time of each point, s, as in the log.
    pub t: Vec<f64>,
    /// Measured torque at `t`.
    pub measured: Vec<f32>,
    /// Of the measured torque, from all rows.
    pub spectrum: Spectrum,
    /// Each model, in the order of the paper.
    pub models: Vec<ModelSeries>,
}

/// What one model says about the torque of a joint. The residual is measured minus predicted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelSeries {
    /// Which model; the power model's parameters predict through the explicit one.
    pub model: ModelKind,
    /// Root mean square of the residual over all rows.
    pub rmse: f64,
    /// `100 * ||residual|| / ||measured||` over all rows.
    pub rel_pct: f64,
    /// Predicted torque at the joint's `t`.
    pub predicted: Vec<f32>,
    /// Of the residual, from all rows.
    pub spectrum: Spectrum,
    /// Autocorrelation of the residual at lags of 1, 2, .. rows, from all rows.
    pub autocorrelation: Vec<f32>,
}

/// Amplitude density of a series about its mean (Welch 1967: Hann windows that overlap by half).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spectrum {
    /// Distance of two values, Hz; the first value stands at this frequency.
    pub step_hz: f64,
    /// Number of windows averaged.
    pub windows: usize,
    /// Density in the series' unit per square root of Hz.
    pub density: Vec<f32>,
}

impl JointSeries {
    /// Measured minus predicted torque of a model, point by point.
    pub fn residual(&self, model: &ModelSeries) -> Vec<f64> {
        let pairs = self.measured.iter().zip(&model.predicted);
        pairs
            .map(|(measured, predicted)| f64::from(*measured) - f64::from(*predicted))
            .collect()
    }
}
