//! Against the reference robots: base parameters, regrouping relations, and D, P, R, h on given
//! states. The data are read from beside the checkout; without them the tests say so and pass.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::collections::HashMap;
use std::path::PathBuf;

use idim_codegen::catalogue::EffectKind;
use idim_codegen::describe::{
    Description, EffectSpec, Geometry, Limits, MdhRow, Motion, Quantity, Span,
};
use idim_codegen::expr::tape::{Batch, Tape};
use idim_codegen::robot::{Output, Robot};
use serde_json::Value;

fn reference(name: &str) -> Option<Value> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../shared/reference/generators")
        .join(name);
    match std::fs::read_to_string(&path) {
        Ok(text) => Some(serde_json::from_str(&text).unwrap()),
        Err(error) => {
            println!("skipped: {name} is not beside this checkout ({error})");
            None
        }
    }
}

/// The serial robots of the geometry file with gravity along `gravity`.
fn description(
    name: &str,
    robot: &Value,
    gravity: [f64; 3],
    effects: &[EffectKind],
) -> Description {
    let lengths = &robot["numeric"];
    let number = |value: &Value| -> Quantity {
        let text = value.as_str().unwrap().to_owned();
        let value = match text.as_str() {
            "pi/2" => std::f64::consts::FRAC_PI_2,
            "-pi/2" => -std::f64::consts::FRAC_PI_2,
            text if text.starts_with("th") => 0.0,
            text => text.parse().ok().or(lengths[text].as_f64()).unwrap_or(0.0),
        };
        Quantity { value, text }
    };
    let rows: Vec<MdhRow> = robot["frames"]
        .as_array()
        .unwrap()
        .iter()
        .map(|frame| MdhRow {
            name: format!("joint{}", frame["j"]),
            motion: if frame["sigma"] == 1 {
                Motion::Prismatic
            } else {
                Motion::Revolute
            },
            ant: frame["ant"].as_u64().unwrap() as usize,
            gamma: number(&frame["gamma"]),
            b: number(&frame["b"]),
            alpha: number(&frame["alpha"]),
            d: number(&frame["d"]),
            theta: number(&frame["theta"]),
            r: number(&frame["r"]),
            limits: Limits::default(),
            span: Span::default(),
        })
        .collect();
    let effects = rows
        .iter()
        .flat_map(|row| {
            effects.iter().map(|&kind| EffectSpec {
                kind,
                joints: vec![row.name.clone()],
                shape: vec![],
                span: Span::default(),
            })
        })
        .collect();
    Description {
        name: name.to_lowercase(),
        hash: String::new(),
        gravity,
        lengths: vec![],
        geometry: Geometry::Mdh(rows),
        effects,
        scaled: vec![],
        identify: Default::default(),
        drives: Default::default(),
        parameters: vec![],
        prior: None,
        warnings: vec![],
        snaps: vec![],
    }
}

fn gravity(robot: &Value) -> [f64; 3] {
    match robot["gravity"][2].as_str() {
        Some("G3") => [0.0, 0.0, -9.81],
        _ => [0.0; 3],
    }
}

/// The name of the independent standard parameter of each base parameter.
fn kept(robot: &Robot) -> Vec<String> {
    robot
        .base
        .parameters
        .iter()
        .map(|p| p.relation[0].1.clone())
        .collect()
}

#[test]
fn base_parameters_are_the_classical_ones() {
    let (Some(geometry), Some(base)) = (
        reference("mdh_geometry.json"),
        reference("base_parameters.json"),
    ) else {
        return;
    };
    for (name, expected) in base["robots"].as_object().unwrap() {
        let Some(columns) = expected["base_columns"].as_array() else {
            continue;
        };
        let source = &geometry["robots"][name];
        let rigid = Robot::new(description(name, source, gravity(source), &[])).unwrap();
        assert_eq!(sorted(kept(&rigid)), sorted(texts(columns)), "{name}");
        assert!(rigid.base.gap > 1e6, "{name}: gap {:.1e}", rigid.base.gap);

        let rotor = description(name, source, gravity(source), &[EffectKind::RotorInertia]);
        let rotor = Robot::new(rotor).unwrap();
        assert_eq!(
            rotor.base.parameters.len(),
            expected["base_with_rotor"],
            "{name}, rotors"
        );

        let tilted = description(name, source, [3.0, -2.0, -9.0], &[]);
        let tilted = Robot::new(tilted).unwrap();
        assert_eq!(
            tilted.base.parameters.len(),
            expected["base_rigid_tilted_gravity"],
            "{name}"
        );
    }
}

