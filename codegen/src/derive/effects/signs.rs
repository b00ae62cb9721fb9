//! The direction of a motion whose velocity is known up to noise.

use crate::expr::{Expr, Function, Graph, Input};

/// Velocities below which a joint's direction is not certain, rad/s or m/s; nothing stands for 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Signs<'a>(pub &'a [f64]);

impl Signs<'_> {
    /// The band of a joint.
    pub(super) fn band(self, joint: usize) -> f64 {
        self.0.get(joint).copied().unwrap_or(0.0)
    }

    /// The sign of a joint's velocity.
    pub(super) fn of_joint(self, graph: &mut Graph, joint: usize) -> Expr {
        let qd = graph.input(Input::Qd(joint));
        self.of(graph, qd, self.band(joint))
    }

    /// The sign of a velocity; within `band` of rest it is v / band. As
    /// (|v / band + 1| - |v / band - 1|) / 2, so that the graph needs no function of its own for it.
    pub(super) fn of(self, graph: &mut Graph, velocity: Expr, band: f64) -> Expr {
        if band <= 0.0 {
            return graph.call(Function::Sign, velocity);
        }
        let relative = graph.scale(1.0 / band, velocity);
        let one = graph.one();
        let [above, below] = [one, -one].map(|by| {
            let moved = graph.add(relative, by);
            graph.call(Function::Abs, moved)
        });
        let twice = graph.sub(above, below);
        graph.scale(0.5, twice)
    }
}
