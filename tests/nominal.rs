//! What has changed on a robot whose parameters are known: each change named first on simulated
//! logs, nothing where nothing has changed, and real logs with a known load and with pushes.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use idim::catalogue::{Changes, Effects};
use idim::codegen::Robot;
use idim::codegen::builder::read_texts;
use idim::interpreted::Interpreter;
use idim::runtime::diagnose::{Log, Nominal, Options, changes};
use idim::runtime::log::{Companion, Recording};
use idim::runtime::model::{IdentificationModel, Output as Rows, States};
use idim::runtime::report::{Diagnosis, Verdict};
use serde_json::Value;

/// An arm of four joints on a vertical axis.
const ARM: &str = r#"
name = "arm"
gravity = [0.0, 0.0, -9.81]
effects = ["viscous", "coulomb", "offset", "rotor_inertia"]
[[joint]]
name = "base"
kind = "revolute"
[[joint]]
name = "shoulder"
kind = "revolute"
alpha = "pi/2"
[[joint]]
name = "elbow"
kind = "revolute"
d = 0.45
[[joint]]
name = "wrist"
kind = "revolute"
alpha = "pi/2"
r = 0.4
"#;

const RATE_HZ: f64 = 500.0;
const SECONDS: f64 = 24.0;

/// Standard parameters of the true arm.
fn standard() -> BTreeMap<String, f64> {
    let mut all = BTreeMap::new();
    for (link, mass, along) in [(1, 8.0, 0.0), (2, 6.0, 0.2), (3, 4.0, 0.1), (4, 1.5, 0.05)] {
        let mut set = |name: &str, value: f64| {
            all.insert(format!("{name}{link}"), value);
        };
        set("M", mass);
        set("MX", mass * along);
        set("MY", 0.05 * mass);
        set("MZ", 0.04 * mass);
        set("XX", 0.02 * mass);
        set("YY", mass * (0.02 + along * along));
        set("ZZ", mass * (0.02 + along * along));
        set("IA", 0.5 / f64::from(link));
        set("FV", 6.0 / f64::from(link));
        set("FS", 8.0 / f64::from(link));
        set("OFF", 0.3);
    }
    all
}

fn robot(text: &str) -> Robot {
    read_texts(&[("arm.toml", text)]).unwrap()
}

/// Base parameters by the regrouping relations.
fn base(robot: &Robot, standard: &BTreeMap<String, f64>) -> Vec<f64> {
    let term = |(factor, name): &(f64, String)| factor * standard.get(name).unwrap_or(&0.0);
    let parameters = robot.base.parameters.iter();
    parameters
        .map(|p| p.relation.iter().map(term).sum())
        .collect()
}

/// A change of the arm or of its log.
struct Change {
    /// Its description.
    text: String,
    standard: BTreeMap<String, f64>,
    /// Factor of the torque of each joint.
    gain: [f64; 4],
    /// Samples that the torque is late.
    late: usize,
    /// Torque on joints during an interval, s.
    touch: Option<(f64, f64, [f64; 4])>,
}

fn nothing() -> Change {
    Change {
        text: ARM.to_owned(),
        standard: standard(),
        gain: [1.0; 4],
        late: 0,
        touch: None,
    }
}

