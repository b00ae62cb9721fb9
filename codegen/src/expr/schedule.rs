//! Which nodes a set of outputs needs, in an order in which they can be computed.

use super::graph::{Expr, Graph, Node};

/// The operands of a node.
pub fn operands(node: Node) -> impl Iterator<Item = Expr> {
    let pair = match node {
        Node::Add(a, b) | Node::Sub(a, b) | Node::Mul(a, b) => [Some(a), Some(b)],
        Node::Call(_, a) => [Some(a), None],
        Node::Constant(_) | Node::Input(_) | Node::Sin(_) | Node::Cos(_) => [None, None],
    };
    pair.into_iter().flatten()
}

/// How often each node is used by the outputs, directly or through other nodes; 0: not needed.
pub fn uses(graph: &Graph, outputs: &[Expr]) -> Vec<usize> {
    let mut uses = vec![0; graph.nodes().len()];
    for output in outputs {
        uses[output.node()] += 1;
    }
    for index in (0..graph.nodes().len()).rev() {
        if uses[index] > 0 {
            for operand in operands(graph.nodes()[index]) {
                uses[operand.node()] += 1;
            }
        }
    }
    uses
}

/// The nodes needed for the outputs, depth first from each output in turn: a value is computed
/// shortly before its first use, and an output can be stored as soon as it is known.
pub fn order(graph: &Graph, outputs: &[Expr]) -> Vec<usize> {
    order_among(graph.nodes(), outputs)
}

/// The same where operands may have any index.
pub fn order_among(nodes: &[Node], outputs: &[Expr]) -> Vec<usize> {
    let mut seen = vec![false; nodes.len()];
    let mut order = Vec::new();
    let mut stack = Vec::new();
    for output in outputs {
        stack.push((output.node(), false));
        while let Some((index, ready)) = stack.pop() {
            if ready {
                order.push(index);
            } else if !seen[index] {
                seen[index] = true;
                stack.push((index, true));
                // Later operands first: the stack turns the order round.
                let mut list: Vec<_> = operands(nodes[index]).collect();
                list.reverse();
                stack.extend(list.into_iter().map(|operand| (operand.node(), false)));
            }
        }
    }
    order
}
