//! Draws what every entry of the catalogue looks like: its torque over the variable that shows it,
//! along one motion of a small arm, from the columns that the diagnosis uses.
//!
//! `cargo run --example effect_pictures` writes `docs/effects/NAME.svg`, the same every time.

use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

use idim::catalogue::Effects;
use idim::codegen::builder;
use idim::interpreted::Interpreter;
use idim::runtime::diagnose::{Catalogue, Hypothesis, Signals};
use idim::runtime::model::{ColumnKind, IdentificationModel, Output, States};

/// An upright arm of two links; without Coulomb friction, whose jumps would hide what is drawn.
const ARM: &str = r#"
name = "arm"
effects = ["viscous", "coulomb", "rotor_inertia"]
[[joint]]
name = "shoulder"
kind = "revolute"
alpha = "pi/2"
[[joint]]
name = "elbow"
kind = "revolute"
d = 0.5
[parameters]
ZZR1 = 3.5
ZZ1 = 3.5
MXR1 = 4.0
MX1 = 4.0
ZZ2 = 0.6
MX2 = 1.2
FV1 = 4.0
FS1 = 0.0
FV2 = 1.5
FS2 = 0.0
"#;

const RATE_HZ: f64 = 200.0;
const SAMPLES: usize = 3200;

/// What an entry is drawn over, and the shape it is drawn with.
fn drawn(name: &str) -> (&'static str, Vec<f64>) {
    match name {
        "torque_offset" | "viscous_asymmetry" => ("velocity, rad/s", vec![]),
        "stribeck" => ("velocity, rad/s", vec![0.4]),
        "nonlinear_viscous" => ("velocity, rad/s", vec![2.0]),
        "transmission_coupling" => ("velocity, rad/s", vec![1.0]),
        "position_dependent_friction" => ("position, rad", vec![3.0]),
        "torque_ripple" => ("position, rad", vec![8.0]),
        "spring" => ("position, rad", vec![]),
        "end_stop" => ("position, rad", vec![1.2, 1.0]),
        "encoder_eccentricity" => ("position, rad", vec![4.0]),
        "presliding" => ("position, rad", vec![0.05]),
        "rotor_inertia" => ("acceleration, rad/s\u{b2}", vec![]),
        "load_dependent_friction" => ("load, N m", vec![]),
        "drive_gain" | "drive_dead_zone" => ("torque of the model, N m", vec![]),
        "drive_saturation" => ("torque of the model, N m", vec![30.0]),
        "friction_drift" => ("time, s", vec![5.0]),
        "joint_elasticity" => ("time, s", vec![4.0, 0.1]),
        "backlash" => ("time, s", vec![0.03]),
        _ => ("time, s", vec![]),
    }
}

/// Motion and torques of the arm.
struct Course {
    t: Vec<f64>,
    motion: [Vec<Vec<f64>>; 3],
    tau: Vec<Vec<f64>>,
    rigid: Vec<Vec<f64>>,
    parameters: Vec<f64>,
}

impl Course {
    fn of(model: &Interpreter, parameters: Vec<f64>) -> Course {
        let t: Vec<f64> = (0..SAMPLES).map(|i| i as f64 / RATE_HZ).collect();
        let wave = |joint: usize, order: i32| -> Vec<f64> {
            let term = |t: f64, size: f64, hz: f64, phase: f64| {
                let w = TAU * hz;
                size * w.powi(order) * (w * t + phase + f64::from(order) * TAU / 4.0).sin()
            };
            let phase = joint as f64 * 1.7;
            let at = |t: &f64| term(*t, 1.9, 0.125, phase) + term(*t, 0.3, 0.375, 2.0 * phase);
            t.iter().map(at).collect()
        };
        let motion = [0, 1, 2].map(|order| (0..2).map(|joint| wave(joint, order)).collect());
        let rigid: Vec<f64> = (model.columns().iter().zip(&parameters))
            .map(|(column, x)| match column.kind {
                ColumnKind::Inertial | ColumnKind::Drive => *x,
                _ => 0.0,
            })
            .collect();
        Course {
            tau: torque(model, &motion, &parameters),
            rigid: torque(model, &motion, &rigid),
            t,
            motion,
            parameters,
        }
    }

    fn signals(&self) -> Signals<'_> {
        Signals {
            rate_hz: RATE_HZ,
            t: &self.t,
            q: &self.motion[0],
            qd: &self.motion[1],
            qdd: &self.motion[2],
            tau_model: &self.tau,
            tau_rigid: &self.rigid,
            parameters: &self.parameters,
            dead_band: &[0.01, 0.01],
        }
    }

    /// A variable of a joint.
    fn variable(&self, what: &str, joint: usize) -> &[f64] {
        match what.split(',').next().unwrap_or("") {
            "position" => &self.motion[0][joint],
            "velocity" => &self.motion[1][joint],
            "acceleration" => &self.motion[2][joint],
            "load" => &self.rigid[joint],
            "torque of the model" => &self.tau[joint],
            _ => &self.t,
        }
    }
}