/// The log of a changed arm along a rich motion: 0.1 N m and less of noise, an encoder behind a gear.
fn log(change: &Change) -> Log {
    let robot = robot(&change.text);
    let model = Interpreter::new(&robot);
    let values = base(&robot, &change.standard);
    let len = (SECONDS * RATE_HZ) as usize;
    let joints = 4;
    let wave = |joint: usize, i: usize, order: u32| -> f64 {
        let term = |k: usize| {
            let omega = TAU * (0.09 + 0.007 * joint as f64) * k as f64;
            let phase = (joint as f64 * 2.1 + k as f64 * 1.7).sin() * 3.0;
            let angle = omega * i as f64 / RATE_HZ + phase + f64::from(order) * TAU / 4.0;
            0.7 / k as f64 * omega.powi(order as i32) * angle.sin()
        };
        (1..6).map(term).sum()
    };
    let all = |order: u32| -> Vec<f64> {
        let samples = (0..joints).flat_map(|j| (0..len).map(move |i| (j, i)));
        samples.map(|(j, i)| wave(j, i, order)).collect()
    };
    let (q, qd, qdd) = (all(0), all(1), all(2));
    let states = States {
        len,
        q: &q,
        qd: &qd,
        qdd: &qdd,
        slip: &[],
    };
    let pattern = model.pattern(Rows::Explicit);
    let mut signals = vec![0.0; pattern.signals * len];
    model.evaluate(Rows::Explicit, &states, &mut signals);
    let mut tau = vec![vec![0.0; len]; joints];
    for entry in pattern.entries.iter() {
        let d = &signals[entry.signal * len..][..len];
        let pairs = tau[entry.row].iter_mut().zip(d);
        pairs.for_each(|(tau, d)| *tau += d * values[entry.column]);
    }
    let mut state = 7_u64;
    let mut uniform = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    for (joint, tau) in tau.iter_mut().enumerate() {
        if let Some((from, to, torque)) = change.touch {
            let inside = (from * RATE_HZ) as usize..(to * RATE_HZ) as usize;
            tau[inside].iter_mut().for_each(|tau| *tau += torque[joint]);
        }
        let before = tau.clone();
        for (i, tau) in tau.iter_mut().enumerate() {
            let noise: f64 = (0..12).map(|_| uniform()).sum();
            *tau = change.gain[joint] * before[i.saturating_sub(change.late)]
                + [0.2, 0.2, 0.1, 0.05][joint] * noise;
        }
    }
    let step = TAU / f64::from(1 << 17) / 40.0;
    let rounded = |q: &f64| (q / step).round() * step;
    let recording = Recording {
        name: "log.csv".into(),
        stem: "log".into(),
        rate_hz: RATE_HZ,
        start: 0.0,
        len,
        q: q.chunks(len)
            .map(|q| q.iter().map(rounded).collect())
            .collect(),
        qd: None,
        tau: Some(tau),
        doubtful: Vec::new(),
        stamps: (0..len).map(|i| i as f64 / RATE_HZ).collect(),
        warnings: Vec::new(),
    };
    Log {
        recording,
        companion: Companion::default(),
    }
}

/// What is said of a changed arm by someone who knows the one before.
fn said(change: &Change) -> Diagnosis {
    let robot = robot(ARM);
    let model = Interpreter::new(&robot);
    let values = base(&robot, &standard());
    let nominal = Nominal {
        source: "known.toml",
        values: &values,
        load_mass: None,
    };
    let effects = Effects::new(&robot);
    let catalogue = Changes::new(&effects);
    let logs = [log(change)];
    let options = Options::default();
    let found = changes(&model, &catalogue, &nominal, (&logs, &[]), &options, &());
    found.unwrap().0
}

/// The strongest effect: name, joints, its parameter by name with its sigma.
fn first(diagnosis: &Diagnosis) -> (&str, &[usize]) {
    let first = diagnosis.effects.first();
    first.map_or(("", &[]), |found| (found.effect.as_str(), &found.joints))
}

fn parameter(diagnosis: &Diagnosis, name: &str) -> (f64, f64) {
    let mut all = diagnosis
        .effects
        .iter()
        .flat_map(|effect| &effect.parameters);
    let found = all.find(|parameter| parameter.name == name).unwrap();
    (found.value, found.sigma.unwrap())
}

