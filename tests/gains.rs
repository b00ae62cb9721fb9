//! Drive gains from a known load, as a user meets them.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::path::Path;
use std::process::{Command, Output};

use idim::codegen::builder;
use idim::interpreted::Interpreter;
use idim::runtime::identify::{IdentifyError, KnownLoad, Options, gains, predict};
use idim::runtime::log::Recording;
use idim::runtime::model::IdentificationModel;
use idim::runtime::observe::ModelKind;
use idim::runtime::report::{DriveGains, gains_terminal};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use serde_json::Value;

/// A slider, and beside it an arm with a wrist, on one base: axis, place and type of each joint.
const SLIDER: (&str, &str, &str) = ("1 0 0", "0 1 0", "prismatic");
const ARM: [(&str, &str, &str); 6] = [
    ("0 0 1", "0 0 0.3", "continuous"),
    ("0 1 0", "0.1 0 0.2", "continuous"),
    ("0 1 0", "0 0 0.5", "continuous"),
    ("1 0 0", "0.2 0 0.1", "continuous"),
    ("0 1 0", "0.3 0 0", "continuous"),
    ("1 0 0", "0.1 0 0", "continuous"),
];

const LOAD: &str = r#"<link name="load"><inertial><origin xyz="0.02 0.05 0.12"/><mass value="3"/>
<inertia ixx="0.01" ixy="0.001" ixz="0" iyy="0.02" iyz="0" izz="0.018"/></inertial></link>
<joint name="flange" type="fixed"><parent link="LAST"/><child link="load"/></joint>"#;

/// Joints one after the other, the slider (if it is there) by itself.
fn robot(joints: &[(&str, &str, &str)], loaded: bool) -> Interpreter {
    let mut urdf = "<robot name=\"arm\"><link name=\"base\"/>".to_owned();
    let (mut from, mut friction) = ("base".to_owned(), String::new());
    for (k, (axis, place, kind)) in joints.iter().enumerate() {
        let (link, mass) = (format!("l{}", k + 1), 6.0 / (k + 1) as f64);
        urdf += &format!(
            "<link name=\"{link}\"><inertial><origin xyz=\"0.05 0.01 0.1\"/><mass value=\"{mass}\"/>\
             <inertia ixx=\"0.02\" ixy=\"0.001\" ixz=\"0\" iyy=\"0.03\" iyz=\"0\" izz=\"0.015\"/>\
             </inertial></link><joint name=\"j{0}\" type=\"{kind}\"><parent link=\"{from}\"/>\
             <child link=\"{link}\"/><origin xyz=\"{place}\"/><axis xyz=\"{axis}\"/>\
             <limit lower=\"-3\" upper=\"3\" effort=\"1\" velocity=\"1\"/></joint>",
            k + 1
        );
        friction += &format!("FV{} = {}\n", k + 1, 1.0 / (k + 1) as f64);
        if *kind == "continuous" {
            from = link;
        }
    }
    if loaded {
        urdf += &LOAD.replace("LAST", &from);
    }
    urdf += "</robot>";
    let toml =
        format!("name = 'arm'\nurdf = 'arm.urdf'\neffects = ['viscous']\n[parameters]\n{friction}");
    let texts = [("arm.toml", toml.as_str()), ("arm.urdf", &urdf)];
    Interpreter::new(&builder::read_texts(&texts).unwrap())
}

fn options() -> Options {
    Options {
        fq_hz: Some(10.0),
        nd: Some(5),
        ..Options::default()
    }
}

/// A log of 40 s whose torques are the true ones by `wrong`, with noise of `noise` of their level.
fn log(
    model: &Interpreter,
    (name, shift): (&str, f64),
    wrong: &[f64],
    (noise, seed): (f64, u64),
) -> Recording {
    let wave = |j: usize, t: f64| -> f64 {
        let part = |k: f64| (t * (0.5 + 0.37 * k + 0.11 * j as f64) + k + j as f64 + shift).sin();
        (1..6).map(|k| 0.4 * part(f64::from(k))).sum()
    };
    let stamps: Vec<f64> = (0..8000).map(|i| f64::from(i) / 200.0).collect();
    let mut log = Recording {
        name: name.into(),
        stem: name.into(),
        rate_hz: 200.0,
        len: stamps.len(),
        q: (0..wrong.len())
            .map(|j| stamps.iter().map(|t| wave(j, *t)).collect())
            .collect(),
        stamps,
        ..Recording::default()
    };
    let values = model.knowledge().nominal.iter().map(|x| x.unwrap());
    let values: Vec<f64> = values.collect();
    let plan = options()
        .resolve(model, std::slice::from_ref(&log))
        .unwrap();
    let filtering = &plan.filtering;
    let mut tau = predict(model, &log, &values, filtering, ModelKind::Explicit).unwrap();
    let mut generator = Pcg64Mcg::seed_from_u64(100 * seed + name.len() as u64);
    let mut normal = || {
        let uniform = || f64::from(generator.next_u32()) / f64::from(u32::MAX);
        std::iter::repeat_with(uniform).take(12).sum::<f64>() - 6.0
    };
    for (tau, wrong) in tau.iter_mut().zip(wrong) {
        let power = tau.iter().map(|x| x * x).sum::<f64>() / tau.len() as f64;
        let level = noise * power.sqrt();
        for tau in tau.iter_mut() {
            *tau = (*tau + level * normal()) / wrong;
        }
    }
    log.tau = Some(tau);
    log
}