/// D X along a motion.
fn torque(model: &Interpreter, motion: &[Vec<Vec<f64>>; 3], x: &[f64]) -> Vec<Vec<f64>> {
    let [q, qd, qdd] = [0, 1, 2].map(|order: usize| motion[order].concat());
    let states = States {
        len: SAMPLES,
        q: &q,
        qd: &qd,
        qdd: &qdd,
        slip: &[],
    };
    let pattern = model.pattern(Output::Explicit);
    let mut signals = vec![0.0; pattern.signals * SAMPLES];
    model.evaluate(Output::Explicit, &states, &mut signals);
    let mut torque = vec![vec![0.0; SAMPLES]; 2];
    for entry in pattern.entries.iter() {
        let column = &signals[entry.signal * SAMPLES..][..SAMPLES];
        let row = torque[entry.row].iter_mut();
        row.zip(column)
            .for_each(|(sum, d)| *sum += x[entry.column] * d);
    }
    torque
}

/// The torque of an effect with parameters of 1 and -0.5 on the joint that it is drawn for.
fn effect(effects: &Effects, course: &Course, entry: usize) -> Option<(usize, Vec<f64>)> {
    let about = &effects.entries()[entry];
    let all = effects.hypotheses(&course.signals());
    let first: &Hypothesis = all.iter().find(|hypothesis| hypothesis.entry == entry)?;
    let columns = effects.columns(first, &drawn(about.name).1, &course.signals());
    let joint = columns.first()?.torque.first()?.0;
    let mut sum = vec![0.0; SAMPLES];
    for (k, column) in columns.iter().enumerate() {
        let size = if k % 2 == 0 { 1.0 } else { -0.5 };
        for (_, torque) in column.torque.iter().filter(|(on, _)| *on == joint) {
            sum.iter_mut()
                .zip(torque)
                .for_each(|(sum, t)| *sum += size * t);
        }
    }
    Some((joint, sum))
}

/// Torque over a variable, dot by dot.
fn svg(title: &str, x: &[f64], y: &[f64]) -> String {
    let span = |values: &[f64]| -> (f64, f64) {
        let low = values.iter().copied().fold(0.0, f64::min);
        let high = values.iter().copied().fold(0.0, f64::max);
        let edge = 0.06 * (high - low).max(1e-9);
        (low - edge, high + edge)
    };
    let ((left, right), (low, high)) = (span(x), span(y));
    let at = |x: f64, y: f64| {
        let across = 10.0 + 300.0 * (x - left) / (right - left);
        let down = 130.0 - 120.0 * (y - low) / (high - low);
        (across, down)
    };
    let mut dots = String::new();
    for (x, y) in x.iter().zip(y).step_by(4) {
        let (x, y) = at(*x, *y);
        let _ = write!(dots, "M{x:.1} {y:.1}h0");
    }
    let (zero, level) = at(0.0, 0.0);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 320 156\" width=\"320\">\n\
         <rect width=\"320\" height=\"156\" fill=\"#fff\"/>\n\
         <path d=\"M10 {level:.1}H310M{zero:.1} 10V130\" stroke=\"#999\" fill=\"none\"/>\n\
         <path d=\"{dots}\" stroke=\"#0065a8\" stroke-width=\"2\" stroke-linecap=\"round\"/>\n\
         <text x=\"160\" y=\"148\" font-family=\"sans-serif\" font-size=\"11\" \
         text-anchor=\"middle\">torque over {title}</text>\n</svg>\n"
    )
}

fn main() -> Result<(), Box<dyn Error>> {
    let robot = builder::read_texts(&[("arm.toml", ARM)])?;
    let model = Interpreter::new(&robot);
    let known = &robot.description.parameters;
    let value = |name: &str| known.iter().find(|(n, _)| n == name).map_or(0.0, |p| p.1);
    let parameters = model.columns().iter().map(|c| value(&c.name)).collect();
    let course = Course::of(&model, parameters);
    let effects = Effects::new(&robot);
    let folder = Path::new("docs/effects");
    std::fs::create_dir_all(folder)?;
    for (entry, about) in effects.entries().iter().enumerate() {
        let Some((joint, torque)) = effect(&effects, &course, entry) else {
            println!("{}: nothing to draw", about.name);
            continue;
        };
        let what = drawn(about.name).0;
        let picture = svg(what, course.variable(what, joint), &torque);
        std::fs::write(folder.join(format!("{}.svg", about.name)), picture)?;
    }
    Ok(())
}
