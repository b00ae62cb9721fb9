//! The functions that languages other than Rust offer: one for each output, over plain arrays.

use super::function::{self, Body, Target};
use super::language::Language;
use crate::functions::{Extent, Function, Quantity};
use crate::robot::{Output, Robot};

/// A function of a robot's module.
#[derive(Clone, Copy, Debug)]
pub struct Signature {
    /// What it computes.
    pub output: Output,
    /// Its name.
    pub name: &'static str,
    /// What it returns, in one line.
    pub summary: &'static str,
    /// Unit of its entries.
    pub unit: &'static str,
    /// Whether it has a row for each joint; else it is one row.
    pub matrix: bool,
    /// The signals it takes, without presliding states.
    pub signals: &'static [&'static str],
}

/// All functions, in a fixed order.
pub const ALL: [Signature; 5] = [
    Signature {
        output: Output::Explicit,
        name: "D",
        summary: "D of the explicit model tau = D(q, qd, qdd) X (Gautier 1996, eq. 5)",
        unit: "N m or N per unit of the parameter",
        matrix: true,
        signals: &["q", "qd", "qdd"],
    },
    Signature {
        output: Output::Momentum,
        name: "P",
        summary: "P of the implicit model tau = d/dt(P X) + R X (Gautier 1996, eqs. 7-9)",
        unit: "N m s or N s per unit of the parameter",
        matrix: true,
        signals: &["q", "qd"],
    },
    Signature {
        output: Output::Rest,
        name: "R",
        summary: "R of the implicit model tau = d/dt(P X) + R X (Gautier 1996, eqs. 7-9)",
        unit: "N m or N per unit of the parameter",
        matrix: true,
        signals: &["q", "qd"],
    },
    Signature {
        output: Output::Energy,
        name: "h",
        summary: "h, the energies: qd . tau = d/dt(h X) + dh X (Gautier 1996, eq. 10)",
        unit: "J per unit of the parameter",
        matrix: false,
        signals: &["q", "qd"],
    },
    Signature {
        output: Output::Power,
        name: "dh",
        summary: "dh, the powers of the columns that have no energy of the state (friction)",
        unit: "W per unit of the parameter",
        matrix: false,
        signals: &["q", "qd"],
    },
];

/// Whether the functions of a robot also take presliding states.
pub fn has_slip(robot: &Robot) -> bool {
    robot.mechanism.presliding().next().is_some()
}

/// What a prototype computes.
#[derive(Clone, Copy, Debug)]
enum Source<'a> {
    Model(Output),
    Beside(&'a Function),
}

/// A function of a robot's module: an identification model, or one beside them.
#[derive(Clone, Debug)]
pub struct Prototype<'a> {
    source: Source<'a>,
    /// Its name.
    pub name: String,
    /// The name of the array that it writes.
    pub argument: &'static str,
    /// What it returns, in one line.
    pub summary: String,
    /// Unit of its entries.
    pub unit: &'static str,
    /// Rows, if it returns a matrix.
    pub rows: Option<Extent>,
    /// Columns.
    pub columns: Extent,
    /// The signals it takes, without presliding states.
    pub signals: &'static [&'static str],
    /// Whether it takes presliding states.
    pub slip: bool,
    /// Whether it takes base parameters.
    pub parameters: bool,
    /// Whether it leaves out entries that are always zero.
    pub sparse: bool,
}

/// All functions of a robot, in a fixed order.
pub fn prototypes(robot: &Robot) -> Vec<Prototype<'_>> {
    let models = ALL.iter().map(|signature| Prototype {
        source: Source::Model(signature.output),
        name: signature.name.to_owned(),
        argument: signature.name,
        summary: signature.summary.to_owned(),
        unit: signature.unit,
        rows: signature.matrix.then_some(Extent::Joints),
        columns: Extent::Parameters,
        signals: signature.signals,
        slip: has_slip(robot),
        parameters: false,
        sparse: true,
    });
    models
        .chain(robot.functions.iter().map(|f| beside(robot, f)))
        .collect()
}

fn beside<'a>(robot: &Robot, function: &'a Function) -> Prototype<'a> {
    let argument = match function.quantity {
        Quantity::InverseDynamics => "tau",
        Quantity::MassMatrix => "M",
        Quantity::Gravity => "g",
        Quantity::Pose => "T",
        Quantity::Jacobian => "J",
    };
    let (rows, columns) = function.extents();
    Prototype {
        source: Source::Beside(function),
        name: match &function.tip {
            Some(tip) => format!("{argument}_{tip}"),
            None => argument.to_owned(),
        },
        argument,
        summary: function.summary(),
        unit: function.unit(),
        rows,
        columns,
        signals: function.signals(),
        slip: has_slip(robot) && function.quantity == Quantity::InverseDynamics,
        parameters: function.takes_parameters(),
        sparse: false,
    }
}

impl Prototype<'_> {
    /// What the function does, with its output in the array of this name.
    pub fn body(&self, robot: &Robot, argument: &'static str, language: &dyn Language) -> Body {
        match self.source {
            Source::Model(output) => {
                function::body(robot, &[Target { output, argument }], language)
            }
            Source::Beside(function) => function::body_of(robot, function, argument, language),
        }
    }

    /// The signals it takes, presliding states included.
    pub fn all_signals(&self) -> impl Iterator<Item = &'static str> + use<> {
        let slip = self.slip.then_some("slip");
        self.signals.iter().copied().chain(slip)
    }
}
