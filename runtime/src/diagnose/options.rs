//! What the user may choose, and what stands in the way.

use crate::identify::IdentifyError;
use crate::log::{Companion, Recording};
use crate::observe::ObserveError;

/// Choices of the user. Each that is `None` is taken from the robot's settings, and failing that
/// chosen for a diagnosis: fast rows, so that colour and shape of what is missing show.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Cut-off of the prefilter of q, Hz.
    pub fq_hz: Option<f64>,
    /// Decimation ratio n_d.
    pub nd: Option<usize>,
    /// Whether the curves of [`crate::report::Pictures`] are wanted.
    pub draw: bool,
}

/// A log with what lies beside it.
#[derive(Clone, Debug)]
pub struct Log {
    /// The samples.
    pub recording: Recording,
    /// Encoder resolution, reference, controller.
    pub companion: Companion,
}

/// Why a diagnosis cannot be done.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DiagnoseError {
    /// No log to diagnose.
    #[error("there is no log to diagnose; give at least one")]
    NoLogs,
    /// The filters cannot be chosen, or a log does not fit the robot.
    #[error(transparent)]
    Identify(#[from] IdentifyError),
    /// A log cannot be turned into equations.
    #[error(transparent)]
    Observe(#[from] ObserveError),
    /// Logs sampled at different rates, whose noise cannot be described together.
    #[error(
        "{log} is sampled at {rate_hz} Hz and {first} at {first_hz} Hz; diagnose logs of one rate \
         together"
    )]
    Rates {
        /// One log.
        log: String,
        /// Its rate, Hz.
        rate_hz: f64,
        /// The first log.
        first: String,
        /// Its rate, Hz.
        first_hz: f64,
    },
    /// A validation log whose torque fits but for a factor.
    #[error(
        "{log}: the torque of {joint} is {factor:.3} times what the training logs let expect, so \
         this log can confirm nothing: bring it to the same unit ([columns] of its companion, \
         [drives] of the robot), or leave it out"
    )]
    OtherUnit {
        /// The validation log.
        log: String,
        /// The joint.
        joint: String,
        /// Measured over expected.
        factor: f64,
    },
    /// A validation log that the parameters of the training logs do not explain at all.
    #[error(
        "{log}: the parameters of the training logs leave {pct:.0} % of its torque unexplained, and \
         {train_pct:.2} % of their own, so this log can confirm nothing: is it of another robot, \
         with joints in another order or counted from another zero? Validate on a log of the same \
         robot"
    )]
    OtherRobot {
        /// The validation log.
        log: String,
        /// Its torque error, percent.
        pct: f64,
        /// That of the training logs.
        train_pct: f64,
    },
    /// Too few rows for anything, with all parameters known.
    #[error(
        "the logs have {rows} rows a joint (at {step_ms} ms); at least {needs} are needed to see \
         whether anything has changed: use a longer log"
    )]
    Short {
        /// Rows there are.
        rows: usize,
        /// Milliseconds between two of them.
        step_ms: f64,
        /// Rows needed.
        needs: usize,
    },
    /// Too few rows for the parameters and the noise.
    #[error(
        "the training logs have {rows} rows a joint (at {step_ms} ms); at least {needs} are needed \
         to tell {parameters} parameters and the noise from a missing effect: use a log of at least \
         {seconds:.1} s of motion"
    )]
    TooShort {
        /// Rows there are.
        rows: usize,
        /// Milliseconds between two of them.
        step_ms: f64,
        /// Rows needed.
        needs: usize,
        /// Parameters of the model.
        parameters: usize,
        /// How long a log with as many rows would be, s.
        seconds: f64,
    },
}