fn found(
    joints: &[(&str, &str, &str)],
    wrong: &[f64],
    noise: (f64, u64),
    load: &KnownLoad,
) -> DriveGains {
    let (empty, full) = (robot(joints, false), robot(joints, true));
    let without = log(&empty, ("without", 0.0), wrong, noise);
    let with = log(&full, ("with", 0.7), wrong, noise);
    gains(&empty, (&[without], &[with]), load, &options(), &()).unwrap()
}

const WRONG: [f64; 6] = [1.10, 0.95, 1.04, 0.90, 1.15, 0.98];

const KNOWN: KnownLoad = KnownLoad {
    link: 5,
    mass: 3.0,
    com: None,
};

#[track_caller]
fn assert_found(found: &DriveGains, wrong: &[f64]) {
    println!("{}", gains_terminal(found));
    assert!(found.converged);
    for (found, truth) in found.factors.iter().zip(wrong) {
        let sigma = found.sigma_corrected.or(found.sigma).unwrap();
        let factor = found.factor.unwrap();
        let error = (factor - truth).abs();
        assert!(error < 3.0 * sigma && error < 0.01 * truth, "{found:?}");
    }
}

#[test]
fn wrong_gains_of_six_joints_are_found_under_noise() {
    let found = found(&ARM, &WRONG, (0.05, 1), &KNOWN);
    assert_found(&found, &WRONG);
    assert!(found.not_reached.is_empty() && found.warnings.is_empty());
    // The rest of the load comes out beside them, as it does without noise.
    let clean = self::found(&ARM, &WRONG, (0.0, 1), &KNOWN);
    for (noisy, clean) in found.load.iter().zip(&clean.load).take(9) {
        let error = (noisy.value.unwrap() - clean.value.unwrap()).abs();
        assert!(error < 4.0 * noisy.sigma.unwrap(), "{noisy:?}");
    }
}

#[test]
fn torques_in_other_units_are_no_other_problem() {
    // Amperes instead of newton metres, on drives of all sizes.
    let wrong = [120.0, 95.0, 61.0, 12.0, 11.0, 0.4];
    assert_found(&found(&ARM, &wrong, (0.05, 1), &KNOWN), &wrong);
}

#[test]
fn noise_of_the_torques_does_not_bias_the_factors() {
    // Noise as large as the torques. Least squares of g tau = W X have it in their regressor and
    // pull all factors down.
    let known = KnownLoad { link: 2, ..KNOWN };
    let runs = 16;
    let mut sums = [0.0; 3];
    for seed in 0..runs {
        let found = found(&ARM[..3], &WRONG[..3], (1.0, seed), &known);
        for ((sum, found), truth) in sums.iter_mut().zip(&found.factors).zip(WRONG) {
            *sum += (found.factor.unwrap() - truth) / found.sigma.unwrap();
        }
    }
    // The mean of so many standard normal values, the three joints together.
    let mean = sums.map(|sum| sum / runs as f64);
    println!("mean errors {mean:.2?} sigma");
    assert!(
        mean.iter()
            .all(|mean| mean.abs() < 3.5 / (runs as f64).sqrt()),
        "{mean:?}"
    );
}

#[test]
fn centre_of_mass_sharpens_the_factors() {
    let clean = found(&ARM, &[1.0; 6], (0.0, 1), &KNOWN);
    let known = KnownLoad {
        com: clean.physical.com,
        ..KNOWN
    };
    let mass = found(&ARM, &WRONG, (0.05, 1), &KNOWN);
    let all = found(&ARM, &WRONG, (0.05, 1), &known);
    assert_found(&all, &WRONG);
    for (mass, all) in mass.factors.iter().zip(&all.factors) {
        assert!(all.sigma.unwrap() <= 1.001 * mass.sigma.unwrap());
    }
}

