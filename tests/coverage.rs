//! Error bars against the truth: on simulated logs with coloured noise the 95 % intervals of the
//! corrected sigma hold the truth as often as they say; those of the classical one do not.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use idim::demo;
use idim::robots;
use idim::runtime::identify::{Options, identify};
use idim::runtime::observe::ModelKind;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

/// Replications. The fraction inside then scatters by about 1 % around the true coverage.
const LOGS: usize = 500;

/// First-order autoregressive torque noise: a slow disturbance of half a second at 100 Hz.
const MEMORY: f64 = 0.98;

/// Sum of uniform numbers: close enough to normal, and bounded.
fn normal(generator: &mut Pcg64Mcg) -> f64 {
    let sum: f64 = (0..12)
        .map(|_| f64::from(generator.next_u32()) / f64::from(u32::MAX))
        .sum();
    sum - 6.0
}

#[test]
fn corrected_intervals_hold_the_truth_as_often_as_they_say() {
    let experiment = demo::experiment().unwrap();
    let model = &robots::scara::Model;
    let options = Options {
        models: vec![ModelKind::Explicit],
        ..Options::default()
    };
    let run = |log| identify(model, &[log], &[], &options, &()).unwrap().models[0].clone();
    // What the filters do without noise is a bias of the model, not an error of the log.
    let centre = run(experiment.recording.clone());
    let mut generator = Pcg64Mcg::new(2026);
    let np = centre.parameters.len();
    let (mut classical, mut corrected) = (vec![0; np], vec![0; np]);
    for _ in 0..LOGS {
        let mut log = experiment.recording.clone();
        for (torque, size) in log.tau.iter_mut().flatten().zip([0.3, 0.03]) {
            let mut state = 0.0;
            for value in torque {
                state = MEMORY * state + (1.0 - MEMORY * MEMORY).sqrt() * normal(&mut generator);
                *value += size * state;
            }
        }
        let found = run(log);
        for (k, (parameter, centre)) in found.parameters.iter().zip(&centre.parameters).enumerate()
        {
            let error = (parameter.value.unwrap() - centre.value.unwrap()).abs();
            classical[k] += usize::from(error < 1.96 * parameter.sigma.unwrap());
            corrected[k] += usize::from(error < 1.96 * parameter.sigma_corrected.unwrap());
        }
    }
    let percent = |count: usize| 100.0 * count as f64 / LOGS as f64;
    for (k, parameter) in centre.parameters.iter().enumerate() {
        let (old, new) = (percent(classical[k]), percent(corrected[k]));
        println!(
            "{:<6} classical {old:5.1} %  corrected {new:5.1} %",
            parameter.name
        );
        assert!(
            (92.0..=98.0).contains(&new),
            "{}: {new} % inside",
            parameter.name
        );
    }
    let worst = classical.iter().copied().min().unwrap();
    assert!(
        percent(worst) < 80.0,
        "the noise is not coloured enough to tell"
    );
}
