//! Why a log cannot be turned into observations.

use crate::signal::SignalError;

/// Why a log cannot be turned into observations. `log` is the recording's name.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ObserveError {
    /// Samples of a log that stays on disk cannot be read again.
    #[error("{log}: its samples cannot be read again: {message}")]
    Unreadable {
        /// Name of the log.
        log: String,
        /// What the reader said.
        message: String,
    },
    /// Every row of W lies near samples that cannot be believed.
    #[error(
        "{log}: no equation is left, since every one lies near samples that cannot be believed \
         (see the warnings); use another part of the log"
    )]
    NothingBelieved {
        /// Name of the log.
        log: String,
    },
    /// The log and the robot have different numbers of joints.
    #[error(
        "{log}: the log has {has} joints and the robot {needs}; \
         name the log's columns after the robot's joints or use the robot of this log"
    )]
    Joints {
        /// Recording.
        log: String,
        /// Joints in the recording.
        has: usize,
        /// Joints of the robot.
        needs: usize,
    },
    /// A series whose length is not that of the recording.
    #[error("{log}: {series} of joint {joint} has {has} samples and the log {needs}")]
    Length {
        /// Recording.
        log: String,
        /// `q`, `qd` or `tau`.
        series: &'static str,
        /// Joint, counted from 1.
        joint: usize,
        /// Samples in the series.
        has: usize,
        /// Samples of the recording.
        needs: usize,
    },
    /// The measured velocity was asked for and the log has none.
    #[error(
        "{log}: the log has no measured velocity; add its columns qd1.. or use \
         velocity = \"derived\""
    )]
    NoVelocity {
        /// Recording.
        log: String,
    },
    /// Torque was needed and the log has none.
    #[error("{log}: the log has no torque; add its columns tau1.. (or i1.. with drive gains)")]
    NoTorque {
        /// Recording.
        log: String,
    },
    /// A value that is not a number.
    #[error(
        "{log}: {series} of joint {joint} is not finite at sample {sample}; \
         cut that part out of the log"
    )]
    NotFinite {
        /// Recording.
        log: String,
        /// `q`, `qd` or `tau`.
        series: &'static str,
        /// Joint, counted from 1.
        joint: usize,
        /// Sample, counted from 0.
        sample: usize,
    },
    /// Nothing is left after cutting the edges.
    #[error(
        "{log}: cutting {cut} of {has} {unit} at the edges leaves nothing; \
         use a longer log or a smaller trim"
    )]
    NothingLeft {
        /// Recording.
        log: String,
        /// How much is cut, both edges together.
        cut: usize,
        /// How much there is.
        has: usize,
        /// `samples` or `decimated rows`.
        unit: &'static str,
    },
    /// A filter cannot be designed or applied.
    #[error("{log}: {step}: {source}")]
    Filter {
        /// Recording.
        log: String,
        /// Which filter.
        step: &'static str,
        /// Why.
        source: SignalError,
    },
}

impl ObserveError {
    /// Says in which log and at which step a filter failed.
    pub(crate) fn filter(log: &str, step: &'static str) -> impl Fn(SignalError) -> Self {
        move |source| ObserveError::Filter {
            log: log.to_owned(),
            step,
            source,
        }
    }
}
