//! What a robot's description knows of its parameters before any log: their values, how far these
//! may be wrong, and the standard parameters behind them.
//!
//! It comes from the inertial values of a URDF and the `[parameters]` and `[prior]` tables of a
//! description, by way of the generated module or the interpreter.

use std::borrow::Cow;

/// One entry of the regrouping relations \\( X = K X_S \\) (Gautier 1991).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// Base parameter, an index into [`crate::model::IdentificationModel::columns`].
    pub column: usize,
    /// Link, counted from 0.
    pub link: usize,
    /// Standard parameter of the link, an index into [`STANDARD`].
    pub parameter: usize,
    /// What the standard parameter is multiplied by.
    pub factor: f64,
}

/// The ten standard inertial parameters of a link, about the origin of its frame.
pub const STANDARD: [&str; 10] = ["XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M"];

/// Units of [`STANDARD`].
pub const STANDARD_UNITS: [&str; 10] = [
    "kg m^2", "kg m^2", "kg m^2", "kg m^2", "kg m^2", "kg m^2", "kg m", "kg m", "kg m", "kg",
];

/// What is known of the np base parameters of a robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Knowledge {
    /// Value of each parameter, SI; `None` where something of it is not described. Empty if
    /// nothing is.
    pub nominal: Cow<'static, [Option<f64>]>,
    /// The share of the described rigid bodies, without friction and rotor inertias, as a
    /// controller's feedforward has it. Empty if no link has inertial values.
    pub rigid: Cow<'static, [f64]>,
    /// The inertial part of K, by column, link and parameter.
    pub terms: Cow<'static, [Term]>,
    /// Gaussian rows \\( A X = b + \epsilon \\) of the description's tolerances, with independent
    /// errors of variance one: row-major, each row np factors, then b. Empty without `[prior]`.
    pub prior: Cow<'static, [f64]>,
}

impl Knowledge {
    /// Nothing known.
    pub const NONE: Knowledge = Knowledge {
        nominal: Cow::Borrowed(&[]),
        rigid: Cow::Borrowed(&[]),
        terms: Cow::Borrowed(&[]),
        prior: Cow::Borrowed(&[]),
    };

    /// Described value of a parameter.
    pub fn value(&self, column: usize) -> Option<f64> {
        self.nominal.get(column).copied().flatten()
    }

    /// The columns of K of a link, ten of `np` values each: what one unit of each of its standard
    /// parameters adds to the base parameters. A load fixed to the link adds its own ten
    /// parameters there.
    pub fn carried(&self, link: usize, np: usize) -> [Vec<f64>; 10] {
        let mut columns: [Vec<f64>; 10] = std::array::from_fn(|_| vec![0.0; np]);
        for term in self.terms.iter().filter(|term| term.link == link) {
            let column = columns.get_mut(term.parameter);
            if let Some(place) = column.and_then(|column| column.get_mut(term.column)) {
                *place = term.factor;
            }
        }
        columns
    }
}
