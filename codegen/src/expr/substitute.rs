//! Outputs of equal value with fewer operations: what is the sum, difference or product of two
//! values that are needed anyhow is computed so.
//!
//! Identities that no constructor sees come from the mechanics (a gyroscopic torque has no part
//! about the axis that it stems from) or from the lengths (a body carried along its own axis).
//! They are found by value ([`residue`](super::residue)), whatever their form. In the synthesis of
//! logic this is resubstitution (Brayton, Hachtel, Sangiovanni-Vincentelli 1990, "Multilevel logic
//! synthesis").

use std::collections::HashMap;

use super::graph::{Expr, Graph, Input, Node};
use super::needs::{Needs, price};
use super::residue::{Residue, residues};
use super::schedule::{operands, order_among};

/// Rewrites outputs so that together they need fewer operations. Each is the same function as
/// before; one that is zero everywhere becomes the constant.
pub fn substitute(graph: &mut Graph, outputs: &mut [Expr]) {
    let mut rewriting = Rewriting::new(graph, outputs);
    rewriting.sweep();
    rewriting.write(graph, outputs);
}

/// The nodes of a graph, some of them computed in another way.
struct Rewriting {
    /// How each node is computed; here operands may have signs and any index.
    nodes: Vec<Node>,
    outputs: Vec<Expr>,
    needs: Needs,
    values: Vec<Residue>,
    /// Reciprocals of the values of needed nodes.
    over: Vec<Residue>,
    /// The joints whose state a node depends on, a bit each.
    joints: Vec<u64>,
    /// The node of each value or its negative.
    known: HashMap<u64, usize>,
    sieve: Sieve,
}

impl Rewriting {
    fn new(graph: &Graph, outputs: &[Expr]) -> Rewriting {
        let count = graph.nodes().len();
        let mut rewriting = Rewriting {
            nodes: graph.nodes().to_vec(),
            outputs: vec![],
            needs: Needs::none(count),
            values: residues(graph),
            over: vec![Residue::ZERO; count],
            joints: joints(graph),
            known: HashMap::new(),
            sieve: Sieve::default(),
        };
        rewriting.merge(graph, outputs);
        for output in &rewriting.outputs {
            rewriting.needs.need(&rewriting.nodes, output.node());
        }
        rewriting
    }

    /// Leaves one node per value, the first in the order of computation.
    fn merge(&mut self, graph: &Graph, outputs: &[Expr]) {
        let constants = [graph.zero().node(), graph.one().node()];
        let order = order_among(&self.nodes, outputs);
        for node in constants.into_iter().chain(order) {
            self.nodes[node] = with_operands(self.nodes[node], |x| self.first(x));
            let value = self.values[node];
            self.known.entry(value.magnitude()).or_insert(node);
            self.over[node] = value.reciprocal();
        }
        self.outputs = outputs.iter().map(|&output| self.first(output)).collect();
        self.sieve = Sieve::of(self.known.values().map(|&node| self.values[node]));
    }

    /// The known node of an expression's value.
    fn first(&self, x: Expr) -> Expr {
        let value = self.values[x.node()].signed(x.is_negative());
        self.having(value).unwrap_or(x)
    }

    fn having(&self, value: Residue) -> Option<Expr> {
        let node = *self.known.get(&value.magnitude())?;
        Some(Expr::of(node).signed(self.values[node] != value))
    }

    /// Tries all needed nodes, the outputs first: what a node spares its operands no longer share.
    /// A second time finds nothing on any arm that was counted.
    fn sweep(&mut self) {
        let mut order = Order::new(&self.nodes, &self.outputs);
        for node in order.nodes.clone().into_iter().rev() {
            if self.needs.has(node) && self.shorten(node, &order) {
                order = Order::new(&self.nodes, &self.outputs);
            }
        }
    }

    /// Computes a node by one operation if that spares any that it alone needs.
    fn shorten(&mut self, node: usize, order: &Order) -> bool {
        let (old, before) = (self.nodes[node], self.needs.cost);
        if price(old) == 0 {
            return false;
        }
        for operand in operands(old) {
            self.needs.release(&self.nodes, operand.node());
        }
        let spares = self.needs.cost < before;
        let found = spares.then(|| self.find(node, order)).flatten();
        self.nodes[node] = found.unwrap_or(old);
        for operand in operands(self.nodes[node]) {
            self.needs.need(&self.nodes, operand.node());
        }
        found.is_some()
    }

    /// One operation on needed nodes that has the value of `node`.
    fn find(&self, node: usize, order: &Order) -> Option<Node> {
        let above = order.above(&self.nodes, node);
        let foreign = !self.joints[node];
        let at_hand = |x: usize| self.needs.has(x) || price(self.nodes[x]) == 0;
        let usable =
            |x: usize| self.joints[x] & foreign == 0 && at_hand(x) && !above[order.place[x]];
        let having = |value: Residue| -> Option<Expr> {
            let found = self.sieve.may_hold(value).then(|| self.having(value));
            found.flatten().filter(|y| usable(y.node()))
        };
        let value = self.values[node];
        let operands = order.nodes.iter().filter(|&&x| usable(x));
        let mut operands = operands.filter(|&&x| self.values[x] != Residue::ZERO);
        operands.find_map(|&x| {
            let (a, own) = (Expr::of(x), self.values[x]);
            let sum = having(value - own).map(|b| Node::Add(a, b));
            let difference = || having(value + own).map(|b| Node::Sub(b, a));
            let product = || having(value * self.over[x]).map(|b| Node::Mul(a, b));
            sum.or_else(difference).or_else(product)
        })
    }

