//! The identification models as expressions: D, P, R, h of every standard parameter, and the
//! columns of every effect, in one graph.
//!
//! Project, do not propagate: the motion of each link is computed once in its own frame, each
//! standard parameter contributes one sparse wrench (D) or momentum (P) there, and an entry is the
//! product of that with the screw of a joint above. This module knows no Rust.

pub mod body;
pub mod effects;
pub mod explicit;
pub mod implicit;
pub mod energy;
pub mod motion;
pub mod vector;

use crate::expr::{Expr, Graph};
use crate::mechanism::{JointKind, Mechanism, inertia};
use motion::Motions;

/// What a standard parameter is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ParameterKind {
    /// One of the ten inertial parameters of a link, by its place in [`inertia::NAMES`].
    Inertial(usize),
    /// A rotor inertia.
    Drive,
    /// Viscous, Coulomb friction, offset.
    Friction,
    /// Any other effect.
    Effect,
}

/// A standard parameter and its columns in all five outputs; absent entries are zero.
#[derive(Clone, Debug)]
pub struct Standard {
    /// Name, such as `ZZ1` or `FV2`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// One line in words.
    pub meaning: String,
    /// Link or joint, counted from 0.
    pub link: usize,
    /// What it is.
    pub kind: ParameterKind,
    /// The columns.
    pub columns: Columns,
}

/// The column of one parameter in each output; entries are (joint, expression).
#[derive(Clone, Debug, Default)]
pub struct Columns {
    /// D.
    pub explicit: Vec<(usize, Expr)>,
    /// P.
    pub momentum: Vec<(usize, Expr)>,
    /// R.
    pub rest: Vec<(usize, Expr)>,
    /// h, if it has an energy.
    pub energy: Option<Expr>,
    /// dh, if it has a power that is no derivative of its energy.
    pub power: Option<Expr>,
}

/// All standard parameters of a mechanism, link by link, then the effects.
pub fn standard(graph: &mut Graph, mechanism: &Mechanism) -> Vec<Standard> {
    let mut motions = Motions::new(graph, mechanism);
    let mut parameters = Vec::new();
    for link in 0..mechanism.joints.len() {
        let explicit = explicit::columns(graph, &mut motions, link);
        let implicit = implicit::columns(graph, &mut motions, link);
        let energy = energy::row(graph, &mut motions, link);
        for (index, name) in inertia::NAMES.iter().enumerate() {
            let (momentum, rest) = implicit[index].clone();
            parameters.push(Standard {
                name: format!("{name}{}", link + 1),
                unit: unit(index).into(),
                meaning: meaning(index, link),
                link,
                kind: ParameterKind::Inertial(index),
                columns: Columns {
                    explicit: explicit[index].clone(),
                    momentum,
                    rest,
                    energy: Some(energy[index]).filter(|&h| !graph.is_zero(h)),
                    power: None,
                },
            });
        }
    }
    let kinds: Vec<JointKind> = mechanism.joints.iter().map(|joint| joint.kind).collect();
    for effect in &mechanism.effects {
        parameters.extend(effects::columns(graph, &kinds, effect));
    }
    parameters
}

fn unit(index: usize) -> &'static str {
    match index {
        0..=5 => "kg m^2",
        6..=8 => "kg m",
        _ => "kg",
    }
}

fn meaning(index: usize, link: usize) -> String {
    let name = inertia::NAMES[index];
    let link = link + 1;
    match index {
        0..=5 => format!("inertia {name} of link {link} about the origin of its frame"),
        6..=8 => format!("first moment {name} of link {link}"),
        _ => format!("mass of link {link}"),
    }
}
