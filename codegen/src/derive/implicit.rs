//! P and R: the implicit dynamic model, F X = d/dt(P X) + R X (Gautier 1996, eqs. 7-9).
//!
//! P is the momentum seen by each joint, R = -dL/dq = -<V x S, momentum> + dU/dq.

use crate::expr::{Expr, Graph};

use super::body;
use super::explicit::pairing;
use super::motion::Motions;

/// Non-zero (joint, entry) of a column of P and of a column of R.
pub type Pair = (Vec<(usize, Expr)>, Vec<(usize, Expr)>);

/// The columns of P and R of the ten parameters of a link.
pub fn columns(graph: &mut Graph, motions: &Motions, link: usize) -> Vec<Pair> {
    let motion = motions.links[link];
    (0..10)
        .map(|index| {
            let momentum = body::momentum(graph, &motion, index);
            let weight = body::weight(graph, &motion, index);
            let mut pair = Pair::default();
            for mover in &motions.movers[link] {
                let p = pairing(graph, &mover.screw, &momentum);
                let kinetic = pairing(graph, &mover.rate, &momentum);
                let potential = pairing(graph, &mover.screw, &weight);
                let r = graph.sub(potential, kinetic);
                pair.0
                    .extend((!graph.is_zero(p)).then_some((mover.joint, p)));
                pair.1
                    .extend((!graph.is_zero(r)).then_some((mover.joint, r)));
            }
            pair
        })
        .collect()
}
