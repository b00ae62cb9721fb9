//! The demo's second experiment: the SCARA under its controller, with an effect that its
//! description has not.

use std::f64::consts::TAU;

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

use idim_codegen::Robot;
use idim_codegen::builder::{self, BuildError};
use idim_runtime::log::{Companion, Recording};
use idim_runtime::simulate::{ClosedLoop, Grid, Options, SimulateError, closed_loop, rigid_only};

use crate::interpreted::Interpreter;
use crate::robots;

/// Sampling rate, Hz.
const RATE_HZ: f64 = 1000.0;

/// Fundamental of the motion, Hz.
const F0_HZ: f64 = 0.125;

/// Harmonics of the motion.
const HARMONICS: usize = 6;

/// Largest position of each joint, rad.
const REACH: [f64; 2] = [1.2, 1.6];

/// Step of the encoders, rad: 17 bits in front of a gear of 40.
const ENCODER: f64 = 1.2e-6;

/// Standard deviation of the logged torque's noise, N m.
const NOISE: [f64; 2] = [0.05, 0.005];

/// What the robot has and its description has not: friction near rest in excess of Coulomb's.
const EFFECT: &str = "\n[[effect]]\nkind = \"stribeck\"\njoint = \"shoulder\"\nvelocity = 0.2\n";

/// Its size, N m.
const SIZE: (&str, f64) = ("FST1", 0.4);

/// What is hidden, in words.
pub const SECRET: &str = "Stribeck friction of 0.4 N m below 0.2 rad/s at the shoulder";

/// Why the hidden effect could not be simulated: defects, all of them.
#[derive(Debug, thiserror::Error)]
pub enum HiddenError {
    /// The description of the robot with the effect.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The simulation.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// A companion without reference or controller.
    #[error("the demo's companion has no {0}")]
    Companion(&'static str),
}

/// A log to simulate: its name, periods of its motion, the seed of motion and noise.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// Stem of its files.
    pub name: &'static str,
    /// Periods of the motion, of 8 s each.
    pub periods: usize,
    /// Seed.
    pub seed: u128,
}

/// The log to fit on, and one of another motion to prove on.
pub const RUNS: [Run; 2] = [
    Run {
        name: "train",
        periods: 3,
        seed: 1,
    },
    Run {
        name: "valid",
        periods: 2,
        seed: 2,
    },
];

impl Run {
    /// The log's companion: encoder, reference and controller, as TOML. The motion is a Fourier
    /// series that begins and ends at rest.
    pub fn companion(&self) -> String {
        let mut generator = Pcg64Mcg::new(self.seed);
        let joints = REACH.map(|reach| series(&mut generator, reach));
        let rows = |part: fn(&[Vec<f64>; 2]) -> &Vec<f64>| {
            let row = |joint: &[Vec<f64>; 2]| {
                let numbers = part(joint).iter().map(|x| format!("{x:.6}"));
                format!("[{}]", numbers.collect::<Vec<_>>().join(", "))
            };
            format!(
                "[{}]",
                joints.iter().map(row).collect::<Vec<_>>().join(", ")
            )
        };
        format!(
            "rate_hz = {RATE_HZ}\nencoder_resolution = {ENCODER:e}\n\n\
             [reference]\nkind = \"fourier\"\nf0_hz = {F0_HZ}\nperiods = {}\n\
             center = [0.0, 0.0]\nsin = {}\ncos = {}\n\n\
             [controller]\nlaw = \"pd\"\nkp = [5700.0, 120.0]\nkd = [210.0, 4.5]\n\
             feedforward = \"none\"\nvelocity_filter_hz = 80\nstart = \"reference\"\n",
            self.periods,
            rows(|joint| &joint[0]),
            rows(|joint| &joint[1]),
        )
    }

    /// Simulates the robot with the hidden effect: its log, as encoders and drives would give it.
    ///
    /// # Errors
    /// [`HiddenError`], which would be a defect.
    pub fn simulate(&self, companion: &Companion) -> Result<Recording, HiddenError> {
        let robot = with_effect()?;
        let model = Interpreter::new(&robot);
        let parameters = truth(&robot);
        let (Some(reference), Some(controller)) = (&companion.reference, &companion.controller)
        else {
            return Err(HiddenError::Companion("reference or controller"));
        };
        let plan = ClosedLoop {
            reference,
            controller,
            rigid: &rigid_only(&model, &parameters),
            grid: Grid {
                rate_hz: RATE_HZ,
                start: 0.0,
                len: (self.periods as f64 / F0_HZ * RATE_HZ) as usize + 1,
            },
            start: None,
        };
        let options = Options {
            encoder_resolution: Some(ENCODER),
            ..Options::default()
        };
        let simulation = closed_loop(&model, &parameters, &plan, &options)?;
        Ok(measured(simulation.into_recording(self.name), self.seed))
    }
}

