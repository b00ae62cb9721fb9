//! What `idim diagnose --write` writes: a robot that has the effects, and predicts what the
//! diagnosis itself predicts.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::f64::consts::TAU;
use std::path::Path;
use std::process::Command;

use idim::codegen::builder::{read, read_texts};
use idim::interpreted::Interpreter;
use idim::runtime::identify::{self, predict};
use idim::runtime::log::{self, ReadOptions, Recording};
use idim::runtime::model::{IdentificationModel, Output, States};
use idim::runtime::observe::{Filtering, ModelKind};
use idim::runtime::settings::Derivatives;

/// A planar arm of two links in the vertical plane.
const ARM: &str = r#"# an arm
name = "arm"
gravity = [0.0, -9.81, 0.0]
effects = ["viscous", "coulomb"]
[lengths]
L = 0.5 # as drawn
[[joint]]
name = "shoulder"
kind = "revolute"
ant = 0
[[joint]]
name = "elbow"
kind = "revolute"
ant = 1
d = "L"
"#;

/// The same arm as a URDF.
const URDF: &str = r#"<robot name="arm"><link name="base"/><link name="upper"/><link name="fore"/>
  <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/>
    <origin rpy="1.5707963267948966 0 0"/><axis xyz="0 0 1"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="fore"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 0 1"/></joint></robot>"#;

/// What the arm has and its description has not.
const RIPPLE: &str = "[[effect]]\nkind = \"torque_ripple\"\njoint = \"elbow\"\nN = 6\n";

const RATE_HZ: f64 = 500.0;

fn truth(name: &str) -> f64 {
    match name {
        "ZZR1" => 3.5,
        "MXR1" => 4.0,
        "ZZ2" => 0.6,
        "MX2" => 1.2,
        "FV1" => 4.0,
        "FS1" => 6.0,
        "FV2" => 1.5,
        "FS2" => 2.0,
        "RS2" => 0.7,
        "RC2" => -0.3,
        _ => 0.0,
    }
}

/// Logs of a motion of five harmonics, repeated, with noise on the torque.
fn simulate(path: &Path, seed: u32) {
    let robot = read_texts(&[("arm.toml", &format!("{ARM}{RIPPLE}"))]).unwrap();
    let model = Interpreter::new(&robot);
    let len = 3 * 4000;
    let wave = |joint: usize, order: i32, i: usize| -> f64 {
        let term = |k: usize| {
            let omega = TAU * 0.125 * k as f64;
            let phase = f64::from(seed) * 1.3 + joint as f64 * 2.1 + k as f64 * 0.7;
            let angle = omega * i as f64 / RATE_HZ + 3.0 * phase.sin();
            0.6 / k as f64 * omega.powi(order) * (angle + f64::from(order) * TAU / 4.0).sin()
        };
        (1..6).map(term).sum()
    };
    let all = |order: i32| -> Vec<f64> {
        let series = |joint: usize| (0..len).map(move |i| wave(joint, order, i));
        (0..2).flat_map(series).collect()
    };
    let (q, qd, qdd) = (all(0), all(1), all(2));
    let states = States {
        len,
        q: &q,
        qd: &qd,
        qdd: &qdd,
        slip: &[],
    };
    let pattern = model.pattern(Output::Explicit);
    let mut signals = vec![0.0; pattern.signals * len];
    model.evaluate(Output::Explicit, &states, &mut signals);
    let mut tau = vec![vec![0.0; len]; 2];
    for entry in pattern.entries.iter() {
        let x = truth(&model.columns()[entry.column].name);
        let column = &signals[entry.signal * len..][..len];
        tau[entry.row]
            .iter_mut()
            .zip(column)
            .for_each(|(tau, d)| *tau += x * d);
    }
    let mut state = u64::from(seed);
    for tau in tau.iter_mut().flatten() {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        *tau += 0.1 * ((state >> 11) as f64 / (1u64 << 53) as f64 - 0.5);
    }
    let t: Vec<f64> = (0..len).map(|i| i as f64 / RATE_HZ).collect();
    let columns: [(&str, &[f64]); 5] = [
        ("t", &t),
        ("q1", &q[..len]),
        ("q2", &q[len..]),
        ("tau1", &tau[0]),
        ("tau2", &tau[1]),
    ];
    log::write(path, &columns).unwrap();
}

