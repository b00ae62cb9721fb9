//! Laws that hold for every robot, on robots drawn at random: the power theorem, the momentum
//! theorem, Newton and Euler, and one robot behind every way of writing it down.
//!
//! A failure names its case; `IDIM_CASE=N` runs that one alone.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

mod random;

use idim_codegen::derive::ParameterKind;
use idim_codegen::describe::{Geometry, Snap, UrdfLink};
use idim_codegen::expr::Expr;
use idim_codegen::knowledge::Knowledge;
use idim_codegen::mechanism::Standard;
use idim_codegen::robot::{Output, Robot};
use idim_codegen::{BuildError, builder};
use random::count::base_parameters;
use random::draw::{self, Draw};
use random::dual::{Dual, Values};
use random::newton_euler;
use random::text;
use random::vector::{Matrix, Vector, add, dot, of_rpy, product, scale, transposed};

/// Robots of the dynamic laws.
const ROBOTS: u64 = 500;

/// Robots with axes that are almost parallel.
const TILTED: u64 = 100;

/// Tables that are written as a URDF too.
const TABLES: u64 = 100;

/// What is asked for one by one, or all of `count`.
fn cases(count: u64) -> Vec<u64> {
    match std::env::var("IDIM_CASE") {
        Ok(case) => vec![case.parse().unwrap()],
        Err(_) => (0..count).collect(),
    }
}

/// The robot of a case, drawn until no angle lies within the snapping distance of a right angle:
/// there the described and the derived robot differ, which the description says.
fn drawn(case: u64) -> (draw::Robot, Robot, Draw) {
    let mut draw = Draw::new(case);
    loop {
        let robot = draw.robot();
        let derived = of(&robot, case);
        let derived = derived.unwrap_or_else(|error| panic!("case {case}: {error}\n{robot:?}"));
        if derived.mechanism.snaps.is_empty() {
            return (robot, derived, draw);
        }
    }
}

/// Every fourth has friction and rotors.
fn of(robot: &draw::Robot, case: u64) -> Result<Robot, BuildError> {
    let effects: &[&str] = match case % 4 {
        0 => &["viscous", "coulomb", "offset", "rotor_inertia"],
        _ => &[],
    };
    derive(&[
        ("arm.toml", &text::companion(robot.gravity, effects)),
        ("arm.urdf", &text::urdf(robot)),
    ])
}

fn derive(texts: &[(&str, &str)]) -> Result<Robot, BuildError> {
    builder::read_texts(texts)
}

/// q, qd, qdd of the drawn order of joints.
struct State {
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
}

impl State {
    fn new(draw: &mut Draw, joints: usize) -> State {
        let mut series = |range: f64| (0..joints).map(|_| range * draw.unit()).collect();
        State {
            q: series(3.0),
            qd: series(2.0),
            qdd: series(5.0),
        }
    }
}

/// Values of the non-zero entries of an output, as a dense matrix row by row.
fn dense(robot: &Robot, values: &Values, output: Output) -> Vec<Vec<Dual>> {
    let rows = match output {
        Output::Energy | Output::Power => 1,
        _ => robot.mechanism.joints.len(),
    };
    let mut matrix = vec![vec![Dual(0.0, 0.0); robot.base.parameters.len()]; rows];
    for entry in robot.entries(output) {
        let value: Expr = entry.value;
        matrix[entry.row][entry.column] = values.of(value);
    }
    matrix
}

