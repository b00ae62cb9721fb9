//! From a log to bodies that exist: real robots beside the checkout, and simulated ones whose truth
//! is known.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

#[path = "export/boxes.rs"]
mod boxes;
#[path = "export/frames.rs"]
mod frames;
#[path = "export/friction.rs"]
mod friction;
#[path = "export/stated.rs"]
mod stated;

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::process::Command;

use idim::codegen::emit::urdf;
use idim::codegen::mechanism::Standard;
use idim::codegen::mechanism::inertia::NAMES;
use idim::codegen::{Robot, builder};
use idim::exported::{ExportError, Exported, Identified, Options, Plane, export};
use idim::interpreted::Interpreter;
use idim::robots;
use idim::runtime::identify::{Options as Identify, identify, predict};
use idim::runtime::log::{self, LogSpec, ReadOptions, Recording};
use idim::runtime::model::IdentificationModel;
use idim::runtime::observe::ModelKind;
use idim::runtime::physical::{PhysicalError, Pseudo};
use idim::runtime::report::{Identification, ModelResult};
use idim::runtime::settings::Edges;
use idim::runtime::signal::Decimator;
use idim::runtime::simulate::{Dynamics, Trajectory, inverse_dynamics};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

fn shared() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/real");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: the reference data are not beside this checkout");
    None
}

fn robot(name: &str) -> Robot {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("robots/{name}.toml"));
    builder::read(&path).unwrap().robot
}

fn generated(name: &str) -> &'static dyn IdentificationModel {
    let robot = robots::ALL.iter().find(|robot| robot.name == name);
    robot.unwrap().model
}

fn read(model: &dyn IdentificationModel, log: &Path) -> Recording {
    let spec: LogSpec = log.display().to_string().parse().unwrap();
    let drives = &model.settings().drives;
    let options = ReadOptions::default();
    log::read(&spec, model.joints(), drives, &options)
        .unwrap()
        .0
}

fn explicit(found: &Identification) -> &ModelResult {
    found.model(ModelKind::Explicit).unwrap()
}

fn only_explicit() -> Identify {
    Identify {
        models: vec![ModelKind::Explicit],
        ..Identify::default()
    }
}

fn uniform(generator: &mut Pcg64Mcg) -> f64 {
    generator.next_u64() as f64 / u64::MAX as f64
}

fn normal(generator: &mut Pcg64Mcg) -> f64 {
    (0..12).map(|_| uniform(generator)).sum::<f64>() - 6.0
}

/// Torque error on a log behind the low-pass of the decimation, in percent.
fn error(
    model: &dyn IdentificationModel,
    log: &Recording,
    found: &Identification,
    parameters: &[f64],
) -> f64 {
    let kind = ModelKind::Explicit;
    let predicted = predict(model, log, parameters, &found.filter, kind).unwrap();
    let decimator = Decimator::new(found.filter.nd, log.rate_hz, Edges::Scipy).unwrap();
    let kept = decimator.kept(log.len);
    let kept = &kept[5..kept.len() - 5];
    let rows = |series: &[Vec<f64>]| decimator.values(series, kept).unwrap();
    let (measured, predicted) = (rows(log.tau.as_ref().unwrap()), rows(&predicted));
    let pairs = measured.iter().flatten().zip(predicted.iter().flatten());
    let (mut apart, mut all) = (0.0, 0.0);
    for (m, p) in pairs {
        apart += (m - p).powi(2);
        all += m * m;
    }
    100.0 * (apart / all).sqrt()
}

/// Every link is a body, and the mass matrix is positive definite in many poses.
fn exists(model: &dyn IdentificationModel, exported: &Exported) {
    for (k, link) in exported.bodies.links.iter().enumerate() {
        assert!(Pseudo::of(link).exists(), "link {}", k + 1);
    }
    let n = model.joints().len();
    let mut dynamics = Dynamics::new(model, &exported.bodies.parameters).unwrap();
    let mut generator = Pcg64Mcg::new(5);
    for _ in 0..10_000 {
        let q: Vec<f64> = (0..n).map(|_| TAU * uniform(&mut generator)).collect();
        let mass = nalgebra::DMatrix::from_row_slice(n, n, dynamics.mass(&q).unwrap());
        assert!(mass.cholesky().is_some(), "{q:?}");
    }
}

