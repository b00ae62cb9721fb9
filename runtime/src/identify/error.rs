//! Why an identification cannot be done.

use crate::estimate::EstimateError;
use crate::evidence::EvidenceError;
use crate::log::LogError;
use crate::observe::{ModelKind, ObserveError};
use crate::simulate::SimulateError;

/// Why an identification or a prediction cannot be done.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum IdentifyError {
    /// No log to identify from.
    #[error("there is no log to identify from; give at least one")]
    NoLogs,
    /// Nothing is excited: every joint rests, or moves no more than its encoder's last digits.
    #[error(
        "no joint moves in {logs}, or its motion drowns in noise ({seen}): there are no dynamics to \
         identify; record a log in which every joint moves through a good part of its range"
    )]
    NothingMoves {
        /// Names of the logs.
        logs: String,
        /// How far each joint moves.
        seen: String,
    },
    /// The joints move so little, or so alike, that not one parameter is determined.
    #[error(
        "the {} model: not one parameter is determined by {logs} ({seen}); record a log in which \
         every joint moves through a good part of its range", model.name()
    )]
    NothingDetermined {
        /// Which model.
        model: ModelKind,
        /// Names of the logs.
        logs: String,
        /// How far each joint moves.
        seen: String,
    },
    /// A sampling rate that is not a positive number.
    #[error("{log}: the sampling rate {rate_hz} Hz is not a positive number")]
    Rate {
        /// Recording.
        log: String,
        /// What it says.
        rate_hz: f64,
    },
    /// A log cannot be turned into equations.
    #[error(transparent)]
    Observe(#[from] ObserveError),
    /// The equations cannot be solved.
    #[error("the {} model: {source}", model.name())]
    Estimate {
        /// Which model.
        model: ModelKind,
        /// Why.
        source: EstimateError,
    },
    /// The equations and the prior together cannot be solved.
    #[error("the {} model with the description's [prior]: {message}", model.name())]
    Prior {
        /// Which model.
        model: ModelKind,
        /// Why.
        message: String,
    },
    /// Instruments without a closed loop to simulate.
    #[error(
        "{log}: instruments from simulation need the commanded motion and the controller, and its \
         companion has no {missing}; add them to the .toml beside the log, or give it with --map"
    )]
    NoLoop {
        /// Name of the recording.
        log: String,
        /// Which tables are missing.
        missing: &'static str,
    },
    /// A log whose simulation fails.
    #[error("instruments for {log}: {source}")]
    Simulate {
        /// Name of the recording.
        log: String,
        /// Why.
        source: SimulateError,
    },
    /// A load on a link that cannot carry one.
    #[error(
        "link {link} of {robot} cannot carry a load: the robot has {links} links, and none of the \
         load's parameters would be felt by a joint"
    )]
    NoLink {
        /// The robot.
        robot: String,
        /// Link, counted from 1.
        link: usize,
        /// Links there are.
        links: usize,
    },
    /// A known load that weighs nothing, less, or no finite number.
    #[error(
        "a known load of {mass} kg cannot set the scale of the torques: give its mass, a positive \
         number of kg"
    )]
    LoadMass {
        /// What was given.
        mass: f64,
    },
    /// A centre of mass that is not three finite numbers.
    #[error("the centre of mass of the known load is not three finite numbers of m")]
    LoadCentre,
    /// A joint without any motion has no gain.
    #[error(
        "joint {joint} ({name}) never moves in {logs}: the factor of its torque cannot be told; \
         record logs in which every joint moves, without load and with it"
    )]
    JointRests {
        /// Joint, counted from 1.
        joint: usize,
        /// Its name.
        name: String,
        /// Names of the logs.
        logs: String,
    },
    /// A known load of which no joint tells anything.
    #[error(
        "no joint of {robot} feels what is known of the load on link {link}, so it sets no scale \
         for the torques; mount the load where a joint must lift or accelerate it, or give its \
         centre of mass too"
    )]
    LoadUnfelt {
        /// The robot.
        robot: String,
        /// Link, counted from 1.
        link: usize,
    },
    /// The equations cannot be reduced to evidence.
    #[error("the {} model: {message}", model.name())]
    Evidence {
        /// Which model.
        model: ModelKind,
        /// Why.
        message: String,
    },
    /// A log with more equations than can be weighted one by one.
    #[error(
        "{log}: weights for single rows need all equations in memory, and {samples} samples make \
         too many; use --weights joint (bad samples are left out in any case), a larger decimation \
         ratio (--nd), or a part of the log"
    )]
    TooLongForRobust {
        /// Name of the log.
        log: String,
        /// Its samples.
        samples: usize,
    },
    /// Samples of a log that stays on disk cannot be read again.
    #[error("the samples of a log cannot be read again: {0}")]
    Unreadable(String),
    /// A wrong number of parameters for a prediction.
    #[error("{has} parameters were given and the robot {robot} has {needs}")]
    Parameters {
        /// The robot.
        robot: String,
        /// Parameters given.
        has: usize,
        /// Parameters of the model.
        needs: usize,
    },
}

impl IdentifyError {
    /// Evidence that cannot be joined with a prior.
    pub(super) fn prior(model: ModelKind, source: EvidenceError) -> Self {
        let message = source.to_string();
        IdentifyError::Prior { model, message }
    }

    /// What the evidence of a model says against it.
    pub(super) fn evidence(model: ModelKind) -> impl Fn(EvidenceError) -> Self {
        move |source| match source {
            EvidenceError::Estimate(source) => IdentifyError::Estimate { model, source },
            other => IdentifyError::Evidence {
                model,
                message: other.to_string(),
            },
        }
    }
}

impl From<LogError> for IdentifyError {
    fn from(error: LogError) -> Self {
        IdentifyError::Unreadable(error.to_string())
    }
}
