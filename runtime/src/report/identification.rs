//! The result of an identification.

use serde::Serialize;

use super::LogSeries;
use crate::model::ColumnKind;
use crate::observe::{Filtering, ModelKind};
use crate::settings::Weights;

/// Result of an identification: the three models side by side.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Identification {
    /// The robot's name.
    pub robot: String,
    /// Samples of all training logs, before decimation.
    pub samples: usize,
    /// Sampling rate of the (first) training log, Hz.
    pub rate_hz: f64,
    /// Names of the training logs.
    pub logs: Vec<String>,
    /// The filters, and which of them were chosen from the data.
    pub filter: Filtering,
    /// How the equations were weighted.
    pub weights: Weights,
    /// What the user ought to know, each a full sentence.
    pub warnings: Vec<String>,
    /// The models, in the order of the paper.
    pub models: Vec<ModelResult>,
    /// Parameters on which two models disagree beyond their standard deviations, the worst first.
    pub disagreements: Vec<Disagreement>,
    /// The command line that gives this result, if one did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub command: Option<String>,
    /// The true parameters, where a simulation made the logs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub truth: Option<Truth>,
    /// What is drawn of each log. Empty, and absent from the JSON, unless asked for with
    /// [`crate::identify::series`]: it is larger than all the rest.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub series: Vec<LogSeries>,
}

/// A parameter on which two models disagree.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Disagreement {
    /// Name of the parameter.
    pub parameter: String,
    /// The two models.
    pub models: [ModelKind; 2],
    /// Its value by each, SI.
    pub values: [f64; 2],
    /// The difference, in standard deviations of both together.
    pub sigmas: f64,
}

/// Parameters that made a simulated log.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Truth {
    /// Title of a report.
    pub title: String,
    /// What was simulated, in a sentence for the top of a report.
    pub about: String,
    /// The values, in the order of the robot's columns.
    pub values: Vec<f64>,
}

/// Result of one model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelResult {
    /// Explicit, implicit or power.
    pub name: ModelKind,
    /// Number of equations.
    pub rows: usize,
    /// 2-norm condition number of W, weighted as it was solved.
    pub condition: f64,
    /// 2-norm condition number of W without weights.
    pub condition_unweighted: f64,
    /// Numerical rank of W.
    pub rank: usize,
    /// Decimal digits that rounding leaves certain in the worst of the determined parameters;
    /// numerics only, sigma says what noise leaves.
    pub certified_digits: f64,
    /// Residual of the model's own equations in percent of Y: of the power for the power model.
    pub equation_pct: f64,
    /// The parameters, in the order of the robot's columns.
    pub parameters: Vec<ParameterResult>,
    /// Torque error on the training logs.
    pub fit: Fit,
    /// Torque error on each validation log.
    pub validation: Vec<Validation>,
    /// Inverse covariance of the parameters for independent errors, in the units of the
    /// parameters: its lower triangle by rows, of the explicit model. `idim export` finds bodies in
    /// its metric.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub precision: Vec<Vec<f64>>,
    /// What the log and the description's tolerances say together, beside the classical estimate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub with_prior: Option<WithPrior>,
    /// What instrumental variables say, if they were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instrumented: Option<InstrumentedFit>,
}

/// One identified parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ParameterResult {
    /// Name, such as `ZZR1`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Link or joint it belongs to, counted from 1.
    pub joint: usize,
    /// Inertial, drive, friction or effect.
    pub kind: ColumnKind,
    /// Identified value; `None` if the data do not determine it.
    pub value: Option<f64>,
    /// Standard deviation for independent errors (Gautier 1996, section 7.3).
    pub sigma: Option<f64>,
    /// Standard deviation that respects the autocorrelation of filtered residuals, if computed.
    pub sigma_corrected: Option<f64>,
    /// `100 * sigma / |value|`.
    pub sigma_pct: Option<f64>,
    /// The standard parameters it stands for.
    pub relation: String,
    /// The value used for prediction: `value`, or one of many equivalent values where the data
    /// do not determine it.
    pub solution: f64,
    /// Value in the description, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nominal: Option<f64>,
    /// Estimate with the description's tolerances as knowledge, if there are any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub with_prior: Option<PriorValue>,
    /// Estimate with instrumental variables, if it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instrumented: Option<InstrumentedValue>,
}

