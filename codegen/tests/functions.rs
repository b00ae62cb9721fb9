//! Functions beside the identification models, against D X, and against poses that are composed
//! as the description has them.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::path::PathBuf;

use idim_codegen::derive::ParameterKind;
use idim_codegen::describe::{Geometry, Motion};
use idim_codegen::expr::Expr;
use idim_codegen::expr::tape::{Batch, Tape};
use idim_codegen::functions::{Function, Group, Quantity};
use idim_codegen::mechanism::Pose;
use idim_codegen::mechanism::pose::{about_x, about_z};
use idim_codegen::robot::{Output, Robot};
use idim_codegen::{builder, expr};
use nalgebra::{DMatrix, Matrix3, Rotation3, Unit, Vector3};
use rand::{RngExt, SeedableRng};

#[path = "robots/humanoid.rs"]
mod humanoid;

/// Rounding of two ways to sum the same terms, relative to the largest entry.
const TOLERANCE: f64 = 1e-12;

/// Prismatic and revolute joints, a branch, tilted axes, gravity along no axis.
const MIXED: &str = r#"
    name = "mixed"
    gravity = [1.0, -2.0, -9.0]
    effects = ["viscous", "coulomb", "rotor_inertia"]
    [[joint]]
    name = "slide"
    kind = "prismatic"
    ant = 0
    alpha = 0.4
    [[joint]]
    name = "turn"
    kind = "revolute"
    ant = 1
    gamma = 0.3
    alpha = "pi/2"
    d = 0.3
    r = 0.2
    [[joint]]
    name = "reach"
    kind = "prismatic"
    ant = 2
    alpha = -0.7
    d = 0.1
    theta = 0.5
    [[joint]]
    name = "hand"
    kind = "revolute"
    ant = 3
    d = 0.4
    [[joint]]
    name = "other"
    kind = "revolute"
    ant = 2
    gamma = 0.8
    b = 0.2
    alpha = 1.1
    d = 0.25
"#;

fn robots() -> Vec<Robot> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../robots");
    let listing = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = listing.map(|item| item.unwrap().path()).collect();
    paths.sort();
    let mut robots: Vec<Robot> = paths
        .iter()
        .map(|path| builder::read(path).unwrap().robot)
        .collect();
    robots.push(builder::read_texts(&[("mixed.toml", MIXED)]).unwrap());
    robots.push(builder::read_texts(&[("humanoid.urdf", &humanoid::urdf())]).unwrap());
    let all = [Group::Dynamics, Group::Kinematics];
    robots.into_iter().map(|robot| robot.with(&all)).collect()
}

#[derive(Clone)]
struct State {
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
    x: Vec<f64>,
}

fn state(robot: &Robot, seed: u64) -> State {
    let mut random = rand::rngs::StdRng::seed_from_u64(seed);
    let mut draw = |count: usize, size: f64| -> Vec<f64> {
        (0..count)
            .map(|_| random.random_range(-size..size))
            .collect()
    };
    let n = robot.mechanism.driven;
    State {
        q: draw(n, 3.0),
        qd: draw(n, 2.0),
        qdd: draw(n, 5.0),
        x: draw(robot.base.parameters.len(), 1.0),
    }
}

fn run(robot: &Robot, values: &[Expr], state: &State) -> Vec<f64> {
    let mut out = vec![0.0; values.len()];
    let batch = Batch {
        len: 1,
        q: &state.q,
        qd: &state.qd,
        qdd: &state.qdd,
        slip: &[],
    };
    let tape = Tape::new(&robot.graph, values).with_parameters(&state.x);
    tape.run(&batch, &mut out);
    out
}

fn evaluate(robot: &Robot, function: &Function, state: &State) -> DMatrix<f64> {
    let flat: Vec<Expr> = function.entries.iter().flatten().copied().collect();
    let values = run(robot, &flat, state);
    DMatrix::from_row_slice(function.entries.len(), function.entries[0].len(), &values)
}

fn of(robot: &Robot, quantity: Quantity) -> Vec<&Function> {
    let all = robot.functions.iter();
    all.filter(|function| function.quantity == quantity)
        .collect()
}

