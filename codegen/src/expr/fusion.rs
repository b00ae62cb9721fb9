//! Which products are rounded together with the sum that they enter.
//!
//! The tape and the emitted Rust both ask here, so that they round alike.

use super::graph::{Expr, Graph, Node};

/// The products that enter one sum and nothing else, at most one of each sum: `a * b + c` is one
/// instruction then. `uses` is what [`uses`](super::schedule::uses) counts.
pub fn fused(graph: &Graph, uses: &[usize]) -> Vec<bool> {
    let mut fused = vec![false; uses.len()];
    let needed = graph
        .nodes()
        .iter()
        .zip(uses)
        .filter(|(_, uses)| **uses > 0);
    for (node, _) in needed {
        if let Node::Add(a, b) | Node::Sub(a, b) = *node {
            let product = [b, a].into_iter().map(Expr::node).find(|&operand| {
                uses[operand] == 1 && matches!(graph.nodes()[operand], Node::Mul(..))
            });
            if let Some(product) = product {
                fused[product] = true;
            }
        }
    }
    fused
}

#[cfg(test)]
mod tests {
    use super::super::graph::Input;
    use super::super::schedule::uses;
    use super::*;

    #[test]
    fn products_used_once_go_into_their_sum_one_of_each() {
        let mut graph = Graph::new();
        let [a, b, c] = [0, 1, 2].map(|joint| graph.input(Input::Qd(joint)));
        let (ab, bc, ca) = (graph.mul(a, b), graph.mul(b, c), graph.mul(c, a));
        let sum = graph.add(ab, bc);
        let difference = graph.sub(sum, ca);
        let found = |outputs: &[Expr]| {
            let fused = fused(&graph, &uses(&graph, outputs));
            [ab, bc, ca].map(|product| fused[product.node()])
        };
        assert_eq!(found(&[difference]), [false, true, true]);
        assert_eq!(found(&[difference, ca]), [false, true, false]);
        assert_eq!(found(&[sum, bc]), [true, false, false]);
        assert_eq!(found(&[ab, bc]), [false; 3]);
    }
}
