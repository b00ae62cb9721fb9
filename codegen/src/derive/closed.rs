//! Closed loops in the graph: turns of their joints, and G and its rate by differentiation.

use super::coordinate::{Coordinate, Share};
use crate::expr::derivative::derivative;
use crate::expr::{Expr, Function, Graph, Input};
use crate::mechanism::Mechanism;
use crate::mechanism::plane::{Algebra, Complex};

/// A joint that a closed loop moves: cosine and sine of its position, and how it moves with each
/// driven joint, dq = sum of ratios times dq of those.
#[derive(Clone, Debug)]
pub struct Closed {
    /// Cosine and sine.
    pub turn: Complex<Expr>,
    /// Entries of G with their rates.
    pub shares: Vec<Share>,
}

/// The joints of every dyad, in the order of [`Mechanism::dyads`].
pub fn solved(graph: &mut Graph, mechanism: &Mechanism) -> Vec<[Closed; 3]> {
    let mut all: Vec<[Closed; 3]> = vec![];
    for (place, dyad) in mechanism.dyads.iter().enumerate() {
        let mut algebra = Symbols {
            graph,
            mechanism,
            known: &all,
        };
        let turns = dyad.turns(&mut algebra);
        let closed = [0, 1, 2].map(|index| {
            let name = format!("{}_{}", place + 1, index + 1);
            graph.name(turns[index].re, &format!("cos_loop{name}"));
            graph.name(turns[index].im, &format!("sin_loop{name}"));
            closed(graph, turns[index], &dyad.drivers)
        });
        all.push(closed);
    }
    all
}

/// With c = cos, s = sin of a position, dq = c ds - s dc.
fn closed(graph: &mut Graph, turn: Complex<Expr>, drivers: &[usize]) -> Closed {
    let shares = drivers.iter().map(|&joint| {
        let along = |graph: &mut Graph, other: usize| match other == joint {
            true => graph.one(),
            false => graph.zero(),
        };
        let ds = derivative(graph, turn.im, &along);
        let dc = derivative(graph, turn.re, &along);
        let (first, second) = (graph.mul(turn.re, ds), graph.mul(turn.im, dc));
        let ratio = graph.sub(first, second);
        let in_time = |graph: &mut Graph, joint: usize| graph.input(Input::Qd(joint));
        let rate = derivative(graph, ratio, &in_time);
        Share { joint, ratio, rate }
    });
    Closed {
        shares: shares.collect(),
        turn,
    }
}

/// Expressions of a graph as numbers of the plane.
struct Symbols<'a> {
    graph: &'a mut Graph,
    mechanism: &'a Mechanism,
    known: &'a [[Closed; 3]],
}

impl Algebra for Symbols<'_> {
    type Value = Expr;
    fn constant(&mut self, value: f64) -> Expr {
        self.graph.constant(value)
    }
    fn add(&mut self, a: Expr, b: Expr) -> Expr {
        self.graph.add(a, b)
    }
    fn mul(&mut self, a: Expr, b: Expr) -> Expr {
        self.graph.mul(a, b)
    }
    fn root(&mut self, a: Expr) -> Expr {
        self.graph.call(Function::Root, a)
    }
    fn reciprocal(&mut self, a: Expr) -> Expr {
        self.graph.call(Function::Reciprocal, a)
    }
    fn turn(&mut self, joint: usize) -> Complex<Expr> {
        Coordinate::of(self.mechanism, self.known, joint).turn(self.graph)
    }
    fn position(&mut self, joint: usize) -> Expr {
        Coordinate::of(self.mechanism, self.known, joint).position(self.graph)
    }
}