/// D X.
fn torques(robot: &Robot, state: &State) -> Vec<f64> {
    let entries = robot.entries(Output::Explicit);
    let values: Vec<Expr> = entries.iter().map(|entry| entry.value).collect();
    let mut torques = vec![0.0; robot.mechanism.joints.len()];
    for (entry, value) in entries.iter().zip(run(robot, &values, state)) {
        torques[entry.row] += value * state.x[entry.column];
    }
    torques
}

fn check(what: &str, ours: &[f64], expected: &[f64], tolerance: f64) {
    let scale = expected.iter().fold(1e-3f64, |scale, x| scale.max(x.abs()));
    assert_eq!(ours.len(), expected.len());
    for (place, (a, b)) in ours.iter().zip(expected).enumerate() {
        let error = (a - b).abs() / scale;
        assert!(error <= tolerance, "{what}, entry {place}: {a} for {b}");
    }
}

#[test]
fn inverse_dynamics_is_the_regressor_times_the_parameters() {
    for robot in robots() {
        for seed in 0..5 {
            let state = state(&robot, seed);
            let tau = evaluate(&robot, of(&robot, Quantity::InverseDynamics)[0], &state);
            let expected = torques(&robot, &state);
            check(&robot.mechanism.name, tau.as_slice(), &expected, TOLERANCE);
        }
    }
}

#[test]
fn gravity_is_the_torque_at_rest_without_friction() {
    for robot in robots() {
        let mut state = state(&robot, 1);
        let gravity = evaluate(&robot, of(&robot, Quantity::Gravity)[0], &state);
        state.qd.fill(0.0);
        state.qdd.fill(0.0);
        for (x, parameter) in state.x.iter_mut().zip(&robot.base.parameters) {
            if !matches!(parameter.kind, ParameterKind::Inertial(_)) {
                *x = 0.0;
            }
        }
        let expected = torques(&robot, &state);
        check(
            &robot.mechanism.name,
            gravity.as_slice(),
            &expected,
            TOLERANCE,
        );
    }
}

#[test]
fn columns_of_the_mass_matrix_are_torques_of_unit_accelerations() {
    for robot in robots() {
        let mut state = state(&robot, 2);
        let matrix = evaluate(&robot, of(&robot, Quantity::MassMatrix)[0], &state);
        assert!((&matrix - matrix.transpose()).amax() == 0.0);
        state.qd.fill(0.0);
        state.qdd.fill(0.0);
        let rest = torques(&robot, &state);
        let scale = matrix
            .amax()
            .max(rest.iter().fold(0.0, |a: f64, b| a.max(b.abs())));
        for joint in 0..state.q.len() {
            state.qdd.fill(0.0);
            state.qdd[joint] = 1.0;
            for (row, (with, without)) in torques(&robot, &state).iter().zip(&rest).enumerate() {
                let error = (matrix[(row, joint)] - (with - without)).abs();
                let name = &robot.mechanism.name;
                assert!(
                    error <= TOLERANCE * scale,
                    "{name} M[{row}][{joint}]: {error:e}"
                );
            }
        }
    }
}

#[test]
fn jacobian_is_the_derivative_of_the_pose() {
    let step = 1e-6;
    for robot in robots() {
        let poses = of(&robot, Quantity::Pose);
        for (pose, jacobian) in poses.into_iter().zip(of(&robot, Quantity::Jacobian)) {
            let state = state(&robot, 3);
            let at = evaluate(&robot, pose, &state);
            let ours = evaluate(&robot, jacobian, &state);
            for joint in 0..state.q.len() {
                let moved = |by: f64| {
                    let mut state = state.clone();
                    state.q[joint] += by;
                    evaluate(&robot, pose, &state)
                };
                let rate = (moved(step) - moved(-step)) / (2.0 * step);
                // dR/dt R^T = [w]x
                let turn = rate.view((0, 0), (3, 3)) * at.view((0, 0), (3, 3)).transpose();
                let expected = [
                    [rate[(0, 3)], rate[(1, 3)], rate[(2, 3)]],
                    [turn[(2, 1)], turn[(0, 2)], turn[(1, 0)]],
                ];
                let column: Vec<f64> = ours.column(joint).iter().copied().collect();
                check(
                    &robot.mechanism.name,
                    &column,
                    expected.as_flattened(),
                    1e-8,
                );
            }
        }
    }
}

