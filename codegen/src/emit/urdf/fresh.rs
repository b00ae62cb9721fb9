//! A new URDF: the links of a robot in their modified Denavit-Hartenberg frames.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::{INERTIA, inertial, triple};
use crate::expr::Angle;
use crate::mechanism::pose::{about_x, about_z};
use crate::mechanism::{Joint, JointKind, Mechanism, Standard};

/// Range of a prismatic joint whose limits are not described, m; a URDF must state one.
const RANGE: f64 = 10.0;

/// A URDF of a robot with the ten parameters of each link. Its base stands so that gravity falls
/// along -z, as readers of URDFs take it.
pub fn fresh(mechanism: &Mechanism, links: &[Standard]) -> String {
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n  <link name=\"base_link\"/>\n",
        mechanism.name
    );
    for (index, body) in links.iter().enumerate().take(mechanism.joints.len()) {
        text.push_str(&link(&link_name(index), body));
    }
    for (index, joint) in mechanism.joints.iter().enumerate() {
        text.push_str(&written(index, joint));
    }
    text.push_str("</robot>\n");
    text
}

fn link_name(index: usize) -> String {
    format!("link_{}", index + 1)
}

fn link(name: &str, body: &Standard) -> String {
    let inertial = inertial(body);
    let tensor = INERTIA.iter().zip(inertial.inertia);
    let tensor: String = tensor
        .map(|(name, value)| format!(" {name}=\"{}\"", value + 0.0))
        .collect();
    format!(
        "  <link name=\"{name}\">\n    <inertial>\n      <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n      \
         <mass value=\"{}\"/>\n      <inertia{tensor}/>\n    </inertial>\n  </link>\n",
        triple(inertial.origin.xyz),
        inertial.mass,
    )
}

fn written(index: usize, joint: &Joint) -> String {
    let limits = &joint.limits;
    let range = limits.lower.zip(limits.upper);
    let (kind, range) = match (joint.kind, range) {
        (JointKind::Revolute, None) => ("continuous", None),
        (JointKind::Revolute, range) => ("revolute", range),
        (JointKind::Prismatic, range) => ("prismatic", Some(range.unwrap_or((-RANGE, RANGE)))),
    };
    let limit = limit(range, limits.effort, limits.velocity);
    let parent = joint.parent.map_or("base_link".into(), link_name);
    let turn = standing(joint) * turned(joint);
    let (roll, pitch, yaw) = Rotation3::from_matrix_unchecked(turn).euler_angles();
    // Right angles as they are meant: rounding would tilt axes.
    let exact = |angle: f64| Angle::radians(angle).snapped(1e-12).value();
    format!(
        "  <joint name=\"{}\" type=\"{kind}\">\n    <origin xyz=\"{}\" rpy=\"{}\"/>\n    \
         <parent link=\"{parent}\"/>\n    <child link=\"{}\"/>\n    <axis xyz=\"0 0 1\"/>\n\
         {limit}  </joint>\n",
        joint.name,
        triple(joint.position),
        triple([roll, pitch, yaw].map(exact)),
        link_name(index),
    )
}

/// `<limit>`, where there is anything to say. With a range, a URDF must state effort and velocity:
/// zero stands for one that is not described.
fn limit(range: Option<(f64, f64)>, effort: Option<f64>, velocity: Option<f64>) -> String {
    if range.is_none() && effort.is_none() && velocity.is_none() {
        return String::new();
    }
    let range = range.map_or(String::new(), |(lower, upper)| {
        format!(" lower=\"{lower}\" upper=\"{upper}\"")
    });
    let (effort, velocity) = (effort.unwrap_or(0.0), velocity.unwrap_or(0.0));
    format!("    <limit{range} effort=\"{effort}\" velocity=\"{velocity}\"/>\n")
}

/// From the antecedent's axes to the joint's at q = 0.
fn turned(joint: &Joint) -> Matrix3<f64> {
    about_z(joint.gamma) * about_x(joint.alpha) * about_z(joint.theta)
}

/// For a first joint, the frame in which its gravity falls along -z.
fn standing(joint: &Joint) -> Matrix3<f64> {
    let down = joint.gravity.map(Vector3::from).filter(|g| g.norm() > 0.0);
    let Some(down) = down else {
        return Matrix3::identity();
    };
    let turn = Rotation3::rotation_between(&down, &-Vector3::z());
    // Upside down: any half turn about a level axis.
    turn.map_or_else(|| about_x(Angle::quarters(2)), Rotation3::into_inner)
}