#[test]
fn real_robots_become_bodies_that_predict_as_well() {
    let Some(folder) = shared() else { return };
    let sets = [
        (
            "tx40",
            "staubli_tx40/log.csv.gz@0..5",
            "staubli_tx40/log.csv.gz@5..7.5",
        ),
        (
            "ur10e",
            "ur10e/identification/20_02_10_30sec_12harm.csv.gz",
            "ur10e/validation/20_01_17_ptp_10_points.csv.gz",
        ),
        (
            "panda",
            "franka_panda/log.csv.gz@0..9",
            "franka_panda/log.csv.gz@9..13.2",
        ),
    ];
    for (name, train, valid) in sets {
        let (robot, model) = (robot(name), generated(name));
        let (train, valid) = (
            read(model, &folder.join(train)),
            read(model, &folder.join(valid)),
        );
        let found = identify(model, &[train], &[] as &[Recording], &only_explicit(), &()).unwrap();
        let identified = Identified::of(explicit(&found));
        let options = Options {
            fill: true,
            ..Options::default()
        };
        let exported = export(&robot, None, &identified, &options).unwrap();
        exists(model, &exported);
        let free = error(model, &valid, &found, &identified.parameters);
        let bodies = error(model, &valid, &found, &exported.bodies.parameters);
        println!("{name}: validation error {free:.3} % free, {bodies:.3} % of bodies");
        assert!(bodies < 1.02 * free, "{name}");
    }
}

#[test]
fn vendors_urdf_of_the_tx40_takes_the_values_and_keeps_the_rest() {
    let Some(folder) = shared() else { return };
    let (robot, model) = (robot("tx40"), generated("tx40"));
    let train = read(model, &folder.join("staubli_tx40/log.csv.gz@0..5"));
    let found = identify(model, &[train], &[] as &[Recording], &only_explicit(), &()).unwrap();
    let identified = Identified::of(explicit(&found));
    let urdf = folder.join("staubli_tx40/tx40_mdh_modified.urdf");
    let urdf = std::fs::read_to_string(urdf).unwrap();
    let exported = export(&robot, Some(&urdf), &identified, &Options::default()).unwrap();
    exists(model, &exported);
    // Nothing but numbers of <inertial> differs.
    let words = |text: &str| -> Vec<String> {
        let inside = |c: char| c.is_ascii_digit() || "+-.e ".contains(c);
        text.split(inside)
            .filter(|w| !w.is_empty())
            .map(str::to_owned)
            .collect()
    };
    assert_eq!(words(&exported.urdf), words(&urdf));
}

/// Bodies about half-way to the next joint, different from link to link.
fn bodies(robot: &Robot) -> Vec<Standard> {
    let mut generator = Pcg64Mcg::new(11);
    let joints = &robot.mechanism.joints;
    let body = |link: usize| {
        let next = joints.iter().find(|joint| joint.parent == Some(link));
        let to = next.map_or([0.0, 0.0, 0.05], |joint| joint.position);
        let mut spread = |x: f64| x * (1.0 + 0.4 * normal(&mut generator));
        let mass = spread(8.0 / (1.0 + link as f64)).abs().max(0.2);
        let radius = spread(0.06).abs().max(0.02);
        let center = to.map(|x| spread(0.5 * x) + 0.1 * spread(0.1));
        Standard::from_values(Pseudo::ball(mass, radius, center).values())
    };
    (0..joints.len()).map(body).collect()
}

/// A description as vendors give it: masses and moments off by about a quarter.
fn described(robot: &Robot, bodies: &[Standard]) -> String {
    let mut generator = Pcg64Mcg::new(13);
    let mut about = || 1.0 + 0.25 * (2.0 * uniform(&mut generator) - 1.0);
    let off = |body: &Standard| {
        let (mass, radius) = (body.mass * about(), 0.06 * about());
        let center: Vec<f64> = body
            .moment
            .iter()
            .map(|l| l / body.mass * about())
            .collect();
        let pseudo = Pseudo::ball(mass, radius, [center[0], center[1], center[2]]);
        Standard::from_values(pseudo.values())
    };
    let bodies: Vec<Standard> = bodies.iter().map(off).collect();
    urdf::fresh(&robot.mechanism, &bodies)
}

/// Base parameters of bodies with friction and rotors.
fn truth(robot: &Robot, bodies: &[Standard]) -> Vec<f64> {
    let value = |name: &str| {
        let symbol = name.trim_end_matches(|c: char| c.is_ascii_digit());
        let number: usize = name[symbol.len()..].parse().unwrap();
        match NAMES.iter().position(|known| *known == symbol) {
            Some(place) => bodies[number - 1].values()[place],
            None if symbol == "IA" => 0.3,
            None if symbol == "FV" || symbol == "FS" => 2.0,
            None => 0.1,
        }
    };
    let of = |(factor, name): &(f64, String)| factor * value(name);
    let parameters = robot.base.parameters.iter();
    parameters
        .map(|p| p.relation.iter().map(of).sum())
        .collect()
}

