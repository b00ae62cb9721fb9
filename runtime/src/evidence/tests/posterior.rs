//! Prior knowledge beside the log: limits, and the covariance against simulation.

use super::super::{Cut, Posterior, Question, Weighting};
use super::{NP, ROWS, Random, assert_close, gather, random};
use crate::observe::Observations;

const NOISE: f64 = 0.5;

fn nominal() -> Vec<f64> {
    (0..NP).map(|k| (k as f64 - 2.5) / scale(k)).collect()
}

fn scale(k: usize) -> f64 {
    10f64.powi(k as i32 - 3)
}

/// Independent knowledge of each parameter: sigma 1 in the units of `random`, times `width`.
fn independent(width: f64) -> Vec<f64> {
    let row = |k: usize| {
        let factor = scale(k) / width;
        let factors = (0..NP).map(move |i| if i == k { factor } else { 0.0 });
        factors.chain([factor * nominal()[k]]).collect::<Vec<_>>()
    };
    (0..NP).flat_map(row).collect()
}

/// Equations of white noise alone about the parameters `x`.
fn about(x: &[f64], random: &mut Random, mut observations: Observations) -> Observations {
    for block in &mut observations.blocks {
        let product = block.product(x).into_iter();
        block.y = Some(product.map(|y| y + NOISE * random.normal()).collect());
    }
    observations
}

fn posterior(observations: &Observations, prior: &[f64]) -> Posterior {
    let evidence = gather(observations, Cut::default());
    evidence
        .posterior(&Weighting::Residual, 1.0, prior)
        .unwrap()
}

/// The last column is twice the one before, wherever both are seen.
fn deficient(mut observations: Observations) -> Observations {
    for block in &mut observations.blocks {
        let place = |c: usize| block.columns.iter().position(|k| *k == c).unwrap();
        let (from, to) = (place(5), place(6));
        for row in 0..block.rows {
            block.w[to * block.rows + row] = 2.0 * block.w[from * block.rows + row];
        }
    }
    observations
}

#[test]
fn a_wide_prior_leaves_the_weighted_estimate() {
    let observations = random(3);
    let found = posterior(&observations, &independent(1e7));
    let evidence = gather(&observations, Cut::default());
    let question = Question::parameters(&evidence, Weighting::Residual);
    let fit = evidence.fit(&question).unwrap();
    assert_close(&found.mean, &fit.solution, 1e-9);
    assert!(found.from_prior < 1e-9);
}

#[test]
fn a_sharp_prior_leaves_the_nominal_values() {
    let found = posterior(&random(3), &independent(1e-7));
    assert_close(&found.mean, &nominal(), 1e-6);
    assert!((found.from_prior - NP as f64).abs() < 1e-6);
    for (k, (sigma, before)) in found.sigma.iter().zip(&found.before).enumerate() {
        assert_close(
            &[sigma.unwrap(), before.unwrap()],
            &[1e-7 / scale(k); 2],
            1e-6,
        );
    }
}

#[test]
fn errors_of_simulated_robots_have_the_covariance_that_is_said() {
    // Individuals drawn from the prior, logs that leave one combination open: the error of the
    // mean, in standard deviations, must have variance one for every parameter, also for those
    // that only the prior tells apart.
    const LOGS: usize = 400;
    let mut draws = Random(11);
    let (mut squares, mut misfit) = (vec![0.0; NP], 0.0);
    let motion = deficient(random(4));
    for _ in 0..LOGS {
        let individual = nominal().into_iter().enumerate();
        let individual = individual.map(|(k, x)| x + 0.02 * draws.normal() / scale(k));
        let individual: Vec<f64> = individual.collect();
        let log = about(&individual, &mut draws, motion.clone());
        let found = posterior(&log, &independent(0.02));
        misfit += found.misfit.powi(2) / LOGS as f64;
        for k in 0..NP {
            squares[k] += ((found.mean[k] - individual[k]) / found.sigma[k].unwrap()).powi(2);
        }
    }
    // Between the chi-square's bounds of one in a thousand, for 7 parameters at once.
    for square in squares {
        let ratio = square / LOGS as f64;
        assert!((0.77..1.26).contains(&ratio), "{ratio}");
    }
    assert!((0.9..1.1).contains(&misfit), "{misfit}");
}

#[test]
fn open_combinations_are_filled_by_the_prior_alone() {
    let truth = nominal();
    let log = about(&truth, &mut Random(5), deficient(random(6)));
    let evidence = gather(&log, Cut::default());
    let question = Question::parameters(&evidence, Weighting::Residual);
    let fit = evidence.fit(&question).unwrap();
    assert_eq!(fit.dependent[0].columns, [5, 6]);
    let found = posterior(&log, &independent(1.0));
    assert!(found.sigma.iter().all(Option::is_some));
    // One direction of the log is empty: the prior decides one parameter's worth of it, and a
    // little of the rest.
    assert!(
        (1.0..1.5).contains(&found.from_prior),
        "{}",
        found.from_prior
    );
    // X6 + 2 X7 is known from the log, which helps both, the less certain one most.
    let gain = |k: usize| found.sigma[k].unwrap() / found.before[k].unwrap();
    assert!(gain(5) < 0.5 && gain(6) < 1.0);
}

#[test]
fn a_prior_of_some_parameters_leaves_the_others_open() {
    let mut log = about(&nominal(), &mut Random(8), deficient(random(7)));
    for block in &mut log.blocks {
        // Nothing moves what X1 stands for.
        if let Some(place) = block.columns.iter().position(|k| *k == 0) {
            block.w[place * ROWS..(place + 1) * ROWS].fill(0.0);
        }
    }
    let only_last: Vec<f64> = independent(0.1)[6 * (NP + 1)..].to_vec();
    let found = posterior(&log, &only_last);
    let open: Vec<usize> = (0..NP).filter(|k| found.sigma[*k].is_none()).collect();
    assert_eq!(open, [0]);
    let known: Vec<usize> = (0..NP).filter(|k| found.before[*k].is_some()).collect();
    assert_eq!(known, [6]);
}

#[test]
fn inflated_errors_widen_the_posterior() {
    let evidence = gather(&random(9), Cut::default());
    let of = |inflation| evidence.posterior(&Weighting::Residual, inflation, &independent(1e6));
    let (one, three) = (of(1.0).unwrap(), of(3.0).unwrap());
    for (one, three) in one.sigma.iter().zip(&three.sigma) {
        assert_close(&[3.0 * one.unwrap()], &[three.unwrap()], 1e-6);
    }
}