/// Runs `idim diagnose` on two logs of the arm and returns what it prints.
fn diagnose(folder: &Path, robot: &str, write: &str) -> String {
    simulate(&folder.join("train.csv"), 1);
    simulate(&folder.join("valid.csv"), 2);
    let output = Command::new(env!("CARGO_BIN_EXE_idim"))
        .current_dir(folder)
        .args(["diagnose", robot, "train.csv", "--validate", "valid.csv"])
        .args(["--write", write, "--predictions", "predicted"])
        .args(["--html", "page.html", "--json", "found.json"])
        .output()
        .unwrap();
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{complaint}");
    String::from_utf8(output.stdout).unwrap()
}

/// The filter of the diagnosis on these logs.
fn filtering(model: &dyn IdentificationModel, recording: &Recording) -> Filtering {
    let options = identify::Options {
        fq_hz: Some(50.0),
        nd: Some(5),
        derivatives: Some(Derivatives::Central),
        ..identify::Options::default()
    };
    let settled = options.resolve(model, std::slice::from_ref(recording));
    settled.unwrap().filtering
}

/// The largest difference of two predictions where every joint moves: that of the written robot
/// with its parameters, and that of the diagnosis.
fn difference(folder: &Path, written: &Path) -> f64 {
    let robot = read(written).unwrap().robot;
    let model = Interpreter::new(&robot);
    let stated = &robot.description.parameters;
    let value = |name: &str| stated.iter().find(|(known, _)| known == name).unwrap().1;
    let parameters: Vec<f64> = model.columns().iter().map(|c| value(&c.name)).collect();
    let options = ReadOptions {
        require_torque: true,
        companion: None,
    };
    let read_log = |name: &str| {
        let path = folder.join(name).display().to_string();
        let drives = &model.settings().drives;
        log::read(&path.parse().unwrap(), model.joints(), drives, &options)
            .unwrap()
            .0
    };
    let valid = read_log("valid.csv");
    let filtering = filtering(&model, &valid);
    let torque = predict(&model, &valid, &parameters, &filtering, ModelKind::Explicit).unwrap();
    let other = text(&folder.join("predicted/valid_after.csv.gz"));
    let moves = |i: usize| {
        let step = |q: &Vec<f64>| (q[(i + 1).min(valid.len - 1)] - q[i.saturating_sub(1)]).abs();
        valid.q.iter().all(|q| step(q) > 2.0 * 0.05 / RATE_HZ)
    };
    let mut largest: f64 = 0.0;
    let mut compared = 0;
    for (i, line) in other.lines().skip(1).enumerate().filter(|(i, _)| moves(*i)) {
        let values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        for (joint, torque) in torque.iter().enumerate() {
            largest = largest.max((torque[i] - values[joint + 1]).abs());
        }
        compared += 1;
    }
    assert!(compared > valid.len / 2, "{compared}");
    largest
}

fn text(path: &Path) -> String {
    let mut text = String::new();
    let file = std::fs::File::open(path).unwrap();
    std::io::Read::read_to_string(&mut flate2::read::GzDecoder::new(file), &mut text).unwrap();
    text
}

#[test]
fn a_written_table_has_the_effect_and_predicts_what_the_diagnosis_predicts() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("arm.toml"), ARM).unwrap();
    let printed = diagnose(folder.path(), "arm.toml", "arm_found.toml");
    assert!(printed.contains("written: arm_found.toml"), "{printed}");
    let written = folder.path().join("arm_found.toml");
    let text = std::fs::read_to_string(&written).unwrap();
    for kept in ["# an arm", "L = 0.5 # as drawn", "name = \"arm_found\""] {
        assert!(text.contains(kept), "{text}");
    }
    assert!(
        text.contains("kind = \"torque_ripple\"\njoint = \"elbow\"\nN = 6.0"),
        "{text}"
    );
    let largest = difference(folder.path(), &written);
    assert!(largest < 1e-10, "{largest}");
    let json = std::fs::read_to_string(folder.path().join("found.json")).unwrap();
    assert!(
        !json.contains("\"simulation\""),
        "these logs have no controller"
    );
    let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(page.contains("<title>arm: torque ripple on joint 2 (elbow)</title>"));
    assert!(
        page.contains("position of elbow, rad"),
        "the variable that explains it"
    );
    assert!(page.matches("class=\"curve after residual\"").count() == 2);
    assert!(page.len() < 600_000, "{}", page.len());
}

