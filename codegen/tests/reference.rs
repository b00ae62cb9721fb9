//! Against the reference robots: base parameters, regrouping relations, and D, P, R, h on given
//! states. The data are read from beside the checkout; without them the tests say so and pass.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

mod robots;

use std::collections::HashMap;
use std::f64::consts::TAU;

use idim_codegen::catalogue::EffectKind;
use idim_codegen::expr::tape::{Batch, Tape};
use idim_codegen::robot::{Output, Robot};
use nalgebra::DMatrix;
use robots::{description, gravity, reference};
use serde_json::{Value, json};

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

/// The rank of D at rest: what gravity alone can tell.
#[test]
fn gravity_alone_tells_as_many_parameters_as_in_the_reference() {
    let (Some(geometry), Some(base)) = (
        reference("mdh_geometry.json"),
        reference("base_parameters.json"),
    ) else {
        return;
    };
    for (name, expected) in base["robots"].as_object().unwrap() {
        let Some(expected) = expected["base_static"].as_u64() else {
            continue;
        };
        let source = &geometry["robots"][name];
        let robot = Robot::new(description(name, source, gravity(source), &[])).unwrap();
        let n = robot.mechanism.joints.len();
        let columns = robot.base.parameters.len();
        let states = 4 * columns;
        let mut w = DMatrix::zeros(n * states, columns);
        for state in 0..states {
            // Angles that fill the circle, none like another.
            let q = (0..n).map(|joint| 2.4 * (1 + state * n + joint) as f64 % TAU);
            let rest = json!(vec![0.0; n]);
            let sample = json!({ "q": q.collect::<Vec<f64>>(), "dq": rest, "ddq": rest });
            for ((row, column), value) in evaluate(&robot, Output::Explicit, &sample) {
                w[(state * n + row, column)] = value;
            }
        }
        let sigma = w.singular_values();
        let rank = sigma.iter().filter(|&&s| s > 1e-9 * sigma.max()).count();
        let rank = if sigma.max() > 0.0 { rank } else { 0 };
        assert_eq!(rank as u64, expected, "{name}");
    }
}

/// The parallelogram robot without its loops is a tree of eight joints.
#[test]
fn tree_of_the_sr400_has_the_base_parameters_of_the_reference() {
    let (Some(geometry), Some(base)) = (
        reference("mdh_geometry.json"),
        reference("base_parameters.json"),
    ) else {
        return;
    };
    let mut source = geometry["robots"]["SR400"].clone();
    source["frames"].as_array_mut().unwrap().truncate(8);
    source["numeric"] = json!({ "d2": 0.5, "d3": 0.9, "d4": 0.15, "-d8": -0.4, "r4": 0.8 });
    let robot = Robot::new(description("SR400", &source, [0.0, 0.0, -9.81], &[])).unwrap();
    let expected = &base["robots"]["SR400"]["tree_base_rigid"];
    assert_eq!(robot.base.parameters.len(), *expected);
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

/// The relations of OpenSYMORO are nested (`XXR3` stands for `MR4` among others): both are
/// evaluated for other lengths than the robot's, so that what is compared are the laws.
#[test]
fn regrouping_relations_by_name_are_those_of_opensymoro() {
    let (Some(geometry), Some(base)) = (
        reference("mdh_geometry.json"),
        reference("base_parameters.json"),
    ) else {
        return;
    };
    let mut seen = 0;
    for (name, expected) in base["robots"].as_object().unwrap() {
        let Some(symbolic) = expected["symbolic_regroup_opensymoro"].as_object() else {
            continue;
        };
        let source = &geometry["robots"][name];
        let robot = Robot::new(description(name, source, gravity(source), &[])).unwrap();
        // Panda's offsets at the elbow cancel: D5 is -D4 there, and has to stay that.
        let equal = match name.as_str() {
            "Panda" => HashMap::from([("D5", "-D4")]),
            _ => HashMap::new(),
        };
        let mut laws = equal.clone();
        for text in [
            symbolic,
            expected["symbolic_aux_opensymoro"].as_object().unwrap(),
        ] {
            let entries = text.iter();
            laws.extend(entries.map(|(name, law)| (name.as_str(), law.as_str().unwrap())));
        }
        for parameter in &robot.base.parameters {
            let Some(law) = laws.get(parameter.name.as_str()) else {
                continue;
            };
            let own = law_value(&parameter.text, &equal);
            let theirs = law_value(law, &laws);
            assert!(
                (own - theirs).abs() <= 1e-12 * theirs.abs().max(1.0),
                "{name} {}: {} instead of {law}",
                parameter.name,
                parameter.text
            );
            seen += 1;
        }
    }
    assert!(seen > 100, "{seen} relations compared");
}

/// A sum of products, possibly in parentheses and with whole powers; a name without a law of its
/// own has a number that follows from its letters, rotor inertias (not in our rigid models) none.
fn law_value(text: &str, laws: &HashMap<&str, &str>) -> f64 {
    let text = text.replace("**", "^").replace(' ', "");
    let mut depth = 0;
    for operators in ["+-", "*", "^"] {
        for (at, c) in text.char_indices().rev() {
            depth += i32::from(c == ')') - i32::from(c == '(');
            if depth == 0 && operators.contains(c) {
                let (left, right) = (&text[..at], law_value(&text[at + 1..], laws));
                let left = match left {
                    "" => 0.0,
                    left => law_value(left, laws),
                };
                return match c {
                    '+' => left + right,
                    '-' => left - right,
                    '*' => left * right,
                    _ => left.powf(right),
                };
            }
        }
    }
    if let Some(inner) = text.strip_prefix('(') {
        return law_value(inner.strip_suffix(')').unwrap(), laws);
    }
    if let Ok(number) = text.parse() {
        return number;
    }
    match laws.get(text.as_str()) {
        Some(law) => law_value(law, laws),
        None if text.starts_with("IA") => 0.0,
        None => text
            .bytes()
            .fold(0.3, |x: f64, byte| (7.1 * x + f64::from(byte)).sin() + 1.5),
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
