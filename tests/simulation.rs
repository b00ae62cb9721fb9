//! Forward dynamics and simulation of built-in robots with physical parameters, and of a log with
//! the parameters of its own description. The log is read from beside the checkout; without it the
//! test says so and passes.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use idim::codegen::builder;
use idim::robots;
use idim::runtime::identify::{Options as Identification, identify};
use idim::runtime::log::{self, Fourier, LogSpec, Reference};
use idim::runtime::model::{ColumnKind, IdentificationModel, Output, States};
use idim::runtime::observe::ModelKind;
use idim::runtime::simulate::{
    Dynamics, Grid, Method, OpenLoop, Options, State, Trajectory, free_motion, inverse_dynamics,
    open_loop,
};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

/// Uniform in [low, high).
fn uniform(generator: &mut Pcg64Mcg, low: f64, high: f64) -> f64 {
    low + (high - low) * (generator.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

/// XX XY XZ YY YZ ZZ MX MY MZ M of a body with a random mass, centre and inertia.
fn link(generator: &mut Pcg64Mcg) -> [f64; 10] {
    let m = uniform(generator, 1.0, 5.0);
    let [x, y, z] = [(); 3].map(|()| uniform(generator, -0.15, 0.15));
    // Moments of inertia of mass along three axes keep the triangle inequality.
    let [a, b, c] = [(); 3].map(|()| m * uniform(generator, 0.001, 0.01));
    let xx = b + c + m * (y * y + z * z);
    let yy = a + c + m * (x * x + z * z);
    let zz = a + b + m * (x * x + y * y);
    [
        xx,
        -m * x * y,
        -m * x * z,
        yy,
        -m * y * z,
        zz,
        m * x,
        m * y,
        m * z,
        m,
    ]
}

/// Base parameters of a built-in robot made of random bodies with rotors; friction as given.
fn physical(robot: &robots::Robot, seed: u128, friction: f64) -> Vec<f64> {
    let mut generator = Pcg64Mcg::new(seed);
    let derived = builder::read_texts(robot.texts).unwrap();
    let mut standard: BTreeMap<String, f64> = BTreeMap::new();
    let names = ["XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M"];
    for joint in 1..=robot.model.joints().len() {
        for (name, value) in names.iter().zip(link(&mut generator)) {
            standard.insert(format!("{name}{joint}"), value);
        }
        standard.insert(format!("IA{joint}"), uniform(&mut generator, 0.05, 0.3));
    }
    let columns = robot.model.columns().iter().zip(&derived.base.parameters);
    let value = |(column, parameter): (&idim::runtime::model::Column, &_)| {
        let parameter: &idim::codegen::base::BaseParameter = parameter;
        let term = |(factor, name): &(f64, String)| {
            let rest = match column.kind {
                // Below what Coulomb friction holds, so that gravity is left to decide.
                ColumnKind::Friction if column.name.starts_with("OFF") => 0.3 * friction,
                ColumnKind::Friction => friction,
                // The coupling of a wrist: friction small beside that of the joints.
                ColumnKind::Effect if !column.name.starts_with("IA") => 0.3 * friction,
                _ => 0.0,
            };
            factor * standard.get(name).copied().unwrap_or(rest)
        };
        parameter.relation.iter().map(term).sum()
    };
    columns.map(value).collect()
}

#[test]
fn forward_dynamics_of_every_robot_is_inverted_by_its_explicit_model() {
    let mut worst: f64 = 0.0;
    for robot in &robots::ALL {
        let model = robot.model;
        let parameters = physical(robot, 1, 0.4);
        let n = model.joints().len();
        let mut generator = Pcg64Mcg::new(2);
        let mut dynamics = Dynamics::new(model, &parameters).unwrap();
        for _ in 0..200 {
            let mut random = |size: f64| -> Vec<f64> {
                (0..n)
                    .map(|_| uniform(&mut generator, -size, size))
                    .collect()
            };
            let (q, qd, tau) = (random(3.1), random(2.0), random(40.0));
            let mut qdd = vec![0.0; n];
            dynamics.acceleration(&q, &qd, &tau, &mut qdd).unwrap();
            let series = |values: &[f64]| values.iter().map(|value| vec![*value]).collect();
            let point = Trajectory {
                q: series(&q),
                qd: series(&qd),
                qdd: series(&qdd),
            };
            let again = inverse_dynamics(model, &parameters, &point).unwrap();
            for (tau, again) in tau.iter().zip(&again) {
                worst = worst.max((tau - again[0]).abs() / 40.0);
            }
        }
    }
    println!("forward dynamics, then D: {worst:.1e} of the torque");
    assert!(worst < 1e-10, "{worst:e}");
}

/// h X along a motion, J.
fn energy(model: &dyn IdentificationModel, parameters: &[f64], q: &[f64], qd: &[f64]) -> f64 {
    let pattern = model.pattern(Output::Energy);
    let mut signals = vec![0.0; pattern.signals];
    let still = vec![0.0; q.len()];
    model.evaluate(
        Output::Energy,
        &States {
            len: 1,
            q,
            qd,
            qdd: &still,
            slip: &[],
        },
        &mut signals,
    );
    let entries = pattern.entries.iter();
    entries
        .map(|entry| parameters[entry.column] * signals[entry.signal])
        .sum()
}

#[test]
fn robots_without_friction_keep_their_energy_over_ten_seconds() {
    let grid = Grid {
        rate_hz: 100.0,
        start: 0.0,
        len: 1001,
    };
    for robot in robots::ALL
        .iter()
        .filter(|robot| ["rx90", "panda"].contains(&robot.name))
    {
        let model = robot.model;
        let parameters = physical(robot, 3, 0.0);
        let n = model.joints().len();
        let start = State {
            q: vec![0.1; n],
            qd: vec![0.2; n],
        };
        let error = |method| {
            let options = Options {
                method,
                ..Options::default()
            };
            let result = free_motion(model, &parameters, (&start, grid), &options).unwrap();
            let at = |series: &[Vec<f64>], k: usize| -> Vec<f64> {
                series.iter().map(|values| values[k]).collect()
            };
            let total = |k| energy(model, &parameters, &at(&result.q, k), &at(&result.qd, k));
            let potential = |k| energy(model, &parameters, &at(&result.q, k), &vec![0.0; n]);
            let largest = (0..grid.len)
                .map(|k| total(k) - potential(k))
                .fold(0.0, f64::max);
            let change = (0..grid.len)
                .map(|k| (total(k) - total(0)).abs())
                .fold(0.0, f64::max);
            change / largest
        };
        let variable = error(Method::Adaptive {
            relative: 1e-11,
            absolute: 1e-12,
        });
        let fixed = error(Options::default().method);
        println!(
            "{}: {variable:.1e} with variable steps, {fixed:.1e} at 0.5 ms",
            robot.name
        );
        // Thrown about without friction a robot moves faster than it ever does in control.
        assert!(
            variable < 1e-9 && fixed < 1e-6,
            "{}: {variable:e} {fixed:e}",
            robot.name
        );
    }
}

#[test]
fn robot_with_a_coupled_wrist_and_dry_friction_comes_to_rest() {
    let robot = robots::ALL
        .iter()
        .find(|robot| robot.name == "tx40")
        .unwrap();
    let parameters = physical(robot, 4, 2.0);
    let grid = Grid {
        rate_hz: 1000.0,
        start: 0.0,
        len: 6001,
    };
    let start = State {
        q: vec![0.3; 6],
        qd: vec![2.0, -1.0, 1.5, -2.0, 3.0, -3.0],
    };
    let options = Options::default();
    let result = free_motion(robot.model, &parameters, (&start, grid), &options).unwrap();
    let at = |series: &[Vec<f64>], k: usize| -> Vec<f64> {
        series.iter().map(|values| values[k]).collect()
    };
    let total = |k| {
        energy(
            robot.model,
            &parameters,
            &at(&result.q, k),
            &at(&result.qd, k),
        )
    };
    for k in 1..grid.len {
        assert!(
            total(k) <= total(k - 1) + 1e-8,
            "energy appears at sample {k}"
        );
    }
    assert_eq!(at(&result.qd, grid.len - 1), [0.0; 6]);
    assert_eq!(at(&result.q, grid.len - 1), at(&result.q, grid.len - 500));
}

#[test]
fn parameters_identified_from_a_simulation_are_those_it_was_made_with() {
    let robot = robots::ALL
        .iter()
        .find(|robot| robot.name == "scara")
        .unwrap();
    let truth = [3.5, 0.05, 0.5, 0.06, 0.12, 0.005, 0.01, 0.1];
    let reference = Reference::Fourier(Fourier {
        f0_hz: 0.2,
        periods: 2.0,
        center: vec![0.2, -0.4],
        sin: vec![vec![0.5, -0.4, 0.2], vec![-0.6, 0.5, 0.25]],
        cos: vec![vec![0.3, 0.2, -0.15], vec![0.4, -0.3, 0.2]],
    });
    // Open loop, since the torque that a controller holds over a sample lags by half of it: that
    // alone would add 0.012 N m s/rad to FV1.
    let grid = Grid {
        rate_hz: 1000.0,
        start: 0.0,
        len: 10_001,
    };
    let motion = Trajectory::of(&reference, &grid).unwrap();
    let tau = inverse_dynamics(robot.model, &truth, &motion).unwrap();
    let first = |series: &[Vec<f64>]| series.iter().map(|values| values[0]).collect();
    let start = State {
        q: first(&motion.q),
        qd: first(&motion.qd),
    };
    let plan = OpenLoop {
        tau: &tau,
        grid,
        start: &start,
    };
    let result = open_loop(robot.model, &truth, &plan, &Options::default()).unwrap();
    let log = result.into_recording("simulated");
    let options = Identification {
        fq_hz: Some(40.0),
        nd: Some(10),
        ..Default::default()
    };
    let found = identify(robot.model, &[log], &[], &options, &()).unwrap();
    let explicit = found.model(ModelKind::Explicit).unwrap();
    for (parameter, truth) in explicit.parameters.iter().zip(truth) {
        let error = (parameter.solution - truth).abs();
        // What filters and differentiation leave, as in table 1 of the paper.
        assert!(error < 1e-3, "{}: {error:.1e} of {truth}", parameter.name);
    }
}

fn practice() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../shared/data/hidden_effects_practice/cases/case_001");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: the practice logs are not beside this checkout");
    None
}

