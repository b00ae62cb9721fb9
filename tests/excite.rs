//! Exciting motions of built-in robots: what is promised of an identification holds when it is
//! simulated, and what is written can be read by the other commands.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::path::Path;
use std::process::{Command, Output};

use idim::robots;
use idim::runtime::excite::{
    Criterion, Excitation, Family, JointLimits, Noise, Search, Settings, Start, Task, excite,
};
use idim::runtime::identify::{Options, identify};
use idim::runtime::log::{Companion, Recording};
use idim::runtime::model::IdentificationModel;
use idim::runtime::observe::ModelKind;
use idim::runtime::settings::{Edges, Weights};
use idim::runtime::simulate::{Grid, Trajectory, in_order, inverse_dynamics, named_values};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

fn robot(name: &str) -> &'static robots::Robot {
    robots::ALL.iter().find(|robot| robot.name == name).unwrap()
}

fn idim(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_idim"));
    command.args(arguments).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

const SIGMA: [f64; 2] = [0.4, 0.1];
const RATE_HZ: f64 = 500.0;

/// The description of the paper's robot, whose parameters are in it.
const SCARA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/robots/scara.toml");

/// The paper's SCARA with its own parameters.
fn scara() -> (&'static dyn IdentificationModel, Vec<f64>) {
    let robot = robot("scara");
    let (_, text) = robot.texts[0];
    let values = in_order(robot.model, &named_values(text).unwrap()).unwrap();
    (robot.model, values)
}

fn exciting(criterion: Criterion) -> Excitation {
    let (model, values) = scara();
    let limits = [JointLimits {
        lower: -2.0,
        upper: 2.0,
        velocity: 2.0,
        acceleration: 10.0,
        effort: 60.0,
    }; 2];
    let task = Task {
        model,
        limits: &limits,
        center: None,
        parameters: Some(&values),
    };
    let settings = Settings {
        family: Family::Fourier { harmonics: 5 },
        start: Start::Rest,
        criterion,
        period_s: 6.0,
        periods: 2,
        search: Search {
            seed: 1,
            starts: 2,
            steps: 60,
        },
        noise: Noise {
            sigma: SIGMA.into(),
            rate_hz: RATE_HZ,
        },
        wanted_pct: None,
    };
    excite(&task, &settings, &|| ()).unwrap()
}

/// Normal numbers (Box and Muller 1958).
fn normal(generator: &mut Pcg64Mcg) -> f64 {
    let mut uniform = || ((generator.next_u64() >> 11) as f64 + 0.5) / (1u64 << 53) as f64;
    let (a, b) = (uniform(), uniform());
    (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
}

/// Spread of the estimates over many identifications of the motion with noisy torque.
fn spread(found: &Excitation, logs: u128) -> Vec<f64> {
    let (model, values) = scara();
    let grid = Grid {
        rate_hz: RATE_HZ,
        start: 0.0,
        len: (found.motion.seconds().unwrap() * RATE_HZ) as usize + 1,
    };
    let motion = Trajectory::of(&found.motion, &grid).unwrap();
    let tau = inverse_dynamics(model, &values, &motion).unwrap();
    let options = Options {
        models: vec![ModelKind::Explicit],
        fq_hz: Some(40.0),
        nd: Some(8),
        trim: Some(20),
        edges: Some(Edges::Scipy),
        weights: Some(Weights::Joint),
        ..Options::default()
    };
    let estimates: Vec<Vec<f64>> = (0..logs)
        .map(|seed| {
            let mut generator = Pcg64Mcg::new(0x5eed + seed);
            let noisy = tau.iter().zip(SIGMA).map(|(tau, sigma)| {
                let noisy = tau.iter().map(|tau| tau + sigma * normal(&mut generator));
                noisy.collect::<Vec<f64>>()
            });
            let log = recording(&grid, &motion, noisy.collect());
            let found = identify(model, &[log], &[], &options, &()).unwrap();
            let explicit = &found.models[0].parameters;
            explicit.iter().map(|it| it.value.unwrap()).collect()
        })
        .collect();
    let deviation = |k: usize| {
        let mean = estimates.iter().map(|it| it[k]).sum::<f64>() / logs as f64;
        let squares = estimates.iter().map(|it| (it[k] - mean).powi(2));
        (squares.sum::<f64>() / (logs - 1) as f64).sqrt()
    };
    (0..values.len()).map(deviation).collect()
}

fn recording(grid: &Grid, motion: &Trajectory, tau: Vec<Vec<f64>>) -> Recording {
    Recording {
        name: "exciting".into(),
        rate_hz: grid.rate_hz,
        start: 0.0,
        len: grid.len,
        q: motion.q.clone(),
        qd: Some(motion.qd.clone()),
        tau: Some(tau),
        ..Recording::default()
    }
}

#[test]
fn predicted_sigma_is_the_spread_of_simulated_identifications() {
    let found = exciting(Criterion::Condition);
    // Two hundred logs know a standard deviation to 5 %.
    let spread = spread(&found, 200);
    for (expected, spread) in found.parameters.iter().zip(spread) {
        let sigma = expected.sigma.unwrap();
        let ratio = spread / sigma;
        assert!(
            (0.8..1.2).contains(&ratio),
            "{}: {spread} / {sigma}",
            expected.name
        );
    }
}

#[test]
fn written_motion_keeps_to_the_limits_of_the_description_when_simulated() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let (motion, csv, log) = (at("motion.toml"), at("motion.csv"), at("log.csv"));
    let parameters = at("parameters.toml");
    let (_, text) = robot("scara").texts[0];
    std::fs::write(&parameters, text).unwrap();
    for family in ["fourier", "via-points"] {
        let output = idim(&[
            "excite",
            "scara",
            "--family",
            family,
            "--period",
            "5",
            "--periods",
            "2",
            "--starts",
            "1",
            "--steps",
            "20",
            "--max-velocity",
            "1.5,2.5",
            "--max-acceleration",
            "7",
            "-o",
            &motion,
            "--csv",
            &csv,
        ]);
        assert!(output.status.success(), "{}", said(&output));
        let text = said(&output);
        assert!(text.contains("assumed are lower -3.1416 rad"), "{text}");
        let companion = Companion::load(Path::new(&motion)).unwrap();
        assert_eq!(companion.reference.unwrap().seconds(), Some(10.0));
        let output = idim(&[
            "simulate",
            "scara",
            "--trajectory",
            &motion,
            "--parameters",
            &parameters,
            "-o",
            &log,
        ]);
        assert!(output.status.success(), "{}", said(&output));
        for (path, first) in [(&log, 3), (&csv, 3)] {
            let text = std::fs::read_to_string(path).unwrap();
            let rows = text.lines().skip(1).map(|line| -> Vec<f64> {
                line.split(',')
                    .map(|number| number.parse().unwrap())
                    .collect()
            });
            for row in rows {
                assert!(
                    row[first].abs() <= 1.5 && row[first + 1].abs() <= 2.5,
                    "{row:?}"
                );
            }
        }
    }
}

#[test]
fn effects_that_are_to_be_told_apart_get_columns_and_a_motion() {
    let arguments = [
        "excite",
        "scara",
        "--separate",
        "stribeck@1,FV1",
        "--starts",
        "2",
        "--steps",
        "40",
        "--json",
        "-",
    ];
    let output = idim(&arguments);
    assert!(output.status.success(), "{}", said(&output));
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let names: Vec<&str> = found["parameters"]
        .as_array()
        .unwrap()
        .iter()
        .map(|it| it["name"].as_str().unwrap())
        .collect();
    assert!(
        names.iter().any(|name| name.starts_with("FST")),
        "{names:?}"
    );
    assert_eq!(found["criterion"]["columns"].as_array().unwrap().len(), 2);
    let chance = &found["by_chance"];
    assert!(
        chance["found"].as_f64() < chance["best"].as_f64(),
        "{chance}"
    );
    assert_eq!(
        output.stdout,
        idim(&arguments).stdout,
        "the same for a seed"
    );
}

#[test]
fn effects_that_only_the_catalogue_has_get_columns_and_a_motion() {
    let list = "drive_gain@1,load_dependent_friction@1,FS1";
    let output = idim(&[
        "excite",
        "scara",
        "--separate",
        list,
        "--parameters",
        SCARA,
        "--starts",
        "2",
        "--steps",
        "40",
        "--json",
        "-",
    ]);
    assert!(output.status.success(), "{}", said(&output));
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let parameters = found["parameters"].as_array().unwrap();
    let alone = |name: &str| {
        let mut all = parameters.iter();
        let own = all.find(|parameter| parameter["name"] == name);
        own.unwrap()["alone"].as_f64().unwrap()
    };
    // Friction that grows with the load is neither a share of the torque nor Coulomb's.
    for name in ["DG1", "FL1", "FS1"] {
        assert!(alone(name) > 0.02, "{name} {}", alone(name));
    }
    let chance = &found["by_chance"];
    assert!(
        chance["found"].as_f64() < chance["best"].as_f64(),
        "{chance}"
    );
}

#[test]
fn requests_that_cannot_be_met_are_refused_in_words() {
    let cases: [(&[&str], &str, i32); 11] = [
        (&["--separate", "magic@1"], "there is no effect `magic`", 2),
        (&["--separate", "stribeck@9"], "there is no joint `9`", 2),
        (
            &["--separate", "XX7"],
            "the model has no parameter `XX7`",
            2,
        ),
        (
            &["--separate", "viscous_asymmetry@1,FV9"],
            "the model has no parameter `FV9`",
            2,
        ),
        (
            &["--separate", "drive_gain@1"],
            "follows from that of the robot; give its present --parameters",
            2,
        ),
        (
            &["--separate", "backlash@1"],
            "`backlash` is no torque of the present state",
            2,
        ),
        (
            // A robot that no gravity falls on.
            &["--separate", "base_tilt", "--parameters", SCARA],
            "`base_tilt` does not act on the whole of this robot",
            2,
        ),
        (
            &["--max-velocity", "1,2,3"],
            "--max-velocity has 3 numbers",
            2,
        ),
        (
            &["--max-velocity", "0"],
            "the velocity limit of joint `shoulder` is 0",
            1,
        ),
        (
            &["--noise", "no/such.json"],
            "--noise takes numbers or the JSON",
            1,
        ),
        (
            &["--harmonics", "2"],
            "2 harmonics leave the motion no freedom",
            1,
        ),
    ];
    for (arguments, message, status) in cases {
        let output = idim(&[&["excite", "scara"], arguments].concat());
        // Messages may be wrapped for the terminal: compare words.
        let text = said(&output)
            .split_whitespace()
            .filter(|word| *word != "│")
            .collect::<Vec<_>>()
            .join(" ");
        assert!(text.contains(message), "{arguments:?}: {text}");
        assert_eq!(output.status.code(), Some(status), "{arguments:?}");
        assert!(output.stdout.is_empty());
    }
}
