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
use idim::runtime::settings::Edges;
use idim::runtime::signal::Decimator;
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

fn interpreted(folder: &str, name: &str) -> Interpreter {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join(folder)
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

/// A robot's logs, and where its baseline has the figures of the validation log.
struct Set {
    robot: &'static str,
    folder: &'static str,
    train: &'static str,
    valid: &'static str,
    key: &'static str,
}

const TX40: Set = Set {
    robot: "tx40",
    folder: "staubli_tx40",
    train: "log.csv.gz@..5",
    valid: "log.csv.gz@5..7.5",
    key: "t5_7p5",
};

const UR10E: Set = Set {
    robot: "ur10e",
    folder: "ur10e",
    train: "identification/20_02_10_30sec_12harm.csv.gz@#635..3510",
    valid: "validation/20_01_17_ptp_10_points.csv.gz@#700..4200",
    key: "ptp_10_points",
};

const PANDA: Set = Set {
    robot: "panda",
    folder: "franka_panda",
    train: "log.csv.gz@..9",
    valid: "log.csv.gz@9..13.2",
    key: "t9_13p2",
};

/// The usual friction and the filters of a baseline give the baseline's figures.
fn baseline(set: &Set) {
    let Some(shared) = shared() else { return };
    let folder = shared.join("data/real").join(set.folder);
    let model = interpreted("tests/baselines", set.robot);
    let result = run(&model, &folder, set.train, set.valid);
    let explicit = result.model(ModelKind::Explicit).unwrap();
    let expected = &value(&folder.join("baseline.json"))["wls"];
    assert_eq!(explicit.rows as u64, expected["n_rows"].as_u64().unwrap());
    let ours = &explicit.validation[0].fit;
    let theirs = &expected["valid"][set.key];
    within_a_percent(ours.total_pct, &theirs["total_rel_err_pct"], set.robot);
    for (joint, expected) in ours
        .joints
        .iter()
        .zip(theirs["per_joint"].as_array().unwrap())
    {
        within_a_percent(joint.rel_pct, &expected["rel_err_pct"], &joint.name);
    }
}

/// The built-in robot validates better than its baseline, and the joints that the baseline leaves
/// weak, by their number from 1, at most at the given share of it.
fn better_than_baseline(set: &Set, weak: &[(usize, f64)]) {
    let Some(shared) = shared() else { return };
    let folder = shared.join("data/real").join(set.folder);
    let result = run(generated(set.robot), &folder, set.train, set.valid);
    let theirs = &value(&folder.join("baseline.json"))["wls"]["valid"][set.key];
    for kind in [ModelKind::Explicit, ModelKind::Implicit] {
        // The protocol's own filters score both: those of the training do not enter.
        let (total, joints) = scored(&result, kind, set, &folder);
        let limit = theirs["total_rel_err_pct"].as_f64().unwrap();
        assert!(total < limit, "{}: {total} % of {limit} %", set.robot);
        for &(joint, share) in weak {
            let limit = theirs["per_joint"][joint - 1]["rel_err_pct"].as_f64();
            let limit = share * limit.unwrap();
            let ours = joints[joint - 1];
            assert!(ours < limit, "joint {joint}: {ours} % of {limit} %");
        }
    }
    let again = run(
        &interpreted("robots", set.robot),
        &folder,
        set.train,
        set.valid,
    );
    for (one, other) in result.models.iter().zip(&again.models) {
        same(one, other);
    }
}

/// Error of the torque predicted on the validation log, of all joints and of each, in percent,
/// decimated and trimmed as the baseline's protocol has it.
fn scored(result: &Identification, kind: ModelKind, set: &Set, folder: &Path) -> (f64, Vec<f64>) {
    let model = generated(set.robot);
    let log = read(model, folder, set.valid);
    let parameters: Vec<f64> = result
        .model(kind)
        .unwrap()
        .parameters
        .iter()
        .map(|p| p.solution)
        .collect();
    let predicted = predict(model, &log, &parameters, &result.filter, kind).unwrap();
    let protocol = &value(&folder.join("baseline.json"))["protocol"];
    let count = |key: &str| protocol[key].as_u64().unwrap() as usize;
    let (nd, trim) = (count("nd"), count("trim_samples"));
    let decimator = Decimator::new(nd, log.rate_hz, Edges::Scipy).unwrap();
    let rows = |series: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let cut: Vec<Vec<f64>> = series
            .iter()
            .map(|x| x[trim..x.len() - trim].to_vec())
            .collect();
        decimator
            .values(cut.as_slice(), &decimator.kept(cut[0].len()))
            .unwrap()
    };
    let (measured, predicted) = (rows(log.tau.as_ref().unwrap()), rows(&predicted));
    let squares = |x: &[f64]| -> f64 { x.iter().map(|x| x * x).sum() };
    let errors: Vec<(f64, f64)> = measured
        .iter()
        .zip(&predicted)
        .map(|(m, p)| {
            let error: Vec<f64> = m.iter().zip(p).map(|(m, p)| m - p).collect();
            (squares(&error), squares(m))
        })
        .collect();
    let total = errors
        .iter()
        .fold((0.0, 0.0), |sum, e| (sum.0 + e.0, sum.1 + e.1));
    let percent = |(error, all): (f64, f64)| 100.0 * (error / all).sqrt();
    (percent(total), errors.into_iter().map(percent).collect())
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
    baseline(&TX40);
}

#[test]
fn ur10e_validates_as_its_baseline() {
    baseline(&UR10E);
}

#[test]
fn panda_validates_as_its_baseline() {
    baseline(&PANDA);
}

#[test]
fn tx40_with_its_own_friction_validates_better() {
    better_than_baseline(&TX40, &[(5, 0.95), (6, 0.85)]);
}

#[test]
fn ur10e_with_its_own_friction_validates_better() {
    better_than_baseline(&UR10E, &[(1, 0.75), (4, 0.75), (5, 0.8), (6, 0.6)]);
}

#[test]
fn panda_with_its_own_friction_validates_better() {
    better_than_baseline(&PANDA, &[(1, 0.9), (7, 0.5)]);
}

#[test]
fn urdf_and_table_of_the_tx40_have_the_same_base_parameters() {
    let Some(shared) = shared() else { return };
    let urdf = shared.join("data/real/staubli_tx40/tx40_mdh_modified.urdf");
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/baselines/tx40.toml");
    // In numbers: as text a length has the name that its description gives it.
    let relations = |path: &Path| -> Vec<(String, Vec<(f64, String)>)> {
        let robot = builder::read(path).unwrap().robot;
        let parameters = robot.base.parameters.into_iter();
        parameters
            .filter(|parameter| !parameter.name.contains("M6"))
            .map(|parameter| (parameter.name, parameter.relation))
            .collect()
    };
    // The table has the wrist coupling besides: IAM6, FVM6, FSM6.
    assert_eq!(relations(&urdf), relations(&table));
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
