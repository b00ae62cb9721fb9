//! Real measured logs against published and reference results. The data are read from beside the
//! checkout; without them the tests say so and pass.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::path::{Path, PathBuf};

use idim::codegen::builder;
use idim::interpreted::Interpreter;
use idim::robots;
use idim::runtime::identify::{Options, identify, predict};
use idim::runtime::log::{self, LogSpec, ReadOptions, Recording};
use idim::runtime::model::IdentificationModel;
use idim::runtime::observe::ModelKind;
use idim::runtime::report::{Identification, ModelResult};
use serde_json::Value;

fn shared() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: the reference data are not beside this checkout");
    None
}

fn value(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn read(model: &dyn IdentificationModel, folder: &Path, log: &str) -> Recording {
    let spec: LogSpec = folder.join(log).display().to_string().parse().unwrap();
    let drives = &model.settings().drives;
    log::read(&spec, model.joints(), drives, &ReadOptions::default())
        .unwrap()
        .0
}

fn run(model: &dyn IdentificationModel, folder: &Path, train: &str, valid: &str) -> Identification {
    let train = read(model, folder, train);
    let valid = read(model, folder, valid);
    identify(model, &[train], &[valid], &Options::default(), &()).unwrap()
}

fn generated(name: &str) -> &'static dyn IdentificationModel {
    robots::ALL
        .iter()
        .find(|robot| robot.name == name)
        .unwrap()
        .model
}

fn interpreted(name: &str) -> Interpreter {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("robots")
        .join(format!("{name}.toml"));
    Interpreter::new(&builder::read(&path).unwrap().robot)
}

fn digits(value: f64, decimals: usize) -> String {
    format!("{value:.decimals$}")
}

#[test]
fn emps_gives_every_published_digit() {
    let Some(shared) = shared() else { return };
    let folder = shared.join("data/real/emps");
    let result = run(
        generated("emps"),
        &folder,
        "log_train.csv.gz",
        "log_valid_pulses.csv.gz",
    );
    let explicit = result.model(ModelKind::Explicit).unwrap();
    let published = [
        ("M1", "95.1089", "0.1085"),
        ("FV1", "203.5034", "1.1460"),
        ("FS1", "20.3935", "0.1012"),
        ("OFF1", "-3.1648", "0.0444"),
    ];
    for (name, estimate, sigma) in published {
        let parameter = explicit.parameter(name).unwrap();
        assert_eq!(digits(parameter.value.unwrap(), 4), estimate, "{name}");
        assert_eq!(
            digits(parameter.sigma.unwrap(), 4),
            sigma,
            "sigma of {name}"
        );
    }
    assert_eq!(digits(explicit.condition, 4), "25.9883");
    assert_eq!(digits(explicit.fit.total_pct, 4), "4.0834");
    assert_eq!(digits(explicit.validation[0].fit.total_pct, 4), "5.9824");
    assert_eq!(explicit.rows, 2480);
}

#[test]
fn scara_gives_table_1_of_the_recipe() {
    let Some(shared) = shared() else { return };
    let model = generated("scara");
    let log = read(model, &shared, "reference/scara_table1_log.csv.gz");
    let result = identify(model, &[log], &[], &Options::default(), &()).unwrap();
    let table = value(&shared.join("reference/scara_table1.json"));
    for found in &result.models {
        let expected = &table["expected"][found.name.name()];
        assert_eq!(found.rows as u64, expected["rows"].as_u64().unwrap());
        let condition = expected["cond"].as_f64().unwrap();
        assert!(
            (found.condition / condition - 1.0).abs() < 1e-4,
            "{}",
            found.name.name()
        );
        for (name, value) in expected["X_hat"].as_object().unwrap() {
            let parameter = found.parameter(&name.to_uppercase()).unwrap();
            let ratio = parameter.value.unwrap() / value.as_f64().unwrap();
            assert!(
                (ratio - 1.0).abs() < 1e-6,
                "{} {name}: {ratio}",
                found.name.name()
            );
        }
    }
}

