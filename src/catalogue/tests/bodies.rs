//! Bodies, gravity and lengths: columns against robots that are described with them.

use super::arm::{Arm, Course, PLAIN, apart, size, slope, spread, torque};
use crate::catalogue::Effects;
use crate::catalogue::evaluate::Motion;
use crate::catalogue::geometry::described;

#[test]
fn a_payload_is_what_a_body_at_the_tool_adds() {
    let plain = PLAIN.robot();
    let loaded = Arm { tool: 1.3, ..PLAIN }.robot();
    let course = Course::of(&plain);
    let added = slope(&torque(&loaded, &course.motion()), &course.tau, 1.0);
    // The body in the frame of the last link, by the description of the loaded arm alone.
    let (with, without) = (described(&loaded)[3], described(&plain)[3]);
    let columns = course.columns(&Effects::new(&plain), "payload", &[], &[]);
    let mut sum = vec![vec![0.0; course.t.len()]; 4];
    for column in &columns {
        let names = idim_codegen::mechanism::inertia::NAMES;
        let place = names
            .iter()
            .position(|name| column.name == format!("P{name}"));
        let place = place.unwrap();
        for (sum, torque) in sum.iter_mut().zip(spread(column, course.t.len())) {
            let x = with[place] - without[place];
            sum.iter_mut()
                .zip(torque)
                .for_each(|(sum, c)| *sum += x * c);
        }
    }
    assert!(size(&added) > 1.0 && apart(&sum, &added) < 1e-10 * size(&added));
}

#[test]
fn a_tilted_base_sees_gravity_turned() {
    let plain = PLAIN.robot();
    let course = Course::of(&plain);
    let columns = course.columns(&Effects::new(&plain), "base_tilt", &[], &[]);
    let angle = 1e-5_f64;
    let (s, c) = angle.sin_cos();
    // Gravity in a base that is turned by the angle about x, then about y.
    for (column, gravity) in columns
        .iter()
        .zip([[0.0, -9.81 * s, -9.81 * c], [9.81 * s, 0.0, -9.81 * c]])
    {
        let tilted = Arm { gravity, ..PLAIN }.robot();
        let expected = slope(&torque(&tilted, &course.motion()), &course.tau, angle);
        let got = spread(column, course.t.len());
        assert!(size(&expected) > 1.0);
        assert!(
            apart(&got, &expected) < 1e-4 * size(&expected),
            "{}",
            column.name
        );
    }
    assert_eq!(columns.len(), 2);
}

#[test]
fn a_longer_link_is_what_a_changed_description_says() {
    let plain = PLAIN.robot();
    let course = Course::of(&plain);
    let columns = course.columns(&Effects::new(&plain), "link_length", &[2], &[]);
    let length = PLAIN.elbow.iter().map(|x| x * x).sum::<f64>().sqrt();
    let longer = |by: f64| {
        let elbow = PLAIN.elbow.map(|x| x * (1.0 + by / length));
        torque(&Arm { elbow, ..PLAIN }.robot(), &course.motion())
    };
    let expected = slope(&longer(1e-3), &longer(-1e-3), 2e-3);
    let got = spread(&columns[0], course.t.len());
    assert!(size(&expected) > 1.0);
    assert!(
        apart(&got, &expected) < 1e-6 * size(&expected),
        "{}",
        apart(&got, &expected)
    );
}

#[test]
fn a_length_that_no_torque_depends_on_is_not_asked_for() {
    let plain = PLAIN.robot();
    let effects = Effects::new(&plain);
    // The base is where it is; all other joints have an offset that matters.
    let with: Vec<bool> = (0..4)
        .map(|joint| effects.length(joint).is_some())
        .collect();
    assert_eq!(with, [false, true, true, true]);
}

#[test]
fn a_force_on_the_flange_is_the_weight_of_a_point_there() {
    for axis in 0..3 {
        let mut gravity = [0.0; 3];
        gravity[axis] = 5.0;
        let arm = Arm { gravity, ..PLAIN };
        let plain = arm.robot();
        let heavy = Arm {
            tool: 1.0,
            point: true,
            ..arm
        };
        let course = Course::of(&plain);
        let still = Motion {
            still: true,
            ..course.motion()
        };
        // The weight of 1 kg pulls with 5 N along the axis.
        let expected = slope(
            &torque(&heavy.robot(), &still),
            &torque(&plain, &still),
            5.0,
        );
        let columns = course.columns(&Effects::new(&plain), "external_force", &[], &[]);
        let got = spread(&columns[axis], course.t.len());
        assert!(size(&expected) > 0.3);
        assert!(apart(&got, &expected) < 1e-10, "{axis}");
    }
}

/// Pose of the arm's flange in frame 0, by its drawing.
fn flange(q: [f64; 4]) -> nalgebra::Isometry3<f64> {
    use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
    let shift = |x: f64, y: f64, z: f64| {
        Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::identity())
    };
    let turn = |axis: [f64; 3], angle: f64| Isometry3::rotation(Vector3::from(axis) * angle);
    let [x, y, z] = PLAIN.elbow;
    shift(0.0, 0.0, 0.3)
        * turn([0.0, 0.0, 1.0], q[0])
        * shift(0.06, 0.0, 0.1)
        * turn([0.0, 1.0, 0.0], q[1])
        * shift(x, y, z)
        * turn([0.0, 1.0, 0.0], q[2])
        * shift(0.3, 0.02, 0.0)
        * turn([1.0, 0.0, 0.0], q[3])
        * shift(0.1, 0.02, 0.03)
        * turn([0.0, 1.0, 0.0], 0.4)
}

#[test]
fn a_force_that_turns_with_the_flange_does_the_work_of_its_drawing() {
    let plain = PLAIN.robot();
    let course = Course::of(&plain);
    let columns = course.columns(&Effects::new(&plain), "external_force", &[], &[1.0]);
    for i in (0..course.t.len()).step_by(7) {
        let q = [0, 1, 2, 3].map(|joint: usize| course.q[joint][i]);
        let axes = flange(q).rotation;
        for joint in 0..4 {
            let at = |by: f64| {
                let mut q = q;
                q[joint] += by;
                flange(q).translation.vector
            };
            // The work of a unit force on the way of the flange, in the flange's axes.
            let work = axes.inverse() * ((at(1e-5) - at(-1e-5)) / 2e-5);
            for (axis, column) in columns.iter().enumerate() {
                let got = spread(column, course.t.len())[joint][i];
                assert!((got + work[axis]).abs() < 1e-8, "{axis} on joint {joint}");
            }
        }
    }
}