#[test]
fn log_simulated_with_its_own_description_follows_its_reference() {
    let Some(case) = practice() else { return };
    let out = tempfile::tempdir().unwrap();
    let csv = out.path().join("simulated.csv");
    let robot = case.join("robot.toml");
    let log_spec = format!("{}@..3", case.join("train.csv.gz").display());
    let status = Command::new(env!("CARGO_BIN_EXE_idim"))
        .args([
            "simulate",
            robot.to_str().unwrap(),
            "--parameters",
            robot.to_str().unwrap(),
        ])
        .args([
            "--like",
            &log_spec,
            "--map",
            case.join("train.toml").to_str().unwrap(),
        ])
        .args(["-o", csv.to_str().unwrap(), "--quiet"])
        .status()
        .unwrap();
    assert!(status.success());
    let model = idim::interpreted::Interpreter::new(&builder::read(&robot).unwrap().robot);
    let read = |spec: &str| {
        let spec: LogSpec = spec.parse().unwrap();
        let options = log::ReadOptions {
            require_torque: true,
            companion: None,
        };
        log::read(&spec, model.joints(), &model.settings().drives, &options)
            .unwrap()
            .0
    };
    let (simulated, measured) = (read(csv.to_str().unwrap()), read(&log_spec));
    assert_eq!(simulated.len, measured.len);
    let companion = log::Companion::load(&case.join("train.toml")).unwrap();
    let grid = Grid::of(&measured);
    let reference = Trajectory::of(companion.reference.as_ref().unwrap(), &grid).unwrap();
    for joint in 0..model.joints().len() {
        let rms = |one: &[f64], other: &[f64]| {
            let sum: f64 = one.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum();
            (sum / one.len() as f64).sqrt()
        };
        let tracking = rms(&simulated.q[joint], &reference.q[joint]);
        let distance = rms(&simulated.q[joint], &measured.q[joint]);
        println!(
            "joint {}: {tracking:.2e} from the reference, {distance:.2e} from the log",
            joint + 1
        );
        assert!(
            tracking < 0.02 && distance < 0.5 * tracking,
            "joint {}",
            joint + 1
        );
    }
}

