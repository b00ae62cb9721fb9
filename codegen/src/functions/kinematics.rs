//! Where the tips of the robot are, and how fast the joints move them.

use crate::expr::{Expr, Graph};
use crate::mechanism::{JointKind, Mechanism};

use crate::derive::coordinate::Coordinate;
use crate::derive::motion::Motions;
use crate::derive::vector::{Vec3, add, constant, cross, dot, into_frame};

/// A frame whose pose is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tip {
    /// Name of the body in the description.
    pub name: String,
    /// Link that carries it.
    pub link: usize,
    /// Its place among the bodies of the link.
    body: usize,
}

/// The tips: of every link that carries no other, the body that the description names last.
pub fn tips(mechanism: &Mechanism) -> Vec<Tip> {
    let joints = mechanism.joints.iter().enumerate();
    let carries = |link: usize| mechanism.joints.iter().any(|j| j.parent == Some(link));
    let leaves = joints.filter(|&(link, _)| !carries(link));
    leaves
        .filter_map(|(link, joint)| {
            let body = joint.bodies.len().checked_sub(1)?;
            let name = joint.bodies[body].name.clone();
            Some(Tip { name, link, body })
        })
        .collect()
}

/// A frame in that of the base: the rows of its rotation, its origin.
#[derive(Clone, Copy, Debug)]
struct Frame {
    rows: [Vec3; 3],
    origin: Vec3,
}

/// The homogeneous matrix of a tip in the frame of the base, by rows.
pub fn pose(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &mut Motions,
    tip: &Tip,
) -> Vec<Vec<Expr>> {
    let tip = at_tip(graph, mechanism, motions, tip).1;
    let (none, one) = (graph.zero(), graph.one());
    let rows = (tip.rows.iter().zip(tip.origin)).map(|(row, p)| vec![row[0], row[1], row[2], p]);
    rows.chain([vec![none, none, none, one]]).collect()
}

/// The Jacobian of a tip: velocity of its origin, then angular velocity, in the axes of the base,
/// per unit velocity of each joint.
pub fn jacobian(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &mut Motions,
    tip: &Tip,
) -> Vec<Vec<Expr>> {
    let (frames, end) = at_tip(graph, mechanism, motions, tip);
    let mut jacobian = vec![vec![graph.zero(); mechanism.driven]; 6];
    for (joint, frame) in frames {
        let axis = frame.rows.map(|row| row[2]);
        let arm = add(graph, end.origin, frame.origin.map(|x| -x));
        let (linear, angular) = match mechanism.joints[joint].kind {
            JointKind::Revolute => (cross(graph, axis, arm), axis),
            JointKind::Prismatic => (axis, [graph.zero(); 3]),
        };
        let coordinate = Coordinate::of(mechanism, &motions.solved, joint);
        for share in coordinate.shares(graph) {
            for (row, value) in linear.into_iter().chain(angular).enumerate() {
                let value = graph.mul(share.ratio, value);
                let place = &mut jacobian[row][share.joint];
                *place = graph.add(*place, value);
            }
        }
    }
    jacobian
}

/// The frames of the joints up to a tip, and that of the tip.
fn at_tip(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &mut Motions,
    tip: &Tip,
) -> (Vec<(usize, Frame)>, Frame) {
    let mut frames: Vec<(usize, Frame)> = vec![];
    let mut at = None;
    for joint in mechanism.chain(tip.link) {
        let before = at.unwrap_or_else(|| base(graph, mechanism, joint));
        let frame = step(graph, mechanism, motions, joint, before);
        frames.push((joint, frame));
        at = Some(frame);
    }
    let link = at.unwrap_or_else(|| base(graph, mechanism, tip.link));
    let body = &mechanism.joints[tip.link].bodies[tip.body].pose;
    let columns: [Vec3; 3] = std::array::from_fn(|column| {
        let column = body.rotation.column(column);
        constant(graph, [column[0], column[1], column[2]].map(clean))
    });
    let offset = constant(graph, body.translation.map(clean).into());
    let rows = link
        .rows
        .map(|row| columns.map(|column| dot(graph, row, column)));
    let reach = link.rows.map(|row| dot(graph, row, offset));
    let origin = add(graph, link.origin, reach);
    (frames, Frame { rows, origin })
}

/// The frame of a first joint at q = 0.
fn base(graph: &mut Graph, mechanism: &Mechanism, joint: usize) -> Frame {
    let pose = mechanism.joints[joint]
        .base
        .unwrap_or(crate::mechanism::Pose::identity());
    let row = |row: usize| [0, 1, 2].map(|column| clean(pose.rotation[(row, column)]));
    let rows = [row(0), row(1), row(2)].map(|row| constant(graph, row));
    let origin = constant(graph, pose.translation.map(clean).into());
    Frame { rows, origin }
}

/// From the frame of the antecedent to that of a joint.
fn step(
    graph: &mut Graph,
    mechanism: &Mechanism,
    motions: &mut Motions,
    index: usize,
    before: Frame,
) -> Frame {
    let joint = &mechanism.joints[index];
    let position = constant(graph, joint.position);
    let coordinate = Coordinate::of(mechanism, &motions.solved, index);
    let theta = coordinate.angle(joint);
    let angles = (joint.gamma, joint.alpha, &theta);
    let moved = before.rows.map(|row| dot(graph, row, position));
    let mut origin = add(graph, before.origin, moved);
    let rows = before
        .rows
        .map(|row| into_frame(graph, &mut motions.rotator, row, angles));
    if joint.kind == JointKind::Prismatic {
        let q = coordinate.position(graph);
        let slid = rows.map(|row| graph.mul(row[2], q));
        origin = add(graph, origin, slid);
    }
    Frame { rows, origin }
}

/// Removes the rounding of products of exact rotations.
fn clean(x: f64) -> f64 {
    let whole = x.round();
    if (x - whole).abs() < 1e-12 { whole } else { x }
}