/// A motion of several sines per joint; slow and short, it leaves much undecided.
fn motion(joints: usize, seed: u128, seconds: f64, rate_hz: f64) -> Trajectory {
    let mut generator = Pcg64Mcg::new(seed);
    let samples = (seconds * rate_hz) as usize;
    let none = || vec![vec![0.0; samples]; joints];
    let mut motion = Trajectory {
        q: none(),
        qd: none(),
        qdd: none(),
    };
    for joint in 0..joints {
        for _ in 0..4 {
            let w = TAU * (0.1 + 0.5 * uniform(&mut generator));
            let (size, phase) = (0.4 / w, TAU * uniform(&mut generator));
            for k in 0..samples {
                let (sin, cos) = (w * k as f64 / rate_hz + phase).sin_cos();
                motion.q[joint][k] += size * sin;
                motion.qd[joint][k] += size * w * cos;
                motion.qdd[joint][k] -= size * w * w * sin;
            }
        }
    }
    motion
}

/// A log with noise of a share of each torque, the `draw`-th.
fn recording(
    model: &dyn IdentificationModel,
    truth: &[f64],
    (noise, draw): (f64, u128),
) -> Recording {
    let rate_hz = 200.0;
    let motion = motion(model.joints().len(), 3, 10.0, rate_hz);
    let mut tau = inverse_dynamics(model, truth, &motion).unwrap();
    let mut generator = Pcg64Mcg::new(7 + draw);
    for tau in &mut tau {
        let size = (tau.iter().map(|t| t * t).sum::<f64>() / tau.len() as f64).sqrt();
        tau.iter_mut()
            .for_each(|t| *t += noise * size * normal(&mut generator));
    }
    let len = motion.q[0].len();
    Recording {
        name: "simulated.csv".into(),
        stem: "simulated".into(),
        rate_hz,
        start: 0.0,
        len,
        q: motion.q,
        qd: Some(motion.qd),
        tau: Some(tau),
        stamps: (0..len).map(|k| k as f64 / rate_hz).collect(),
        doubtful: Vec::new(),
        warnings: Vec::new(),
    }
}

/// Torque error against the truth on another motion, in percent.
fn away(model: &dyn IdentificationModel, truth: &[f64], parameters: &[f64]) -> f64 {
    let motion = motion(model.joints().len(), 21, 30.0, 50.0);
    let torque = |x: &[f64]| inverse_dynamics(model, x, &motion).unwrap();
    let (wanted, found) = (torque(truth), torque(parameters));
    let pairs = wanted.iter().flatten().zip(found.iter().flatten());
    let (mut apart, mut all) = (0.0, 0.0);
    for (w, f) in pairs {
        apart += (w - f).powi(2);
        all += w * w;
    }
    100.0 * (apart / all).sqrt()
}

/// Simulated logs of each robot.
const DRAWS: u128 = 8;

#[test]
fn bodies_are_nearer_to_the_truth_than_the_free_estimate_at_equal_noise() {
    for name in ["scara", "puma560", "rx90", "tx40", "ur10e", "panda"] {
        let robot = robot(name);
        let model = Interpreter::new(&robot);
        let bodies = bodies(&robot);
        let (truth, described) = (truth(&robot, &bodies), described(&robot, &bodies));
        // Root mean squares over logs with other noise of the same size.
        let (mut all, mut farthest) = ([0.0; 2], 0.0_f64);
        for draw in 0..DRAWS {
            let log = recording(&model, &truth, (0.1, draw));
            let found = identify(&model, &[log], &[] as &[Recording], &only_explicit(), &());
            let identified = Identified::of(explicit(&found.unwrap()));
            let exported = export(&robot, Some(&described), &identified, &Options::default());
            let bodies = exported.unwrap().bodies;
            farthest = farthest.max(bodies.distance.sqrt());
            let found = [identified.parameters, bodies.parameters];
            for (sum, parameters) in all.iter_mut().zip(&found) {
                *sum += away(&model, &truth, parameters).powi(2) / DRAWS as f64;
            }
        }
        let [free, bodies] = all.map(f64::sqrt);
        println!("{name}: {free:.3} % free, {bodies:.3} % of bodies, {farthest:.4} sigma");
        // An estimate that is one of bodies already stays where it is, to a hundredth of its errors.
        let same = farthest < 0.01;
        assert!(bodies < free || same, "{name}: {bodies} {free}");
    }
}

const ARM: &str = r#"<robot name="arm"><link name="base"/>
<link name="upper"><inertial><origin xyz="0 0 0.2"/><mass value="2"/>
<inertia ixx="0.03" iyy="0.03" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="lower"/>
<joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/></joint>
<joint name="elbow" type="continuous"><origin xyz="0 0 0.4"/><parent link="upper"/><child link="lower"/><axis xyz="0 1 0"/></joint>
</robot>"#;