/// Named alone, and the truth within four standard deviations that are small beside it.
fn is_named(diagnosis: &Diagnosis, (effect, joints): (&str, &[usize]), truth: &[(&str, f64)]) {
    assert_eq!(
        first(diagnosis),
        (effect, joints),
        "{:?}",
        diagnosis.effects
    );
    assert_eq!(diagnosis.effects.len(), 1, "{:?}", diagnosis.effects);
    assert_eq!(diagnosis.verdict, Verdict::Named);
    assert!(diagnosis.changed.as_ref().unwrap().contacts.is_empty());
    for (name, value) in truth {
        let (found, sigma) = parameter(diagnosis, name);
        assert!(
            (found - value).abs() < 4.0 * sigma,
            "{name}: {found} +- {sigma}, true {value}"
        );
        assert!(sigma < 0.15 * value.abs(), "{name}: {found} +- {sigma}");
    }
}

#[test]
fn nothing_is_said_where_nothing_has_changed() {
    let diagnosis = said(&nothing());
    assert_eq!(diagnosis.verdict, Verdict::Nothing);
    assert!(diagnosis.effects.is_empty(), "{:?}", diagnosis.effects);
    assert!(diagnosis.changed.unwrap().is_empty());
}

#[test]
fn a_payload_is_named_with_its_mass_and_centre() {
    let mut change = nothing();
    for (name, value) in [
        ("M4", 2.0),
        ("MX4", 0.06),
        ("MY4", -0.1),
        ("MZ4", 0.3),
        ("ZZ4", 0.01),
    ] {
        *change.standard.get_mut(name).unwrap() += value;
    }
    let diagnosis = said(&change);
    is_named(
        &diagnosis,
        ("payload", &[4]),
        &[("PM", 2.0), ("PMX", 0.06), ("PMY", -0.1), ("PMZ", 0.3)],
    );
    let load = diagnosis.changed.unwrap().payload.unwrap();
    let com = load.com.unwrap();
    for (found, value) in com.iter().zip([0.03, -0.05, 0.15]) {
        assert!((found.value - value).abs() < 0.005, "{com:?}");
    }
}

#[test]
fn friction_of_one_joint_is_named_with_its_part() {
    let mut change = nothing();
    *change.standard.get_mut("FV3").unwrap() *= 1.3;
    *change.standard.get_mut("FS3").unwrap() *= 1.3;
    let diagnosis = said(&change);
    is_named(
        &diagnosis,
        ("friction_change", &[3]),
        &[("DFV3", 0.6), ("DFS3", 0.8)],
    );
    let friction = diagnosis.changed.unwrap().friction;
    let coulomb = friction.iter().find(|f| f.parameter == "FS3").unwrap();
    assert!((coulomb.before.unwrap() - 8.0 / 3.0).abs() < 1e-9);
}

#[test]
fn the_gain_of_a_drive_is_told_from_that_of_all() {
    let mut one = nothing();
    one.gain[1] = 0.95;
    is_named(&said(&one), ("drive_gain", &[2]), &[("DG2", -0.05)]);
    let mut all = nothing();
    all.gain = [0.95; 4];
    is_named(&said(&all), ("drive_gain", &[]), &[("DG", -0.05)]);
}

#[test]
fn a_late_torque_is_named_with_its_delay() {
    let late = Change {
        late: 3,
        ..nothing()
    };
    is_named(&said(&late), ("time_shift", &[]), &[("TSH", -0.006)]);
}

#[test]
fn a_tilted_base_is_named_with_its_angles() {
    let angle = 0.03_f64;
    let gravity = format!(
        "gravity = [0.0, {}, {}]",
        -9.81 * angle.sin(),
        -9.81 * angle.cos()
    );
    let tilted = Change {
        text: ARM.replace("gravity = [0.0, 0.0, -9.81]", &gravity),
        ..nothing()
    };
    let diagnosis = said(&tilted);
    assert_eq!(
        first(&diagnosis),
        ("base_tilt", &[][..]),
        "{:?}",
        diagnosis.effects
    );
    let (x, sigma) = parameter(&diagnosis, "TX");
    assert!(
        (x.abs() - angle).abs() < 4.0 * sigma + 1e-3,
        "{x} +- {sigma}"
    );
}

