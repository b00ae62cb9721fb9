//! D: the explicit dynamic model (Gautier 1996, eqs. 5-6).

use crate::expr::{Expr, Graph};

use super::body;
use super::motion::Motions;
use super::vector::{Screw, dot};

/// The columns of D of the ten parameters of a link: per parameter the non-zero (joint, entry).
pub fn columns(graph: &mut Graph, motions: &Motions, link: usize) -> Vec<Vec<(usize, Expr)>> {
    let motion = motions.links[link];
    (0..10)
        .map(|index| {
            let wrench = body::wrench(graph, &motion, index);
            let mut entries = Vec::new();
            for mover in &motions.movers[link] {
                let entry = pairing(graph, &mover.screw, &wrench);
                if !graph.is_zero(entry) {
                    entries.push((mover.joint, entry));
                }
            }
            entries
        })
        .collect()
}

/// <screw, wrench>: angular with moment, linear with force.
pub fn pairing(graph: &mut Graph, screw: &Screw, wrench: &Screw) -> Expr {
    let angular = dot(graph, screw.angular, wrench.angular);
    let linear = dot(graph, screw.linear, wrench.linear);
    graph.add(angular, linear)
}
