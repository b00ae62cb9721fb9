//! Effects hidden in simulated logs: named where there is one, nothing where there is none.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::f64::consts::TAU;

use idim::catalogue::Effects;
use idim::codegen::builder::read_texts;
use idim::interpreted::Interpreter;
use idim::runtime::diagnose::{Log, Options, diagnose};
use idim::runtime::log::{Companion, Recording};
use idim::runtime::model::{IdentificationModel, Output, States};
use idim::runtime::report::{Diagnosis, Verdict};

/// A planar arm of two links in the vertical plane.
const ARM: &str = r#"
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

const RATE_HZ: f64 = 1000.0;

/// The truth, parameter by parameter.
fn value(name: &str) -> f64 {
    match name {
        "ZZR1" => 3.5,
        "MXR1" => 4.0,
        "ZZ2" => 0.6,
        "MX2" => 1.2,
        "FV1" => 4.0,
        "FS1" => 6.0,
        "FV2" => 1.5,
        "FS2" => 2.0,
        _ => 0.0,
    }
}

/// Torque hidden in a log: joint, position, velocity to N m.
type Hidden = fn(usize, f64, f64) -> f64;

/// Three equal periods of 8 s, or one of another motion; white noise of 0.2 and 0.1 N m.
fn log(model: &dyn IdentificationModel, seed: u64, periods: usize, hidden: Hidden) -> Log {
    let len = periods * 8000;
    let phase =
        |joint: usize, k: usize| (seed as f64 * 1.3 + joint as f64 * 2.1 + k as f64 * 0.7).sin();
    let wave = |joint: usize, i: usize, order: u32| -> f64 {
        let term = |k: usize| {
            let omega = TAU * 0.125 * k as f64;
            let angle =
                omega * i as f64 / RATE_HZ + 3.0 * phase(joint, k) + f64::from(order) * TAU / 4.0;
            0.6 / k as f64 * omega.powi(order as i32) * angle.sin()
        };
        (1..7).map(term).sum()
    };
    let joints = 2;
    let all = |order: u32| -> Vec<f64> {
        (0..joints)
            .flat_map(|j| (0..len).map(move |i| (j, i)))
            .map(|(j, i)| wave(j, i, order))
            .collect()
    };
    let (q, qd, qdd) = (all(0), all(1), all(2));
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
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut normal = || {
        let mut uniform = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        (0..12).map(|_| uniform()).sum::<f64>()
    };
    let mut tau = vec![vec![0.0; len]; joints];
    for (joint, tau) in tau.iter_mut().enumerate() {
        for entry in pattern.entries.iter().filter(|e| e.row == joint) {
            let x = value(&model.columns()[entry.column].name);
            for (tau, d) in tau.iter_mut().zip(&signals[entry.signal * len..]) {
                *tau += d * x;
            }
        }
        for (i, tau) in tau.iter_mut().enumerate() {
            let at = joint * len + i;
            *tau += hidden(joint, q[at], qd[at]) + [0.2, 0.1][joint] * normal();
        }
    }
    // An encoder of 17 bits in front of a gear of 40.
    let step = TAU / f64::from(1 << 17) / 40.0;
    let rounded = |q: &f64| (q / step).round() * step;
    let recording = Recording {
        name: format!("log{seed}.csv"),
        stem: format!("log{seed}"),
        rate_hz: RATE_HZ,
        start: 0.0,
        len,
        q: q.chunks(len)
            .map(|q| q.iter().map(rounded).collect())
            .collect(),
        qd: None,
        tau: Some(tau),
        doubtful: Vec::new(),
        stamps: (0..len).map(|i| i as f64 / RATE_HZ).collect(),
        warnings: Vec::new(),
    };
    Log {
        recording,
        companion: Companion::default(),
    }
}

fn diagnosed(hidden: Hidden) -> Diagnosis {
    let robot = read_texts(&[("arm.toml", ARM)]).unwrap();
    let model = Interpreter::new(&robot);
    let (train, valid) = ([log(&model, 1, 3, hidden)], [log(&model, 2, 2, hidden)]);
    let catalogue = Effects::new(&robot);
    diagnose(
        &model,
        &catalogue,
        (&train, &valid),
        &Options::default(),
        &(),
    )
    .unwrap()
    .0
}

fn assert_names(found: &Diagnosis, effect: &str, joint: usize) {
    let names: Vec<_> = found
        .effects
        .iter()
        .map(|e| (e.effect.as_str(), &e.joints))
        .collect();
    assert_eq!(found.verdict, Verdict::Named, "{names:?}");
    assert_eq!(names.first(), Some(&(effect, &vec![joint])), "{names:?}");
    let (before, after) = (&found.gap.torque.before, &found.gap.torque.after);
    assert!(
        after.total_pct < before.total_pct,
        "{} {}",
        before.total_pct,
        after.total_pct
    );
}

#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    let found = diagnosed(|_, _, _| 0.0);
    assert_eq!(found.verdict, Verdict::Nothing, "{:?}", found.effects);
    assert!(found.effects.is_empty());
}

#[test]
fn a_stribeck_peak_of_the_shoulder_is_named() {
    let found = diagnosed(|joint, _, qd| match joint {
        0 => 3.0 * qd.signum() * (-(qd / 0.3).powi(2)).exp(),
        _ => 0.0,
    });
    assert_names(&found, "stribeck", 1);
}

#[test]
fn a_ripple_of_the_elbow_is_named() {
    let found = diagnosed(|joint, q, _| match joint {
        1 => 0.8 * (6.0 * q + 0.4).sin(),
        _ => 0.0,
    });
    assert_names(&found, "torque_ripple", 2);
}

#[test]
fn an_offset_of_the_elbow_is_named() {
    let found = diagnosed(|joint, _, _| if joint == 1 { 0.7 } else { 0.0 });
    assert_names(&found, "torque_offset", 2);
}
