//! Vectors of expressions.

use crate::expr::rotate::{Rotator, Turn};
use crate::expr::{Angle, AngleSum, Expr, Graph};

/// Names of the components of a vector.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// Three components.
pub type Vec3 = [Expr; 3];

/// A motion (angular, linear) or a wrench (moment, force), in one frame about its origin.
#[derive(Clone, Copy, Debug)]
pub struct Screw {
    /// Angular velocity, or moment.
    pub angular: Vec3,
    /// Linear velocity of the origin, or force.
    pub linear: Vec3,
}

impl Screw {
    /// `factor` times the screw.
    pub fn times(&self, graph: &mut Graph, factor: Expr) -> Screw {
        Screw {
            angular: self.angular.map(|x| graph.mul(factor, x)),
            linear: self.linear.map(|x| graph.mul(factor, x)),
        }
    }

    /// The sum of two screws.
    pub fn plus(&self, graph: &mut Graph, other: &Screw) -> Screw {
        Screw {
            angular: add(graph, self.angular, other.angular),
            linear: add(graph, self.linear, other.linear),
        }
    }
}

/// The zero vector.
pub fn zero(graph: &Graph) -> Vec3 {
    [graph.zero(); 3]
}

/// `a + b`.
pub fn add(graph: &mut Graph, a: Vec3, b: Vec3) -> Vec3 {
    [
        graph.add(a[0], b[0]),
        graph.add(a[1], b[1]),
        graph.add(a[2], b[2]),
    ]
}

/// `a . b`.
pub fn dot(graph: &mut Graph, a: Vec3, b: Vec3) -> Expr {
    let products = [
        graph.mul(a[0], b[0]),
        graph.mul(a[1], b[1]),
        graph.mul(a[2], b[2]),
    ];
    graph.sum(&products)
}

/// `a x b`.
pub fn cross(graph: &mut Graph, a: Vec3, b: Vec3) -> Vec3 {
    let mut component = |i: usize, j: usize| {
        let first = graph.mul(a[i], b[j]);
        let second = graph.mul(a[j], b[i]);
        graph.sub(first, second)
    };
    [component(1, 2), component(2, 0), component(0, 1)]
}

/// A constant vector.
pub fn constant(graph: &mut Graph, value: [f64; 3]) -> Vec3 {
    value.map(|x| graph.constant(x))
}

/// Components of a vector in a frame turned by gamma about z, alpha about x, `theta` about z.
pub fn into_frame(
    graph: &mut Graph,
    rotator: &mut Rotator,
    vector: Vec3,
    (gamma, alpha, theta): (Angle, Angle, &Turn),
) -> Vec3 {
    let [x, y, z] = vector;
    let (x, y) = rotator.by(graph, (x, y), &constant_turn(gamma));
    let (s, c) = alpha.sin_cos();
    let (y, z) = if alpha.is_zero() {
        (y, z)
    } else {
        let (s, c) = (graph.constant(s), graph.constant(c));
        let (cy, sz, sy, cz) = (
            graph.mul(c, y),
            graph.mul(s, z),
            graph.mul(s, y),
            graph.mul(c, z),
        );
        (graph.add(cy, sz), graph.sub(cz, sy))
    };
    let (x, y) = rotator.by(graph, (x, y), theta);
    [x, y, z]
}

/// Components in the frame before those turns, of a vector given after them.
pub fn out_of_frame(
    graph: &mut Graph,
    rotator: &mut Rotator,
    vector: Vec3,
    (gamma, alpha, theta): (Angle, Angle, &Turn),
) -> Vec3 {
    let none = constant_turn(Angle::ZERO);
    let turned = into_frame(
        graph,
        rotator,
        vector,
        (Angle::ZERO, Angle::ZERO, &theta.negated()),
    );
    let tilted = into_frame(graph, rotator, turned, (Angle::ZERO, -alpha, &none));
    into_frame(graph, rotator, tilted, (-gamma, Angle::ZERO, &none))
}

fn constant_turn(angle: Angle) -> Turn {
    Turn::Angle(AngleSum::constant(angle))
}