/// The protocol of a baseline through the generated model, and the same through the interpreter.
fn baseline(robot: &str, folder: &str, train: &str, valid: &str, key: &str) {
    let Some(shared) = shared() else { return };
    let folder = shared.join("data/real").join(folder);
    let result = run(generated(robot), &folder, train, valid);
    let explicit = result.model(ModelKind::Explicit).unwrap();
    let expected = &value(&folder.join("baseline.json"))["wls"];
    assert_eq!(explicit.rows as u64, expected["n_rows"].as_u64().unwrap());
    let ours = &explicit.validation[0].fit;
    let theirs = &expected["valid"][key];
    within_a_percent(ours.total_pct, &theirs["total_rel_err_pct"], robot);
    for (joint, expected) in ours
        .joints
        .iter()
        .zip(theirs["per_joint"].as_array().unwrap())
    {
        within_a_percent(joint.rel_pct, &expected["rel_err_pct"], &joint.name);
    }
    let again = run(&interpreted(robot), &folder, train, valid);
    for (one, other) in result.models.iter().zip(&again.models) {
        same(one, other);
    }
}

fn within_a_percent(ours: f64, theirs: &Value, what: &str) {
    let theirs = theirs.as_f64().unwrap();
    assert!(
        (ours / theirs - 1.0).abs() < 0.01,
        "{what}: {ours} % instead of {theirs} %"
    );
}

/// The generated model and the interpreter agree to the bit, so their results do.
fn same(one: &ModelResult, other: &ModelResult) {
    assert_eq!(one.parameters, other.parameters, "{}", one.name.name());
    assert_eq!(one.fit, other.fit, "{}", one.name.name());
    assert_eq!(one.validation, other.validation, "{}", one.name.name());
}

#[test]
fn tx40_validates_as_its_baseline() {
    let (train, valid) = ("log.csv.gz@..5", "log.csv.gz@5..7.5");
    baseline("tx40", "staubli_tx40", train, valid, "t5_7p5");
}

#[test]
fn ur10e_validates_as_its_baseline() {
    let train = "identification/20_02_10_30sec_12harm.csv.gz@#635..3510";
    let valid = "validation/20_01_17_ptp_10_points.csv.gz@#700..4200";
    baseline("ur10e", "ur10e", train, valid, "ptp_10_points");
}

#[test]
fn panda_validates_as_its_baseline() {
    baseline(
        "panda",
        "franka_panda",
        "log.csv.gz@..9",
        "log.csv.gz@9..13.2",
        "t9_13p2",
    );
}

#[test]
fn urdf_and_table_of_the_tx40_have_the_same_base_parameters() {
    let Some(shared) = shared() else { return };
    let urdf = shared.join("data/real/staubli_tx40/tx40_mdh_modified.urdf");
    let urdf = Interpreter::new(&builder::read(&urdf).unwrap().robot);
    let names = |model: &dyn IdentificationModel| -> Vec<(String, String)> {
        let columns = model
            .columns()
            .iter()
            .filter(|column| !column.name.contains("M6"));
        columns
            .map(|column| (column.name.to_string(), column.relation.to_string()))
            .collect()
    };
    // The table has the wrist coupling besides: IAM6, FVM6, FSM6.
    assert_eq!(names(&urdf), names(generated("tx40")));
}

#[test]
fn torque_of_a_log_never_reaches_a_prediction() {
    let Some(shared) = shared() else { return };
    let folder = shared.join("data/real/staubli_tx40");
    let model = generated("tx40");
    let log = read(model, &folder, "log.csv.gz@5..7.5");
    let mut blind = log.clone();
    for torque in blind.tau.iter_mut().flatten() {
        torque.fill(f64::NAN);
    }
    let parameters: Vec<f64> = (0..model.columns().len()).map(|i| 1.0 + i as f64).collect();
    let plan = Options::default()
        .resolve(model, std::slice::from_ref(&log))
        .unwrap();
    for kind in ModelKind::ALL {
        let torque = |log| predict(model, log, &parameters, &plan.filtering, kind).unwrap();
        assert_eq!(torque(&log), torque(&blind), "{}", kind.name());
    }
}
