//! Published motions, or ones made by published searches, as tasks with the same limits.

use std::f64::consts::{FRAC_PI_2, PI};

use idim::runtime::excite::{Criterion, Family, JointLimits, Noise, Search, Settings, Start};

/// A published motion and its limits.
pub struct Case {
    /// Robot, family and limits, in words.
    pub name: &'static str,
    /// File and text of the robot.
    pub robot: (&'static str, String),
    /// Of each joint.
    pub limits: Vec<JointLimits>,
    /// Of the motion; searched if absent.
    pub center: Option<Vec<f64>>,
    /// Of the Fourier series.
    pub harmonics: usize,
    /// How it begins.
    pub start: Start,
    /// s.
    pub period_s: f64,
    /// Condition number, in words.
    pub published: &'static str,
    /// Condition number of the published motion on idim's columns, if there is one.
    pub condition: Option<f64>,
}

impl Case {
    /// A search for the smallest condition number, within the case's time and harmonics.
    pub fn settings(&self, starts: usize, steps: usize) -> Settings {
        Settings {
            family: Family::Fourier {
                harmonics: self.harmonics,
            },
            start: self.start,
            criterion: Criterion::Condition,
            period_s: self.period_s,
            periods: 1,
            search: Search {
                seed: 1,
                starts,
                steps,
            },
            noise: Noise {
                sigma: vec![1.0; self.limits.len()],
                rate_hz: 100.0,
            },
            wanted_pct: None,
        }
    }
}

/// All cases.
pub fn all() -> [Case; 4] {
    [fixture(), waypoints(), ur10e(), puma()]
}

/// Universal Robots UR10 without friction: the 36 inertial base parameters.
const UR10: &str = r#"
name = "ur10"
effects = []
[[joint]]
name = "shoulder_pan"
kind = "revolute"
theta = "pi"
r = 0.1273
[[joint]]
name = "shoulder_lift"
kind = "revolute"
alpha = "pi/2"
[[joint]]
name = "elbow"
kind = "revolute"
d = -0.6127
[[joint]]
name = "wrist_1"
kind = "revolute"
d = -0.57155
r = 0.17415
[[joint]]
name = "wrist_2"
kind = "revolute"
alpha = "pi/2"
r = 0.11985
[[joint]]
name = "wrist_3"
kind = "revolute"
alpha = "-pi/2"
"#;

const PUMA: &str = include_str!("../../robots/puma560.toml");
const UR10E: &str = include_str!("../../robots/ur10e.toml");

fn limits<const N: usize>(
    lower: [f64; N],
    upper: [f64; N],
    velocity: [f64; N],
    acceleration: [f64; N],
) -> Vec<JointLimits> {
    let joint = |j: usize| JointLimits {
        lower: lower[j],
        upper: upper[j],
        velocity: velocity[j],
        acceleration: acceleration[j],
        effort: f64::INFINITY,
    };
    (0..N).map(joint).collect()
}

/// thanhndv212/figaroh-examples, examples/ur10: the training motion of the truth fixture,
/// data/truth/protocol.yaml (best of 20 random Fourier series), at 70 % of the velocity limits.
fn fixture() -> Case {
    let home = [0.0, -FRAC_PI_2, FRAC_PI_2, -FRAC_PI_2, -FRAC_PI_2, 0.0];
    let velocity = [2.0943951, 2.0943951, PI, PI, PI, PI].map(|v| 0.7 * v);
    Case {
        name: "UR10, 36 parameters, Fourier 5 harmonics, 10 s, home +- 1.2 rad",
        robot: ("ur10.toml", UR10.into()),
        limits: limits(
            home.map(|q| q - 1.2),
            home.map(|q| q + 1.2),
            velocity,
            [40.0; 6],
        ),
        center: Some(home.into()),
        harmonics: 5,
        start: Start::Moving,
        period_s: 10.0,
        published: "77.02 (figaroh-examples, examples/ur10/data/truth/protocol.yaml)",
        condition: Some(70.0),
    }
}

/// Positions of the same repository's optimised motion, data/truth/train_waypoints.json (IPOPT, best
/// of 16 seeds): cubic splines through 13 points, 24 s.
const BOX: [[f64; 6]; 2] = [
    [-PI, -2.3707963, 0.7707963, -2.7707963, -1.7707963, -1.5],
    [PI, -1.3707963, 1.7707963, -0.3707963, -0.0707963, 1.2],
];

/// The same box; no joint faster than it is in the published motion, nor with more acceleration
/// (natural splines through its points).
fn waypoints() -> Case {
    Case {
        name: "UR10, 36 parameters, 24 s, 12 numbers a joint, its box, its own speeds",
        robot: ("ur10.toml", UR10.into()),
        limits: limits(
            BOX[0],
            BOX[1],
            [1.4943, 0.5108, 0.5380, 1.2319, 0.8403, 1.4638],
            [1.948, 0.483, 0.863, 1.855, 0.984, 2.385],
        ),
        center: None,
        harmonics: 7,
        start: Start::Rest,
        period_s: 24.0,
        published: "61.74 (figaroh-examples, examples/ur10/data/truth/train_waypoints.json)",
        condition: Some(134.0),
    }
}

/// The built-in UR10e with friction and rotors, at the limits of its data sheet.
fn ur10e() -> Case {
    Case {
        name: "UR10e, all parameters, Fourier 5 harmonics, 10 s, +- pi rad, 10 rad/s^2",
        robot: ("ur10e.toml", UR10E.into()),
        limits: limits(
            [-PI; 6],
            [PI; 6],
            [2.0943951, 2.0943951, PI, PI, PI, PI],
            [10.0; 6],
        ),
        center: None,
        harmonics: 5,
        start: Start::Rest,
        period_s: 10.0,
        published: "none found for these parameters",
        condition: None,
    }
}

/// The built-in PUMA 560 with friction and rotors. Ranges of its joints as in P. Corke's Robotics
/// Toolbox; speeds and accelerations are chosen here, for `tests/interop/excitation.py` as well.
fn puma() -> Case {
    let degrees = |q: [f64; 6]| q.map(f64::to_radians);
    Case {
        name: "PUMA 560, all parameters, Fourier 5 harmonics, 10 s, 2 rad/s, 10 rad/s^2",
        robot: ("puma560.toml", PUMA.into()),
        limits: limits(
            degrees([-160.0, -110.0, -135.0, -266.0, -100.0, -266.0]),
            degrees([160.0, 110.0, 135.0, 266.0, 100.0, 266.0]),
            [2.0; 6],
            [10.0; 6],
        ),
        center: None,
        harmonics: 5,
        start: Start::Rest,
        period_s: 10.0,
        published: "36.6 (BIRDy's search by SLSQP, 40 starts: tests/interop/excitation.py)",
        condition: Some(36.6),
    }
}