#[test]
fn a_touch_is_found_where_and_when_it_was() {
    let touch = (9.0, 9.8, [0.0, 12.0, 8.0, 0.0]);
    let touched = Change {
        touch: Some(touch),
        ..nothing()
    };
    let diagnosis = said(&touched);
    assert_eq!(diagnosis.verdict, Verdict::Named);
    assert!(diagnosis.effects.is_empty(), "{:?}", diagnosis.effects);
    let contacts = diagnosis.changed.unwrap().contacts;
    let [contact] = &contacts[..] else {
        panic!("{contacts:?}");
    };
    assert!((contact.from_s - touch.0).abs() < 0.15, "{contact:?}");
    assert!((contact.to_s - touch.1).abs() < 0.15, "{contact:?}");
    let joints: Vec<usize> = contact
        .joints
        .iter()
        .map(|touched| touched.number)
        .collect();
    assert_eq!(joints, [2, 3]);
    for (found, torque) in contact.joints.iter().zip([12.0, 8.0]) {
        assert!((found.torque / torque - 1.0).abs() < 0.3, "{contact:?}");
    }
}

#[test]
fn a_rotor_other_than_known_is_named() {
    let mut change = nothing();
    *change.standard.get_mut("IA3").unwrap() += 0.2;
    is_named(&said(&change), ("rotor_inertia", &[3]), &[("IA3", 0.2)]);
}

/// Logs of the UR10e beside this checkout.
fn ur10e() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/real/ur10e");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: the reference data are not beside this checkout");
    None
}

fn idim(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_idim"));
    command.args(arguments).output().unwrap()
}

/// The unloaded UR10e of one day, identified.
fn unloaded(data: &Path, folder: &Path) -> String {
    let path = folder.join("unloaded.json").display().to_string();
    let log = data.join("identification/20_02_10_30sec_12harm.csv.gz@#635..3510");
    let log = log.display().to_string();
    let output = idim(&[
        "identify", "ur10e", &log, "--models", "explicit", "--json", &path,
    ]);
    assert!(output.status.success());
    path
}

