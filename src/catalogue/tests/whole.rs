//! The robot to simulate has what the catalogue's columns say.

use std::collections::BTreeMap;

use idim_codegen::Robot;
use idim_codegen::catalogue::EffectKind;
use idim_codegen::describe::{EffectSpec, Span};
use idim_runtime::report::{Diagnosis, EffectParameter, FoundEffect};

use super::arm::{Course, PLAIN, apart, size, slope, spread};
use super::described::diagnosis;
use crate::catalogue::evaluate::{Linear, Motion};
use crate::catalogue::{Effects, Whole};

/// Rotor inertia of the pitch, kg m^2.
const ROTOR: f64 = 0.5;

/// An effect with parameters of some values on a robot whose parameters are given.
fn found(
    robot: &Robot,
    x: &[f64],
    (name, joint): (&str, Option<usize>),
    values: &[f64],
    shape: &[(&str, f64)],
) -> Diagnosis {
    let parameter = |value: &f64| EffectParameter {
        name: String::new(),
        unit: String::new(),
        value: *value,
        sigma: None,
    };
    let shape = shape
        .iter()
        .map(|(name, value)| ((*name).to_owned(), *value));
    let mut all = diagnosis(
        robot,
        FoundEffect {
            effect: name.into(),
            joint: joint.map(|joint| robot.mechanism.joints[joint].name.clone()),
            joints: joint.iter().map(|joint| joint + 1).collect(),
            meaning: String::new(),
            formula: String::new(),
            parameters: values.iter().map(parameter).collect(),
            shape: shape.collect::<BTreeMap<_, _>>(),
            p_value: 0.0,
            gain_pct: 0.0,
            alternatives: Vec::new(),
            experiment: String::new(),
        },
    );
    for (parameter, x) in all.parameters.iter_mut().zip(x) {
        parameter.after.value = *x;
    }
    all
}

fn whole(robot: &Robot, found: &Diagnosis) -> Whole {
    let effects = Effects::new(robot);
    let extension = effects.extension(found).unwrap();
    effects.whole(found, &extension, &[100.0; 4]).unwrap()
}

/// D X along a motion.
fn torque(whole: &Whole, motion: &Motion<'_>) -> Vec<Vec<f64>> {
    let columns = whole.robot.base.parameters.iter();
    let columns = columns.map(|parameter| parameter.columns.explicit.as_slice());
    let joints = whole.robot.mechanism.joints.len();
    Linear::new(&whole.robot.graph, joints, columns.enumerate()).torque(motion, &whole.parameters)
}

#[test]
fn a_small_tilt_and_a_small_length_add_their_columns() {
    let plain = PLAIN.robot();
    let course = Course::of(&plain);
    let effects = Effects::new(&plain);
    let small = 1e-6;
    for (name, joint, place) in [
        ("base_tilt", None, 0),
        ("base_tilt", None, 1),
        ("link_length", Some(2), 0),
    ] {
        let mut values = vec![0.0; 2];
        values[place] = small;
        let said = found(&plain, &course.parameters, (name, joint), &values, &[]);
        let whole = whole(&plain, &said);
        assert!(whole.left_out.is_empty() && whole.driven == [0, 1, 2, 3]);
        let beyond = slope(&torque(&whole, &course.motion()), &course.tau, small);
        let joints: Vec<usize> = joint.into_iter().collect();
        let column = &course.columns(&effects, name, &joints, &[])[place];
        let column = spread(column, course.t.len());
        let error = apart(&beyond, &column) / size(&column);
        assert!(error < 1e-4, "{name}: {error}");
    }
}

