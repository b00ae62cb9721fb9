//! A robot whose joints follow others, checked against the open tree it is made of.

use std::collections::HashMap;

use idim_codegen::builder;
use idim_codegen::derive::{self, Columns, Standard};
use idim_codegen::describe::{Description, Drive, Geometry, Motion};
use idim_codegen::expr::tape::{Batch, Tape};
use idim_codegen::expr::{Expr, Graph};
use idim_codegen::mechanism::Mechanism;
use idim_codegen::robot::{Output, Robot};
use nalgebra::{Matrix4, Vector3};
use rand::{RngExt, SeedableRng};

/// A robot from a text.
pub fn robot(name: &str, text: &str) -> Robot {
    builder::read_texts(&[(name, text)]).unwrap_or_else(|error| panic!("{error}"))
}

/// The same links and joints, each joint with a drive of its own.
fn open(description: &Description) -> Mechanism {
    let mut open = description.clone();
    match &mut open.geometry {
        Geometry::Urdf(tree) => tree.joints.iter_mut().for_each(|j| j.drive = Drive::Own),
        Geometry::Mdh(rows) => rows.iter_mut().for_each(|row| row.drive = Drive::Own),
    }
    open.loops.clear();
    open.effects.clear();
    Mechanism::new(&open)
}

/// D, P, R (n x 1) and h of one column at one state.
#[derive(Clone, Debug)]
struct Column {
    matrices: [Vec<f64>; 3],
    energy: f64,
}

/// The standard columns of a mechanism at a state, by link and place among a link's parameters.
fn columns(mechanism: &Mechanism, state: &[Vec<f64>; 3]) -> Vec<Column> {
    let mut graph = Graph::new();
    let standard: Vec<Standard> = derive::standard(&mut graph, mechanism).parameters;
    let n = mechanism.driven;
    let value = |columns: &Columns| {
        let of = |list: &[(usize, Expr)]| {
            let mut dense = vec![0.0; n];
            for &(row, entry) in list {
                dense[row] += evaluate(&graph, entry, state);
            }
            dense
        };
        Column {
            matrices: [&columns.explicit, &columns.momentum, &columns.rest].map(|list| of(list)),
            energy: columns.energy.map_or(0.0, |h| evaluate(&graph, h, state)),
        }
    };
    standard[..10 * mechanism.joints.len()]
        .iter()
        .map(|parameter| value(&parameter.columns))
        .collect()
}

fn evaluate(graph: &Graph, entry: Expr, [q, qd, qdd]: &[Vec<f64>; 3]) -> f64 {
    let mut value = [0.0];
    let batch = Batch {
        len: 1,
        q,
        qd,
        qdd,
        slip: &[],
    };
    Tape::new(graph, &[entry]).run(&batch, &mut value);
    value[0]
}

/// g, G and dG/dt of a mechanism by differences of its positions, which the graph does not share.
struct Constraint {
    state: [Vec<f64>; 3],
    g: Vec<Vec<f64>>,
    gd: Vec<Vec<f64>>,
}

const STEP: f64 = 1e-3;

/// Fourth-order central difference of a function of one number.
fn slope(f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| f(k * STEP));
    (0..a.len())
        .map(|i| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * STEP))
        .collect()
}

fn ratios(mechanism: &Mechanism, q: &[f64]) -> Vec<Vec<f64>> {
    let along = |joint: usize| {
        slope(|by| {
            let mut q = q.to_vec();
            q[joint] += by;
            mechanism.positions(&q)
        })
    };
    (0..q.len()).map(along).collect()
}

fn constraint(mechanism: &Mechanism, [q, qd, qdd]: &[Vec<f64>; 3]) -> Constraint {
    let n = q.len();
    let g = ratios(mechanism, q);
    let moved = |by: f64| -> Vec<f64> { q.iter().zip(qd).map(|(q, qd)| q + by * qd).collect() };
    let flat = slope(|by| ratios(mechanism, &moved(by)).concat());
    let links = mechanism.joints.len();
    let gd: Vec<Vec<f64>> = flat.chunks(links).map(<[f64]>::to_vec).collect();
    let sum = |m: &[Vec<f64>], v: &[f64], link: usize| -> f64 {
        (0..n).map(|joint| m[joint][link] * v[joint]).sum()
    };
    let state = [
        mechanism.positions(q),
        (0..links).map(|link| sum(&g, qd, link)).collect(),
        (0..links)
            .map(|link| sum(&g, qdd, link) + sum(&gd, qd, link))
            .collect(),
    ];
    Constraint { state, g, gd }
}

