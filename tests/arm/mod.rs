//! A planar arm of two links in the vertical plane, and logs of it in which something is hidden.

use std::f64::consts::TAU;

use idim::catalogue::Effects;
use idim::codegen::Robot;
use idim::codegen::builder::read_texts;
use idim::interpreted::Interpreter;
use idim::runtime::diagnose::{DiagnoseError, Log, Options, diagnose};
use idim::runtime::log::{Companion, Recording};
use idim::runtime::model::{IdentificationModel, Output, States};
use idim::runtime::report::Diagnosis;

/// Its description.
pub const ARM: &str = r#"
name = "arm"
gravity = [0.0, -9.81, 0.0]
effects = ["viscous", "coulomb"]
[lengths]
L = 0.5
[[joint]]
name = "shoulder"
kind = "revolute"
ant = 0
[[joint]]
name = "elbow"
kind = "revolute"
ant = 1
d = "L"
"#;

pub const RATE_HZ: f64 = 1000.0;

/// Coulomb friction of its joints, N m.
pub const COULOMB: [f64; 2] = [6.0, 2.0];

/// The truth, parameter by parameter.
fn value(name: &str) -> f64 {
    match name {
        "ZZR1" => 3.5,
        "MXR1" => 4.0,
        "ZZ2" => 0.6,
        "MX2" => 1.2,
        "FV1" => 4.0,
        "FS1" => COULOMB[0],
        "FV2" => 1.5,
        "FS2" => COULOMB[1],
        _ => 0.0,
    }
}

/// The motion of a joint, sample by sample: s, rad, rad/s, rad/s^2.
pub struct Course {
    pub t: Vec<f64>,
    pub q: Vec<f64>,
    pub qd: Vec<f64>,
    pub qdd: Vec<f64>,
}

impl Course {
    /// A torque that is a function of position and velocity.
    pub fn map(&self, torque: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let states = self.q.iter().zip(&self.qd);
        states.map(|(q, qd)| torque(*q, *qd)).collect()
    }
}

/// Torque hidden in a log: of a joint (from 0) along its motion, N m.
pub type Hidden<'a> = &'a dyn Fn(usize, &Course) -> Vec<f64>;

/// Nothing hidden.
pub fn nothing(_: usize, course: &Course) -> Vec<f64> {
    vec![0.0; course.t.len()]
}

/// A log to be made.
#[derive(Clone, Copy)]
pub struct Plan {
    /// Of motion and noise; it also names the log.
    pub seed: u64,
    /// Period of the motion, s, and how many of them.
    pub period: f64,
    pub periods: usize,
    /// Time constant of the slow part of the torque's noise, s; 0: it is white.
    pub colour: f64,
    /// Whether the arm stands still for a while in each period.
    pub rests: bool,
}

/// Three equal periods to fit on.
pub const TRAIN: Plan = Plan {
    seed: 1,
    period: 8.0,
    periods: 3,
    colour: 0.0,
    rests: false,
};

/// Two of another motion.
pub const VALID: Plan = Plan {
    seed: 2,
    periods: 2,
    ..TRAIN
};

impl Plan {
    fn samples(&self) -> usize {
        (self.period * self.periods as f64 * RATE_HZ).round() as usize
    }

    /// How far the motion has come along its course at a time, and its two derivatives: a rest of
    /// 1.5 s after the middle of each period, slowed down to and started from within 0.5 s; the
    /// course of a period is shorter by what that takes.
    fn progress(&self, t: f64) -> [f64; 3] {
        if !self.rests {
            return [t, 1.0, 0.0];
        }
        let (whole, within) = ((t / self.period).floor(), t % self.period);
        let moved = self.period - 2.0;
        let [a, b, c, d] = [0.0, 0.5, 2.0, 2.5].map(|after| 0.5 * self.period + after);
        // Smoothstep of the speed: 1 - 3 x^2 + 2 x^3, its integral and its derivative.
        let slow = |x: f64| {
            [
                x - x.powi(3) + 0.5 * x.powi(4),
                1.0 - 3.0 * x * x + 2.0 * x.powi(3),
                6.0 * x * (x - 1.0),
            ]
        };
        let [s, ds, dds] = match within {
            w if w < a => [w, 1.0, 0.0],
            w if w < b => {
                let [x, dx, ddx] = slow((w - a) / 0.5);
                [a + 0.5 * x, dx, ddx / 0.5]
            }
            w if w < c => [a + 0.25, 0.0, 0.0],
            w if w < d => {
                let [x, dx, ddx] = slow((d - w) / 0.5);
                [a + 0.5 - 0.5 * x, dx, -ddx / 0.5]
            }
            w => [w - 2.0, 1.0, 0.0],
        };
        [whole * moved + s, ds, dds]
    }

