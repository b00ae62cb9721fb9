//! Newton and Euler, link by link, in the axes of the base and from the numbers of the URDF.

use super::draw::{Joint, Kind, Robot};
use super::vector::{
    Matrix, Vector, about, add, cross, dot, of_rpy, product, scale, times, transposed,
};

/// How a link's frame lies and moves, all in the axes of the base.
#[derive(Clone, Copy, Debug)]
struct Frame {
    rotation: Matrix,
    origin: Vector,
    omega: Vector,
    omega_dot: Vector,
    acceleration: Vector,
}

/// Torques of the moving joints; q, qd, qdd have one value for each of them.
pub fn torques(robot: &Robot, q: &[f64], qd: &[f64], qdd: &[f64]) -> Vec<f64> {
    let mut frames = vec![Frame {
        rotation: of_rpy([0.0; 3]),
        origin: [0.0; 3],
        omega: [0.0; 3],
        omega_dot: [0.0; 3],
        // A base that is pushed up feels like gravity.
        acceleration: scale(-1.0, robot.gravity),
    }];
    let mut axes: Vec<Vector> = Vec::new();
    let mut state = q
        .iter()
        .zip(qd)
        .zip(qdd)
        .map(|((&q, &qd), &qdd)| [q, qd, qdd]);
    for joint in &robot.joints {
        let motion = match joint.kind {
            Kind::Fixed => [0.0; 3],
            _ => state.next().unwrap(),
        };
        let (frame, axis) = next(&frames[joint.parent], joint, motion);
        frames.push(frame);
        axes.push(axis);
    }
    backwards(robot, &frames, &axes)
}

fn next(parent: &Frame, joint: &Joint, [q, qd, qdd]: [f64; 3]) -> (Frame, Vector) {
    let fixed = product(parent.rotation, of_rpy(joint.rpy));
    let axis = times(fixed, joint.axis);
    let mut arm = times(parent.rotation, joint.xyz);
    let mut frame = Frame {
        rotation: fixed,
        ..*parent
    };
    match joint.kind {
        Kind::Revolute => {
            frame.rotation = product(fixed, about(joint.axis, q));
            frame.omega = add(parent.omega, scale(qd, axis));
            let turned = cross(parent.omega, scale(qd, axis));
            frame.omega_dot = add(add(parent.omega_dot, scale(qdd, axis)), turned);
        }
        Kind::Prismatic => {
            arm = add(arm, scale(q, axis));
            let coriolis = scale(2.0 * qd, cross(parent.omega, axis));
            frame.acceleration = add(add(frame.acceleration, scale(qdd, axis)), coriolis);
        }
        Kind::Fixed => {}
    }
    frame.origin = add(parent.origin, arm);
    frame.acceleration = add(frame.acceleration, carried(parent, arm));
    (frame, axis)
}

/// Acceleration of a point of a link against that of its origin.
fn carried(frame: &Frame, arm: Vector) -> Vector {
    let centripetal = cross(frame.omega, cross(frame.omega, arm));
    add(cross(frame.omega_dot, arm), centripetal)
}

/// Forces and moments about the base's origin, summed from the tips; the share of each joint.
fn backwards(robot: &Robot, frames: &[Frame], axes: &[Vector]) -> Vec<f64> {
    let mut forces = vec![[0.0; 3]; frames.len()];
    let mut moments = vec![[0.0; 3]; frames.len()];
    let mut torques = Vec::new();
    for (index, joint) in robot.joints.iter().enumerate().rev() {
        let (link, frame) = (index + 1, &frames[index + 1]);
        if let Some(body) = &joint.inertial {
            let arm = times(frame.rotation, body.xyz);
            let force = scale(body.mass, add(frame.acceleration, carried(frame, arm)));
            let turn = product(frame.rotation, of_rpy(body.rpy));
            let inertia = product(turn, product(body.inertia, transposed(turn)));
            let spin = cross(frame.omega, times(inertia, frame.omega));
            let couple = add(times(inertia, frame.omega_dot), spin);
            forces[link] = add(forces[link], force);
            let lever = cross(add(frame.origin, arm), force);
            moments[link] = add(moments[link], add(couple, lever));
        }
        let about_origin = add(
            moments[link],
            scale(-1.0, cross(frame.origin, forces[link])),
        );
        match joint.kind {
            Kind::Revolute => torques.push(dot(axes[index], about_origin)),
            Kind::Prismatic => torques.push(dot(axes[index], forces[link])),
            Kind::Fixed => {}
        }
        forces[joint.parent] = add(forces[joint.parent], forces[link]);
        moments[joint.parent] = add(moments[joint.parent], moments[link]);
    }
    torques.reverse();
    torques
}
