//! Frictionless motion keeps its energy; a pendulum has the period of the textbook.

use std::f64::consts::TAU;

use super::model::{DOUBLE, G, double_pendulum, pendulum};
use crate::simulate::{Grid, Method, Options, State, free_motion};

const TEN_SECONDS: Grid = Grid {
    rate_hz: 1000.0,
    start: 0.0,
    len: 10_001,
};

/// Largest change of the energy of a double pendulum in 10 s, relative to its kinetic energy scale.
fn energy_error(method: Method) -> f64 {
    let model = double_pendulum();
    let start = State {
        q: vec![1.2, -0.7],
        qd: vec![0.0, 0.0],
    };
    let options = Options {
        method,
        ..Options::default()
    };
    let result = free_motion(&model, &DOUBLE, (&start, TEN_SECONDS), &options).unwrap();
    let energy = |k: usize| {
        let at = |series: &[Vec<f64>]| [series[0][k], series[1][k]];
        model.energy(&DOUBLE, &at(&result.q), &at(&result.qd))
    };
    let begin = energy(0);
    let bottom = model.energy(&DOUBLE, &[0.0, 0.0], &[0.0, 0.0]);
    let change = (0..TEN_SECONDS.len)
        .map(|k| (energy(k) - begin).abs())
        .fold(0.0, f64::max);
    change / (begin - bottom)
}

#[test]
fn double_pendulum_keeps_its_energy_with_fixed_steps() {
    let error = energy_error(Options::default().method);
    println!(
        "energy error, RK4 at 0.5 ms: {error:.2e}; at 1 ms: {:.2e}",
        { energy_error(Method::Fixed { step_s: 1e-3 }) }
    );
    assert!(error < 1e-9, "{error:e}");
}

#[test]
fn double_pendulum_keeps_its_energy_with_variable_steps() {
    let error = energy_error(Method::Adaptive {
        relative: 1e-12,
        absolute: 1e-12,
    });
    println!("energy error, Dormand-Prince at 1e-12: {error:.2e}");
    assert!(error < 1e-9, "{error:e}");
}

#[test]
fn pendulum_of_small_amplitude_has_the_period_of_the_closed_form() {
    let parameters = [0.4, 0.6, 0.0, 0.0];
    let amplitude = 1e-3;
    let start = State {
        q: vec![amplitude],
        qd: vec![0.0],
    };
    let options = Options::default();
    let run = (&start, TEN_SECONDS);
    let result = free_motion(&pendulum(), &parameters, run, &options).unwrap();
    let rate = (parameters[1] * G / parameters[0]).sqrt();
    // The next term of the elliptic integral: T = T0 (1 + amplitude^2 / 16).
    let rate = rate / (1.0 + amplitude * amplitude / 16.0);
    let crossings: Vec<f64> = result.q[0]
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0] > 0.0 && pair[1] <= 0.0)
        .map(|(k, pair)| (k as f64 + pair[0] / (pair[0] - pair[1])) / 1000.0)
        .collect();
    let periods = crossings.len() - 1;
    let period = (crossings[periods] - crossings[0]) / periods as f64;
    assert!(
        (period * rate / TAU - 1.0).abs() < 1e-7,
        "{}",
        period * rate / TAU - 1.0
    );
}