#[test]
fn what_cannot_be_exported_is_said() {
    let robot = builder::read_texts(&[("arm.urdf", ARM)]).unwrap();
    let np = robot.base.parameters.len();
    let sigma = vec![Some(0.01); np];
    let identified = Identified::new(vec![0.3; np], (&sigma, &sigma), &[]);
    let run = |options: &Options| export(&robot, Some(ARM), &identified, options);
    match run(&Options::default()) {
        Err(ExportError::NoInertia(joints)) => assert_eq!(joints, ["`elbow`"]),
        other => panic!("{other:?}"),
    }
    let fill = || Options {
        fill: true,
        ..Options::default()
    };
    assert!(run(&fill()).unwrap().warnings[0].contains("guess"));
    let unknown = Options {
        masses: vec![("hand".into(), 1.0)],
        ..fill()
    };
    match run(&unknown) {
        Err(ExportError::UnknownLink { name, known }) => {
            assert_eq!((name.as_str(), known.len()), ("hand", 2));
        }
        other => panic!("{other:?}"),
    }
    let unknown = Options {
        symmetric: vec![("hand".into(), Plane::Xy)],
        ..fill()
    };
    assert!(matches!(
        run(&unknown),
        Err(ExportError::UnknownLink { .. })
    ));
    let symmetric = Options {
        symmetric: vec![("lower".into(), Plane::Xy)],
        ..fill()
    };
    let [_, _, xz, _, yz, _, _, _, mz, _] = run(&symmetric).unwrap().bodies.links[1];
    assert_eq!([xz, yz, mz], [0.0; 3]);
    let negative = Options {
        total_mass: Some(-3.0),
        ..fill()
    };
    let negative = run(&negative);
    assert!(matches!(
        negative,
        Err(ExportError::Physical(PhysicalError::Value { .. }))
    ));
    let linked = format!(
        "{}<link name=\"finger\"/><joint name=\"grip\" type=\"continuous\"><parent link=\"lower\"/>\
         <child link=\"finger\"/><mimic joint=\"elbow\"/></joint></robot>",
        ARM.trim_end_matches("</robot>")
    );
    let follower = builder::read_texts(&[("arm.urdf", linked.as_str())]).unwrap();
    match export(&follower, None, &identified, &fill()) {
        Err(ExportError::Follows(joints)) => assert_eq!(joints, ["`grip`"]),
        other => panic!("{other:?}"),
    }
    let longer = ARM.replace("0 0 0.4", "0 0 0.5");
    let other = export(&robot, Some(&longer), &identified, &fill());
    assert!(matches!(other, Err(ExportError::Other(_))));
}

#[test]
fn pinocchio_and_mujoco_read_what_is_meant() {
    let python = Command::new("python3")
        .args(["-c", "import mujoco, numpy, pinocchio"])
        .output();
    if !python.is_ok_and(|output| output.status.success()) {
        println!("skipped: python3 with numpy, pinocchio and mujoco is not here");
        return;
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output = Command::new("python3")
        .arg(root.join("tests/interop/urdf.py"))
        .args(["--idim", env!("CARGO_BIN_EXE_idim")])
        .args(
            ["scara", "tx40", "ur10e", "panda"]
                .map(|name| root.join(format!("robots/{name}.toml"))),
        )
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    println!("{said}");
    assert!(
        output.status.success(),
        "{said}{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn command_writes_a_urdf_and_says_what_it_holds() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let values = "[parameters]\nZZR1 = 3.5\nZZ2 = 0.06\nLMX2 = 0.12\nLMY2 = 0.0\nFV1 = 0.05\nFS1 = 0.5\nFV2 = 0.01\nFS2 = 0.1\n";
    std::fs::write(path("values.toml"), values).unwrap();
    let run = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_idim"));
        command.args(["export", "scara", "--parameters"]);
        command.arg(path("values.toml")).args(more);
        command.current_dir(folder.path()).output().unwrap()
    };
    let output = run(&["-o", "scara.urdf", "--json", "scara.json"]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("principal moments"), "{said}");
    let read = builder::read(&path("scara.urdf")).unwrap().robot;
    assert_eq!(read.mechanism.joints.len(), 2);
    let json = std::fs::read_to_string(path("scara.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let exported = |name: &str| {
        let parameters = json["parameters"].as_array().unwrap().iter();
        let mut named = parameters.filter(|p| p["name"] == name);
        named.next().unwrap()["exported"].as_f64().unwrap()
    };
    assert!((exported("ZZR1") - 3.5).abs() < 0.05);
    let wrong = run(&["--mass", "elbow"]);
    assert_eq!(wrong.status.code(), Some(2));
    let plane = run(&["--symmetric", "elbow=xx"]);
    assert_eq!(plane.status.code(), Some(2));
    let boxes = run(&["--boxes"]);
    assert_eq!(boxes.status.code(), Some(2));
    let heavy = run(&["--mass", "forearm=3"]);
    assert_eq!(heavy.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&heavy.stderr).contains("there is no joint or moving link"));
}
