//! What a description knows about the parameters beside the equations: their values, how far these
//! may be wrong, and which standard parameters of which link stand behind each of them.
//!
//! Everything is linear: the base parameters are \\( X = K X_S \\) (Gautier 1991), so values and
//! deviations of the standard parameters go through the regrouping relations.

mod spread;
#[cfg(test)]
mod tests;
mod values;
mod whiten;

use nalgebra::DVector;

use crate::mechanism::inertia::NAMES;
use crate::robot::Robot;
use values::Values;

/// One entry of K for an inertial parameter of a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// Base parameter, counted from 0.
    pub column: usize,
    /// Link, counted from 0.
    pub link: usize,
    /// Place of the standard parameter in [`crate::mechanism::inertia::NAMES`].
    pub parameter: usize,
    /// What it is multiplied by.
    pub factor: f64,
}

/// What is known of the np base parameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Knowledge {
    /// Value of each, SI: stated by its own name in `[parameters]`, otherwise from the inertial
    /// values of the links and the standard parameters that are stated. `None` where something
    /// of it is not described.
    pub nominal: Vec<Option<f64>>,
    /// The share of the rigid bodies, without friction and rotor inertias; what is not described
    /// counts as zero. Empty if no link has inertial values.
    pub rigid: Vec<f64>,
    /// The inertial part of K, by column, link and parameter.
    pub terms: Vec<Term>,
    /// Gaussian rows \\( A X = b + \epsilon \\) with independent errors of variance one: each has
    /// np factors and b. Empty without `[prior]`.
    pub prior: Vec<Vec<f64>>,
}

impl Knowledge {
    /// Reads the knowledge off a robot.
    pub fn of(robot: &Robot) -> Knowledge {
        let values = Values::of(robot);
        let nominal = values.nominal(robot);
        let prior = match &robot.description.prior {
            None => Vec::new(),
            Some(prior) => {
                let deviations = spread::deviations(robot, &values, prior);
                let mean = nominal.iter().map(|value| value.unwrap_or(0.0));
                let mean = DVector::from_iterator(nominal.len(), mean);
                whiten::rows(&deviations, &mean)
            }
        };
        Knowledge {
            rigid: values.rigid(robot),
            terms: terms(robot),
            nominal,
            prior,
        }
    }
}

/// Link (from 0) of a standard inertial parameter such as `XX3`, and its place in [`NAMES`].
pub fn inertial(name: &str) -> Option<(usize, usize)> {
    let symbol = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let parameter = NAMES.iter().position(|known| *known == symbol)?;
    let number: usize = name[symbol.len()..].parse().ok()?;
    Some((number.checked_sub(1)?, parameter))
}

fn terms(robot: &Robot) -> Vec<Term> {
    let mut terms = Vec::new();
    for (column, parameter) in robot.base.parameters.iter().enumerate() {
        let known = parameter.relation.iter().filter_map(|(factor, name)| {
            let (link, parameter) = inertial(name)?;
            Some(Term {
                column,
                link,
                parameter,
                factor: *factor,
            })
        });
        terms.extend(known);
    }
    terms.sort_by_key(|term| (term.column, term.link, term.parameter));
    terms
}
