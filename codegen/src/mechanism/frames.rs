//! Frames on axes: the modified Denavit-Hartenberg placement of Khalil and Kleinfinger.
//!
//! z lies along the joint's axis. The origin is the foot of the common normal with the next axis,
//! and x lies along that normal. Where axes are parallel the origin is free: it is slid so that
//! the offset along the axes ends up on the most distal frame of the parallel group. Signs that
//! the geometry leaves open follow the frames of the description.

use nalgebra::Vector3;

use super::pose::Pose;
use super::{Body, Joint, JointKind};
use crate::describe::{Drive, Limits, Snap};
use crate::expr::Angle;

/// Axes that differ by less than this (rad) are parallel, and angles that are this near to a
/// multiple of pi/2 are that multiple; what it changes is reported.
pub const SNAP: f64 = 1e-3;

/// Between [`SNAP`] and this angle (rad) the common normal of two axes lies far away from both:
/// origins stay where they are for parallel axes, and the frame takes the tilt.
const NEARLY_PARALLEL: f64 = 0.03;

/// Lengths below this (m) are rounding of composed displacements.
const LENGTH: f64 = 1e-9;

/// A joint's axis in space at q = 0.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Joint name.
    pub name: String,
    /// Revolute or prismatic.
    pub kind: JointKind,
    /// Antecedent among the axes.
    pub parent: Option<usize>,
    /// A frame with its origin on the axis and z along it, in the frame of the base.
    pub frame: Pose,
    /// What moves it.
    pub drive: Drive,
    /// Limits of the joint.
    pub limits: Limits,
    /// Bodies carried; poses and inertias still in the frame of the base and the body's own.
    pub bodies: Vec<Body>,
}

impl Axis {
    fn point(&self) -> Vector3<f64> {
        self.frame.translation
    }
    fn z(&self) -> Vector3<f64> {
        self.frame.rotation.column(2).into()
    }
    fn x(&self) -> Vector3<f64> {
        self.frame.rotation.column(0).into()
    }
}

/// Places a frame on every axis and expresses each in its antecedent's.
pub fn place(axes: &[Axis], gravity: [f64; 3], snaps: &mut Vec<Snap>) -> Vec<Joint> {
    let origins = origins(axes);
    let mut frames: Vec<Pose> = Vec::new();
    for (index, axis) in axes.iter().enumerate() {
        let x = x_axis(axes, &origins, index, &frames);
        let z = axis.z();
        let rotation = nalgebra::Matrix3::from_columns(&[x, z.cross(&x), z]);
        frames.push(Pose {
            rotation,
            translation: origins[index],
        });
    }
    (0..axes.len())
        .map(|index| joint(axes, &frames, index, gravity, snaps))
        .collect()
}

/// The child whose common normal decides a frame: the first in the order of the description.
fn main_child(axes: &[Axis], index: usize) -> Option<usize> {
    axes.iter().position(|axis| axis.parent == Some(index))
}

/// The last of the axes parallel to `index`, one main child after the other.
fn group_end(axes: &[Axis], index: usize) -> Option<usize> {
    let mut end = None;
    let mut at = index;
    while let Some(child) = main_child(axes, at) {
        if tilt(&axes[at], &axes[child]) >= NEARLY_PARALLEL {
            break;
        }
        end = Some(child);
        at = child;
    }
    end
}

fn tilt(a: &Axis, b: &Axis) -> f64 {
    a.z().cross(&b.z()).norm()
}

/// Origins of all frames. Those that a common normal fixes come first; the others of a parallel
/// group follow from their antecedent, or from their child where there is none.
fn origins(axes: &[Axis]) -> Vec<Vector3<f64>> {
    let mut known: Vec<Option<Vector3<f64>>> = vec![None; axes.len()];
    for (index, axis) in axes.iter().enumerate() {
        let child = main_child(axes, index).map(|child| &axes[child]);
        known[index] = child
            .filter(|child| tilt(axis, child) >= NEARLY_PARALLEL)
            .map(|child| foot(axis, child));
    }
    // A first joint's offset along its axis does not exist: it takes the level of the frame that
    // ends its parallel group.
    for index in 0..axes.len() {
        if known[index].is_none() && axes[index].parent.is_none() {
            known[index] = group_end(axes, index)
                .and_then(|end| known[end])
                .map(|origin| project(origin, &axes[index]));
        }
    }
    let mut origins = Vec::with_capacity(axes.len());
    for (index, axis) in axes.iter().enumerate() {
        let from_parent = axis.parent.map(|parent| match tilt(&axes[parent], axis) {
            tilt if tilt >= NEARLY_PARALLEL => foot(axis, &axes[parent]),
            _ => project(origins[parent], axis),
        });
        origins.push(known[index].or(from_parent).unwrap_or(axis.point()));
    }
    origins
}

/// The point of `axis` nearest to `other` (axes that are not parallel).
fn foot(axis: &Axis, other: &Axis) -> Vector3<f64> {
    let normal = axis.z().cross(&other.z());
    let between = other.point() - axis.point();
    let along = between.cross(&other.z()).dot(&normal) / normal.norm_squared();
    axis.point() + along * axis.z()
}

/// The point of `axis` nearest to a point.
fn project(point: Vector3<f64>, axis: &Axis) -> Vector3<f64> {
    axis.point() + axis.z() * (point - axis.point()).dot(&axis.z())
}

