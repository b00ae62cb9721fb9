//! Least squares: from equations to parameters, their standard deviations, and what the data
//! cannot tell.
//!
//! Each block of equations (a joint) is reduced to a small triangular factor ([`Triangle`]);
//! ordinary and weighted least squares, residuals, condition and rank all follow from these
//! factors without the rows (Gautier 1996, sections 5 and 7.3). Where it is cheap, the solution is
//! then refined to all the digits that the equations hold ([`refine()`]), and the digits that are
//! certain are counted.

mod double;
mod entries;
mod identifiable;
mod instrumental;
mod least_squares;
#[cfg(test)]
mod made;
#[cfg(test)]
mod nist;
mod orthogonal;
mod reduced;
mod refine;
mod robust;
mod triangle;
mod weights;

pub use double::Double;
pub use entries::Entries;
pub use identifiable::Dependency;
pub(crate) use identifiable::identifiability;
pub use instrumental::{Instrumental, instrumental, long_run};
pub use least_squares::{Estimate, estimate, from_triangles};
pub use refine::{Refined, refine, refined};
pub use robust::row_factors;
pub use triangle::Triangle;

/// Why parameters cannot be estimated.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EstimateError {
    /// Fewer equations than parameters.
    #[error(
        "there are {rows} equations for {parameters} parameters; \
         use a longer log or a smaller decimation ratio"
    )]
    TooFewEquations {
        /// Number of equations.
        rows: usize,
        /// Number of parameters that appear in them.
        parameters: usize,
    },
    /// There is no torque to explain.
    #[error("the measurements of joint {block} are missing; identification needs torque")]
    NoMeasurements {
        /// Joint, counted from 1; 1 for the power balance.
        block: usize,
    },
    /// A measurement or an entry of W that is not a number.
    #[error(
        "{what} of joint {block} is not finite in decimated row {row}; \
         look there for extreme values, or for a model that divides by zero"
    )]
    NotFinite {
        /// `the measurement` or `the regressor`.
        what: &'static str,
        /// Joint, counted from 1; 1 for the power balance.
        block: usize,
        /// Row of the decimated equations, counted from 0.
        row: usize,
    },
    /// Every column of W is zero.
    #[error("no parameter appears in the equations: the robot does not move in these logs")]
    NothingMoves,
    /// A column that the others make up, in a system that was to be refined as it is.
    #[error(
        "column {column} of W, counted from 0, is a combination of the others; \
         leave it out, or identify it from richer data"
    )]
    Dependent {
        /// Column of W, counted from 0.
        column: usize,
    },
    /// The singular values did not converge.
    #[error("the singular values of W could not be computed; check the log for extreme values")]
    Singular,
}