/// Every body's pose, composed joint by joint as the description has them.
fn composed(robot: &Robot, q: &[f64]) -> Vec<(String, Pose)> {
    let position = |name: &str| {
        let joints = &robot.mechanism.joints;
        let place = joints.iter().position(|joint| joint.name == name);
        place.map_or(0.0, |place| q[place])
    };
    let mut poses: Vec<(String, Pose)> = vec![];
    match &robot.description.geometry {
        Geometry::Mdh(rows) => {
            for row in rows {
                let moved = position(&row.name);
                let (turn, slide) = match row.motion {
                    Motion::Prismatic => (0.0, moved),
                    _ => (moved, 0.0),
                };
                let angle = expr::Angle::radians;
                let before = about_z(angle(row.gamma.value)) * about_x(angle(row.alpha.value));
                let rotation = before * about_z(angle(row.theta.value + turn));
                let up = before * Vector3::new(row.d.value, 0.0, row.r.value + slide);
                let step = Pose {
                    rotation,
                    translation: Vector3::new(0.0, 0.0, 0.0)
                        + about_z(angle(row.gamma.value)) * Vector3::new(0.0, 0.0, row.b.value)
                        + up,
                };
                let parent = match row.ant {
                    0 => Pose::identity(),
                    ant => poses[ant - 1].1,
                };
                poses.push((row.name.clone(), parent.then(&step)));
            }
        }
        Geometry::Urdf(tree) => {
            let mut found = vec![None; tree.links.len()];
            let is_child = |link: usize| tree.joints.iter().any(|joint| joint.child == link);
            let root = (0..tree.links.len()).find(|&link| !is_child(link)).unwrap();
            found[root] = Some(Pose::identity());
            while found.iter().any(Option::is_none) {
                for joint in &tree.joints {
                    let Some(parent) = found[joint.parent] else {
                        continue;
                    };
                    let axis = Unit::new_normalize(Vector3::from(joint.axis));
                    let turn: Matrix3<f64> =
                        Rotation3::from_axis_angle(&axis, position(&joint.name)).into_inner();
                    let turned = Pose {
                        rotation: turn,
                        translation: Vector3::zeros(),
                    };
                    found[joint.child] =
                        Some(parent.then(&Pose::from_rpy(&joint.origin)).then(&turned));
                }
            }
            for (link, pose) in tree.links.iter().zip(found) {
                poses.push((link.name.clone(), pose.unwrap()));
            }
        }
    }
    poses
}

#[test]
fn pose_is_that_of_the_description_joint_by_joint() {
    for robot in robots() {
        let state = state(&robot, 4);
        let bodies = composed(&robot, &state.q);
        let poses = of(&robot, Quantity::Pose);
        assert!(!poses.is_empty());
        for function in poses {
            let body = function.body.clone().unwrap();
            let (_, pose) = bodies.iter().find(|(name, _)| *name == body).unwrap();
            let mut expected = DMatrix::identity(4, 4);
            expected.view_mut((0, 0), (3, 3)).copy_from(&pose.rotation);
            expected
                .view_mut((0, 3), (3, 1))
                .copy_from(&pose.translation);
            let ours = evaluate(&robot, function, &state);
            check(&body, ours.as_slice(), expected.as_slice(), TOLERANCE);
        }
    }
}

/// Without functions nothing of them is in the text, and with them the models are as they were.
#[test]
fn functions_are_there_for_those_who_ask_alone() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../robots/panda.toml");
    let plain = builder::read(&path).unwrap().robot;
    let with = plain.clone().with(&[Group::Dynamics, Group::Kinematics]);
    let (plain, with) = [plain, with]
        .map(|robot| idim_codegen::emit::rust(&robot).unwrap())
        .into();
    let names = [
        "inverse_dynamics",
        "mass_matrix",
        "gravity",
        "pose",
        "jacobian",
    ];
    let heads = names.map(|name| format!("pub fn {name}<"));
    assert!(
        heads
            .iter()
            .all(|head| !plain.contains(head) && with.contains(head))
    );
    let explicit = |text: &str| {
        let body = text.split_once("pub fn explicit").unwrap().1;
        body.split_once("\n}").unwrap().0.to_owned()
    };
    assert_eq!(explicit(&plain), explicit(&with));
}

