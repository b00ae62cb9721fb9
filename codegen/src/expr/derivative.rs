//! Derivatives of expressions of positions alone.

use std::collections::HashMap;

use super::graph::{Expr, Function, Graph, Input, Node};
use super::schedule;

/// The derivative of `x`, given that of every position by joint: along one joint where that is 1
/// for it and 0 for all others, in time where they are the velocities. Functions that have no
/// derivative everywhere (signs) count as constant.
pub fn derivative(graph: &mut Graph, x: Expr, of: &dyn Fn(&mut Graph, usize) -> Expr) -> Expr {
    let mut known: HashMap<usize, Expr> = HashMap::new();
    for node in schedule::order(graph, &[x]) {
        let found = one(graph, node, &known, of);
        known.insert(node, found);
    }
    signed(&known, x).unwrap_or(graph.zero())
}

fn signed(known: &HashMap<usize, Expr>, x: Expr) -> Option<Expr> {
    let found = known.get(&x.node()).copied();
    found.map(|found| if x.is_negative() { -found } else { found })
}

fn one(
    graph: &mut Graph,
    node: usize,
    known: &HashMap<usize, Expr>,
    of: &dyn Fn(&mut Graph, usize) -> Expr,
) -> Expr {
    let zero = graph.zero();
    let rate = |x: Expr| signed(known, x).unwrap_or(zero);
    match graph.nodes()[node] {
        Node::Input(Input::Q(joint)) => of(graph, joint),
        Node::Constant(_) | Node::Input(_) => zero,
        Node::Sin(angle) => {
            let (turn, (_, cos)) = (turning(graph, angle, of), both(graph, angle));
            graph.mul(cos, turn)
        }
        Node::Cos(angle) => {
            let (turn, (sin, _)) = (turning(graph, angle, of), both(graph, angle));
            -graph.mul(sin, turn)
        }
        Node::Add(a, b) => graph.add(rate(a), rate(b)),
        Node::Sub(a, b) => graph.sub(rate(a), rate(b)),
        Node::Mul(a, b) => {
            let (first, second) = (graph.mul(rate(a), b), graph.mul(a, rate(b)));
            graph.add(first, second)
        }
        Node::Call(function, a) => {
            let slope = slope(graph, function, a);
            graph.mul(slope, rate(a))
        }
    }
}

/// The derivative of an angle.
fn turning(graph: &mut Graph, angle: usize, of: &dyn Fn(&mut Graph, usize) -> Expr) -> Expr {
    let terms = graph.angle(angle).terms.clone();
    terms.iter().fold(graph.zero(), |sum, &(joint, factor)| {
        let own = of(graph, joint);
        let term = graph.scale(factor, own);
        graph.add(sum, term)
    })
}

fn both(graph: &mut Graph, angle: usize) -> (Expr, Expr) {
    let angle = graph.angle(angle).clone();
    graph.sin_cos(&angle)
}

fn slope(graph: &mut Graph, function: Function, x: Expr) -> Expr {
    match function {
        Function::Reciprocal => {
            let value = graph.call(function, x);
            -graph.mul(value, value)
        }
        Function::Root => {
            let value = graph.call(function, x);
            let over = graph.call(Function::Reciprocal, value);
            graph.scale(0.5, over)
        }
        Function::RootOfOpposite => {
            let value = graph.call(Function::Root, -x);
            let over = graph.call(Function::Reciprocal, value);
            graph.scale(-0.5, over)
        }
        Function::Sine => graph.call(Function::Cosine, x),
        Function::Cosine => -graph.call(Function::Sine, x),
        _ => graph.zero(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::tape::{Batch, Tape};
    use crate::expr::{Angle, AngleSum};

    fn value(graph: &Graph, x: Expr, q: f64) -> f64 {
        let mut value = [0.0];
        let batch = Batch {
            len: 1,
            q: &[q],
            qd: &[0.0],
            qdd: &[0.0],
            slip: &[],
        };
        Tape::new(graph, &[x]).run(&batch, &mut value);
        value[0]
    }

    #[test]
    fn derivatives_are_limits_of_differences() {
        let mut graph = Graph::new();
        let angle = AngleSum::of(&[(0, 1.5)], Angle::radians(0.2));
        let (sin, cos) = graph.sin_cos(&angle);
        let q = graph.input(Input::Q(0));
        let two = graph.constant(2.0);
        let inside = graph.add(two, sin);
        let root = graph.call(Function::Root, inside);
        let opposite = graph.sub(cos, two);
        let other = graph.call(Function::Root, -opposite);
        let over = graph.call(Function::Reciprocal, root);
        let product = graph.mul(over, q);
        let sum = graph.sub(product, other);
        let x = graph.mul(sum, -cos);
        let slope = derivative(&mut graph, x, &|graph, _| graph.one());
        for q in [-1.3, 0.1, 0.9] {
            let step = 1e-5;
            let difference =
                (value(&graph, x, q + step) - value(&graph, x, q - step)) / (2.0 * step);
            assert!((value(&graph, slope, q) - difference).abs() < 1e-8);
        }
    }
}
