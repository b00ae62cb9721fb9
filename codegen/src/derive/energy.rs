//! h: the energy model (Gautier 1996, eq. 10), one short row per link.

use crate::expr::{Expr, Graph};

use super::body::tensor;
use super::motion::Motions;
use super::vector::{cross, dot};

/// Kinetic plus potential energy per unit of each of the ten parameters of a link.
pub fn row(graph: &mut Graph, motions: &Motions, link: usize) -> Vec<Expr> {
    let m = motions.links[link];
    let vw = cross(graph, m.v, m.w);
    (0..10)
        .map(|index| match index {
            // w . J w / 2: the products of inertia meet twice.
            0..=5 => {
                let jw = tensor(graph, index, m.w);
                let twice = dot(graph, m.w, jw);
                graph.scale(0.5, twice)
            }
            // v . (w x e) - g . e
            6..=8 => graph.sub(vw[index - 6], m.g[index - 6]),
            _ => {
                let vv = dot(graph, m.v, m.v);
                let kinetic = graph.scale(0.5, vv);
                graph.add(kinetic, m.potential)
            }
        })
        .collect()
}