#[test]
fn joint_beside_the_arm_is_named_and_gets_no_factor() {
    let joints = [&[SLIDER], &ARM[..3]].concat();
    let wrong = [1.2, 1.10, 0.95, 1.04];
    let known = KnownLoad { link: 3, ..KNOWN };
    let found = found(&joints, &wrong, (0.02, 1), &known);
    assert_eq!(found.not_reached, [1]);
    assert_eq!(
        (found.factors[0].factor, found.factors[0].sigma),
        (None, None)
    );
    assert!(
        found.warnings[0].contains("joint 1 (j1)"),
        "{:?}",
        found.warnings
    );
    println!("{}", gains_terminal(&found));
    for (found, truth) in found.factors[1..].iter().zip(&wrong[1..]) {
        assert!(
            (found.factor.unwrap() / truth - 1.0).abs() < 0.01,
            "{found:?}"
        );
    }
}

#[test]
fn impossible_questions_are_refused() {
    let (empty, full) = (robot(&ARM[..2], false), robot(&ARM[..2], true));
    let without = log(&empty, ("without", 0.0), &[1.0; 2], (0.01, 1));
    let with = log(&full, ("with", 0.7), &[1.0; 2], (0.01, 1));
    let known = KnownLoad { link: 1, ..KNOWN };
    let ask = |without: &Recording, with: &Recording, load: &KnownLoad| {
        let logs = (&[without.clone()][..], &[with.clone()][..]);
        gains(&empty, logs, load, &options(), &()).unwrap_err()
    };
    for mass in [0.0, -1.0, f64::NAN] {
        let error = ask(&without, &with, &KnownLoad { mass, ..known });
        assert!(matches!(error, IdentifyError::LoadMass { .. }), "{error}");
    }
    let com = Some([0.0, f64::INFINITY, 0.0]);
    let error = ask(&without, &with, &KnownLoad { com, ..known });
    assert_eq!(error, IdentifyError::LoadCentre);
    let error = ask(&without, &with, &KnownLoad { link: 2, ..known });
    assert!(matches!(error, IdentifyError::NoLink { link: 3, .. }));
    let still = |log: &Recording| {
        let mut log = log.clone();
        log.q[1].fill(0.3);
        log
    };
    let error = ask(&still(&without), &still(&with), &known).to_string();
    assert!(
        error.contains("joint 2 (j2) never moves in without, with"),
        "{error}"
    );
}

#[test]
fn load_on_a_vertical_axis_is_not_felt_by_its_mass() {
    let (empty, full) = (robot(&ARM[..1], false), robot(&ARM[..1], true));
    let without = log(&empty, ("without", 0.0), &[1.0], (0.01, 1));
    let with = log(&full, ("with", 0.7), &[1.0], (0.01, 1));
    let known = KnownLoad { link: 0, ..KNOWN };
    let error = gains(&empty, (&[without], &[with]), &known, &options(), &()).unwrap_err();
    assert!(matches!(error, IdentifyError::LoadUnfelt { .. }), "{error}");
}

fn idim(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_idim"))
        .args(arguments)
        .output()
        .unwrap()
}

#[test]
fn command_without_the_mass_says_what_to_do() {
    let refused = |arguments: &[&str], pieces: &[&str]| {
        let output = idim(&[&["identify", "scara", "none.csv"], arguments].concat());
        let message = String::from_utf8_lossy(&output.stderr).replace('\n', " ");
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(
            pieces.iter().all(|piece| message.contains(piece)),
            "{message}"
        );
    };
    refused(&["--loaded", "more.csv"], &["--load-mass KG", "--payload"]);
    refused(&["--load-mass", "2"], &["--loaded LOG"]);
    let all = ["--loaded", "more.csv", "--load-mass", "2"];
    refused(&[&all[..], &["--models", "power"]].concat(), &["explicit"]);
    refused(
        &[&all[..], &["--load-com", "1,2"]].concat(),
        &["0,0.02,0.1"],
    );
}

#[test]
fn gains_of_the_ur10e_by_its_known_load() {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    if !shared.is_dir() {
        println!("skipped: the reference data are not beside this checkout");
        return;
    }
    let logs = shared.join("real/ur10e/identification");
    let part = |log: &str| logs.join(log).display().to_string();
    let without = part("20_02_19_14harm50sec.csv.gz@#195..4966");
    let with = part("20_02_19_14harm50secLoad.csv.gz@#308..5071");
    let load = ["--loaded", &with, "--load-mass", "2.805", "--json", "-"];
    let output = idim(&[&["identify", "ur10e", &without], &load[..]].concat());
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    let result: Value = serde_json::from_slice(&output.stdout).unwrap();
    println!("as logged {} kg of 2.805 kg", result["mass_as_logged"]);
    // What the true gains are nobody knows: only that six positive ones come out.
    for found in result["factors"].as_array().unwrap() {
        println!("{found}");
    }
    assert_eq!(result["converged"], true);
}
