//! Positions in degrees: found where the dynamics show them, left alone where they do not.

use super::hand_written::scara;
use super::synthetic::{X, log, motion, options, with_torque};
use crate::identify::{identify, settle_units};
use crate::log::{Companion, Recording};

fn in_degrees(log: &mut Recording, joint: usize) {
    for value in &mut log.q[joint] {
        *value = value.to_degrees();
    }
}

fn settled(mut log: Recording, companion: &str) -> Recording {
    let companion = Companion::parse(companion).unwrap();
    settle_units(&scara(), &mut log, &companion, &options());
    log
}

#[test]
fn joint_in_degrees_is_found_and_put_into_radians() {
    for joints in [vec![0], vec![1], vec![0, 1]] {
        let clean = log("log.csv", 0.0, 3000);
        let mut dirty = clean.clone();
        joints
            .iter()
            .for_each(|joint| in_degrees(&mut dirty, *joint));
        let found = settled(dirty, "");
        assert_eq!(found.warnings.len(), joints.len(), "{:?}", found.warnings);
        for (joint, warning) in joints.iter().zip(&found.warnings) {
            let number = joint + 1;
            assert!(
                warning.starts_with(&format!("Joint {number} (`")),
                "{warning}"
            );
            assert!(warning.contains("was taken to be in deg: so its log explains the torque"));
            assert!(
                warning.contains(&format!("unit = \"deg\" for q{number}")),
                "{warning}"
            );
        }
        for (a, b) in found.q.iter().flatten().zip(clean.q.iter().flatten()) {
            assert!((a - b).abs() < 1e-12);
        }
    }
}

#[test]
fn velocity_of_a_joint_in_degrees_is_converted_with_it() {
    let mut dirty = log("log.csv", 0.0, 3000);
    dirty.qd = Some(vec![vec![180.0; 3000]; 2]);
    in_degrees(&mut dirty, 1);
    let qd = settled(dirty, "").qd.unwrap();
    assert_eq!(qd[0][7], 180.0);
    assert!((qd[1][7] - std::f64::consts::PI).abs() < 1e-12);
}

#[test]
fn unit_that_the_companion_states_is_believed() {
    let mut dirty = log("log.csv", 0.0, 3000);
    in_degrees(&mut dirty, 1);
    for key in ["q2", "q_elbow", "elbow"] {
        let stated = format!("[columns]\n{key} = {{ unit = 'rad' }}");
        assert_eq!(settled(dirty.clone(), &stated), dirty);
    }
}

#[test]
fn joint_that_turns_twenty_times_keeps_its_radians() {
    let mut turning = motion("turning.csv", 0.0, 6000);
    for (i, q) in turning.q[1].iter_mut().enumerate() {
        *q += 20.0 * std::f64::consts::TAU * i as f64 / 6000.0;
    }
    let turning = with_torque(&scara(), turning);
    assert_eq!(settled(turning.clone(), ""), turning);
    let found = identify(&scara(), &[turning], &[], &options(), &()).unwrap();
    for (parameter, x) in found.models[0].parameters.iter().zip(X) {
        assert!(
            (parameter.value.unwrap() - x).abs() < 1e-6,
            "{}",
            parameter.name
        );
    }
}

#[test]
fn log_that_no_unit_explains_is_left_alone_and_the_doubt_is_said() {
    let mut dirty = log("log.csv", 0.0, 3000);
    in_degrees(&mut dirty, 1);
    // Torque that has nothing to do with the motion.
    let noise = |i: usize| ((i * i * 7919) % 1013) as f64 / 1013.0 - 0.5;
    dirty.tau = Some(vec![(0..3000).map(noise).collect(); 2]);
    let found = settled(dirty.clone(), "");
    assert_eq!(found.q, dirty.q);
    let [warning] = found.warnings.as_slice() else {
        panic!("{:?}", found.warnings)
    };
    assert!(
        warning.contains("Joint 2 (`elbow`) goes as far as"),
        "{warning}"
    );
    assert!(
        warning.contains("State unit = \"deg\" or \"rad\" for q2"),
        "{warning}"
    );
}
