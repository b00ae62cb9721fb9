//! Plane rotations that remember what they turned.
//!
//! Along parallel axes a vector is turned again and again in one plane. When what was turned first
//! is sparse, turning it once by the sum of the angles (C23, S23) is cheaper than turning the
//! result: [`Rotator`] keeps where each pair came from and chooses.

use std::collections::HashMap;

use super::angle::AngleSum;
use super::graph::{Expr, Graph};

/// Where a pair of components came from: `turned` by `angle`.
#[derive(Clone, Debug)]
struct Origin {
    turned: (Expr, Expr),
    angle: AngleSum,
}

/// Turns pairs of components about z, merging successive angles where that saves operations.
#[derive(Clone, Debug, Default)]
pub struct Rotator {
    origins: HashMap<(Expr, Expr), Origin>,
}

impl Rotator {
    /// Components in a frame that is turned by `angle` about z:
    /// (c x + s y, -s x + c y).
    pub fn into_frame(
        &mut self,
        graph: &mut Graph,
        (x, y): (Expr, Expr),
        angle: &AngleSum,
    ) -> (Expr, Expr) {
        if graph.is_zero(x) && graph.is_zero(y) {
            return (x, y);
        }
        if let Some(origin) = self.origin((x, y)) {
            let (ux, uy) = origin.turned;
            if graph.is_zero(ux) || graph.is_zero(uy) {
                let total = origin.angle.plus(angle);
                return self.turn(graph, origin.turned, total);
            }
        }
        self.turn(graph, (x, y), angle.clone())
    }

    /// The origin of a pair, or of its mirror image (x, -y) as axes of opposite sense have it.
    fn origin(&self, (x, y): (Expr, Expr)) -> Option<Origin> {
        if let Some(origin) = self.origins.get(&(x, y)) {
            return Some(origin.clone());
        }
        let mirrored = self.origins.get(&(x, -y))?;
        let (ux, uy) = mirrored.turned;
        Some(Origin {
            turned: (ux, -uy),
            angle: mirrored.angle.negated(),
        })
    }

    fn turn(&mut self, graph: &mut Graph, (x, y): (Expr, Expr), angle: AngleSum) -> (Expr, Expr) {
        let (s, c) = graph.sin_cos(&angle);
        let cx = graph.mul(c, x);
        let sy = graph.mul(s, y);
        let sx = graph.mul(s, x);
        let cy = graph.mul(c, y);
        let turned = (graph.add(cx, sy), graph.sub(cy, sx));
        self.origins.insert(
            turned,
            Origin {
                turned: (x, y),
                angle,
            },
        );
        turned
    }
}
