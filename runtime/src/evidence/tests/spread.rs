//! Corrected covariances and tests on them.

use super::super::{Cut, Question, Resampling, Weighting};
use super::{NP, assert_close, gather, random};

#[test]
fn both_corrections_agree_with_the_classical_sigma_on_white_errors() {
    let evidence = gather(&random(1), Cut::default());
    // Weights as they are known, errors of the joints correlated: joint 1 alone sees columns 0, 1.
    let fit = evidence
        .fit(&Question::parameters(&evidence, Weighting::Residual))
        .unwrap();
    let corrected = evidence.corrected(&fit).unwrap();
    let resampling = Resampling {
        run: 1,
        ..Resampling::default()
    };
    let bootstrap = evidence.bootstrap(&fit, &resampling).unwrap();
    assert_eq!(bootstrap.discarded, 0);
    for k in [0, 1] {
        let classical = fit.sigma[k].unwrap();
        for other in [&corrected, &bootstrap.covariance] {
            let ratio = other.sigma[k].unwrap() / classical;
            assert!((0.6..1.6).contains(&ratio), "column {k}: {ratio}");
        }
        assert!((5.0..=10.0).contains(&corrected.dof[k].unwrap()));
    }
}

#[test]
fn several_logs_have_corrected_sigmas_as_one_has() {
    // 32 blocks each: none holds as large a share as those of a single log.
    let logs: Vec<_> = (1..=4)
        .map(|k| gather(&random(k), Cut::default()))
        .collect();
    let mut together = logs[0].clone();
    for more in &logs[1..] {
        together.merge(more).unwrap();
    }
    let fit = together
        .fit(&Question::parameters(&together, Weighting::Residual))
        .unwrap();
    let corrected = together.corrected(&fit).unwrap();
    for k in [0, 1] {
        let ratio = corrected.sigma[k].unwrap() / fit.sigma[k].unwrap();
        assert!((0.6..1.6).contains(&ratio), "column {k}: {ratio}");
    }
}

#[test]
fn covariance_matrix_has_the_variances_on_its_diagonal() {
    let evidence = gather(&random(2), Cut::default());
    let fit = evidence
        .fit(&Question::parameters(&evidence, Weighting::Residual))
        .unwrap();
    let covariance = evidence.corrected(&fit).unwrap();
    assert_eq!(covariance.columns, Vec::from_iter(0..NP));
    for k in 0..NP {
        assert_close(
            &[covariance.matrix[k * NP + k].sqrt()],
            &[covariance.sigma[k].unwrap()],
            1e-12,
        );
        for i in 0..k {
            assert_close(
                &[covariance.matrix[k * NP + i]],
                &[covariance.matrix[i * NP + k]],
                1e-12,
            );
        }
    }
}

#[test]
fn same_seed_gives_the_same_bootstrap_and_another_a_similar_one() {
    let evidence = gather(&random(3), Cut::default());
    let fit = evidence
        .fit(&Question::parameters(&evidence, Weighting::Residual))
        .unwrap();
    let of = |seed| {
        evidence
            .bootstrap(
                &fit,
                &Resampling {
                    seed,
                    ..Resampling::default()
                },
            )
            .unwrap()
    };
    assert_eq!(of(5), of(5));
    let (a, b) = (of(5).covariance, of(6).covariance);
    assert!(a != b);
    for (a, b) in a.sigma.iter().zip(&b.sigma) {
        assert!((a.unwrap() / b.unwrap() - 1.0).abs() < 0.15);
    }
}

#[test]
fn test_of_one_column_is_the_square_of_t() {
    let evidence = gather(&random(4), Cut::default());
    let fit = evidence
        .fit(&Question::parameters(&evidence, Weighting::Residual))
        .unwrap();
    let covariance = evidence.corrected(&fit).unwrap();
    let test = covariance.zero(&fit.solution, &[2]).unwrap();
    let t = fit.solution[2] / covariance.sigma[2].unwrap();
    assert_close(&[t * t], &[test.statistic], 1e-12);
    assert_eq!(test.below, covariance.dof[2].unwrap());
    assert!(covariance.zero(&fit.solution, &[]).is_none());
    assert!(covariance.zero(&fit.solution, &[NP]).is_none());
    let several = covariance.zero(&fit.solution, &[1, 2, 3]).unwrap();
    assert!(several.p_value < 1e-6 && several.above == 3.0);
}

#[test]
fn parameter_seen_in_one_block_only_gets_no_corrected_sigma() {
    let mut observations = random(5);
    let rows = observations.blocks[0].rows;
    observations.blocks[0].w[10..rows].fill(0.0);
    let evidence = gather(&observations, Cut::default());
    let fit = evidence
        .fit(&Question::parameters(&evidence, Weighting::Residual))
        .unwrap();
    assert!(fit.determined[0]);
    let covariance = evidence.corrected(&fit).unwrap();
    assert!(covariance.sigma[0].is_none() && covariance.sigma[1].is_some());
    let bootstrap = evidence.bootstrap(&fit, &Resampling::default()).unwrap();
    assert!(bootstrap.discarded > 100);
}