#[test]
fn a_written_companion_finds_its_urdf_from_another_folder() {
    let folder = tempfile::tempdir().unwrap();
    for part in ["robots", "found/here"] {
        std::fs::create_dir_all(folder.path().join(part)).unwrap();
    }
    std::fs::write(folder.path().join("robots/arm.urdf"), URDF).unwrap();
    diagnose(folder.path(), "robots/arm.urdf", "found/here/arm.toml");
    let written = folder.path().join("found/here/arm.toml");
    let text = std::fs::read_to_string(&written).unwrap();
    assert!(text.contains("urdf = \"../../robots/arm.urdf\""), "{text}");
    assert!(text.contains("kind = \"torque_ripple\""), "{text}");
    let largest = difference(folder.path(), &written);
    assert!(largest < 1e-10, "{largest}");
}

/// Runs `idim diagnose` on the arm with other arguments: what it prints, and what it complains of.
fn other(folder: &Path, arguments: &[&str]) -> (bool, String, String) {
    std::fs::write(folder.join("arm.toml"), ARM).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_idim"))
        .current_dir(folder)
        .args(["diagnose", "arm.toml"])
        .args(arguments)
        .output()
        .unwrap();
    // Complaints are wrapped to lines of their own.
    let words = |bytes: &[u8]| {
        let text = String::from_utf8_lossy(bytes).replace('│', " ");
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    (
        output.status.success(),
        words(&output.stdout),
        words(&output.stderr),
    )
}

/// A log with its columns changed line by line.
fn changed(folder: &Path, from: &str, to: &str, change: impl Fn(&mut Vec<f64>)) {
    let text = std::fs::read_to_string(folder.join(from)).unwrap();
    let mut lines = text.lines();
    let mut out = format!("{}\n", lines.next().unwrap());
    for line in lines {
        let mut values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        change(&mut values);
        let words: Vec<String> = values.iter().map(f64::to_string).collect();
        out += &format!("{}\n", words.join(","));
    }
    std::fs::write(folder.join(to), out).unwrap();
}

#[test]
fn a_validation_log_that_can_confirm_nothing_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(&folder.join("train.csv"), 1);
    simulate(&folder.join("valid.csv"), 2);
    // t, q1, q2, tau1, tau2.
    changed(folder, "valid.csv", "unit.csv", |v| v[4] *= 1000.0);
    changed(folder, "valid.csv", "robot.csv", |v| v.swap(3, 4));
    changed(folder, "valid.csv", "degrees.csv", |v| {
        v[1] = v[1].to_degrees();
        v[2] = v[2].to_degrees();
    });
    for (log, piece) in [
        (
            "train.csv",
            "train.csv is the training log train.csv itself",
        ),
        (
            "train.csv@10..24",
            "shares 14.0 s with the training log train.csv",
        ),
        ("degrees.csv", "degrees"),
    ] {
        let (done, said, _) = other(folder, &["train.csv", "--validate", log]);
        assert!(done && said.contains(piece), "{log}: {said}");
    }
    // What is not of this robot at all would confirm anything.
    for (log, piece) in [
        ("unit.csv", "times what the training logs let expect"),
        (
            "robot.csv",
            "is it of another robot, with joints in another order",
        ),
    ] {
        let (done, _, said) = other(folder, &["train.csv", "--validate", log]);
        assert!(!done && said.contains(piece), "{log}: {said}");
    }
    let (_, said, _) = other(folder, &["train.csv", "--validate", "valid.csv"]);
    assert!(!said.contains("warning"), "{said}");
    let (_, said, _) = other(folder, &["train.csv"]);
    assert!(
        said.contains("no validation log: what was found is not confirmed"),
        "{said}"
    );
}

#[test]
fn too_little_data_is_said_with_what_would_be_needed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(&folder.join("train.csv"), 1);
    simulate(&folder.join("valid.csv"), 2);
    let (done, _, said) = other(folder, &["train.csv@0..1.4", "--validate", "valid.csv"]);
    assert!(!done, "{said}");
    assert!(said.contains("use a log of at least"), "{said}");
    let (done, _, said) = other(folder, &["train.csv", "--validate", "valid.csv@0..0.1"]);
    assert!(!done && said.contains("valid.csv"), "{said}");
}
