//! Plane rotations that remember what they turned.
//!
//! Along parallel axes a vector is turned again and again in one plane. When what was turned first
//! is sparse, turning it once by the sum of the angles (C23, S23) is cheaper than turning the
//! result: [`Rotator`] keeps where each pair came from and chooses.

use std::collections::HashMap;

use super::angle::{Angle, AngleSum};
use super::graph::{Expr, Graph};

/// An angle to turn by.
#[derive(Clone, Debug, PartialEq)]
pub enum Turn {
    /// A sum of positions and a constant.
    Angle(AngleSum),
    /// One of which sine and cosine are expressions, plus a constant.
    Pair {
        /// Sine without the constant.
        sine: Expr,
        /// Cosine without the constant.
        cosine: Expr,
        /// The constant.
        offset: Angle,
    },
}

impl Turn {
    /// A constant turn.
    pub fn constant(angle: Angle) -> Turn {
        Turn::Angle(AngleSum::constant(angle))
    }

    /// Sine and cosine.
    pub fn sin_cos(&self, graph: &mut Graph) -> (Expr, Expr) {
        match self {
            Turn::Angle(angle) => graph.sin_cos(angle),
            Turn::Pair {
                sine,
                cosine,
                offset,
            } => {
                let (s, c) = offset.sin_cos();
                let (ss, cs) = (graph.scale(s, *sine), graph.scale(s, *cosine));
                let (sc, cc) = (graph.scale(c, *sine), graph.scale(c, *cosine));
                (graph.add(sc, cs), graph.sub(cc, ss))
            }
        }
    }

    /// The turn back.
    pub fn negated(&self) -> Turn {
        match self {
            Turn::Angle(angle) => Turn::Angle(angle.negated()),
            Turn::Pair {
                sine,
                cosine,
                offset,
            } => Turn::Pair {
                sine: -*sine,
                cosine: *cosine,
                offset: -*offset,
            },
        }
    }
}

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

    /// The same by any turn; only sums of angles are remembered.
    pub fn by(&mut self, graph: &mut Graph, pair: (Expr, Expr), turn: &Turn) -> (Expr, Expr) {
        match turn {
            Turn::Angle(angle) if angle.terms.is_empty() && angle.offset.is_zero() => pair,
            Turn::Angle(angle) => self.into_frame(graph, pair, angle),
            Turn::Pair {
                sine,
                cosine,
                offset,
            } => {
                let pair = self.by(graph, pair, &Turn::Angle(AngleSum::constant(*offset)));
                turned(graph, pair, (*sine, *cosine))
            }
        }
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
        let sin_cos = graph.sin_cos(&angle);
        let turned = turned(graph, (x, y), sin_cos);
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

/// (c x + s y, -s x + c y).
fn turned(graph: &mut Graph, (x, y): (Expr, Expr), (s, c): (Expr, Expr)) -> (Expr, Expr) {
    let cx = graph.mul(c, x);
    let sy = graph.mul(s, y);
    let sx = graph.mul(s, x);
    let cy = graph.mul(c, y);
    (graph.add(cx, sy), graph.sub(cy, sx))
}
