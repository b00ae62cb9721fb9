//! How long a diagnosis takes: the whole catalogue on an arm of six joints, from logs in memory to
//! what is said of them. The torque of joint 2 holds a load friction that the model lacks.
//!
//! `cargo bench --bench diagnose`

use std::f64::consts::TAU;
use std::path::Path;

use idim::catalogue::Effects;
use idim::codegen::Robot;
use idim::interpreted::Interpreter;
use idim::runtime::diagnose::{DiagnoseError, Log, Options, diagnose};
use idim::runtime::log::{Companion, Recording};
use idim::runtime::model::IdentificationModel;
use idim::runtime::report::Diagnosis;
use idim::runtime::simulate::{SimulateError, Trajectory, inverse_dynamics};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

const RATE_HZ: f64 = 1000.0;

/// Sines in the motion of a joint, and the range of their frequencies, Hz.
const SINES: usize = 6;
const FREQUENCIES: [f64; 2] = [0.1, 0.8];

/// An encoder of 19 bits behind the gear.
const STEP: f64 = TAU / (1 << 19) as f64;

/// Share of its torque by which friction grows with the load of joint 2.
const LOAD_FRICTION: f64 = 0.08;

fn main() {
    divan::main();
}

/// Seconds to fit on: as long as a usual log, and 100 000 samples.
#[divan::bench(args = [24, 100], sample_count = 5)]
fn six_joints(bencher: divan::Bencher<'_, '_>, seconds: usize) {
    let (Some(robot), Some(train), Some(valid)) = (puma(), log(1, seconds), log(2, 16)) else {
        println!("skipped: the PUMA 560 is not described as this benchmark expects");
        return;
    };
    bencher.bench(|| said(&robot, &train, &valid));
}

fn puma() -> Option<Robot> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("robots/puma560.toml");
    Some(idim::codegen::builder::read(&path).ok()?.robot)
}

fn said(robot: &Robot, train: &Log, valid: &Log) -> Result<Diagnosis, DiagnoseError> {
    let logs = (std::slice::from_ref(train), std::slice::from_ref(valid));
    let catalogue = Effects::new(robot);
    let model = Interpreter::new(robot);
    diagnose(&model, &catalogue, logs, &Options::default(), &()).map(|(diagnosis, _)| diagnosis)
}

/// A log of the arm as its encoders and drives would give it.
fn log(seed: u64, seconds: usize) -> Option<Log> {
    let robot = puma()?;
    let model = Interpreter::new(&robot);
    let mut noise = Pcg64Mcg::new(seed.into());
    let motion = sines(&mut noise, model.joints().len(), seconds);
    let mut tau = torque(&model, &motion, true).ok()?;
    let rigid = torque(&model, &motion, false).ok()?;
    for ((tau, load), v) in tau[1].iter_mut().zip(&rigid[1]).zip(&motion.qd[1]) {
        *tau += LOAD_FRICTION * load.abs() * v.signum();
    }
    for tau in &mut tau {
        let largest = tau.iter().fold(0.0_f64, |top, tau| top.max(tau.abs()));
        tau.iter_mut()
            .for_each(|tau| *tau += 0.01 * largest * normal(&mut noise));
    }
    let rounded = |q: &Vec<f64>| q.iter().map(|q| (q / STEP).round() * STEP).collect();
    Some(Log {
        recording: Recording {
            name: format!("log{seed}.csv"),
            stem: format!("log{seed}"),
            rate_hz: RATE_HZ,
            start: 0.0,
            len: motion.q[0].len(),
            q: motion.q.iter().map(rounded).collect(),
            qd: None,
            tau: Some(tau),
            stamps: (0..motion.q[0].len()).map(|k| k as f64 / RATE_HZ).collect(),
            doubtful: Vec::new(),
            warnings: Vec::new(),
        },
        companion: Companion::default(),
    })
}

/// Torques of parameters that fall off from the shoulder to the wrist, with or without friction.
fn torque(
    model: &Interpreter,
    motion: &Trajectory,
    friction: bool,
) -> Result<Vec<Vec<f64>>, SimulateError> {
    let value = |name: &str| {
        let joint = name.chars().filter_map(|c| c.to_digit(10)).next_back();
        let size = 0.5_f64.powi(joint.map_or(0, u32::cast_signed));
        match name {
            _ if name.starts_with('F') && !friction => 0.0,
            _ if name.starts_with("FS") => 8.0 * size,
            _ if name.starts_with("FV") => 4.0 * size,
            _ if name.starts_with("ZZ") || name.starts_with("IA") => 4.0 * size,
            _ if name.starts_with("MX") || name.starts_with("MY") => 2.0 * size,
            _ => 0.3 * size,
        }
    };
    let columns = model.columns().iter();
    let parameters: Vec<f64> = columns.map(|column| value(&column.name)).collect();
    inverse_dynamics(model, &parameters, motion)
}

/// A sum of sines for each joint, which does not repeat itself.
fn sines(noise: &mut Pcg64Mcg, joints: usize, seconds: usize) -> Trajectory {
    let samples = (seconds as f64 * RATE_HZ) as usize;
    let mut motion = Trajectory {
        q: vec![vec![0.0; samples]; joints],
        qd: vec![vec![0.0; samples]; joints],
        qdd: vec![vec![0.0; samples]; joints],
    };
    for joint in 0..joints {
        for _ in 0..SINES {
            let [lowest, highest] = FREQUENCIES;
            let w = TAU * (lowest + (highest - lowest) * uniform(noise));
            let (size, phase) = (0.4 / w, TAU * uniform(noise));
            for k in 0..samples {
                let (sin, cos) = (w * k as f64 / RATE_HZ + phase).sin_cos();
                motion.q[joint][k] += size * sin;
                motion.qd[joint][k] += size * w * cos;
                motion.qdd[joint][k] -= size * w * w * sin;
            }
        }
    }
    motion
}

/// A normal number of unit variance, as far as twelve uniform ones make one.
fn normal(generator: &mut Pcg64Mcg) -> f64 {
    (0..12).map(|_| uniform(generator)).sum::<f64>() - 6.0
}

/// A number between zero and one.
fn uniform(generator: &mut Pcg64Mcg) -> f64 {
    generator.next_u64() as f64 / u64::MAX as f64
}
