//! Torques, mass matrix and gravity of given base parameters: what D X is, without D.
//!
//! The base parameters stand in the places of the standard parameters that they are named after,
//! all others being zero: the model is the same, and the links are as sparse as they can be.
//! Torques come from Newton and Euler (wrenches handed back from the last link to the first), the
//! mass matrix from composite bodies (Walker, Orin 1982).

use crate::base::BaseParameter;
use crate::derive::coordinate::Coordinate;
use crate::derive::motion::{Motion, Motions};
use crate::derive::vector::{AXES, Screw, add, zero};
use crate::derive::{ParameterKind, body};
use crate::expr::{Expr, Graph, Input, Node};
use crate::mechanism::{JointKind, Mechanism};
use crate::placement::transport;

use super::composite::Composite;

/// The ten inertial parameters of every link, in the order of
/// [`crate::mechanism::inertia::NAMES`]: base parameters as inputs, zero elsewhere.
pub type Links = Vec<[Expr; 10]>;

/// What of a unit of a parameter counts: [`body::wrench`] or [`body::weight`].
type Share = fn(&mut Graph, &Motion, usize) -> Screw;

/// Base parameters as inputs of the graph.
pub fn links(graph: &mut Graph, mechanism: &Mechanism, base: &[BaseParameter]) -> Links {
    let mut links = vec![[graph.zero(); 10]; mechanism.joints.len()];
    for (column, parameter) in base.iter().enumerate() {
        if let ParameterKind::Inertial(index) = parameter.kind {
            links[parameter.link][index] = symbol(graph, column, parameter);
        }
    }
    links
}

/// The standard parameter that a base parameter is named after; a scaled one is divided by its
/// factor.
fn symbol(graph: &mut Graph, column: usize, parameter: &BaseParameter) -> Expr {
    let value = graph.input(Input::Parameter(column));
    graph.name(value, &parameter.name.to_lowercase());
    graph.scale(1.0 / parameter.relation[0].0, value)
}

/// tau = D X, joint by joint.
pub fn inverse(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &mut Motions,
    base: &[BaseParameter],
) -> Vec<Expr> {
    let links = links(graph, mechanism, base);
    let mut torques = handed_back(graph, mechanism, motions, &links, body::wrench);
    for (column, parameter) in base.iter().enumerate() {
        if matches!(parameter.kind, ParameterKind::Inertial(_)) {
            continue;
        }
        let value = graph.input(Input::Parameter(column));
        graph.name(value, &parameter.name.to_lowercase());
        for &(joint, entry) in &parameter.columns.explicit {
            let term = graph.mul(entry, value);
            torques[joint] = graph.add(torques[joint], term);
        }
    }
    torques
}

/// The torques that hold the links against gravity, joint by joint.
pub fn gravity(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &mut Motions,
    base: &[BaseParameter],
) -> Vec<Expr> {
    let links = links(graph, mechanism, base);
    handed_back(graph, mechanism, motions, &links, body::weight)
}

/// The share of every link's wrench that its joint feels, all links behind it included.
fn handed_back(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &mut Motions,
    links: &Links,
    share: Share,
) -> Vec<Expr> {
    let none = zero(graph);
    let still = Screw {
        angular: none,
        linear: none,
    };
    let mut wrenches = vec![still; links.len()];
    let mut torques = vec![graph.zero(); links.len()];
    for &joint in mechanism.order.iter().rev() {
        let motion = motions.links[joint];
        for (index, &value) in links[joint].iter().enumerate() {
            if !graph.is_zero(value) {
                let unit = share(graph, &motion, index);
                let share = scaled(graph, value, &unit);
                wrenches[joint] = plus(graph, &wrenches[joint], &share);
            }
        }
        let wrench = wrenches[joint];
        name(graph, joint, &wrench);
        torques[joint] = along(mechanism, joint, &wrench);
        if let Some(parent) = mechanism.joints[joint].parent {
            let back = transport::back(graph, mechanism, motions, joint, wrench);
            wrenches[parent] = plus(graph, &wrenches[parent], &back);
        }
    }
    driven(graph, mechanism, motions, &torques)
}

/// G^T times what the joints of the tree feel: one value per joint with a drive.
fn driven(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &Motions,
    of_tree: &[Expr],
) -> Vec<Expr> {
    let mut sums = vec![graph.zero(); mechanism.driven];
    for (joint, &value) in of_tree.iter().enumerate() {
        let coordinate = Coordinate::of(mechanism, &motions.solved, joint);
        for share in coordinate.shares(graph) {
            let term = graph.mul(share.ratio, value);
            sums[share.joint] = graph.add(sums[share.joint], term);
        }
    }
    sums
}

