//! The position of a joint and its rates as expressions of those of the driven joints.

use super::closed::Closed;
use crate::expr::rotate::Turn;
use crate::expr::{Angle, AngleSum, Expr, Graph, Input};
use crate::mechanism::plane::Complex;
use crate::mechanism::{Affine, Follow, Joint, JointKind, Mechanism};

/// The coordinate of one joint: its own input where it has a drive, otherwise what it follows.
#[derive(Clone, Debug)]
pub enum Coordinate {
    /// A sum of positions: G is constant.
    Sum(Affine),
    /// A joint that turns in a closed loop.
    Closed(Closed),
}

/// How a joint moves with a driven one.
#[derive(Clone, Copy, Debug)]
pub struct Share {
    /// The driven joint.
    pub joint: usize,
    /// dq / dq of that joint: an entry of G.
    pub ratio: Expr,
    /// Its derivative in time: an entry of dG/dt.
    pub rate: Expr,
}

impl Coordinate {
    /// Of a joint of a mechanism, in which loops are solved.
    pub fn of(mechanism: &Mechanism, solved: &[[Closed; 3]], joint: usize) -> Coordinate {
        match mechanism.follow(joint) {
            Follow::Sum(sum) => Coordinate::Sum(sum),
            Follow::Dyad { dyad, index } => Coordinate::Closed(solved[dyad][index].clone()),
        }
    }

    /// q of a joint that slides, m; joints in closed loops turn.
    pub fn position(&self, graph: &mut Graph) -> Expr {
        match self {
            Coordinate::Sum(sum) => {
                let offset = graph.constant(sum.offset);
                weighted(graph, sum, Input::Q, offset)
            }
            Coordinate::Closed(_) => graph.zero(),
        }
    }

    /// Its first derivative, G qd.
    pub fn velocity(&self, graph: &mut Graph) -> Expr {
        let zero = graph.zero();
        match self {
            Coordinate::Sum(sum) => weighted(graph, sum, Input::Qd, zero),
            Coordinate::Closed(closed) => closed.shares.iter().fold(zero, |sum, share| {
                let qd = graph.input(Input::Qd(share.joint));
                let term = graph.mul(share.ratio, qd);
                graph.add(sum, term)
            }),
        }
    }

    /// Its second derivative, G qdd + dG/dt qd.
    pub fn acceleration(&self, graph: &mut Graph) -> Expr {
        let zero = graph.zero();
        match self {
            Coordinate::Sum(sum) => weighted(graph, sum, Input::Qdd, zero),
            Coordinate::Closed(closed) => closed.shares.iter().fold(zero, |sum, share| {
                let qdd = graph.input(Input::Qdd(share.joint));
                let qd = graph.input(Input::Qd(share.joint));
                let (term, swept) = (graph.mul(share.ratio, qdd), graph.mul(share.rate, qd));
                let both = graph.add(term, swept);
                graph.add(sum, both)
            }),
        }
    }

    /// The turn between the x axes of the joint's antecedent, after gamma and alpha, and its link.
    pub fn angle(&self, joint: &Joint) -> Turn {
        match self {
            _ if joint.kind == JointKind::Prismatic => Turn::Angle(AngleSum::constant(joint.theta)),
            Coordinate::Sum(sum) => {
                let theta = match sum.offset {
                    0.0 => joint.theta,
                    offset => joint.theta + Angle::radians(offset),
                };
                Turn::Angle(AngleSum::of(&sum.terms, theta))
            }
            Coordinate::Closed(closed) => Turn::Pair {
                sine: closed.turn.im,
                cosine: closed.turn.re,
                offset: joint.theta,
            },
        }
    }

    /// Cosine and sine of the position.
    pub fn turn(&self, graph: &mut Graph) -> Complex<Expr> {
        match self {
            Coordinate::Sum(sum) => {
                let angle = AngleSum::of(&sum.terms, Angle::radians(sum.offset));
                let (im, re) = graph.sin_cos(&angle);
                Complex { re, im }
            }
            Coordinate::Closed(closed) => closed.turn,
        }
    }

    /// The driven joints that it moves with.
    pub fn shares(&self, graph: &mut Graph) -> Vec<Share> {
        match self {
            Coordinate::Closed(closed) => closed.shares.clone(),
            Coordinate::Sum(sum) => {
                let constant = |&(joint, factor): &(usize, f64)| Share {
                    joint,
                    ratio: graph.constant(factor),
                    rate: graph.zero(),
                };
                sum.terms.iter().map(constant).collect()
            }
        }
    }
}

fn weighted(graph: &mut Graph, sum: &Affine, input: fn(usize) -> Input, offset: Expr) -> Expr {
    let terms = sum.terms.iter();
    terms.fold(offset, |sum, &(joint, factor)| {
        let own = graph.input(input(joint));
        let term = graph.scale(factor, own);
        graph.add(sum, term)
    })
}