/// Torques come from Newton and Euler, not from the regressor.
#[test]
fn inverse_dynamics_costs_less_than_the_regressor() {
    for robot in robots().iter().filter(|r| r.mechanism.joints.len() > 5) {
        let cost = |entries: Vec<Expr>| {
            let count = expr::Operations::of(&robot.graph, &entries);
            count.mul + count.add
        };
        let entries = robot.entries(Output::Explicit);
        let times_x = 2 * entries.len() - robot.mechanism.joints.len();
        let regressor = times_x + cost(entries.iter().map(|entry| entry.value).collect());
        let of = |quantity| cost(of(robot, quantity)[0].entries.concat());
        let torque = of(Quantity::InverseDynamics);
        println!(
            "{}: D X {regressor}, tau {torque}, M {}, g {}, T {}, J {}",
            robot.mechanism.name,
            of(Quantity::MassMatrix),
            of(Quantity::Gravity),
            of(Quantity::Pose),
            of(Quantity::Jacobian)
        );
        assert!(10 * torque < 7 * regressor, "{torque} of {regressor}");
    }
}

/// Crank, coupler, rocker, and a tool that follows the crank: functions in the driven joint alone.
#[test]
fn functions_of_loops_and_followers_are_those_of_the_driven_joints() {
    let text = r#"
        gravity = [1.0, -9.0, -2.0]
        effects = []
        [[joint]]
        name = "crank"
        kind = "revolute"
        [[joint]]
        name = "coupler"
        kind = "revolute"
        d = 0.2
        passive = true
        [[joint]]
        name = "wrist"
        kind = "revolute"
        alpha = 0.7
        d = 0.3
        [[joint]]
        name = "tool"
        kind = "prismatic"
        alpha = 0.4
        d = 0.1
        mimic = { joint = "crank", multiplier = -0.5, offset = 0.3 }
        [[joint]]
        name = "rocker"
        kind = "revolute"
        ant = 0
        d = 0.7
        passive = true
        [[loop]]
        cut = { ant = 2, d = 0.6 }
        meets = { ant = 5, d = 0.5 }
    "#;
    let robot = builder::read_texts(&[("closed.toml", text)]).unwrap();
    let robot = robot.with(&[Group::Dynamics, Group::Kinematics]);
    let n = robot.mechanism.driven;
    let own = state(&robot, 3);
    let torque = |state: &State| -> Vec<f64> {
        let entries = robot.entries(Output::Explicit);
        let values: Vec<Expr> = entries.iter().map(|entry| entry.value).collect();
        let values = run(&robot, &values, state);
        let mut torque = vec![0.0; n];
        for (entry, value) in entries.iter().zip(values) {
            torque[entry.row] += value * state.x[entry.column];
        }
        torque
    };
    let function = |quantity| evaluate(&robot, of(&robot, quantity)[0], &own);
    let inverse = function(Quantity::InverseDynamics);
    let still = State {
        qd: vec![0.0; n],
        qdd: vec![0.0; n],
        ..own.clone()
    };
    let (gravity, matrix) = (function(Quantity::Gravity), function(Quantity::MassMatrix));
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-10 * b.abs().max(1.0), "{a} for {b}");
    for joint in 0..n {
        near(inverse[(0, joint)], torque(&own)[joint]);
        near(gravity[(0, joint)], torque(&still)[joint]);
        let mut pushed = still.clone();
        pushed.qdd[joint] = 1.0;
        for row in 0..n {
            near(
                matrix[(row, joint)],
                torque(&pushed)[row] - torque(&still)[row],
            );
        }
    }
    // The Jacobian of the tool is the slope of its pose.
    let place = |by: f64, joint: usize| {
        let mut moved = own.clone();
        moved.q[joint] += by;
        let pose = of(&robot, Quantity::Pose);
        let tool = pose.iter().find(|one| one.body.as_deref() == Some("tool"));
        evaluate(&robot, tool.unwrap(), &moved)
    };
    let jacobian = of(&robot, Quantity::Jacobian);
    let tool = jacobian
        .iter()
        .find(|one| one.body.as_deref() == Some("tool"));
    let jacobian = evaluate(&robot, tool.unwrap(), &own);
    for joint in 0..n {
        let slope = (place(1e-5, joint) - place(-1e-5, joint)) / 2e-5;
        for axis in 0..3 {
            assert!((slope[(axis, 3)] - jacobian[(axis, joint)]).abs() < 1e-8);
        }
    }
}
