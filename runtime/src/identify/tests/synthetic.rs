//! Logs of the hand-written SCARA, made here.

use std::f64::consts::TAU;

use super::hand_written::{HandWritten, scara};
use crate::identify::{Options, identify, predict};
use crate::log::Recording;
use crate::observe::ModelKind;
use crate::report::Identification;
use crate::settings::{Edges, Weights};

/// The parameters of the torque: those of Gautier 1996, section 7.1.
pub const X: [f64; 8] = [3.5, 0.05, 0.5, 0.06, 0.12, 0.005, 0.01, 0.1];

pub fn options() -> Options {
    Options {
        fq_hz: Some(20.0),
        nd: Some(5),
        trim: Some(100),
        edges: Some(Edges::Scipy),
        weights: Some(Weights::None),
        ..Options::default()
    }
}

/// A motion of several sines per joint, without torque.
pub fn motion(name: &str, seed: f64, len: usize) -> Recording {
    let rate_hz = 200.0;
    let joint = |j: usize| -> Vec<f64> {
        let wave = |i: usize, k: f64| {
            let phase = seed + k * 1.7 + j as f64;
            ((0.2 + 0.13 * k + 0.05 * j as f64) * TAU * i as f64 / rate_hz + phase).sin()
        };
        (0..len)
            .map(|i| (1..5).map(|k| 0.5 * wave(i, f64::from(k))).sum())
            .collect()
    };
    Recording {
        doubtful: vec![],
        name: name.to_owned(),
        stem: name.to_owned(),
        rate_hz,
        start: 0.0,
        len,
        q: vec![joint(0), joint(1)],
        qd: None,
        tau: None,
        stamps: (0..len).map(|i| i as f64 / rate_hz).collect(),
        warnings: Vec::new(),
    }
}

/// The recording with the torque that the explicit model predicts along its filtered motion, so
/// that identification has nothing but rounding to explain.
pub fn with_torque(model: &HandWritten, log: Recording) -> Recording {
    let plan = options()
        .resolve(model, std::slice::from_ref(&log))
        .unwrap();
    let tau = predict(model, &log, &X, &plan.filtering, ModelKind::Explicit).unwrap();
    Recording {
        tau: Some(tau),
        ..log
    }
}

pub fn log(name: &str, seed: f64, len: usize) -> Recording {
    with_torque(&scara(), motion(name, seed, len))
}

pub fn identified(model: &HandWritten, logs: &[Recording]) -> Identification {
    identify(model, logs, &[], &options(), &()).unwrap()
}

/// Torque with a disturbance that no parameter explains.
pub fn disturbed(tau: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let error = |i: usize| 0.05 * (i as f64 * 0.037).sin() * (i as f64 * 0.011).cos();
    tau.iter()
        .map(|s| s.iter().enumerate().map(|(i, x)| x + error(i)).collect())
        .collect()
}