/// Sine and cosine coefficients of a motion of that reach: velocity and acceleration are zero
/// where a period begins.
fn series(generator: &mut Pcg64Mcg, reach: f64) -> [Vec<f64>; 2] {
    let mut random = |power: i32| -> Vec<f64> {
        let free: Vec<f64> = (1..=HARMONICS)
            .map(|h| normal(generator) / h as f64)
            .collect();
        let weights: Vec<f64> = (1..=HARMONICS).map(|h| (h as f64).powi(power)).collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let share = dot(&free, &weights) / dot(&weights, &weights);
        let pairs = free.iter().zip(&weights);
        pairs.map(|(x, weight)| x - share * weight).collect()
    };
    let (sin, cos) = (random(1), random(2));
    let at = |angle: f64| -> f64 {
        let harmonics = sin.iter().zip(&cos).enumerate();
        let term = |(k, (s, c)): (usize, (&f64, &f64))| {
            let (sine, cosine) = ((k + 1) as f64 * angle).sin_cos();
            s * sine + c * cosine
        };
        harmonics.map(term).sum()
    };
    let angles = (0..500).map(|i| TAU * f64::from(i) / 500.0);
    let largest = angles.fold(0.0_f64, |top, angle| top.max(at(angle).abs()));
    [sin, cos].map(|list| list.iter().map(|x| x * reach / largest).collect())
}

/// The built-in description with the effect.
fn with_effect() -> Result<Robot, BuildError> {
    let texts = robots::ALL
        .iter()
        .find(|robot| robot.name == robots::scara::NAME)
        .map_or(&[][..], |robot| robot.texts);
    let (file, text) = texts.first().copied().unwrap_or_default();
    builder::read_texts(&[(file, &format!("{text}{EFFECT}"))])
}

/// The true parameters.
fn truth(robot: &Robot) -> Vec<f64> {
    let known = &robot.description.parameters;
    let value = |name: &str| match name == SIZE.0 {
        true => SIZE.1,
        false => known
            .iter()
            .find(|(known, _)| known == name)
            .map_or(0.0, |p| p.1),
    };
    let columns = robot.base.parameters.iter();
    columns.map(|column| value(&column.name)).collect()
}

/// Positions in steps of the encoders, torques with noise.
fn measured(mut log: Recording, seed: u128) -> Recording {
    log.qd = None;
    let steps = log.q.iter_mut().flatten();
    steps.for_each(|q| *q = (*q / ENCODER).round() * ENCODER);
    let mut generator = Pcg64Mcg::new(seed ^ 0x5eed);
    for (series, noise) in log.tau.iter_mut().flatten().zip(NOISE) {
        series
            .iter_mut()
            .for_each(|tau| *tau += noise * normal(&mut generator));
    }
    log
}

/// A normal number, near enough: the sum of twelve uniform ones.
fn normal(generator: &mut Pcg64Mcg) -> f64 {
    let mut uniform = || f64::from(generator.next_u32()) / f64::from(u32::MAX) - 0.5;
    (0..12).map(|_| uniform()).sum()
}

#[cfg(test)]
mod tests {
    use idim_runtime::model::IdentificationModel;

    use super::*;

    #[test]
    fn a_motion_begins_at_rest_and_stays_within_its_reach() {
        let [sin, cos] = series(&mut Pcg64Mcg::new(3), 1.2);
        let order = |list: &[f64], power: i32| -> f64 {
            let terms = list.iter().enumerate();
            terms.map(|(k, x)| x * ((k + 1) as f64).powi(power)).sum()
        };
        assert!(order(&sin, 1).abs() < 1e-12, "velocity");
        assert!(order(&cos, 2).abs() < 1e-12, "acceleration");
        assert!(sin.iter().chain(&cos).all(|x| x.abs() <= 2.4));
    }

    #[test]
    fn the_hidden_effect_is_in_the_robot_and_not_in_its_description() {
        let robot = with_effect().unwrap();
        let plain = robots::scara::Model;
        assert_eq!(robot.base.parameters.len(), plain.columns().len() + 1);
        assert!(truth(&robot).contains(&SIZE.1));
        assert!(SECRET.contains("0.4 N m below 0.2 rad/s"));
    }
}
