//! A generic model of a joint: everything that it could do by its own motion and torque, without
//! a name. What it leaves is taken for noise where a log does not repeat itself.

use std::f64::consts::TAU;

use super::track::{Predicted, Track};
use crate::model::JointKind;
use crate::signal::central_difference;

/// The variables that the columns are functions of.
pub(super) const VARIABLES: [&str; 6] = [
    "position",
    "velocity",
    "velocity sign",
    "acceleration",
    "load",
    "time",
];

/// The variable of each of the columns.
pub(super) fn variables() -> Vec<&'static str> {
    let mut names = vec!["velocity sign"];
    names.extend(["velocity"; 7]);
    names.extend(["position"; 2]);
    for n in 1..=HARMONICS {
        names.extend(["position"; 2]);
        if n <= 4 {
            names.extend(["velocity sign"; 2]);
        }
    }
    names.extend(["time"; 6]);
    names.extend(["position"; 4]);
    names.push("acceleration");
    names.extend(["load"; 5]);
    names
}

/// Harmonics of a turn.
const HARMONICS: usize = 14;

/// Columns of a joint along a track, decimated.
pub(super) fn columns(
    track: &Track,
    predicted: &Predicted,
    (joint, kind): (usize, JointKind),
) -> Vec<Vec<f64>> {
    let mut all = of_motion(track, (joint, kind));
    all.extend(of_torque(track, predicted, joint));
    all
}

/// Those that its motion decides: offset, speed laws, harmonics of q, direction, slow time, end
/// zones, acceleration. A prismatic joint has the harmonics of its stroke.
pub(super) fn of_motion(track: &Track, (joint, kind): (usize, JointKind)) -> Vec<Vec<f64>> {
    let motion = &track.motion;
    let (q, qdd) = (&motion.q[joint], &motion.qdd[joint]);
    let (low, high) = range(q);
    let stroke = (high - low).max(1e-9);
    let turn = match kind {
        JointKind::Revolute => 1.0,
        JointKind::Prismatic => TAU / stroke,
    };
    let x: Vec<f64> = q.iter().map(|q| 2.0 * (q - low) / stroke - 1.0).collect();
    let [v, side] = speeds(track, joint);
    let t = track.times();
    let long = t.last().copied().unwrap_or(1.0).max(1e-9);
    let s: Vec<f64> = t.iter().map(|t| t / long).collect();
    let mut all: Vec<Vec<f64>> = Vec::new();
    let mut of = |f: &dyn Fn(usize) -> f64| all.push((0..q.len()).map(f).collect());
    of(&|_| 1.0);
    of(&|t| v[t].abs());
    of(&|t| v[t] * v[t].abs());
    of(&|t| v[t].powi(3));
    for width in [0.03_f64, 0.08, 0.2, 0.45] {
        of(&|t| side[t] * (-(v[t] / width).powi(2)).exp());
    }
    of(&|t| x[t]);
    of(&|t| x[t] * x[t]);
    for n in 1..=HARMONICS {
        let waves: Vec<(f64, f64)> = q.iter().map(|q| (n as f64 * turn * q).sin_cos()).collect();
        of(&|t| waves[t].0);
        of(&|t| waves[t].1);
        if n <= 4 {
            of(&|t| side[t] * waves[t].0);
            of(&|t| side[t] * waves[t].1);
        }
    }
    all.extend(drifts(&s, &side, &v));
    let mut of = |f: &dyn Fn(usize) -> f64| all.push((0..q.len()).map(f).collect());
    for edge in [0.35, 0.7] {
        of(&|t| (x[t] - edge).max(0.0));
        of(&|t| (-x[t] - edge).max(0.0));
    }
    of(&|t| qdd[t]);
    track.decimate(&all)
}

/// Those that follow the predicted torque.
pub(super) fn of_torque(track: &Track, predicted: &Predicted, joint: usize) -> Vec<Vec<f64>> {
    let tau = &predicted.model[joint];
    let (least, most) = range(tau);
    let largest = most.max(-least).max(1e-9);
    let rigid = &predicted.rigid[joint];
    let load: Vec<f64> = rigid.iter().map(|t| t / largest).collect();
    let tau: Vec<f64> = tau.iter().map(|t| t / largest).collect();
    let rate = central_difference(&tau, track.motion.rate_hz);
    let [_, side] = speeds(track, joint);
    let mut all: Vec<Vec<f64>> = Vec::new();
    let mut of = |f: &dyn Fn(usize) -> f64| all.push((0..tau.len()).map(f).collect());
    of(&|t| tau[t]);
    of(&|t| load[t].abs() * side[t]);
    of(&|t| (tau[t] / 0.05).tanh());
    of(&|t| (tau[t] - 0.6).max(0.0) + (tau[t] + 0.6).min(0.0));
    of(&|t| rate[t]);
    track.decimate(&all)
}

/// The velocity of a joint as a part of its largest, and its sign.
fn speeds(track: &Track, joint: usize) -> [Vec<f64>; 2] {
    let qd = &track.motion.qd[joint];
    let top = qd.iter().fold(1e-9_f64, |top, v| top.max(v.abs()));
    let band = track.dead_band[joint];
    let side = qd.iter().map(|v| (v / band).clamp(-1.0, 1.0)).collect();
    [qd.iter().map(|v| v / top).collect(), side]
}

/// The columns that change slowly in time alone, decimated: offset and friction that drift.
pub(super) fn slow(track: &Track, joint: usize) -> Vec<Vec<f64>> {
    let [v, side] = speeds(track, joint);
    let long = v.len().max(1) as f64;
    let s: Vec<f64> = (0..v.len()).map(|k| k as f64 / long).collect();
    track.decimate(&drifts(&s, &side, &v))
}

/// Offset, Coulomb and viscous friction times powers of time.
fn drifts(time: &[f64], side: &[f64], v: &[f64]) -> Vec<Vec<f64>> {
    let of_power = |power: i32| {
        let with = |other: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let times = time.iter().enumerate();
            times.map(|(t, s)| s.powi(power) * other(t)).collect()
        };
        [with(&|_| 1.0), with(&|t| side[t]), with(&|t| v[t])]
    };
    (1..=2).flat_map(of_power).collect()
}

fn range(series: &[f64]) -> (f64, f64) {
    let low = series.iter().copied().fold(f64::INFINITY, f64::min);
    (
        low,
        series.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    )
}