/// Checks a robot at some states: its standard columns are those of the open tree projected, and
/// its base columns and relations give the same torques, and obey the identities.
pub fn check(robot: &Robot) {
    check_within(robot, &|_| true, 1e-7);
}

/// The same at states that are possible; `tolerance` is relative to the largest entry.
pub fn check_within(robot: &Robot, possible: &dyn Fn(&[f64]) -> bool, tolerance: f64) {
    let mechanism = &robot.mechanism;
    let tree = open(&robot.description);
    let by_name: HashMap<&str, usize> = tree
        .joints
        .iter()
        .enumerate()
        .map(|(link, joint)| (joint.name.as_str(), link))
        .collect();
    let place: Vec<usize> = mechanism
        .joints
        .iter()
        .map(|joint| by_name[joint.name.as_str()])
        .collect();
    for state in states(mechanism.driven, possible) {
        let gap = gap(robot, &state[0]);
        assert!(gap < 1e-9, "{}: open by {gap:.1e}", mechanism.name);
        let constraint = constraint(mechanism, &state);
        let ordered = constraint.state.clone().map(|series| {
            let mut ordered = vec![0.0; series.len()];
            for (link, value) in series.into_iter().enumerate() {
                ordered[place[link]] = value;
            }
            ordered
        });
        let of_tree = columns(&tree, &ordered);
        let own = columns(mechanism, &state);
        for link in 0..mechanism.joints.len() {
            for parameter in 0..10 {
                let tree = &of_tree[10 * place[link] + parameter];
                let projected = projected(tree, &constraint, &place);
                near(&own[10 * link + parameter], &projected, tolerance, robot);
            }
        }
        relations_hold(robot, &own, &state);
        identities_hold(robot, &state);
    }
}

/// How far the two sides of each loop are from each other, by the table of the description and
/// nothing else: distance of the origins, m, or of the directions of the axes.
fn gap(robot: &Robot, q: &[f64]) -> f64 {
    let Geometry::Mdh(rows) = &robot.description.geometry else {
        return 0.0;
    };
    let loops = &robot.description.loops;
    let cuts = loops.iter().map(|one| &one.cut);
    let all = rows
        .iter()
        .chain(cuts)
        .chain(loops.iter().map(|one| &one.meets));
    let positions = robot.mechanism.positions(q);
    let mut frames: Vec<Matrix4<f64>> = vec![];
    for (index, row) in all.enumerate() {
        let joints = &robot.mechanism.joints;
        let own = joints.iter().position(|joint| joint.name == row.name);
        let q = own
            .filter(|_| index < rows.len())
            .map_or(0.0, |k| positions[k]);
        let (turn, slide) = match row.motion {
            Motion::Revolute => (q, 0.0),
            Motion::Prismatic => (0.0, q),
            Motion::Fixed => (0.0, 0.0),
        };
        let about = |axis: Vector3<f64>, angle: f64| Matrix4::new_rotation(axis * angle);
        let along = |axis: Vector3<f64>, by: f64| Matrix4::new_translation(&(axis * by));
        let (x, z) = (Vector3::x(), Vector3::z());
        let step = about(z, row.gamma.value)
            * along(z, row.b.value)
            * about(x, row.alpha.value)
            * along(x, row.d.value)
            * about(z, row.theta.value + turn)
            * along(z, row.r.value + slide);
        let before = row
            .ant
            .checked_sub(1)
            .map_or(Matrix4::identity(), |ant| frames[ant]);
        frames.push(before * step);
    }
    let pairs = (0..loops.len()).map(|k| (rows.len() + k, rows.len() + loops.len() + k));
    let gaps = pairs.map(|(a, b)| {
        let difference = frames[a] - frames[b];
        difference.column(2).norm().max(difference.column(3).norm())
    });
    gaps.fold(0.0, f64::max)
}

/// G^T D, G^T P, G^T R - dG/dt^T P, h.
fn projected(tree: &Column, constraint: &Constraint, place: &[usize]) -> Column {
    let times = |m: &[Vec<f64>], v: &[f64]| -> Vec<f64> {
        m.iter()
            .map(|row| row.iter().zip(place).map(|(g, &at)| g * v[at]).sum())
            .collect()
    };
    let [d, p, r] = &tree.matrices;
    let rest = times(&constraint.g, r);
    let moved = times(&constraint.gd, p);
    Column {
        matrices: [
            times(&constraint.g, d),
            times(&constraint.g, p),
            rest.iter().zip(moved).map(|(r, p)| r - p).collect(),
        ],
        energy: tree.energy,
    }
}

