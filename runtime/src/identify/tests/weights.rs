//! Weights of joints and of single rows.

use super::hand_written::scara;
use super::synthetic::{disturbed, log, options};
use crate::identify::{Options, identify};
use crate::log::Recording;
use crate::settings::Weights;

#[test]
fn weights_balance_joints_of_different_noise() {
    // Ten times the disturbance on the shoulder: the elbow's parameters are better weighted.
    let clean = log("a", 0.0, 6000);
    let tau = clean.tau.as_ref().map(|tau| {
        let scaled = |joint: &Vec<f64>, by: f64| {
            let noise = (0..joint.len()).map(|i| by * (i as f64 * 0.61).sin() * (i as f64).cos());
            joint.iter().zip(noise).map(|(x, e)| x + e).collect()
        };
        vec![scaled(&tau[0], 2.0), scaled(&tau[1], 0.02)]
    });
    let noisy = Recording { tau, ..clean };
    let sigma = |weights| {
        let options = Options {
            weights: Some(weights),
            ..options()
        };
        let found = identify(&scara(), std::slice::from_ref(&noisy), &[], &options, &()).unwrap();
        found.models[0].parameter("ZZ2").unwrap().sigma.unwrap()
    };
    assert!(sigma(Weights::Joint) < 0.5 * sigma(Weights::None));
    assert!(sigma(Weights::Robust) < 0.5 * sigma(Weights::None));
}

#[test]
fn robust_weights_resist_glitches() {
    let mut spoiled = log("a", 0.0, 6000);
    for joint in spoiled.tau.iter_mut().flatten() {
        *joint = disturbed(std::slice::from_ref(joint)).remove(0);
        for i in (1000..5000).step_by(400) {
            joint[i..i + 20].fill(60.0);
        }
    }
    let error = |weights| {
        let options = Options {
            weights: Some(weights),
            ..options()
        };
        let found = identify(&scara(), std::slice::from_ref(&spoiled), &[], &options, &()).unwrap();
        (found.models[0].parameter("FS1").unwrap().value.unwrap() - 0.5).abs()
    };
    assert!(error(Weights::Robust) < 0.1 * error(Weights::Joint));
}