#[test]
fn simulate_command_says_what_is_missing() {
    let out = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = out.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let trajectory = file(
        "reference.toml",
        "[reference]\nkind = 'fourier'\nf0_hz = 1\ncenter = [0, 0]\nsin = [[0.1], [0.2]]\ncos = [[0], [0]]\n",
    );
    let empty = file("empty.toml", "");
    let some = file("some.toml", "[parameters]\nZZR1 = 3.5\n");
    let run = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_idim"))
            .args(["simulate", "scara"])
            .args(arguments)
            .output()
            .unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        (
            output.status.code(),
            text,
            String::from_utf8(output.stdout).unwrap(),
        )
    };
    let (code, text, _) = run(&["--parameters", &some, "--trajectory", &trajectory]);
    assert!(
        code == Some(1) && text.contains("FS1") && text.contains("LMX2"),
        "{text}"
    );
    let (code, text, _) = run(&["--parameters", &empty, "--trajectory", &trajectory]);
    assert!(
        code == Some(1) && text.contains("missing field `parameters`"),
        "{text}"
    );
    let (code, text, _) = run(&["--parameters", &some]);
    assert!(code == Some(2) && text.contains("--trajectory"), "{text}");
    let scara = concat!(env!("CARGO_MANIFEST_DIR"), "/robots/scara.toml");
    let (code, text, _) = run(&["--parameters", scara, "--trajectory", &some]);
    assert!(code == Some(1), "{text}");
    let (code, text, csv) = run(&[
        "--parameters",
        scara,
        "--trajectory",
        &trajectory,
        "--quiet",
    ]);
    assert!(code == Some(0) && text.is_empty(), "{text}");
    assert!(csv.starts_with("t,q1,q2,qd1,qd2,tau1,tau2\n0,0,0,") && csv.lines().count() == 1002);
}

