//! The base (minimum) parameters: which columns of D are independent, and what the others add.
//!
//! A standard parameter without effect on the model is dropped; one whose column is a combination
//! of others is regrouped into them: X_b = X + sum of coefficients times the regrouped parameters
//! (Gautier 1991, "Numerical calculation of the base inertial parameters").

pub mod detail;
pub mod lengths;
pub mod names;
pub mod rank;
pub mod regroup;
pub mod relation;
pub mod sample;
pub mod scale;
pub mod symbolic;

use crate::derive::{Columns, ParameterKind, Standard};
use crate::describe::Description;
use crate::expr::Graph;
use crate::mechanism::Mechanism;

/// A base parameter with its columns in all outputs.
#[derive(Clone, Debug)]
pub struct BaseParameter {
    /// Classical name, such as `ZZR1`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// One line in words.
    pub meaning: String,
    /// Link or joint, counted from 0.
    pub link: usize,
    /// What the independent standard parameter is.
    pub kind: ParameterKind,
    /// Standard parameters with their coefficients, the independent one first.
    pub relation: Vec<(f64, String)>,
    /// The relation as text, with the lengths by name where they explain a coefficient.
    pub text: String,
    /// Columns of D, P, R, h, dh.
    pub columns: Columns,
}

impl BaseParameter {
    /// The relation as text, such as `ZZ1 + IA1 + L^2*M2`.
    pub fn relation_text(&self) -> String {
        self.text.clone()
    }
}

/// The base parameters of a robot.
#[derive(Clone, Debug)]
pub struct BaseParameters {
    /// In the order of the columns of every output.
    pub parameters: Vec<BaseParameter>,
    /// Number of standard parameters they stand for.
    pub standard: usize,
    /// Singular value of the last kept column over that of the first dropped one.
    pub gap: f64,
    /// Those that a detail of the description alone keeps among them, if there are any.
    pub detail: Option<detail::Detail>,
}

/// Why base parameters could not be derived.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BaseError {
    /// The regressor has no clear rank.
    #[error(
        "the rank of the regressor is not clear: the gap between kept and dropped singular values \
         is {gap:.1e} (at least 1e3 is needed, and no column within it); nearly dependent: {}. Look \
         for joints that are almost parallel, lengths that are almost zero and loops that are \
         almost parallelograms, and make them exact",
        columns.join(", ")
    )]
    NoGap {
        /// Last kept over first dropped singular value.
        gap: f64,
        /// Names of the columns that are neither dependent nor independent.
        columns: Vec<String>,
    },
    /// `[scaled]` names a parameter that is not a base parameter.
    #[error(
        "[scaled] {name}: `{parameter}` is not a base parameter of this robot; they are {}",
        known.join(", ")
    )]
    Scaled {
        /// The new name.
        name: String,
        /// The parameter that was to be scaled.
        parameter: String,
        /// Base parameters of the robot.
        known: Vec<String>,
    },
}

/// Derives the base parameters from the standard ones.
///
/// # Errors
/// [`BaseError::NoGap`] if the rank is not clear, [`BaseError::Scaled`] if a parameter to be
/// scaled does not exist.
pub fn parameters(
    graph: &mut Graph,
    mechanism: &Mechanism,
    standard: Vec<Standard>,
    description: &Description,
) -> Result<BaseParameters, BaseError> {
    let samples = sample::explicit(graph, mechanism, &standard);
    let priority = names::priority(mechanism, &standard);
    let split = rank::split(&samples, &priority, &standard)?;
    let names: Vec<String> = standard.iter().map(|p| p.name.clone()).collect();
    let mut parameters = regroup::regroup(&samples, &split, &standard);
    let detail = detail::find(&samples, &split, &standard, &parameters);
    scale::apply(graph, &mut parameters, &description.scaled)?;
    relation::write(&mut parameters, mechanism, description, &split, &names);
    Ok(BaseParameters {
        parameters,
        standard: names.len(),
        gap: split.gap,
        detail,
    })
}