/// One robot at one state with everything that the laws speak of; `digits` is how far torques may
/// be from Newton and Euler, against the largest of them.
fn check(case: u64, digits: f64, robot: &draw::Robot, derived: &Robot, draw: &mut Draw) {
    let moving = robot.moving();
    let state = State::new(draw, moving.len());
    let place = |name: &str| {
        let joint: usize = name[1..].parse().unwrap();
        moving.iter().position(|&known| known == joint).unwrap()
    };
    let joints = &derived.mechanism.joints;
    let places: Vec<usize> = joints.iter().map(|joint| place(&joint.name)).collect();
    assert_eq!(places.len(), moving.len(), "case {case}");
    let [q, qd, qdd] = [&state.q, &state.qd, &state.qdd]
        .map(|series| places.iter().map(|&k| series[k]).collect::<Vec<f64>>());
    let values = Values::at(&derived.graph, &q, &qd, &qdd);
    theorems(case, derived, &values, &qd);

    let rigid = Knowledge::of(derived).rigid;
    let expected = newton_euler::torques(robot, &state.q, &state.qd, &state.qdd);
    let largest = expected.iter().fold(1.0, |a: f64, b| a.max(b.abs()));
    let d = dense(derived, &values, Output::Explicit);
    for (row, &place) in d.iter().zip(&places) {
        let torque: f64 = row.iter().zip(&rigid).map(|(d, x)| d.0 * x).sum();
        let error = (torque - expected[place]).abs() / largest;
        let named = format!("case {case}, joint {place}, D X: {error:e}");
        assert!(error <= digits, "{named}\n{robot:?}");
    }
    links_return(case, digits, derived);
}

/// D = dP/dt + R and qd . D = dh/dt + dh, column by column, of which only rounding may be left.
fn theorems(case: u64, robot: &Robot, values: &Values, qd: &[f64]) {
    let read = |output| dense(robot, values, output);
    let (d, p, r) = (
        read(Output::Explicit),
        read(Output::Momentum),
        read(Output::Rest),
    );
    let (h, dh) = (read(Output::Energy), read(Output::Power));
    for (column, parameter) in robot.base.parameters.iter().enumerate() {
        let named = format!("case {case}, {}", parameter.name);
        let (mut power, mut size) = (0.0, 1.0_f64);
        for joint in 0..qd.len() {
            let (d, p, r) = (d[joint][column], p[joint][column], r[joint][column]);
            let terms = d.0.abs() + p.1.abs() + r.0.abs();
            let error = (d.0 - (p.1 + r.0)).abs() / terms.max(1.0);
            assert!(error <= 1e-12, "{named}, D = dP/dt + R: {error:e}");
            power += qd[joint] * d.0;
            size += (qd[joint] * d.0).abs();
        }
        let error = (power - (h[0][column].1 + dh[0][column].0)).abs() / size;
        assert!(error <= 1e-12, "{named}, qd D = dh/dt + dh: {error:e}");
    }
}

/// What a description says of its links is found again behind the link frames, where the bodies
/// keep the way back.
fn links_return(case: u64, digits: f64, derived: &Robot) {
    let Geometry::Urdf(tree) = &derived.description.geometry else {
        panic!("case {case}: no URDF");
    };
    let joints = &derived.mechanism.joints;
    for body in joints.iter().flat_map(|joint| &joint.bodies) {
        let mut links = tree.links.iter();
        let link = links.find(|link| link.name == body.name).unwrap();
        let described = about_link_frame(link);
        let back = |inertial: &Standard| inertial.moved(&body.pose.inverse()).values();
        let ours = body.inertial.as_ref().map(back);
        assert_eq!(ours.is_some(), described.is_some(), "case {case}");
        for (ours, described) in ours.into_iter().zip(described) {
            for (ours, described) in ours.into_iter().zip(described) {
                let error = (ours - described).abs();
                assert!(error <= digits, "case {case}, {}: {error:e}", body.name);
            }
        }
    }
}

/// The ten parameters of a URDF link about the origin of its frame, by the definition.
fn about_link_frame(link: &UrdfLink) -> Option<[f64; 10]> {
    let body = link.inertial.as_ref()?;
    let [xx, xy, xz, yy, yz, zz] = body.inertia;
    let turn = of_rpy(body.origin.rpy);
    let central = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let central: Matrix = product(turn, product(central, transposed(turn)));
    let (mass, c): (f64, Vector) = (body.mass, body.origin.xyz);
    let inertia = [0, 1, 2].map(|i| {
        let mut unit = [0.0; 3];
        unit[i] = 1.0;
        let steiner = add(scale(dot(c, c), unit), scale(-c[i], c));
        add(central[i], scale(mass, steiner))
    });
    let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = inertia;
    let [mx, my, mz] = scale(mass, c);
    Some([xx, xy, xz, yy, yz, zz, mx, my, mz, mass])
}

