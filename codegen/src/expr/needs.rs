//! What a changing set of outputs needs: how often each node is used, and the operations of all.

use super::graph::Node;
use super::schedule::operands;

/// Uses of every node and the operations of those that are used, each once.
#[derive(Clone, Debug)]
pub struct Needs {
    uses: Vec<u32>,
    /// Multiplications and additions.
    pub cost: usize,
}

impl Needs {
    /// Nothing is needed of so many nodes.
    pub fn none(nodes: usize) -> Needs {
        Needs {
            uses: vec![0; nodes],
            cost: 0,
        }
    }

    /// Whether anything uses the node.
    pub fn has(&self, node: usize) -> bool {
        self.uses[node] > 0
    }

    /// One more use of a node, and of what it is made from if it is the first.
    pub fn need(&mut self, nodes: &[Node], node: usize) {
        self.uses[node] += 1;
        if self.uses[node] == 1 {
            self.cost += price(nodes[node]);
            for operand in operands(nodes[node]) {
                self.need(nodes, operand.node());
            }
        }
    }

    /// One use less of a node, and of what it is made from if it was the last.
    pub fn release(&mut self, nodes: &[Node], node: usize) {
        self.uses[node] -= 1;
        if self.uses[node] == 0 {
            self.cost -= price(nodes[node]);
            for operand in operands(nodes[node]) {
                self.release(nodes, operand.node());
            }
        }
    }
}

/// Operations of a node itself.
pub fn price(node: Node) -> usize {
    usize::from(matches!(
        node,
        Node::Add(..) | Node::Sub(..) | Node::Mul(..)
    ))
}
