//! The functions that languages other than Rust offer: one for each output, over plain arrays.

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