#[test]
fn random_robots_obey_power_momentum_and_newton() {
    for case in cases(ROBOTS) {
        let (robot, derived, mut draw) = drawn(case);
        check(case, 1e-11, &robot, &derived, &mut draw);
        if case % 5 == 1 {
            let parameters = derived.base.parameters.iter();
            let inertial = parameters.filter(|p| matches!(p.kind, ParameterKind::Inertial(_)));
            let expected = base_parameters(&robot);
            assert_eq!(inertial.count(), expected, "case {case}: {robot:?}");
        }
    }
}

/// Where axes are almost parallel a rank may be unclear, which is an answer; what is derived
/// obeys the same laws. Regrouping divides by the square of the tilt, down to 1e-4, and loses as
/// much of its twelve digits.
#[test]
fn random_robots_with_nearly_parallel_axes_obey_them_or_are_refused() {
    let mut derived = 0;
    for case in cases(TILTED) {
        let mut draw = Draw::new(2_000_000 + case);
        let robot = draw.tilted();
        match of(&robot, case) {
            Ok(found) if found.mechanism.snaps.is_empty() => {
                check(case, 1e-8, &robot, &found, &mut draw);
                derived += 1;
            }
            Ok(_) | Err(BuildError::Base { .. }) => {}
            Err(error) => panic!("case {case}: {error}"),
        }
    }
    assert!(derived > TILTED / 2, "{derived} of {TILTED} were derived");
}

/// Two turns that almost cancel leave axes that are taken for parallel: that is said.
#[test]
fn tilt_that_only_two_joints_together_have_is_reported() {
    let mut draw = Draw::new(3_000_000);
    let mut robot = draw.robot();
    robot.joints.truncate(2);
    for joint in &mut robot.joints {
        joint.kind = draw::Kind::Revolute;
    }
    robot.joints[0].rpy = [0.3, 0.0, 0.4];
    robot.joints[0].axis = [0.0, 0.0, 1.0];
    robot.joints[1].rpy = [0.3 + 5e-4, 0.0, 0.0];
    robot.joints[1].axis = [0.0, 0.3_f64.sin(), 0.3_f64.cos()];
    let derived = of(&robot, 1).unwrap();
    let snaps = &derived.mechanism.snaps;
    let tilt = |snap: &Snap| (snap.from.abs() - 5e-4).abs() < 1e-9 && snap.to == "0";
    assert!(snaps.iter().any(tilt), "{snaps:?}");
}

#[test]
fn random_tables_and_their_urdf_have_the_same_base_parameters() {
    for case in cases(TABLES) {
        let mut draw = Draw::new(1_000_000 + case);
        let rows = loop {
            let rows = draw.table();
            let of = |name, text: &str| derive(&[(name, text)]);
            let table = of("arm.toml", &text::table(&rows));
            let table = table.unwrap_or_else(|error| panic!("case {case}: {error}\n{rows:?}"));
            if table.mechanism.snaps.is_empty() {
                break (rows, table);
            }
        };
        let (rows, table) = rows;
        let urdf = derive(&[
            ("arm.toml", &text::companion([0.0, 0.0, -9.81], &[])),
            ("arm.urdf", &text::table_as_urdf(&rows)),
        ]);
        let urdf = urdf.unwrap_or_else(|error| panic!("case {case}: {error}\n{rows:?}"));
        assert_eq!(names(&urdf), names(&table), "case {case}: {rows:?}");
    }
}

fn names(robot: &Robot) -> Vec<String> {
    let parameters = robot.base.parameters.iter();
    parameters.map(|parameter| parameter.name.clone()).collect()
}
