//! URDFs whose link frames are elsewhere than the identified ones.

use std::fmt::Write;

use idim::codegen::mechanism::alignment::{AlignError, Alignment};
use idim::codegen::mechanism::pose::{Pose, about_z};
use idim::codegen::mechanism::{JointKind, Mechanism};
use nalgebra::{Rotation3, Vector3};

use super::*;

/// A random arm of modified Denavit-Hartenberg rows: revolute joints, and a prismatic one.
fn arm(generator: &mut Pcg64Mcg) -> String {
    let mut text = String::from("name = \"arm\"\neffects = []\n");
    for joint in 0..6 {
        let kind = if joint == 3 { "prismatic" } else { "revolute" };
        let mut about = |x: f64| x * (2.0 * uniform(generator) - 1.0);
        let _ = writeln!(
            text,
            "[[joint]]\nname = \"j{joint}\"\nkind = \"{kind}\"\nalpha = {}\nd = {}\ntheta = {}\nr = {}",
            about(3.0),
            about(0.4),
            about(3.0),
            about(0.4)
        );
    }
    text
}

/// A URDF of a robot with every link frame turned and slid along its axis, some axes the other way
/// round, and zeros shifted.
fn elsewhere(own: &Mechanism, generator: &mut Pcg64Mcg) -> String {
    let mut text = String::from("<robot name=\"other\"><link name=\"base\"/>");
    let mut frames: Vec<Pose> = Vec::new();
    for (index, joint) in own.joints.iter().enumerate() {
        let mut about = |x: f64| x * (2.0 * uniform(generator) - 1.0);
        let rotation = Rotation3::from_euler_angles(about(3.0), about(1.5), about(3.0));
        let (sign, zero) = (about(1.0).signum(), about(1.5));
        let frame = Pose {
            rotation: rotation.into_inner(),
            translation: Vector3::new(0.0, 0.0, about(0.2)),
        };
        let mut start = Pose::identity();
        match joint.kind {
            JointKind::Revolute => {
                let zero = idim::codegen::expr::Angle::radians(-sign * zero);
                start.rotation = about_z(zero);
            }
            JointKind::Prismatic => start.translation.z = -sign * zero,
        }
        let before = joint.parent.map_or(Pose::identity(), |at| frames[at]);
        let origin = before
            .inverse()
            .then(&joint.rest())
            .then(&start)
            .then(&frame);
        let (r, p, y) = Rotation3::from_matrix_unchecked(origin.rotation).euler_angles();
        let (axis, t) = (frame.rotation.row(2) * sign, origin.translation);
        let parent = joint.parent.map_or("base".into(), |at| format!("l{at}"));
        let kind = match joint.kind {
            JointKind::Revolute => "type=\"continuous\"><dynamics/>",
            JointKind::Prismatic => {
                "type=\"prismatic\"><limit lower=\"-9\" upper=\"9\" effort=\"1\" velocity=\"1\"/>"
            }
        };
        let _ = write!(
            text,
            "<link name=\"l{index}\"/><joint name=\"{}\" {kind}<parent link=\"{parent}\"/>\
             <child link=\"l{index}\"/><origin xyz=\"{} {} {}\" rpy=\"{r} {p} {y}\"/>\
             <axis xyz=\"{} {} {}\"/></joint>",
            joint.name, t.x, t.y, t.z, axis[0], axis[1], axis[2],
        );
        frames.push(frame);
    }
    text + "</robot>"
}

/// Base parameters of bodies without friction and rotors.
fn rigid(robot: &Robot, bodies: &[Standard]) -> Vec<f64> {
    let value = |name: &str| {
        let inertial = idim::codegen::knowledge::inertial(name);
        inertial.map_or(0.0, |(link, place)| bodies[link].values()[place])
    };
    let parameters = robot.base.parameters.iter();
    let of = |(factor, name): &(f64, String)| factor * value(name);
    parameters
        .map(|p| p.relation.iter().map(of).sum())
        .collect()
}

/// How far the torques of an exported URDF are from those of the identified robot with the same
/// bodies, in the largest.
fn torques_apart(robot: &Robot, exported: &Exported, frames: &Alignment) -> f64 {
    let other = builder::read_texts(&[("other.urdf", exported.urdf.as_str())]).unwrap();
    let links = exported.bodies.links.iter();
    let ours: Vec<Standard> = links.map(|v| Standard::from_values(*v)).collect();
    let joints = other.mechanism.joints.iter();
    let others: Vec<Standard> = joints.map(|joint| joint.carried()).collect();
    let motion = motion(frames.links.len(), 17, 20.0, 50.0);
    let mut moved = motion.clone();
    for (joint, link) in frames.links.iter().enumerate() {
        let each = |series: &mut Vec<f64>| series.iter_mut().for_each(|x| *x *= link.sign);
        each(&mut moved.qd[joint]);
        each(&mut moved.qdd[joint]);
        each(&mut moved.q[joint]);
        moved.q[joint].iter_mut().for_each(|q| *q += link.zero);
    }
    let torque = |robot: &Robot, bodies: &[Standard], motion: &Trajectory| {
        inverse_dynamics(&Interpreter::new(robot), &rigid(robot, bodies), motion).unwrap()
    };
    let wanted = torque(robot, &ours, &motion);
    let found = torque(&other, &others, &moved);
    let (mut apart, mut largest) = (0.0_f64, 0.0_f64);
    for ((wanted, found), link) in wanted.iter().zip(&found).zip(&frames.links) {
        for (w, f) in wanted.iter().zip(found) {
            apart = apart.max((w - link.sign * f).abs());
            largest = largest.max(w.abs());
        }
    }
    apart / largest
}