    /// The motion of a joint.
    fn course(&self, joint: usize) -> Course {
        let fundamental = match self.rests {
            true => 1.0 / (self.period - 2.0),
            false => 1.0 / self.period,
        };
        let orders = (0.75 * self.period) as usize;
        let phase = |k: usize| (self.seed as f64 * 1.3 + joint as f64 * 2.1 + k as f64 * 0.7).sin();
        let wave = |s: f64, order: i32| -> f64 {
            let term = |k: usize| {
                let omega = TAU * fundamental * k as f64;
                let angle = omega * s + 3.0 * phase(k) + f64::from(order) * TAU / 4.0;
                0.6 / k as f64 * omega.powi(order) * angle.sin()
            };
            (1..=orders).map(term).sum()
        };
        let t: Vec<f64> = (0..self.samples()).map(|i| i as f64 / RATE_HZ).collect();
        let at: Vec<[f64; 3]> = t.iter().map(|t| self.progress(*t)).collect();
        Course {
            q: at.iter().map(|[s, ..]| wave(*s, 0)).collect(),
            qd: at.iter().map(|[s, ds, _]| ds * wave(*s, 1)).collect(),
            qdd: at
                .iter()
                .map(|[s, ds, dds]| ds * ds * wave(*s, 2) + dds * wave(*s, 1))
                .collect(),
            t,
        }
    }

    /// The log, with noise of 0.2 and 0.1 N m.
    pub fn log(&self, hidden: Hidden<'_>) -> Log {
        let robot = arm();
        let courses: Vec<Course> = (0..2).map(|joint| self.course(joint)).collect();
        let mut tau = modelled(&Interpreter::new(&robot), &courses);
        let mut normal = normal(self.seed);
        for (joint, tau) in tau.iter_mut().enumerate() {
            let noise = noise(self.samples(), self.colour, &mut normal);
            let hidden = hidden(joint, &courses[joint]);
            for ((tau, hidden), noise) in tau.iter_mut().zip(hidden).zip(noise) {
                *tau += hidden + [0.2, 0.1][joint] * noise;
            }
        }
        // An encoder of 17 bits in front of a gear of 40.
        let step = TAU / f64::from(1 << 17) / 40.0;
        let rounded = |q: &f64| (q / step).round() * step;
        let recording = Recording {
            name: format!("log{}.csv", self.seed),
            stem: format!("log{}", self.seed),
            rate_hz: RATE_HZ,
            start: 0.0,
            len: self.samples(),
            q: courses
                .iter()
                .map(|course| course.q.iter().map(rounded).collect())
                .collect(),
            qd: None,
            tau: Some(tau),
            doubtful: Vec::new(),
            stamps: courses[0].t.clone(),
            warnings: Vec::new(),
        };
        Log {
            recording,
            companion: Companion::default(),
        }
    }
}

/// The described arm.
pub fn arm() -> Robot {
    read_texts(&[("arm.toml", ARM)]).unwrap()
}

/// The arm's own torque along a motion.
fn modelled(model: &dyn IdentificationModel, courses: &[Course]) -> Vec<Vec<f64>> {
    let len = courses[0].t.len();
    let packed = |of: fn(&Course) -> &Vec<f64>| -> Vec<f64> {
        courses.iter().flat_map(of).copied().collect()
    };
    let (q, qd, qdd) = (packed(|c| &c.q), packed(|c| &c.qd), packed(|c| &c.qdd));
    let states = States {
        len,
        q: &q,
        qd: &qd,
        qdd: &qdd,
        slip: &[],
    };
    let pattern = model.pattern(Output::Explicit);
    let mut signals = vec![0.0; pattern.signals * len];
    model.evaluate(Output::Explicit, &states, &mut signals);
    let mut tau = vec![vec![0.0; len]; courses.len()];
    for entry in pattern.entries.iter() {
        let x = value(&model.columns()[entry.column].name);
        for (tau, d) in tau[entry.row]
            .iter_mut()
            .zip(&signals[entry.signal * len..])
        {
            *tau += d * x;
        }
    }
    tau
}

/// Normal numbers, near enough: sums of twelve uniform ones.
pub fn normal(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut uniform = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    move || (0..12).map(|_| uniform()).sum::<f64>()
}

/// White noise of unit variance, and beside it a third of its size with a time constant, s, if
/// there is one: below 20 Hz that is the larger part.
fn noise(len: usize, time: f64, normal: &mut dyn FnMut() -> f64) -> Vec<f64> {
    if time == 0.0 {
        return (0..len).map(|_| normal()).collect();
    }
    let keep = (-1.0 / (time * RATE_HZ)).exp();
    let mut slow = normal();
    let next = |_| {
        slow = keep * slow + (1.0 - keep * keep).sqrt() * normal();
        normal() + slow / 3.0
    };
    (0..len).map(next).collect()
}

/// What is said of the arm's logs.
pub fn said(train: &[Log], validate: &[Log]) -> Result<Diagnosis, DiagnoseError> {
    let robot = arm();
    let (model, catalogue) = (Interpreter::new(&robot), Effects::new(&robot));
    let logs = (train, validate);
    Ok(diagnose(&model, &catalogue, logs, &Options::default(), &())?.0)
}

/// What was named, strongest first: effect and joints, from 1.
pub fn names(found: &Diagnosis) -> Vec<(&str, &[usize])> {
    let effects = found.effects.iter();
    effects
        .map(|e| (e.effect.as_str(), e.joints.as_slice()))
        .collect()
}