fn near(found: &Column, expected: &Column, tolerance: f64, robot: &Robot) {
    for (found, expected) in found.matrices.iter().zip(&expected.matrices) {
        let scale = expected.iter().fold(1.0f64, |most, x| most.max(x.abs()));
        for (a, b) in found.iter().zip(expected) {
            assert!(
                (a - b).abs() <= tolerance * scale,
                "{}: {a} for {b}",
                robot.mechanism.name
            );
        }
    }
    assert!((found.energy - expected.energy).abs() <= tolerance * expected.energy.abs().max(1.0));
}

/// With any standard parameters the base model gives the torque that the standard model gives.
fn relations_hold(robot: &Robot, standard: &[Column], state: &[Vec<f64>; 3]) {
    let links = robot.mechanism.joints.len();
    let mut random = rand::rngs::StdRng::seed_from_u64(9);
    let values: Vec<f64> = (0..10 * links)
        .map(|_| random.random_range(-1.0..1.0))
        .collect();
    let names = idim_codegen::mechanism::inertia::NAMES;
    let value = |name: &str| {
        let symbol = name.trim_end_matches(|c: char| c.is_ascii_digit());
        let index = names.iter().position(|known| *known == symbol)?;
        let link: usize = name[symbol.len()..].parse().unwrap();
        Some(values[10 * (link - 1) + index])
    };
    let base: Vec<f64> = robot
        .base
        .parameters
        .iter()
        .map(|p| {
            let terms = p.relation.iter();
            terms
                .map(|(by, name)| by * value(name).unwrap_or(0.0))
                .sum()
        })
        .collect();
    let mut torque = vec![0.0; robot.mechanism.driven];
    for entry in robot.entries(Output::Explicit) {
        torque[entry.row] += evaluate(&robot.graph, entry.value, state) * base[entry.column];
    }
    for (joint, torque) in torque.iter().enumerate() {
        let terms = standard.iter().zip(&values);
        let expected: f64 = terms.map(|(c, x)| c.matrices[0][joint] * x).sum();
        let error = (torque - expected).abs();
        assert!(
            error <= 1e-8 * expected.abs().max(1.0),
            "{}: torque {torque} for {expected}",
            robot.mechanism.name
        );
    }
}

/// D = dP/dt + R and qd^T D = dh/dt + dh, column by column, derivatives by differences in time.
fn identities_hold(robot: &Robot, [q, qd, qdd]: &[Vec<f64>; 3]) {
    let (n, nb) = (robot.mechanism.driven, robot.base.parameters.len());
    let moved = |by: f64| {
        let at = |j: usize| q[j] + by * qd[j] + 0.5 * by * by * qdd[j];
        let rate = |j: usize| qd[j] + by * qdd[j];
        [
            (0..n).map(at).collect(),
            (0..n).map(rate).collect::<Vec<f64>>(),
            qdd.clone(),
        ]
    };
    let value = |output: Output, by: f64| {
        let mut dense = vec![0.0; n * nb];
        for entry in robot.entries(output) {
            dense[entry.row * nb + entry.column] += evaluate(&robot.graph, entry.value, &moved(by));
        }
        dense
    };
    let explicit = value(Output::Explicit, 0.0);
    let rest = value(Output::Rest, 0.0);
    let momentum = slope(|by| value(Output::Momentum, by));
    let energy = slope(|by| value(Output::Energy, by));
    let power = value(Output::Power, 0.0);
    let scale = explicit.iter().fold(1.0f64, |most, x| most.max(x.abs()));
    for column in 0..nb {
        let mut sum = 0.0;
        for (row, qd) in qd.iter().enumerate() {
            let at = row * nb + column;
            let implicit = momentum[at] + rest[at];
            assert!(
                (explicit[at] - implicit).abs() <= 1e-7 * scale,
                "{}: D = {}, dP/dt + R = {implicit}",
                robot.mechanism.name,
                explicit[at]
            );
            sum += qd * explicit[at];
        }
        let rate = energy[column] + power[column];
        assert!((sum - rate).abs() <= 1e-7 * scale, "{sum} for {rate}");
    }
}

/// A few states with positions, velocities, accelerations of the driven joints.
fn states(n: usize, possible: &dyn Fn(&[f64]) -> bool) -> Vec<[Vec<f64>; 3]> {
    let mut random = rand::rngs::StdRng::seed_from_u64(4);
    let mut states = vec![];
    while states.len() < 3 {
        let state = [3.0, 2.0, 5.0].map(|most| {
            let draw = (0..n).map(|_| random.random_range(-most..most));
            draw.collect::<Vec<f64>>()
        });
        if possible(&state[0]) {
            states.push(state);
        }
    }
    states
}
