//! Why there is no exciting motion.

use crate::simulate::SimulateError;

/// Why an exciting motion cannot be found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExciteError {
    /// A number of joints that is not the robot's.
    #[error("{what} is for {has} joints, {robot} has {needs}")]
    Joints {
        /// What was given.
        what: &'static str,
        /// Joints that it is for.
        has: usize,
        /// The robot.
        robot: String,
        /// Joints of the robot.
        needs: usize,
    },
    /// A range in which nothing can move.
    #[error(
        "joint `{joint}` cannot move: its lower limit {lower} is not below its upper limit {upper}; \
         correct its limits"
    )]
    Range {
        /// The joint.
        joint: String,
        /// Lowest position, rad or m.
        lower: f64,
        /// Highest position.
        upper: f64,
    },
    /// A limit that is not a positive number.
    #[error(
        "the {what} limit of joint `{joint}` is {value}: no motion satisfies it; \
         give a number above zero"
    )]
    NotPositive {
        /// `velocity`, `acceleration` or `effort`.
        what: &'static str,
        /// The joint.
        joint: String,
        /// The value.
        value: f64,
    },
    /// Noise that is not a positive number.
    #[error("the noise of joint `{joint}` is {value}: give a standard deviation above zero")]
    Noise {
        /// The joint.
        joint: String,
        /// Its standard deviation, N m or N.
        value: f64,
    },
    /// A limit that the description does not state and that cannot be assumed.
    #[error(
        "joint `{joint}` has no {what} limit and none can be assumed for it; \
         state it in the description or with --limits"
    )]
    Missing {
        /// What limit.
        what: &'static str,
        /// The joint.
        joint: String,
    },
    /// A centre outside the limits.
    #[error(
        "the centre of joint `{joint}`, {value}, is not between its limits {lower} and {upper}; \
         choose another --center"
    )]
    Center {
        /// The joint.
        joint: String,
        /// The centre, rad or m.
        value: f64,
        /// Lowest position.
        lower: f64,
        /// Highest position.
        upper: f64,
    },
    /// Holding the robot takes more than its drives have.
    #[error(
        "holding joint `{joint}` still at the centre of the motion takes {torque:.4}, its effort limit \
         is {effort:.4}: no motion around it satisfies that; choose another --center, or correct limit or parameters"
    )]
    Effort {
        /// The joint.
        joint: String,
        /// Torque at rest, N m or N.
        torque: f64,
        /// Limit.
        effort: f64,
    },
    /// A family without freedom.
    #[error(
        "{what} leave the motion no freedom; at least {least} are needed to begin and end at rest"
    )]
    TooFew {
        /// `1 harmonics`, `0 via points`.
        what: String,
        /// Fewest.
        least: usize,
    },
    /// A setting that is no number that can be used.
    #[error("{what} is {value}: give a number above zero")]
    Setting {
        /// What.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A sampling rate that sees less than the motion.
    #[error(
        "at {rate_hz} Hz a period of {period_s} s has {samples} samples, fewer than the {least} \
         that its parameters need; sample faster or give it more time"
    )]
    TooFewSamples {
        /// Rate, Hz.
        rate_hz: f64,
        /// Period, s.
        period_s: f64,
        /// Samples in a period.
        samples: usize,
        /// Fewest.
        least: usize,
    },
    /// No parameter can be determined.
    #[error(
        "no motion within these limits determines any parameter of {robot}; \
         widen the limits, or give the model an effect"
    )]
    NothingDetermined {
        /// The robot.
        robot: String,
    },
    /// A relative standard deviation that cannot be had.
    #[error(
        "{wanted_pct} % cannot be reached for any parameter within {most} periods: the best of them, {name}, \
         needs {needs:.3e}; lower the noise, or want less"
    )]
    Unreachable {
        /// What was wanted, %.
        wanted_pct: f64,
        /// Most periods.
        most: f64,
        /// The parameter that needs fewest.
        name: String,
        /// Periods that it needs.
        needs: f64,
    },
    /// A relative standard deviation of unknown values.
    #[error(
        "a wanted relative standard deviation needs values of the parameters; give --parameters FILE"
    )]
    NoValues,
    /// Two columns that no motion separates.
    #[error(
        "no motion within these limits separates `{name}` from the other parameters of the model"
    )]
    Inseparable {
        /// The parameter.
        name: String,
    },
    /// An effort limit or a value that the model cannot use.
    #[error(transparent)]
    Model(#[from] SimulateError),
    /// Numbers that broke down.
    #[error(
        "the search ended without a motion whose equations can be solved; try another --seed or wider limits"
    )]
    NoMotion,
}
