//! Operation counts of a set of outputs.

use super::graph::{Expr, Graph, Node};
use super::schedule;

/// Operations by kind. A product of k factors counts k-1, a sum of k terms k-1, a square 1, a
/// factor -1 nothing, one sine or one cosine 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Multiplications.
    pub mul: usize,
    /// Additions and subtractions.
    pub add: usize,
    /// Sines and cosines.
    pub trig: usize,
}

impl Operations {
    /// Counts what the outputs need, each shared node once.
    pub fn of(graph: &Graph, outputs: &[Expr]) -> Operations {
        let mut count = Operations::default();
        for index in schedule::order(graph, outputs) {
            match graph.nodes()[index] {
                Node::Mul(..) => count.mul += 1,
                Node::Add(..) | Node::Sub(..) => count.add += 1,
                Node::Sin(_) | Node::Cos(_) => count.trig += 1,
                Node::Constant(_) | Node::Input(_) | Node::Call(..) => {}
            }
        }
        count
    }
}
