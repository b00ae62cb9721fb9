//! The estimators beside least squares, as a user meets them.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn idim(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_idim"))
        .args(arguments)
        .output()
        .unwrap()
}

#[track_caller]
fn json(arguments: &[&str]) -> Value {
    let output = idim(&[arguments, &["--json", "-"]].concat());
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {text}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn shared() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: the reference data are not beside this checkout");
    None
}

fn text(path: &Path) -> String {
    path.display().to_string()
}

/// A carriage that is described as 5 % too heavy, with tolerances and without friction values.
const CARRIAGE: &str = r#"<robot name="carriage"><link name="base"/><link name="slide"><inertial>
<origin xyz="0 0 0"/><mass value="2.1"/>
<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
<joint name="rail" type="prismatic"><parent link="base"/><child link="slide"/><axis xyz="1 0 0"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"#;

fn carriage(folder: &Path, mass: f64) -> String {
    std::fs::write(folder.join("carriage.urdf"), CARRIAGE).unwrap();
    let toml = format!(
        "name = 'carriage'\nurdf = 'carriage.urdf'\neffects = ['viscous', 'coulomb']\n\
         [prior]\nmass = {mass}\ncom = 0.01\ninertia = 0.1\n"
    );
    let path = folder.join("carriage.toml");
    std::fs::write(&path, toml).unwrap();
    text(&path)
}

/// 2 kg on a sine of 0.2 m.
fn carriage_log(folder: &Path) -> String {
    let rows = (0..3000).map(|row| {
        let t = f64::from(row) * 0.01;
        let (q, qd, qdd) = (
            0.2 * (3.0 * t).sin(),
            0.6 * (3.0 * t).cos(),
            -1.8 * (3.0 * t).sin(),
        );
        let noise = 0.2 * (f64::from(row) * 1.7).sin() * (f64::from(row) * 0.31).cos();
        let tau = 2.0 * qdd + 3.0 * qd + 0.7 * qd.signum() + noise;
        format!("{t:.2},{q},{tau}\n")
    });
    let path = folder.join("log.csv");
    std::fs::write(&path, format!("t,q1,tau1\n{}", rows.collect::<String>())).unwrap();
    text(&path)
}

fn parameter<'a>(result: &'a Value, name: &str) -> &'a Value {
    let all = result["models"][0]["parameters"].as_array().unwrap();
    all.iter().find(|p| p["name"] == name).unwrap()
}

#[test]
fn tolerances_of_a_description_stand_beside_the_classical_estimate() {
    let folder = tempfile::tempdir().unwrap();
    let log = carriage_log(folder.path());
    let of = |mass: f64, more: &[&str]| {
        let robot = carriage(folder.path(), mass);
        json(&[&["identify", &robot, &log, "--models", "explicit"], more].concat())
    };
    let sharp = of(1e-4, &[]);
    let mass = parameter(&sharp, "M1");
    assert!((mass["nominal"].as_f64().unwrap() - 2.1).abs() < 1e-12);
    let own = mass["with_prior"]["sigma_before"].as_f64().unwrap();
    assert!((own - 2.1e-4).abs() < 1e-9);
    assert!((mass["with_prior"]["value"].as_f64().unwrap() - 2.1).abs() < 0.01);
    assert!(
        (mass["value"].as_f64().unwrap() - 2.0).abs() < 0.02,
        "classical: {mass}"
    );
    // Friction is not described: the log alone says.
    let friction = parameter(&sharp, "FV1");
    assert!(friction["nominal"].is_null() && friction["with_prior"]["sigma_before"].is_null());
    let wide = of(1e4, &[]);
    let mass = parameter(&wide, "M1");
    let difference =
        mass["with_prior"]["value"].as_f64().unwrap() - mass["value"].as_f64().unwrap();
    assert!(difference.abs() < 1e-6);
    let without = of(1e-4, &["--prior", "ignore"]);
    assert!(parameter(&without, "M1")["with_prior"].is_null());
}

#[test]
fn practice_robots_agree_with_their_tolerances() {
    let Some(shared) = shared() else { return };
    // The description carries the errors of an honest calibration within its tolerances: log and
    // description must not be further apart than these say, and knowing both must not validate
    // worse.
    let case = shared.join("hidden_effects_practice/cases/case_001");
    let [robot, train, valid] =
        ["robot.toml", "train.csv.gz", "valid.csv.gz"].map(|file| text(&case.join(file)));
    let result = json(&[
        "identify",
        &robot,
        &train,
        "--validate",
        &valid,
        "--models",
        "explicit",
    ]);
    let model = &result["models"][0];
    let with_prior = &model["with_prior"];
    assert!(
        with_prior["misfit"].as_f64().unwrap() < 2.0,
        "{}",
        with_prior["misfit"]
    );
    let classical = model["validation"][0]["total_pct"].as_f64().unwrap();
    let found = with_prior["validation"][0]["total_pct"].as_f64().unwrap();
    println!("validation {classical:.2} % without, {found:.2} % with the prior");
    assert!(found < 1.02 * classical);
}