    /// Writes what has changed into the graph.
    fn write(&self, graph: &mut Graph, outputs: &mut [Expr]) {
        let mut written: Vec<Expr> = (0..self.nodes.len()).map(Expr::of).collect();
        let at = |written: &[Expr], x: Expr| written[x.node()].signed(x.is_negative());
        for node in order_among(&self.nodes, &self.outputs) {
            let rewritten = with_operands(self.nodes[node], |x| at(&written, x));
            let new = match rewritten {
                Node::Add(a, b) => graph.add(a, b),
                Node::Sub(a, b) => graph.sub(a, b),
                Node::Mul(a, b) => graph.mul(a, b),
                Node::Call(function, a) => graph.call(function, a),
                Node::Constant(_) | Node::Input(_) | Node::Sin(_) | Node::Cos(_) => continue,
            };
            graph.rename(node, new);
            written[node] = new;
        }
        for (output, own) in outputs.iter_mut().zip(&self.outputs) {
            *output = at(&written, *own);
        }
    }
}

/// A node with other operands.
fn with_operands(node: Node, of: impl Fn(Expr) -> Expr) -> Node {
    match node {
        Node::Add(a, b) => Node::Add(of(a), of(b)),
        Node::Sub(a, b) => Node::Sub(of(a), of(b)),
        Node::Mul(a, b) => Node::Mul(of(a), of(b)),
        Node::Call(function, a) => Node::Call(function, of(a)),
        leaf => leaf,
    }
}

/// The joints whose state each node depends on; those of long chains share bits.
fn joints(graph: &Graph) -> Vec<u64> {
    let bit = |joint: usize| 1u64 << (joint % 64);
    let mut joints: Vec<u64> = Vec::with_capacity(graph.nodes().len());
    for &node in graph.nodes() {
        let own = match node {
            Node::Input(Input::Q(j) | Input::Qd(j) | Input::Qdd(j) | Input::Slip(j)) => bit(j),
            Node::Sin(angle) | Node::Cos(angle) => {
                let terms = graph.angle(angle).terms.iter();
                terms.fold(0, |bits, &(joint, _)| bits | bit(joint))
            }
            _ => 0,
        };
        joints.push(operands(node).fold(own, |bits, x| bits | joints[x.node()]));
    }
    joints
}

/// An order of computation.
struct Order {
    nodes: Vec<usize>,
    /// The place of each node in it; the end if it is not needed.
    place: Vec<usize>,
}

impl Order {
    fn new(nodes: &[Node], outputs: &[Expr]) -> Order {
        let order = order_among(nodes, outputs);
        let mut place = vec![order.len(); nodes.len()];
        for (index, &node) in order.iter().enumerate() {
            place[node] = index;
        }
        Order {
            nodes: order,
            place,
        }
    }

    /// Which places hold `node` or what is computed from it; the end holds nothing.
    fn above(&self, nodes: &[Node], node: usize) -> Vec<bool> {
        let mut above = vec![false; self.nodes.len() + 1];
        let own = self.place[node];
        above[own] = true;
        for place in own + 1..self.nodes.len() {
            let mut operands = operands(nodes[self.nodes[place]]);
            above[place] = operands.any(|operand| above[self.place[operand.node()]]);
        }
        above
    }
}

/// Says quickly of most values that they are not among some: a bit each of a word per value, so
/// that it stays in the fastest memory and lets one in 32 pass.
#[derive(Default)]
struct Sieve {
    bits: Vec<u64>,
}

impl Sieve {
    /// Of values and their negatives.
    fn of(values: impl ExactSizeIterator<Item = Residue>) -> Sieve {
        let mut bits = vec![0; values.len().next_power_of_two()];
        for value in values.flat_map(|value| [value, -value]) {
            let (word, bit) = Self::place(&bits, value);
            bits[word] |= bit;
        }
        Sieve { bits }
    }

    fn may_hold(&self, value: Residue) -> bool {
        let (word, bit) = Self::place(&self.bits, value);
        self.bits[word] & bit != 0
    }

    fn place(bits: &[u64], value: Residue) -> (usize, u64) {
        let hash = value.bits();
        ((hash >> 6) as usize & (bits.len() - 1), 1 << (hash & 63))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Angle, AngleSum, Operations};

    #[test]
    fn common_factor_is_taken_out_where_the_sum_is_needed_anyhow() {
        let mut graph = Graph::new();
        let [a, b, c] = [0, 1, 2].map(|joint| graph.input(Input::Qd(joint)));
        let (ab, ac, sum) = (graph.mul(a, b), graph.mul(a, c), graph.sub(b, c));
        let mut outputs = [graph.sub(ab, ac), sum];
        substitute(&mut graph, &mut outputs);
        assert_eq!(outputs, [graph.mul(a, sum), sum]);
    }

    #[test]
    fn theorem_of_pythagoras_saves_what_it_can() {
        let mut graph = Graph::new();
        let (s, c) = graph.sin_cos(&AngleSum::joint(0, Angle::ZERO));
        let q = graph.input(Input::Qd(0));
        let (ss, cc) = (graph.mul(s, s), graph.mul(c, c));
        let (ssq, ccq) = (graph.mul(ss, q), graph.mul(cc, q));
        let mut outputs = [graph.add(ssq, ccq), graph.sub(q, ccq)];
        let vanishing = graph.sub(ccq, q);
        let mut none = [graph.add(ssq, vanishing)];
        graph.name(outputs[1], "rest");
        substitute(&mut graph, &mut outputs);
        assert_eq!(outputs[0], q);
        assert_eq!(Operations::of(&graph, &outputs).mul, 2);
        substitute(&mut graph, &mut none);
        assert_eq!(none, [graph.zero()]);
    }
}
