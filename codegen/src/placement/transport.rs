//! Screws and wrenches in the frames between a link and the base.

use crate::derive::body;
use crate::derive::coordinate::Coordinate;
use crate::derive::motion::{Motions, Mover};
use crate::derive::vector::{Screw, add, constant, cross, out_of_frame};
use crate::expr::Graph;
use crate::mechanism::{JointKind, Mechanism};

/// A frame on the way from a link to the base.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// The frame of a link.
    Link(usize),
    /// The axes of a link's antecedent at the place of the link's own joint: turned back, not yet
    /// moved back.
    Turned(usize),
}

/// The frames from a link to the base, the link's own first.
pub fn path(mechanism: &Mechanism, link: usize) -> Vec<Frame> {
    let mut path = vec![];
    for &joint in mechanism.chain(link).iter().rev() {
        path.push(Frame::Link(joint));
        if mechanism.joints[joint].parent.is_some() {
            path.push(Frame::Turned(joint));
        }
    }
    path
}

/// The driven joints that move a link and with it each frame of its path as one body, with their
/// screws there. Where a joint of the path follows a driven one, the frames behind it move with
/// that in another way, and have no screw of it.
pub fn movers_along(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &Motions,
    link: usize,
) -> Vec<Vec<Mover>> {
    let mut passed: Vec<usize> = vec![];
    let mut all = vec![];
    for frame in path(mechanism, link) {
        if let Frame::Turned(joint) = frame {
            passed.extend(mechanism.moves_with(joint));
        }
        let mut movers = movers(graph, mechanism, motions, frame);
        movers.retain(|mover| !passed.contains(&mover.joint));
        all.push(movers);
    }
    all
}

/// The joints that move a frame, with their screws there.
fn movers(graph: &mut Graph, mechanism: &Mechanism, motions: &Motions, frame: Frame) -> Vec<Mover> {
    let joint = match frame {
        Frame::Link(link) => return motions.movers[link].clone(),
        Frame::Turned(joint) => &mechanism.joints[joint],
    };
    let Some(parent) = joint.parent else {
        return vec![];
    };
    let position = constant(graph, joint.position);
    let mut moved = |screw: &Screw| {
        let swept = cross(graph, screw.angular, position);
        let linear = add(graph, screw.linear, swept);
        Screw { linear, ..*screw }
    };
    let above = motions.movers[parent].iter();
    above
        .map(|mover| Mover {
            joint: mover.joint,
            screw: moved(&mover.screw),
            rate: moved(&mover.rate),
        })
        .collect()
}

/// What one unit of a parameter does to its link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Share {
    /// The wrench of inertia and gravity, for D.
    Wrench,
    /// The momentum, for P and the kinetic part of R.
    Momentum,
    /// The wrench against gravity, for the potential part of R.
    Weight,
}

/// The share of a parameter in every frame of the path of its link.
pub fn shares(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &mut Motions,
    (link, index): (usize, usize),
    share: Share,
) -> Vec<Screw> {
    let motion = motions.links[link];
    let mut screw = match share {
        Share::Wrench => body::wrench(graph, &motion, index),
        Share::Momentum => body::momentum(graph, &motion, index),
        Share::Weight => body::weight(graph, &motion, index),
    };
    let mut screws = vec![];
    for frame in path(mechanism, link) {
        if let Frame::Turned(joint) = frame {
            screw = turned(graph, mechanism, motions, joint, screw);
        }
        screws.push(screw);
        if let Frame::Turned(joint) = frame {
            // On to the antecedent's own origin, where the path goes next.
            screw = moved(graph, mechanism, joint, screw);
        }
    }
    screws
}

/// A wrench in a link's frame, in the frame of its antecedent.
pub fn back(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &mut Motions,
    joint: usize,
    wrench: Screw,
) -> Screw {
    let turned = turned(graph, mechanism, motions, joint, wrench);
    moved(graph, mechanism, joint, turned)
}

/// A wrench at the place of a joint, about the origin of its antecedent.
fn moved(graph: &mut Graph, mechanism: &Mechanism, joint: usize, wrench: Screw) -> Screw {
    let position = constant(graph, mechanism.joints[joint].position);
    let lever = cross(graph, position, wrench.linear);
    Screw {
        angular: add(graph, wrench.angular, lever),
        ..wrench
    }
}

/// A wrench in a link's frame, in the axes of the antecedent.
fn turned(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &mut Motions,
    index: usize,
    wrench: Screw,
) -> Screw {
    let joint = &mechanism.joints[index];
    let (mut moment, force) = (wrench.angular, wrench.linear);
    let coordinate = Coordinate::of(mechanism, &motions.solved, index);
    let theta = coordinate.angle(joint);
    if joint.kind == JointKind::Prismatic {
        let (zero, q) = (graph.zero(), coordinate.position(graph));
        let lever = cross(graph, [zero, zero, q], force);
        moment = add(graph, moment, lever);
    }
    let mut back = |vector| {
        let angles = (joint.gamma, joint.alpha, &theta);
        out_of_frame(graph, &mut motions.rotator, vector, angles)
    };
    Screw {
        angular: back(moment),
        linear: back(force),
    }
}