/// What is said of a log of the UR10e against a file of parameters.
fn of_ur10e(data: &Path, log: &str, nominal: &str, more: &[&str]) -> Value {
    let log = data.join(log).display().to_string();
    let mut arguments = vec!["diagnose", "ur10e", &log, "--nominal", nominal];
    arguments.extend(more);
    arguments.extend(["--json", "-", "--quiet"]);
    let output = idim(&arguments);
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn the_load_of_a_real_robot_is_named_first() {
    let Some(data) = ur10e() else { return };
    let folder = tempfile::tempdir().unwrap();
    let nominal = unloaded(&data, folder.path());
    for log in [
        "14harm50secLoad.csv.gz@#308..5071",
        "15harm50secLoad.csv.gz@#300..5000",
    ] {
        let log = format!("identification/20_02_19_{log}");
        let said = of_ur10e(&data, &log, &nominal, &["--load-mass", "2.805"]);
        assert_eq!(said["effects"][0]["effect"], "payload");
        assert_eq!(said["verdict"], "named");
        // Published for these logs: 20.4 to 4.3 %.
        let [before, after] = ["before", "after"]
            .map(|when| said["gap"]["torque"][when]["total_pct"].as_f64().unwrap());
        assert!(before > 18.0 && after < 4.3, "{log}: {before} -> {after}");
        // With the gains that are listed the load of 2.805 kg weighs 2.45 kg.
        let value = |place: &Value, what: &str| place[what].as_f64().unwrap();
        let mass = &said["changed"]["payload"]["mass"];
        let (kg, sigma) = (value(mass, "value"), value(mass, "sigma"));
        assert!(
            (kg - 2.45).abs() < 0.1 && sigma < 0.1,
            "{log}: {kg} +- {sigma}"
        );
        let factor = value(&said["changed"]["torque_scale"]["factor"], "value");
        assert!((factor - 1.145).abs() < 0.05, "{log}: {factor}");
    }
}

#[test]
fn pushes_on_a_real_robot_are_found_and_none_where_nobody_pushed() {
    let Some(data) = ur10e() else { return };
    let folder = tempfile::tempdir().unwrap();
    let nominal = unloaded(&data, folder.path());
    let contacts = |log: &str| -> Vec<(f64, Vec<u64>)> {
        let said = of_ur10e(&data, log, &nominal, &[]);
        let contacts = said["changed"]["contacts"].as_array().unwrap().iter();
        contacts
            .map(|contact| {
                let joints = contact["joints"].as_array().unwrap().iter();
                let joints = joints.map(|joint| joint["number"].as_u64().unwrap());
                (contact["from_s"].as_f64().unwrap(), joints.collect())
            })
            .collect()
    };
    // By eye in the currents: when each push begins, and what it turns.
    let pushed = [
        ("1", [(2.1, 1), (4.8, 5), (8.6, 2), (12.0, 2)].as_slice()),
        (
            "2",
            &[(0.7, 1), (2.6, 4), (5.0, 2), (8.2, 1), (11.5, 5), (14.4, 1)],
        ),
    ];
    for (pose, pushes) in pushed {
        let found = contacts(&format!("collision/20_01_22_push_pose_{pose}.csv.gz"));
        assert_eq!(found.len(), pushes.len(), "{found:?}");
        for ((from, joints), (begins, last)) in found.iter().zip(pushes) {
            assert!((from - begins).abs() < 0.3, "{found:?}");
            assert_eq!(joints.last(), Some(last), "{found:?}");
        }
    }
    let alone = [
        "identification/20_02_19_14harm50sec.csv.gz@#195..4966",
        "identification/20_02_19_15harm50sec.csv.gz@#300..5000",
        "identification/20_02_12_40sec_12harm.csv.gz@#500..4460",
        "validation/20_01_17_ptp_10_points.csv.gz",
        "validation/20_01_17_p1.csv.gz",
        "validation/20_01_17_p6.csv.gz",
        "jointwise/20_01_22_joint_3.csv.gz",
    ];
    for log in alone {
        assert_eq!(contacts(log), [], "{log}");
    }
}

#[test]
fn known_parameters_of_another_robot_or_not_all_of_them_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (arm, log, known) = (path("arm.toml"), path("log.csv"), path("known.toml"));
    std::fs::write(&arm, ARM).unwrap();
    let header: String = (1..=4).map(|j| format!(",q{j}")).collect::<String>()
        + &(1..=4).map(|j| format!(",tau{j}")).collect::<String>();
    let row = |i: usize| {
        let t = i as f64 / 100.0;
        let q: String = (1..=4)
            .map(|j| format!(",{}", (t * f64::from(j)).sin()))
            .collect();
        format!("{t}{q},1,2,3,4\n")
    };
    let rows: String = (0..400).map(row).collect();
    std::fs::write(&log, format!("t{header}\n{rows}")).unwrap();
    let refused = |text: &str, file: &str| -> String {
        std::fs::write(file, text).unwrap();
        let output = idim(&["diagnose", &arm, &log, "--nominal", file]);
        assert_eq!(output.status.code(), Some(1));
        let message = String::from_utf8_lossy(&output.stderr).replace("│", " ");
        message.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let other = refused("[parameters]\nA1 = 1.0\nB2 = 2.0\n", &known);
    assert!(
        other.contains("these are not the parameters of arm"),
        "{other}"
    );
    let robot = robot(ARM);
    let values = base(&robot, &standard());
    let mut table = String::from("[parameters]\n");
    for (parameter, value) in robot.base.parameters.iter().zip(values) {
        if !["FS2", "FV3"].contains(&parameter.name.as_str()) {
            table += &format!("{} = {value:?}\n", parameter.name);
        }
    }
    let some = refused(&table, &known);
    assert!(some.contains("no value for FS2, FV3 of arm"), "{some}");
    let none = refused("[parameters]\n", &path("none.json"));
    assert!(none.contains("none.json"), "{none}");
    let output = idim(&["diagnose", &arm, &log, "--load-mass", "2"]);
    assert_eq!(output.status.code(), Some(2));
}
