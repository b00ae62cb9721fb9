//! From a log to the observation matrix W and the measurements Y.
//!
//! The steps of Gautier 1996, section 6: [`Motion`] holds the prefiltered positions and their
//! central differences; [`observe`] evaluates the model's outputs along it, low-passes and
//! decimates them in parallel and spreads them over the equations of each joint. The torque goes
//! into Y only: W is a function of the motion alone.

mod course;
mod equations;
mod error;
mod filtering;
mod motion;
mod regressor;
mod slip;
mod stream;
mod stretch;
mod torque;

pub(crate) use course::Course;
pub(crate) use equations::equations_at;
pub use equations::{Equations, Observations, observe};
pub use error::ObserveError;
pub use filtering::Filtering;
pub(crate) use motion::rests;
pub use motion::{Motion, check, check_torque};
pub(crate) use regressor::contract;
pub use regressor::decimated;
pub use slip::dahl;
pub(crate) use slip::slipped;
pub(crate) use stretch::stretch;
pub use torque::{Torque, filtered_torque};

use serde::Serialize;

use crate::model::Output;

/// The three identification models of Gautier 1996.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ModelKind {
    /// \\( \tau = D(q, \dot q, \ddot q) X \\), eq. (17).
    Explicit,
    /// \\( \tau = \frac{d}{dt}(P X) + R X \\), eq. (19).
    Implicit,
    /// \\( \dot q^T \tau = (\frac{d}{dt} h + dh) X \\), eq. (23).
    Power,
}

/// What is decimated: an output itself, or its time derivative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Treatment {
    /// The output as it is.
    Value,
    /// The time derivative of the output.
    Rate,
}

impl ModelKind {
    /// All three, in the order of the paper.
    pub const ALL: [ModelKind; 3] = [ModelKind::Explicit, ModelKind::Implicit, ModelKind::Power];

    /// Lower-case name, as on the command line and in the JSON.
    pub fn name(self) -> &'static str {
        match self {
            ModelKind::Explicit => "explicit",
            ModelKind::Implicit => "implicit",
            ModelKind::Power => "power",
        }
    }

    /// The outputs whose sum is the regressor of this model.
    pub fn terms(self) -> &'static [(Output, Treatment)] {
        match self {
            ModelKind::Explicit => &[(Output::Explicit, Treatment::Value)],
            ModelKind::Implicit => &[
                (Output::Momentum, Treatment::Rate),
                (Output::Rest, Treatment::Value),
            ],
            ModelKind::Power => &[
                (Output::Energy, Treatment::Rate),
                (Output::Power, Treatment::Value),
            ],
        }
    }
}