/// The arm with a described rotor at the pitch, and the base parameters of its bodies.
fn with_rotor() -> (Robot, Vec<f64>) {
    let spec = EffectSpec {
        kind: EffectKind::RotorInertia,
        joints: vec!["pitch".into()],
        shape: vec![],
        span: Span { line: 0, column: 0 },
    };
    let mut robot = Effects::new(&PLAIN.robot()).extended(&[spec]).unwrap();
    robot.description.parameters.push(("IA2".into(), ROTOR));
    let mut x = Course::of(&robot).parameters;
    for (x, parameter) in x.iter_mut().zip(&robot.base.parameters) {
        let own = parameter.relation.iter().filter(|(_, name)| name == "IA2");
        *x += own.map(|(factor, _)| factor * ROTOR).sum::<f64>();
    }
    (robot, x)
}

#[test]
fn a_gear_is_in_balance_where_its_load_bends_it_to() {
    let (robot, x) = with_rotor();
    let yields = 1e-4;
    let shape = [("f", 8.0), ("damping", 0.1)];
    let said = found(&robot, &x, ("joint_elasticity", Some(1)), &[yields], &shape);
    let whole = whole(&robot, &said);
    assert!(whole.left_out.is_empty());
    assert_eq!(whole.driven, [0, 1, 3, 4]);
    assert_eq!((whole.gears[0].link, whole.gears[0].gap), (2, 0.0));
    let course = Course::of(&robot);
    let still = Motion {
        still: true,
        ..course.motion()
    };
    let load = torque_of(&robot, &x, &still);
    let bent: Vec<f64> = load[1].iter().map(|load| yields * load).collect();
    // The link is where the joint of the rigid arm is, its drive ahead of it.
    let mut q = course.q.clone();
    q[1].iter_mut().zip(&bent).for_each(|(q, bent)| *q += bent);
    q.insert(2, bent.iter().map(|bent| -bent).collect());
    let zero = vec![vec![0.0; course.t.len()]; 5];
    let along = Motion {
        q: &q,
        qd: &zero,
        qdd: &zero,
        ..still
    };
    let mut all = torque(&whole, &along);
    let gear = all.remove(2);
    assert!(size(&load) > 1.0);
    assert!(size(&[gear]) < 1e-9 * size(&load));
    assert!(apart(&all, &load) < 1e-9 * size(&load));
    // Drive and link together are as heavy as the joint.
    let mut one = zero.clone();
    (one[1], one[2]) = (vec![1.0; course.t.len()], vec![0.0; course.t.len()]);
    let pushed = torque(
        &whole,
        &Motion {
            qdd: &one,
            still: false,
            ..along
        },
    );
    let mut alone = zero[..4].to_vec();
    alone[1] = vec![1.0; course.t.len()];
    let rigid = Motion {
        qd: &zero[..4],
        qdd: &alone,
        ..course.motion()
    };
    let drive = slope(&pushed[1..2], &all[1..2], 1.0);
    let joint = slope(&torque_of(&robot, &x, &rigid)[1..2], &load[1..2], 1.0);
    assert!(apart(&drive, &joint) < 1e-9 * size(&joint));
}

fn torque_of(robot: &Robot, x: &[f64], motion: &Motion<'_>) -> Vec<Vec<f64>> {
    let columns = robot.base.parameters.iter();
    let columns = columns.map(|parameter| parameter.columns.explicit.as_slice());
    Linear::new(&robot.graph, 4, columns.enumerate()).torque(motion, x)
}

#[test]
fn a_gear_without_a_known_rotor_is_left_out_and_stops_hold_a_tenth_of_the_gap() {
    let plain = PLAIN.robot();
    let x = Course::of(&plain).parameters;
    let said = found(&plain, &x, ("backlash", Some(1)), &[2e-3], &[]);
    assert_eq!(whole(&plain, &said).left_out, [0]);
    let (robot, x) = with_rotor();
    let said = found(&robot, &x, ("backlash", Some(1)), &[2e-3], &[]);
    let whole = whole(&robot, &said);
    assert_eq!(whole.gears[0].gap, 2e-3);
    assert!((100.0 / whole.gears[0].stiffness - 2e-4).abs() < 1e-12);
}
