//! Values of expressions at a point drawn at random, modulo a prime: which expressions are equal.
//!
//! Two expressions of different form are the same function of the state if, as polynomials in the
//! inputs and half-angle tangents, their difference vanishes. One that does not vanish does so at
//! a random point of the field with probability degree / 2^61 (Schwartz 1980, "Fast probabilistic
//! algorithms for verification of polynomial identities"): with all comparisons of a large robot
//! less than one in 10^8. Unlike in floating point there is no rounding, hence no tolerance:
//! constants are taken for what they are, m * 2^e.

use std::hash::{DefaultHasher, Hash, Hasher};

use super::angle::AngleSum;
use super::graph::{Expr, Graph, Node};

/// The Mersenne prime 2^61 - 1.
const PRIME: u64 = (1 << 61) - 1;

/// A number modulo 2^61 - 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Residue(u64);

impl Residue {
    /// The number 0.
    pub const ZERO: Residue = Residue(0);

    /// A random number, the same for the same key.
    fn drawn(key: impl Hash) -> Residue {
        let mut hasher = DefaultHasher::new();
        key.hash(&mut hasher);
        Residue(hasher.finish() % PRIME)
    }

    /// A finite number, m * 2^e; the order of 2 is 61.
    fn constant(value: f64) -> Residue {
        let bits = value.abs().to_bits();
        let (exponent, fraction) = ((bits >> 52) as i64, bits & ((1 << 52) - 1));
        let mantissa = fraction | u64::from(exponent > 0) << 52;
        let power = Residue(1 << (exponent.max(1) - 1075).rem_euclid(61));
        (Residue(mantissa) * power).signed(value < 0.0)
    }

    /// 1/x; 0 for 0.
    pub fn reciprocal(self) -> Residue {
        // Fermat: x^(p - 2), and p - 2 has every bit but the second.
        let powers = std::iter::successors(Some(self), |&x| Some(x * x));
        let factors = powers.take(61).enumerate().filter(|&(bit, _)| bit != 1);
        factors.fold(Residue(1), |product, (_, power)| product * power)
    }

    /// Its negative if asked for.
    pub fn signed(self, negative: bool) -> Residue {
        if negative { -self } else { self }
    }

    /// The number itself, 0 to p - 1.
    pub fn bits(self) -> u64 {
        self.0
    }

    /// What a number and its negative have in common.
    pub fn magnitude(self) -> u64 {
        self.0.min((-self).0)
    }
}

impl std::ops::Neg for Residue {
    type Output = Residue;
    fn neg(self) -> Residue {
        Residue(if self.0 == 0 { 0 } else { PRIME - self.0 })
    }
}

impl std::ops::Add for Residue {
    type Output = Residue;
    fn add(self, other: Residue) -> Residue {
        let sum = self.0 + other.0;
        Residue(if sum >= PRIME { sum - PRIME } else { sum })
    }
}

impl std::ops::Sub for Residue {
    type Output = Residue;
    fn sub(self, other: Residue) -> Residue {
        self + -other
    }
}

impl std::ops::Mul for Residue {
    type Output = Residue;
    fn mul(self, other: Residue) -> Residue {
        let product = u128::from(self.0) * u128::from(other.0);
        Residue(product as u64 & PRIME) + Residue((product >> 61) as u64)
    }
}

/// The values of all nodes of a graph, by node.
pub fn residues(graph: &Graph) -> Vec<Residue> {
    let angles: Vec<_> = (0..graph.angle_count())
        .map(|index| sin_cos(graph.angle(index)))
        .collect();
    let mut values: Vec<Residue> = Vec::with_capacity(graph.nodes().len());
    for &node in graph.nodes() {
        let of = |x: Expr| values[x.node()].signed(x.is_negative());
        let value = match node {
            Node::Constant(bits) => Residue::constant(f64::from_bits(bits)),
            Node::Input(input) => Residue::drawn(input),
            Node::Sin(angle) => angles[angle].0,
            Node::Cos(angle) => angles[angle].1,
            Node::Add(a, b) => of(a) + of(b),
            Node::Sub(a, b) => of(a) - of(b),
            Node::Mul(a, b) => of(a) * of(b),
            Node::Call(function, a) => Residue::drawn((function, of(a))),
        };
        values.push(value);
    }
    values
}

/// Sine and cosine of an angle, by the theorems of addition.
fn sin_cos(angle: &AngleSum) -> (Residue, Residue) {
    let joints = angle.terms.iter();
    let turns = joints.map(|&(joint, factor)| one(Some(joint), factor));
    let offset = angle.offset.value();
    let start = match offset {
        0.0 => (Residue::ZERO, Residue(1)),
        offset => one(None, offset),
    };
    turns.fold(start, |(s, c), (sin, cos)| {
        (s * cos + c * sin, c * cos - s * sin)
    })
}

/// Sine and cosine of one joint's angle times a factor, or of an offset: of a random tangent t of
/// half of it 2 t / (1 + t^2) and (1 - t^2) / (1 + t^2).
fn one(joint: Option<usize>, factor: f64) -> (Residue, Residue) {
    let tangent = Residue::drawn((joint, factor.abs().to_bits()));
    let square = tangent * tangent;
    let over = (Residue(1) + square).reciprocal();
    let sine = (tangent + tangent) * over;
    (sine.signed(factor < 0.0), (Residue(1) - square) * over)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Angle, Input};

    #[test]
    fn arithmetic_is_that_of_a_field() {
        let values = [0.1, -3.0, 1e-300, 4.9e-324, 1e300].map(Residue::constant);
        for a in values {
            assert_eq!(a * a.reciprocal(), Residue(1));
            for b in values {
                assert_eq!((a + b) * (a - b), a * a - b * b);
            }
        }
        let quarter = Residue::constant(0.25);
        assert_eq!(quarter + quarter, Residue::constant(0.5));
    }

    #[test]
    fn equal_expressions_of_different_form_have_equal_values() {
        let mut graph = Graph::new();
        let (both, first) = ([(0, 1.0), (1, -1.0)], [(0, 1.0)]);
        let (s01, c01) = graph.sin_cos(&AngleSum::of(&both, Angle::radians(0.3)));
        let (s0, c0) = graph.sin_cos(&AngleSum::of(&first, Angle::radians(0.3)));
        let (s1, c1) = graph.sin_cos(&AngleSum::of(&[(1, 1.0)], Angle::ZERO));
        let (sc, cs) = (graph.mul(s0, c1), graph.mul(c0, s1));
        let sine = graph.sub(sc, cs);
        let squares = [s1, c1].map(|x| graph.mul(x, x));
        let unit = graph.add(squares[0], squares[1]);
        let q = graph.input(Input::Q(1));
        let values = residues(&graph);
        assert_eq!(values[sine.node()], values[s01.node()]);
        assert_eq!(values[unit.node()], Residue(1));
        for other in [c01, s0, c1, q] {
            assert_ne!(
                values[sine.node()].magnitude(),
                values[other.node()].magnitude()
            );
        }
    }
}
