//! From the links and joints of a URDF to axes in space at q = 0.

use nalgebra::{Matrix3, Vector3};

use super::frames::Axis;
use super::inertia::Standard;
use super::pose::Pose;
use super::{Body, JointKind};
use crate::describe::{Motion, UrdfJoint, UrdfTree};

/// The moving axes, antecedents first, children in the order of the document; links on fixed
/// joints are merged into the link that carries them.
pub fn axes(tree: &UrdfTree) -> Vec<Axis> {
    let is_child = |link: usize| tree.joints.iter().any(|joint| joint.child == link);
    let root = (0..tree.links.len())
        .find(|&link| !is_child(link))
        .unwrap_or(0);
    let mut axes = Vec::new();
    // What is still to visit: a joint, the pose of its parent link, and what carries that link.
    let mut stack = Vec::new();
    push_children(tree, root, Pose::identity(), None, &mut stack);
    while let Some((joint, parent, carrier)) = stack.pop() {
        let pose = parent.then(&Pose::from_rpy(&joint.origin));
        let carrier = match joint.motion {
            Motion::Fixed => carrier,
            Motion::Revolute => Some(push(&mut axes, joint, JointKind::Revolute, pose, carrier)),
            Motion::Prismatic => Some(push(&mut axes, joint, JointKind::Prismatic, pose, carrier)),
        };
        if let Some(carrier) = carrier {
            let link = &tree.links[joint.child];
            let inertial = link.inertial.as_ref().map(Standard::from_urdf);
            axes[carrier].bodies.push(Body {
                name: link.name.clone(),
                pose,
                inertial,
            });
        }
        push_children(tree, joint.child, pose, carrier, &mut stack);
    }
    axes
}

type Visit<'a> = (&'a UrdfJoint, Pose, Option<usize>);

fn push_children<'a>(
    tree: &'a UrdfTree,
    link: usize,
    pose: Pose,
    carrier: Option<usize>,
    stack: &mut Vec<Visit<'a>>,
) {
    // Reversed, because the stack turns the order round.
    for joint in tree
        .joints
        .iter()
        .rev()
        .filter(|joint| joint.parent == link)
    {
        stack.push((joint, pose, carrier));
    }
}

fn push(
    axes: &mut Vec<Axis>,
    joint: &UrdfJoint,
    kind: JointKind,
    pose: Pose,
    parent: Option<usize>,
) -> usize {
    let frame = Pose {
        rotation: pose.rotation * along_z(joint.axis),
        ..pose
    };
    axes.push(Axis {
        name: joint.name.clone(),
        kind,
        parent,
        frame,
        drive: joint.drive.clone(),
        limits: joint.limits,
        bodies: Vec::new(),
    });
    axes.len() - 1
}

/// A rotation whose z column is the axis and whose x column is the link's x axis where it can be
/// (its y axis where x is the joint's axis).
fn along_z(axis: [f64; 3]) -> Matrix3<f64> {
    let z = Vector3::from(axis).normalize();
    let near = if z.x.abs() < 0.9 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    let x = (near - z * z.dot(&near)).normalize();
    Matrix3::from_columns(&[x, z.cross(&x), z])
}