/// The SCARA under a controller, as `idim simulate` makes it, and as a log with another companion.
struct Controlled {
    folder: tempfile::TempDir,
}

const REFERENCE: &str = "[reference]\nkind = 'fourier'\nf0_hz = 0.5\nperiods = 2\n\
    center = [0.1, -0.2]\nsin = [[0.6, 0.1], [0.5, -0.2]]\ncos = [[0.1, 0.1], [0.3, 0.1]]\n";

const CONTROLLER: &str = "[controller]\nlaw = 'pd'\nkp = [900, 150]\nkd = [110, 12]\n";

impl Controlled {
    fn new() -> Controlled {
        let made = Controlled {
            folder: tempfile::tempdir().unwrap(),
        };
        made.write("made.toml", &format!("{REFERENCE}{CONTROLLER}"));
        let (trajectory, log) = (made.path("made.toml"), made.path("log.csv"));
        let output = idim(&[
            "simulate",
            "scara",
            "--parameters",
            "robots/scara.toml",
            "--trajectory",
            &trajectory,
            "--rate",
            "500",
            "-o",
            &log,
        ]);
        assert!(output.0, "{}", output.1);
        made
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).display().to_string()
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.folder.path().join(name), text).unwrap();
    }

    /// What is said about the log with this companion.
    fn said(&self, companion: &str) -> String {
        self.write("log.toml", companion);
        let (log, again) = (self.path("log.csv"), self.path("again.csv"));
        let output = idim(&[
            "simulate",
            "scara",
            "--parameters",
            "robots/scara.toml",
            "--like",
            &log,
            "-o",
            &again,
        ]);
        assert!(output.0, "{}", output.1);
        output.1
    }
}

/// Whether the command succeeded, and all that it said.
fn idim(arguments: &[&str]) -> (bool, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_idim"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(arguments)
        .output()
        .unwrap();
    let text = [output.stdout, output.stderr].concat();
    (output.status.success(), String::from_utf8(text).unwrap())
}

#[test]
fn companion_that_fits_its_log_raises_no_warning() {
    let said = Controlled::new().said(&format!("{REFERENCE}{CONTROLLER}"));
    assert!(
        said.contains("closed loop") && !said.contains("warning"),
        "{said}"
    );
}

#[test]
fn controller_that_is_not_of_the_log_is_said_with_the_second() {
    let soft = CONTROLLER
        .replace("[900, 150]", "[30, 5]")
        .replace("[110, 12]", "[4, 1]");
    let said = Controlled::new().said(&format!("{REFERENCE}{soft}"));
    assert!(
        said.contains("leaves what the controller gives along this motion at 0."),
        "{said}"
    );
    assert!(
        said.contains("The controller or the reference is not that of this log"),
        "{said}"
    );
    assert!(
        said.contains("warning: Log and simulation part at "),
        "{said}"
    );
    assert!(
        said.contains("See above for what does not belong to this log"),
        "{said}"
    );
}

#[test]
fn reference_that_is_not_of_the_log_is_said_with_the_second() {
    let other = REFERENCE.replace("[0.5, -0.2]", "[-0.5, 0.4]");
    let made = Controlled::new();
    let said = made.said(&format!("{other}{CONTROLLER}"));
    assert!(
        said.contains("joint 2 (`elbow`) leaves its reference at 0."),
        "{said}"
    );
    let (ok, said) = idim(&["identify", "scara", &made.path("log.csv")]);
    assert!(
        ok && said.contains("joint 2 (`elbow`) leaves its reference at 0."),
        "{said}"
    );
    assert!(
        said.contains("The reference is not that of this log"),
        "{said}"
    );
}
