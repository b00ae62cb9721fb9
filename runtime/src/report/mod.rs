//! Results as one serialisable value, and its renderings.
//!
//! [`Identification`] is all that is said about an identification: its JSON is the machine
//! readable report, and [`terminal`] renders nothing but this value.

mod identification;
mod table;
mod terminal;

pub use identification::{Fit, Identification, JointFit, ModelResult, ParameterResult, Validation};
pub use terminal::terminal;