fn x_axis(axes: &[Axis], origins: &[Vector3<f64>], index: usize, frames: &[Pose]) -> Vector3<f64> {
    let axis = &axes[index];
    let Some(child) = main_child(axes, index) else {
        return last_x(axis, axis.parent.map(|parent| &frames[parent]));
    };
    let offset = origins[child] - origins[index];
    let across = offset - axis.z() * offset.dot(&axis.z());
    let normal = if tilt(axis, &axes[child]) >= NEARLY_PARALLEL {
        axis.z().cross(&axes[child].z())
    } else if across.norm() > LENGTH {
        across
    } else {
        return last_x(axis, axis.parent.map(|parent| &frames[parent]));
    };
    let normal = clean(normal.normalize());
    match normal.dot(&axis.x()) {
        side if side < -1e-6 => -normal,
        side if side > 1e-6 => normal,
        _ if across.dot(&normal) < -LENGTH => -normal,
        _ => normal,
    }
}

/// x of a frame that no common normal fixes: the description's own where it stands at right
/// angles to the antecedent's, otherwise the one that makes theta vanish.
fn last_x(axis: &Axis, parent: Option<&Pose>) -> Vector3<f64> {
    let Some(parent) = parent else {
        return axis.x();
    };
    let parent_z: Vector3<f64> = parent.rotation.column(2).into();
    let parent_x: Vector3<f64> = parent.rotation.column(0).into();
    let near = parent_z.cross(&axis.z());
    let line = if near.norm() >= NEARLY_PARALLEL {
        near.normalize()
    } else {
        // Square to this axis also where it is a little tilted against the antecedent's.
        (parent_x - axis.z() * parent_x.dot(&axis.z())).normalize()
    };
    let theta = line
        .cross(&axis.x())
        .dot(&axis.z())
        .atan2(line.dot(&axis.x()));
    if Angle::radians(theta).rest().abs() <= SNAP {
        axis.x()
    } else {
        clean(line)
    }
}

/// Removes the rounding of products of exact rotations.
fn clean(vector: Vector3<f64>) -> Vector3<f64> {
    vector.map(|x| if x.abs() < 1e-12 { 0.0 } else { x })
}

fn joint(
    axes: &[Axis],
    frames: &[Pose],
    index: usize,
    gravity: [f64; 3],
    snaps: &mut Vec<Snap>,
) -> Joint {
    let (axis, frame) = (&axes[index], &frames[index]);
    let (relative, gravity) = match axis.parent {
        Some(parent) => (frames[parent].inverse().then(frame), None),
        None => {
            let local = frame.rotation.transpose() * Vector3::from(gravity);
            (Pose::identity(), Some(clean(local).into()))
        }
    };
    let [gamma, alpha, theta] = euler(&relative).map(|angle| snap(angle, &axis.name, snaps));
    let round = |x: f64| {
        if x.abs() < LENGTH {
            0.0
        } else {
            (x * 1e12).round() / 1e12
        }
    };
    Joint {
        name: axis.name.clone(),
        kind: axis.kind,
        parent: axis.parent,
        gamma,
        alpha,
        theta,
        position: relative.translation.map(round).into(),
        gravity,
        base: axis.parent.is_none().then_some(*frame),
        limits: axis.limits,
        bodies: axis
            .bodies
            .iter()
            .map(|body| local_body(body, frame))
            .collect(),
    }
}

/// gamma, alpha, theta of a rotation Rz(gamma) Rx(alpha) Rz(theta); where z axes are parallel all
/// of the turn is theta, and where x lies along the antecedent's x there is no gamma.
fn euler(pose: &Pose) -> [f64; 3] {
    let r = &pose.rotation;
    let (sin, cos) = (r[(0, 2)].hypot(r[(1, 2)]), r[(2, 2)]);
    if sin.atan2(cos.abs()) <= SNAP {
        // The tilt that is left is snapped, and reported, by whoever asks.
        let theta = (r[(1, 0)] * cos.signum()).atan2(r[(0, 0)]);
        return [0.0, sin.atan2(cos), theta];
    }
    // z of the new frame is (sin gamma sin alpha, -cos gamma sin alpha, cos alpha).
    let mut gamma = r[(0, 2)].atan2(-r[(1, 2)]);
    let mut alpha = sin.atan2(cos);
    if gamma.abs() > std::f64::consts::FRAC_PI_2 + SNAP {
        gamma -= std::f64::consts::PI * gamma.signum();
        alpha = -alpha;
    }
    let turn = |angle: f64| super::pose::about_z(Angle::radians(angle));
    let tilt = super::pose::about_x(Angle::radians(alpha));
    let rest = (turn(gamma) * tilt).transpose() * r;
    [gamma, alpha, rest[(1, 0)].atan2(rest[(0, 0)])]
}

fn snap(value: f64, joint: &str, snaps: &mut Vec<Snap>) -> Angle {
    let exact = Angle::radians(value);
    let snapped = exact.snapped(SNAP);
    if (exact.rest() - snapped.rest()).abs() > 1e-6 {
        snaps.push(Snap {
            joint: joint.to_owned(),
            from: value,
            to: snapped.text(),
        });
    }
    snapped
}

/// A body's pose and inertia, from the frame of the base to the link frame.
fn local_body(body: &Body, frame: &Pose) -> Body {
    let pose = frame.inverse().then(&body.pose);
    let inertial = body.inertial.map(|inertial| inertial.moved(&pose));
    Body {
        name: body.name.clone(),
        pose,
        inertial,
    }
}
