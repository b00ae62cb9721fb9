//! SYMORO's `.par` there and back: the same base parameters, the same D.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::path::PathBuf;

use idim_codegen::builder;
use idim_codegen::describe::Geometry;
use idim_codegen::emit::{self, signals::signals};
use idim_codegen::expr::tape::{Batch, Tape};
use idim_codegen::robot::{Output, Robot};
use rand::{RngExt, SeedableRng};

const SAMPLES: usize = 50;

fn built_in() -> Vec<Robot> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../robots");
    let listing = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = listing.map(|item| item.unwrap().path()).collect();
    paths.sort();
    let robots = paths.iter().map(|path| builder::read(path).unwrap().robot);
    robots
        .filter(|robot| matches!(robot.description.geometry, Geometry::Mdh(_)))
        .collect()
}

/// The robot with what the format can say: neither other effects nor other names of parameters.
fn sayable(robot: &Robot) -> Robot {
    use idim_codegen::catalogue::EffectKind::{Coulomb, RotorInertia, Viscous};
    let mut description = robot.description.clone();
    let plain = |effect: &idim_codegen::describe::EffectSpec| {
        [Viscous, Coulomb, RotorInertia].contains(&effect.kind)
            && effect.shape.iter().all(|&(_, value)| value == 0.0)
    };
    description.effects.retain(plain);
    description.scaled.clear();
    Robot::new(description).unwrap()
}

/// Name, relation and D, dense, sample by sample, of a column.
type Column = (String, Vec<(f64, String)>, Vec<f64>);

/// All columns by name.
fn explicit(robot: &Robot) -> Vec<Column> {
    let n = robot.mechanism.joints.len();
    let mut random = rand::rngs::StdRng::seed_from_u64(7);
    let mut draw = || -> Vec<f64> {
        (0..n * SAMPLES)
            .map(|_| random.random_range(-3.0..3.0))
            .collect()
    };
    let (q, qd, qdd) = (draw(), draw(), draw());
    let signals = signals(robot, Output::Explicit);
    let mut values = vec![0.0; signals.values.len() * SAMPLES];
    let batch = Batch {
        len: SAMPLES,
        q: &q,
        qd: &qd,
        qdd: &qdd,
        slip: &[],
    };
    Tape::new(&robot.graph, &signals.values).run(&batch, &mut values);
    let parameters = robot.base.parameters.iter().enumerate();
    let mut columns: Vec<_> = parameters
        .map(|(column, parameter)| {
            let mut dense = vec![0.0; n * SAMPLES];
            let own = signals.entries.iter().filter(|entry| entry.1 == column);
            for &(row, _, signal) in own {
                dense[row * SAMPLES..][..SAMPLES]
                    .copy_from_slice(&values[signal * SAMPLES..][..SAMPLES]);
            }
            (parameter.name.clone(), parameter.relation.clone(), dense)
        })
        .collect();
    columns.sort_by(|a, b| a.0.cmp(&b.0));
    columns
}

#[test]
fn import_of_export_has_the_same_base_parameters_and_the_same_d() {
    let robots = built_in();
    assert!(robots.len() >= 6, "{} robots with a table", robots.len());
    for robot in robots {
        let file = emit::par(&robot).unwrap();
        let read = builder::read_texts(&[(&file.name, &file.text)]);
        let read = read.unwrap_or_else(|error| panic!("{error}\n{}", file.text));
        assert_eq!(read.mechanism.name, robot.mechanism.name);
        assert_eq!(read.description.gravity, robot.description.gravity);
        let (there, back) = (explicit(&sayable(&robot)), explicit(&read));
        assert_eq!(there.len(), back.len(), "{}", file.text);
        for ((name, relation, before), (other, same, after)) in there.iter().zip(&back) {
            assert_eq!(name, other);
            assert_eq!(relation.len(), same.len(), "{name}");
            for ((x, standard), (y, again)) in relation.iter().zip(same) {
                assert_eq!(standard, again, "{name}");
                assert!(
                    (x - y).abs() <= 1e-12 * x.abs().max(1.0),
                    "{name}: {x} and {y}"
                );
            }
            let scale = before.iter().fold(1.0f64, |scale, x| scale.max(x.abs()));
            for (x, y) in before.iter().zip(after) {
                assert!((x - y).abs() <= 1e-12 * scale, "{name}: {x} and {y}");
            }
        }
    }
}

#[test]
fn export_says_what_the_format_cannot() {
    let robots = built_in();
    let tx40 = robots.iter().find(|robot| robot.mechanism.name == "tx40");
    let text = emit::par(tx40.unwrap()).unwrap().text;
    assert!(
        text.contains("(* not in this format: wrist_coupling of "),
        "{text}"
    );
    let again = emit::par(tx40.unwrap()).unwrap().text;
    assert_eq!(text, again);
}

#[test]
fn inertial_numbers_of_a_par_become_values_of_the_base_parameters() {
    let text = "NL = 2\nalpha = {0,-Pi/2}\nd = {0,0.5}\nZZ = {1,2}\nM = {3,4}\nMX = {0,0.5}\n\
                IA = {0.1,0}\nFV = {0.2,0}\n";
    let robot = builder::read_texts(&[("two.par", text)]).unwrap();
    let known = idim_codegen::knowledge::Knowledge::of(&robot);
    let value = |name: &str| {
        let mut parameters = robot.base.parameters.iter();
        let place = parameters.position(|parameter| parameter.name.starts_with(name));
        known.nominal[place.unwrap()]
    };
    // ZZ1 + IA1 + YY2 + d^2 M2 by hand; YY2 is 0.
    assert!((value("ZZR1").unwrap() - (1.0 + 0.1 + 0.25 * 4.0)).abs() < 1e-12);
    assert_eq!(value("FV1"), Some(0.2));
}
