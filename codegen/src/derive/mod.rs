//! The identification models as expressions: D, P, R, h of every standard parameter, and the
//! columns of every effect, in one graph.
//!
//! Project, do not propagate: the motion of each link is computed once in its own frame, each
//! standard parameter contributes one sparse wrench (D) or momentum (P) there, and an entry is the
//! product of that with the screw of a joint above. This module knows no Rust.

pub mod body;
pub mod closed;
pub mod coordinate;
pub mod effects;
pub mod energy;
pub mod explicit;
pub mod implicit;
pub mod motion;
pub mod names;
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
    pub unit: &'static str,
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

/// The standard parameters of a mechanism, and where in the graph each link's share ends.
#[derive(Clone, Debug, Default)]
pub struct StandardModel {
    /// Link by link, then the effects.
    pub parameters: Vec<Standard>,
    /// Number of nodes after each link in the order from the base outwards: what belongs to the
    /// k-th of them lies between ends k-1 and k.
    pub ends: Vec<usize>,
    /// The motions of the links.
    pub motions: Motions,
}

/// All standard parameters of a mechanism. Link by link: its motion, then its columns, so that
/// the order of the nodes is the order in which a person would write the model down.
pub fn standard(graph: &mut Graph, mechanism: &Mechanism) -> StandardModel {
    let mut motions = Motions::new(graph, mechanism);
    let mut model = StandardModel::default();
    for &link in &mechanism.order {
        motions.push(graph, mechanism, link);
        names::motion(graph, link, &motions.links[link]);
        names::movers(graph, link, &motions.movers[link]);
        inertial(graph, &motions, link, &mut model.parameters);
        model.ends.push(graph.nodes().len());
    }
    model.motions = motions;
    model.parameters.sort_by_key(|parameter| parameter.link);
    let kinds: Vec<JointKind> = mechanism.joints.iter().map(|joint| joint.kind).collect();
    for effect in &mechanism.effects {
        model
            .parameters
            .extend(effects::columns(graph, &kinds, effect));
    }
    model
}

/// The ten inertial parameters of a link.
fn inertial(graph: &mut Graph, motions: &Motions, link: usize, parameters: &mut Vec<Standard>) {
    let explicit = explicit::columns(graph, motions, link);
    let implicit = implicit::columns(graph, motions, link);
    let energy = energy::row(graph, motions, link);
    let columns = explicit.into_iter().zip(implicit).zip(energy);
    for (index, ((explicit, (momentum, rest)), energy)) in columns.enumerate() {
        let name = format!("{}{}", inertia::NAMES[index], link + 1);
        for (prefix, entries) in [("d", &explicit), ("p", &momentum), ("r", &rest)] {
            for &(joint, entry) in entries {
                let symbol = format!("{prefix}{}_{}", joint + 1, name.to_lowercase());
                graph.name(entry, &symbol);
            }
        }
        let energy = Some(energy).filter(|&h| !graph.is_zero(h));
        parameters.push(Standard {
            name,
            unit: unit(index),
            meaning: meaning(index, link),
            link,
            kind: ParameterKind::Inertial(index),
            columns: Columns {
                explicit,
                momentum,
                rest,
                energy,
                power: None,
            },
        });
    }
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