/// M(q), by rows; M qdd is the part of tau that accelerations make, rotors included.
pub fn mass_matrix(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &mut Motions,
    base: &[BaseParameter],
) -> Vec<Vec<Expr>> {
    let n = mechanism.joints.len();
    let links = links(graph, mechanism, base);
    let mut composites: Vec<Composite> = links.iter().map(Composite::new).collect();
    let mut matrix = vec![vec![graph.zero(); n]; n];
    for &joint in mechanism.order.iter().rev() {
        let composite = composites[joint];
        composite.name(graph, joint);
        let mut momentum = composite.momentum(graph, mechanism.joints[joint].kind);
        let mut at = joint;
        matrix[joint][joint] = along(mechanism, joint, &momentum);
        while let Some(parent) = mechanism.joints[at].parent {
            momentum = transport::back(graph, mechanism, motions, at, momentum);
            matrix[parent][joint] = along(mechanism, parent, &momentum);
            matrix[joint][parent] = matrix[parent][joint];
            at = parent;
        }
        if let Some(parent) = mechanism.joints[joint].parent {
            let back = composite.back(graph, mechanism, motions, joint);
            composites[parent] = composites[parent].plus(graph, &back);
        }
    }
    // G^T M G, column by column, then row by row.
    let mut driven = |rows: Vec<Vec<Expr>>| -> Vec<Vec<Expr>> {
        let row = |row: &Vec<Expr>| self::driven(graph, mechanism, motions, row);
        rows.iter().map(row).collect()
    };
    let half = transposed(&driven(matrix));
    let mut matrix = driven(half);
    rotors(graph, base, &mut matrix);
    matrix
}

fn transposed(rows: &[Vec<Expr>]) -> Vec<Vec<Expr>> {
    let width = rows.first().map_or(0, Vec::len);
    (0..width)
        .map(|column| rows.iter().map(|row| row[column]).collect())
        .collect()
}

/// Adds what parameters beside the inertial ones have as momentum: B of B qd, which is constant.
fn rotors(graph: &mut Graph, base: &[BaseParameter], matrix: &mut [Vec<Expr>]) {
    let inertial = |p: &BaseParameter| matches!(p.kind, ParameterKind::Inertial(_));
    for (column, parameter) in base.iter().enumerate().filter(|(_, p)| !inertial(p)) {
        for &(row, momentum) in &parameter.columns.momentum {
            for (joint, place) in matrix[row].iter_mut().enumerate() {
                let share = slope(graph, momentum, joint);
                if share != 0.0 {
                    let value = graph.input(Input::Parameter(column));
                    graph.name(value, &parameter.name.to_lowercase());
                    let term = graph.scale(share, value);
                    *place = graph.add(*place, term);
                }
            }
        }
    }
}

/// The coefficient of a joint's velocity in an expression that is linear in velocities.
fn slope(graph: &Graph, x: Expr, joint: usize) -> f64 {
    let size = match graph.nodes()[x.node()] {
        Node::Input(Input::Qd(own)) if own == joint => 1.0,
        Node::Add(a, b) => slope(graph, a, joint) + slope(graph, b, joint),
        Node::Sub(a, b) => slope(graph, a, joint) - slope(graph, b, joint),
        Node::Mul(a, b) => match (graph.value(a), graph.value(b)) {
            (Some(factor), _) => factor * slope(graph, b, joint),
            (_, Some(factor)) => factor * slope(graph, a, joint),
            _ => 0.0,
        },
        _ => 0.0,
    };
    if x.is_negative() { -size } else { size }
}

/// The component along a joint's axis, in its own frame.
fn along(mechanism: &Mechanism, joint: usize, wrench: &Screw) -> Expr {
    match mechanism.joints[joint].kind {
        JointKind::Revolute => wrench.angular[2],
        JointKind::Prismatic => wrench.linear[2],
    }
}

fn scaled(graph: &mut Graph, factor: Expr, screw: &Screw) -> Screw {
    Screw {
        angular: screw.angular.map(|x| graph.mul(factor, x)),
        linear: screw.linear.map(|x| graph.mul(factor, x)),
    }
}

fn plus(graph: &mut Graph, a: &Screw, b: &Screw) -> Screw {
    Screw {
        angular: add(graph, a.angular, b.angular),
        linear: add(graph, a.linear, b.linear),
    }
}

/// Moment `n3x` and force `f3x` of link 3 with all links behind it.
fn name(graph: &mut Graph, link: usize, wrench: &Screw) {
    for (symbol, vector) in [("n", wrench.angular), ("f", wrench.linear)] {
        for (axis, component) in AXES.iter().zip(vector) {
            graph.name(component, &format!("{symbol}{}{axis}", link + 1));
        }
    }
}