#[test]
fn regrouping_relations_are_those_of_the_reference() {
    let (Some(geometry), Some(base)) = (
        reference("mdh_geometry.json"),
        reference("base_parameters.json"),
    ) else {
        return;
    };
    for (name, expected) in base["robots"].as_object().unwrap() {
        let Some(dropped) = expected["numeric_regroup_of_eliminated"].as_object() else {
            continue;
        };
        let source = &geometry["robots"][name];
        let robot = Robot::new(description(name, source, gravity(source), &[])).unwrap();
        let mut relations: HashMap<(String, String), f64> = HashMap::new();
        for parameter in &robot.base.parameters {
            for (coefficient, other) in &parameter.relation[1..] {
                relations.insert(
                    (other.clone(), parameter.relation[0].1.clone()),
                    *coefficient,
                );
            }
        }
        let mut seen = 0;
        for (other, into) in dropped {
            for (kept, coefficient) in into.as_object().unwrap() {
                let coefficient = coefficient.as_f64().unwrap();
                let ours = relations
                    .get(&(other.clone(), kept.clone()))
                    .copied()
                    .unwrap_or(0.0);
                assert!(
                    (ours - coefficient).abs() < 1e-10,
                    "{name}: {other} into {kept}: {ours}"
                );
                seen += 1;
            }
        }
        assert_eq!(
            seen,
            relations.len(),
            "{name}: relations beyond the reference's"
        );
    }
}

#[test]
fn models_equal_the_test_vectors() {
    let (Some(geometry), Some(vectors)) = (
        reference("mdh_geometry.json"),
        reference("test_vectors.json"),
    ) else {
        return;
    };
    let robots = vectors["robots"].as_object().unwrap();
    assert_eq!(robots.len(), 12);
    for (name, vector) in robots {
        let down = -vector["gravity_z"].as_f64().unwrap().abs();
        let source = &geometry["robots"][name];
        let robot = Robot::new(description(name, source, [0.0, 0.0, down], &[])).unwrap();
        let names = texts(vector["columns"].as_array().unwrap());
        let places: Vec<usize> = names
            .iter()
            .map(|column| kept(&robot).iter().position(|ours| ours == column).unwrap())
            .collect();
        for sample in vector["samples"].as_array().unwrap() {
            let checks = [
                (Output::Explicit, "D"),
                (Output::Momentum, "P"),
                (Output::Rest, "R"),
                (Output::Energy, "h"),
            ];
            for (output, key) in checks {
                let ours = evaluate(&robot, output, sample);
                let rows = match sample[key][0].is_array() {
                    true => sample[key].as_array().unwrap().clone(),
                    false => vec![sample[key].clone()],
                };
                for (row, values) in rows.iter().enumerate() {
                    for (column, expected) in numbers(values).into_iter().enumerate() {
                        let value = ours.get(&(row, places[column])).copied().unwrap_or(0.0);
                        let error = (value - expected).abs() / expected.abs().max(1.0);
                        assert!(
                            error <= 1e-12,
                            "{name} {key}[{row}][{}]: {value} instead of {expected}",
                            names[column]
                        );
                    }
                }
            }
        }
    }
}

fn evaluate(robot: &Robot, output: Output, sample: &Value) -> HashMap<(usize, usize), f64> {
    let entries = robot.entries(output);
    let values: Vec<_> = entries.iter().map(|entry| entry.value).collect();
    let (q, qd, qdd) = (
        numbers(&sample["q"]),
        numbers(&sample["dq"]),
        numbers(&sample["ddq"]),
    );
    let mut out = vec![0.0; values.len()];
    let batch = Batch {
        len: 1,
        q: &q,
        qd: &qd,
        qdd: &qdd,
        slip: &[],
    };
    Tape::new(&robot.graph, &values).run(&batch, &mut out);
    entries
        .iter()
        .zip(out)
        .map(|(entry, value)| ((entry.row, entry.column), value))
        .collect()
}

fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap()
        .iter()
        .map(|x| x.as_f64().unwrap())
        .collect()
}

fn texts(values: &[Value]) -> Vec<String> {
    values
        .iter()
        .map(|value| value.as_str().unwrap().to_owned())
        .collect()
}

fn sorted(mut names: Vec<String>) -> Vec<String> {
    names.sort();
    names
}
