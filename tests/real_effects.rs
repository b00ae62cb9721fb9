//! Effects that real robots are known to have, hidden by leaving them out of the description: the
//! diagnosis names them first and the error on data that were not used falls below what the
//! literature's models reach. The logs are read from beside the checkout; without them the tests
//! say so and pass.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

fn shared() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/real");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: the reference data are not beside this checkout");
    None
}

/// The description of a built-in robot without its effects; the published one of EMPS has none.
fn bare(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("robots/{name}.toml"));
    let text = std::fs::read_to_string(path).unwrap();
    let mut kept = String::new();
    let mut keeping = true;
    for line in text.lines() {
        if line.starts_with('[') {
            keeping = line != "[[effect]]";
        }
        if keeping {
            kept.push_str(line);
            kept.push('\n');
        }
    }
    kept
}

/// What is said of a robot without its effects.
fn said(name: &str, train: &[PathBuf], validate: &[PathBuf]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let robot = folder.path().join("robot.toml");
    std::fs::write(&robot, bare(name)).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_idim"));
    command.arg("diagnose").arg(robot).args(train);
    for log in validate {
        command.arg("--validate").arg(log);
    }
    let output = command.args(["--json", "-", "--quiet"]).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn named(said: &Value) -> Vec<(String, Vec<u64>)> {
    let effects = said["effects"].as_array().unwrap().iter();
    effects
        .map(|effect| {
            let joints = effect["joints"].as_array().unwrap().iter();
            let joints = joints.map(|joint| joint.as_u64().unwrap()).collect();
            (effect["effect"].as_str().unwrap().to_owned(), joints)
        })
        .collect()
}

/// Torque error in percent before and after.
fn gap(said: &Value) -> [f64; 2] {
    ["before", "after"].map(|when| said["gap"]["torque"][when]["total_pct"].as_f64().unwrap())
}

fn effect(name: &str, joints: &[u64]) -> (String, Vec<u64>) {
    (name.to_owned(), joints.to_vec())
}

#[test]
fn the_wrist_coupling_of_the_tx40_is_named() {
    let Some(folder) = shared() else { return };
    let part = |range: &str| folder.join(format!("staubli_tx40/log.csv.gz@{range}"));
    let said = said("tx40", &[part("0..5")], &[part("5..7.5")]);
    assert_eq!(named(&said)[0], effect("transmission_coupling", &[5, 6]));
    let [before, after] = gap(&said);
    println!("TX40 without its wrist coupling: {before:.2} -> {after:.2} %");
    assert!(before > 15.0 && after < 9.0);
    // The published identification has 1.95 N m of dry friction on the common shaft.
    let shaft = &said["effects"][0]["parameters"][0];
    let (value, sigma) = (
        shaft["value"].as_f64().unwrap(),
        shaft["sigma"].as_f64().unwrap(),
    );
    assert!((value - 1.95).abs() < 2.0 * sigma, "{value} +- {sigma}");
}

#[test]
fn the_loaded_gears_of_the_ur10e_are_named() {
    let Some(folder) = shared() else { return };
    let log = |name: &str| folder.join(format!("ur10e/identification/{name}.csv.gz"));
    let said = said(
        "ur10e",
        &[log("20_02_12_40sec_12harm"), log("20_02_12_50sec_12harm")],
        &[log("20_02_19_14harm50sec"), log("20_02_19_15harm50sec")],
    );
    let named = named(&said);
    assert_eq!(named[0], effect("load_dependent_friction", &[2]));
    assert_eq!(named[1], effect("load_dependent_friction", &[3]));
    let [before, after] = gap(&said);
    println!("UR10e without friction under load: {before:.2} -> {after:.2} %");
    assert!(before > 4.0 && after < 3.83);
}

#[test]
fn the_asymmetric_friction_of_emps_is_named() {
    let Some(folder) = shared() else { return };
    let log = |name: &str| folder.join(format!("emps/{name}.csv.gz"));
    let said = said("emps", &[log("log_train")], &[log("log_valid_pulses")]);
    assert_eq!(named(&said)[0], effect("viscous_asymmetry", &[1]));
    let [before, after] = gap(&said);
    println!("EMPS with symmetric friction: {before:.2} -> {after:.2} %");
    assert!(after < 0.9 * before);
}
