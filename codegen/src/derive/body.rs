//! What one unit of a standard parameter contributes in the frame of its link.

use crate::expr::Graph;

use super::motion::Motion;
use super::vector::{Screw, Vec3, cross, zero};

/// Unit tensors in the order XX XY XZ YY YZ ZZ, as the rows that a vector meets.
const TENSORS: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// J v of a unit tensor.
pub fn tensor(graph: &Graph, index: usize, v: Vec3) -> Vec3 {
    let (i, j) = TENSORS[index];
    let mut out = zero(graph);
    out[i] = v[j];
    out[j] = v[i];
    out
}

/// The unit vector of MX, MY or MZ.
fn unit(graph: &Graph, index: usize) -> Vec3 {
    let mut e = zero(graph);
    e[index - 6] = graph.one();
    e
}

/// The wrench of inertia and gravity of one unit of the parameter `index`, in the order of
/// [`crate::mechanism::inertia::NAMES`].
///
/// Inertia: moment J wd + w x J w. First moment e: force U e, moment e x a. Mass: force a.
pub fn wrench(graph: &mut Graph, m: &Motion, index: usize) -> Screw {
    let none = zero(graph);
    match index {
        0..=5 => Screw {
            angular: euler(graph, m, index),
            linear: none,
        },
        6..=8 => {
            let e = unit(graph, index);
            let force = m.u.map(|row| row[index - 6]);
            Screw {
                angular: cross(graph, e, m.a),
                linear: force,
            }
        }
        _ => Screw {
            angular: none,
            linear: m.a,
        },
    }
}

/// J wd + w x J w with the squares and products that U shares.
fn euler(graph: &mut Graph, m: &Motion, index: usize) -> Vec3 {
    let jwd = tensor(graph, index, m.wd);
    let jw = tensor(graph, index, m.w);
    let gyro = cross(graph, m.w, jw);
    super::vector::add(graph, jwd, gyro)
}

/// The momentum of one unit of the parameter: inertia J w (moment of momentum); first moment e:
/// linear w x e, angular e x v; mass: linear v.
pub fn momentum(graph: &mut Graph, m: &Motion, index: usize) -> Screw {
    let none = zero(graph);
    match index {
        0..=5 => Screw {
            angular: tensor(graph, index, m.w),
            linear: none,
        },
        6..=8 => {
            let e = unit(graph, index);
            Screw {
                angular: cross(graph, e, m.v),
                linear: cross(graph, m.w, e),
            }
        }
        _ => Screw {
            angular: none,
            linear: m.v,
        },
    }
}

/// The wrench that holds one unit of the parameter against gravity.
pub fn weight(graph: &mut Graph, m: &Motion, index: usize) -> Screw {
    let none = zero(graph);
    let up = m.g.map(|x| -x);
    match index {
        0..=5 => Screw {
            angular: none,
            linear: none,
        },
        6..=8 => {
            let e = unit(graph, index);
            Screw {
                angular: cross(graph, e, up),
                linear: none,
            }
        }
        _ => Screw {
            angular: none,
            linear: up,
        },
    }
}