/// A parameter by instrumental variables.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InstrumentedValue {
    /// Value; `None` if the instruments do not determine it.
    pub value: Option<f64>,
    /// Standard deviation for independent errors.
    pub sigma: Option<f64>,
    /// Standard deviation that respects the correlation of errors in time and between joints.
    pub sigma_corrected: Option<f64>,
    /// Weighted least squares minus this value, with the same weights.
    pub difference: Option<f64>,
    /// Probability of a difference this large if least squares were not biased.
    pub p_value: Option<f64>,
    /// Whether the difference is significant at 5 % for all parameters together (Holm), and larger
    /// than the corrected standard deviation.
    pub biased: bool,
}

/// An estimate with instrumental variables as a whole.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InstrumentedFit {
    /// How often each log was simulated.
    pub simulations: usize,
    /// Whether the last simulation changed nothing.
    pub converged: bool,
    /// Parameters in which least squares are biased.
    pub biased: Vec<String>,
    /// The parameters for prediction, in the order of the robot's columns.
    pub solution: Vec<f64>,
    /// Torque error on the training logs.
    pub fit: Fit,
    /// Torque error on each validation log.
    pub validation: Vec<Validation>,
}

/// A parameter by the log and the description's tolerances together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PriorValue {
    /// Mean; `None` if neither determines it.
    pub value: Option<f64>,
    /// Standard deviation given both.
    pub sigma: Option<f64>,
    /// Standard deviation by the tolerances alone; `None` if they leave it open.
    pub sigma_before: Option<f64>,
    /// Whether the log alone leaves it open, so that the tolerances fill it in.
    pub filled: bool,
}

/// An estimate with prior knowledge as a whole.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WithPrior {
    /// How many of the parameters, as a real number, the prior decides rather than the log.
    pub from_prior: f64,
    /// How far log and prior are apart, in standard deviations of their difference (root mean
    /// square): about 1 if they agree.
    pub misfit: f64,
    /// Factor by which errors are taken to be wider than independent ones, because filtered
    /// residuals are correlated.
    pub inflation: f64,
    /// The parameters for prediction, in the order of the robot's columns.
    pub solution: Vec<f64>,
    /// Torque error on the training logs.
    pub fit: Fit,
    /// Torque error on each validation log.
    pub validation: Vec<Validation>,
}

/// Torque error on one or several logs. For the power model, torque is predicted by the explicit
/// model with its parameters.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// `100 * ||tau - W X|| / ||tau||` over all joints.
    pub total_pct: f64,
    /// Each joint.
    pub joints: Vec<JointFit>,
}

/// Torque error of one joint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointFit {
    /// The joint's name.
    pub name: String,
    /// Unit of `rmse`: `N m` or `N`.
    pub unit: &'static str,
    /// Root mean square error.
    pub rmse: f64,
    /// `100 * ||tau - W X|| / ||tau||`.
    pub rel_pct: f64,
}

/// Torque error on one validation log.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Validation {
    /// Name of the log.
    pub log: String,
    /// The error.
    #[serde(flatten)]
    pub fit: Fit,
}

impl Identification {
    /// The result of one model, if it was asked for.
    pub fn model(&self, kind: ModelKind) -> Option<&ModelResult> {
        self.models.iter().find(|model| model.name == kind)
    }
}

impl ModelResult {
    /// The parameters for prediction, in the order of the robot's columns.
    pub fn solution(&self) -> Vec<f64> {
        self.parameters
            .iter()
            .map(|parameter| parameter.solution)
            .collect()
    }

    /// A parameter by its name.
    pub fn parameter(&self, name: &str) -> Option<&ParameterResult> {
        self.parameters
            .iter()
            .find(|parameter| parameter.name == name)
    }
}