fn fill() -> Options {
    Options {
        fill: true,
        ..Options::default()
    }
}

#[test]
fn bodies_go_into_frames_that_are_elsewhere() {
    let mut generator = Pcg64Mcg::new(2026);
    let mut worst = 0.0_f64;
    for _ in 0..12 {
        let text = arm(&mut generator);
        let robot = builder::read_texts(&[("arm.toml", text.as_str())]).unwrap();
        let urdf = elsewhere(&robot.mechanism, &mut generator);
        let truth = rigid(&robot, &bodies(&robot));
        let sigma = vec![Some(1e-3); truth.len()];
        let identified = Identified::new(truth, (&sigma, &sigma), &[]);
        let exported = export(&robot, Some(&urdf), &identified, &fill()).unwrap();
        let frames = exported.frames.as_ref().unwrap();
        assert!(frames.apart < 1e-9 && !frames.is_identity());
        worst = worst.max(torques_apart(&robot, &exported, frames));
    }
    println!("torques differ by {worst:.1e} of the largest");
    assert!(worst < 1e-12, "{worst}");
}

#[test]
fn vendors_urdf_of_the_ur10e_takes_what_was_identified_with_a_table() {
    let Some(folder) = shared() else { return };
    let robot = robot("ur10e");
    let urdf = std::fs::read_to_string(folder.join("ur10e/ur10e.urdf")).unwrap();
    let bodies = bodies(&robot);
    let truth = truth(&robot, &bodies);
    let sigma = vec![Some(1e-3); truth.len()];
    let identified = Identified::new(truth, (&sigma, &sigma), &[]);
    let exported = export(&robot, Some(&urdf), &identified, &fill()).unwrap();
    let frames = exported.frames.as_ref().unwrap();
    let apart = torques_apart(&robot, &exported, frames);
    println!(
        "frames {:.1e}, torques {apart:.1e}: {frames:#?}",
        frames.apart
    );
    assert!(frames.apart < 1e-9 && !frames.is_identity());
    assert!(apart < 1e-12, "{apart}");
}

#[test]
fn urdf_of_another_robot_is_refused_where_it_parts() {
    let mut generator = Pcg64Mcg::new(5);
    let text = arm(&mut generator);
    let robot = builder::read_texts(&[("arm.toml", text.as_str())]).unwrap();
    let mut longer = robot.mechanism.clone();
    longer.joints[2].position[0] += 0.02;
    let urdf = elsewhere(&longer, &mut generator);
    let np = robot.base.parameters.len();
    let sigma = vec![Some(0.01); np];
    let identified = Identified::new(vec![0.3; np], (&sigma, &sigma), &[]);
    let refused = export(&robot, Some(&urdf), &identified, &fill()).unwrap_err();
    match &refused {
        ExportError::Other(AlignError::Parts {
            number,
            distance,
            angle,
            ..
        }) => {
            assert_eq!(*number, 3);
            assert!(
                *distance > 1e-3 && *distance < 0.03 && *angle < 1e-9,
                "{refused}"
            );
        }
        other => panic!("{other:?}"),
    }
    assert!(
        refused.to_string().contains("part at joint 3 (`j2`)"),
        "{refused}"
    );
}

#[test]
fn gravity_that_falls_elsewhere_is_said() {
    let mut generator = Pcg64Mcg::new(6);
    let text = format!("gravity = [0.0, 9.81, 0.0]\n{}", arm(&mut generator));
    let robot = builder::read_texts(&[("arm.toml", text.as_str())]).unwrap();
    let urdf = elsewhere(&robot.mechanism, &mut generator);
    let np = robot.base.parameters.len();
    let sigma = vec![Some(0.01); np];
    let identified = Identified::new(vec![0.3; np], (&sigma, &sigma), &[]);
    let exported = export(&robot, Some(&urdf), &identified, &fill()).unwrap();
    let said = &exported.warnings[0];
    assert!(
        said.contains("gravity falls along (0.0000, 1.0000, 0.0000)"),
        "{said}"
    );
}
