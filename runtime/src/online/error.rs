//! What a control loop can ask of this room that it cannot do.

use crate::signal::SignalError;

/// Why something cannot be set up, pushed or solved on line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OnlineError {
    /// A sample of another robot.
    #[error(
        "a sample has {has} values of {series} and the robot {needs} joints; \
         push one value per joint, in the order of the robot's joints"
    )]
    Joints {
        /// `q`, `qd` or `tau`.
        series: &'static str,
        /// Values in the sample.
        has: usize,
        /// Joints of the robot.
        needs: usize,
    },
    /// Measured velocities were announced and are missing.
    #[error(
        "the stream was set up for measured velocities and a sample has none; push qd, or set \
         velocity = Derived"
    )]
    NoVelocity,
    /// A sampling rate that is none.
    #[error("the sampling rate is {rate_hz} Hz; it has to be a positive number")]
    Rate {
        /// What was asked for.
        rate_hz: f64,
    },
    /// A decimation ratio of zero.
    #[error("the decimation ratio is 0; 1 keeps the equations of every sample")]
    Ratio,
    /// A filter cannot be designed.
    #[error("{step}: {source}")]
    Filter {
        /// Which filter.
        step: &'static str,
        /// Why.
        source: SignalError,
    },
    /// A prefilter that looks back too far to be kept in memory.
    #[error(
        "a prefilter of {fq_hz} Hz at {rate_hz} Hz looks at {samples} samples, more than {most}; \
         raise its cut-off or sample more slowly"
    )]
    TooLong {
        /// Cut-off asked for, Hz.
        fq_hz: f64,
        /// Sampling rate, Hz.
        rate_hz: f64,
        /// Samples that it would look at.
        samples: usize,
        /// The most.
        most: usize,
    },
    /// A band that is none.
    #[error("the band of rest is {band}; it has to be 0 or more (rad or m)")]
    Band {
        /// What was asked for.
        band: f64,
    },
    /// A forgetting factor that does not forget.
    #[error(
        "the forgetting factor is {factor}; it has to be above 0 and at most 1 (1 forgets nothing)"
    )]
    Forgetting {
        /// What was asked for.
        factor: f64,
    },
    /// Weights of another robot, or of another model.
    #[error(
        "{has} weights for {needs} equations per instant; give one per joint, or one for the power model"
    )]
    Weights {
        /// Weights given.
        has: usize,
        /// Equations per instant.
        needs: usize,
    },
    /// A weight that is none.
    #[error("the weight of equation {equation} is {weight}; it has to be a positive number")]
    Weight {
        /// Equation, counted from 1: the joint, or 1 for the power balance.
        equation: usize,
        /// What was asked for.
        weight: f64,
    },
    /// Parameters of another robot.
    #[error(
        "{has} parameters for a robot of {needs}; give them in the order of the model's columns"
    )]
    Parameters {
        /// Parameters given.
        has: usize,
        /// Columns of the model.
        needs: usize,
    },
    /// A parameter that is no number.
    #[error("parameter {name} is not finite; leave it at zero if it is not known")]
    NotFinite {
        /// Its name.
        name: String,
    },
    /// Nothing to solve yet.
    #[error("no equation has come yet, or no joint has moved; move the robot and solve later")]
    NothingMoves,
    /// A block too short for its statistics.
    #[error(
        "a block of {block_s} s holds {rows} equations of a joint and the model has up to \
         {columns} columns; blocks need twice as many equations as columns"
    )]
    Block {
        /// Length asked for, s.
        block_s: f64,
        /// Equations in it.
        rows: usize,
        /// Most columns of an equation.
        columns: usize,
    },
    /// Too few blocks.
    #[error("{blocks} {what}; {needs} or more are needed")]
    Blocks {
        /// Blocks asked for.
        blocks: usize,
        /// Of what.
        what: &'static str,
        /// Fewest.
        needs: usize,
    },
    /// A level of alarm that is none.
    #[error("the alarm's level is {sigma} standard deviations; it has to be positive, 6 is usual")]
    Level {
        /// What was asked for.
        sigma: f64,
    },
}
