//! Identification with a description's tolerances.

use super::hand_written::{HandWritten, scara};
use super::synthetic::{X, disturbed, log, motion, options, with_torque};
use crate::identify::{Options, PriorUse, identify};
use crate::log::Recording;
use crate::report::{Identification, terminal};
use crate::settings::Weights;

/// The SCARA with independent knowledge of every parameter: 10 % more than the truth, known to
/// `sigma` of it.
fn known(sigma: f64) -> HandWritten {
    let mut model = scara();
    let nominal: Vec<f64> = X.iter().map(|x| 1.1 * x).collect();
    let rows = nominal.iter().enumerate().flat_map(|(k, value)| {
        let factor = 1.0 / (sigma * value);
        let factors = (0..X.len()).map(move |i| if i == k { factor } else { 0.0 });
        factors.chain([factor * value])
    });
    model.knowledge.prior = rows.collect();
    model.knowledge.nominal = nominal.into_iter().map(Some).collect();
    model
}

fn noisy(name: &str, seed: f64) -> Recording {
    let log = log(name, seed, 2000);
    let tau = log.tau.as_deref().map(disturbed);
    Recording { tau, ..log }
}

fn run(model: &HandWritten, train: Recording, options: &Options) -> Identification {
    identify(model, &[train], &[noisy("valid", 5.0)], options, &()).unwrap()
}

#[test]
fn the_classical_estimate_is_the_same_with_and_without_prior() {
    let model = known(0.01);
    let ignored = Options {
        prior: PriorUse::Ignore,
        ..options()
    };
    let with = run(&model, noisy("a", 0.3), &options());
    let without = run(&model, noisy("a", 0.3), &ignored);
    for (with, without) in with.models.iter().zip(&without.models) {
        assert!(with.with_prior.is_some() && without.with_prior.is_none());
        for (a, b) in with.parameters.iter().zip(&without.parameters) {
            assert_eq!((a.value, a.sigma), (b.value, b.sigma));
            assert_eq!(a.nominal, b.nominal);
            assert!(a.with_prior.is_some() && b.with_prior.is_none());
        }
    }
    assert!(!terminal(&without).contains("prior"));
    assert!(terminal(&with).contains("with prior"));
}

#[test]
fn wide_tolerances_leave_the_weighted_estimate_and_sharp_ones_the_description() {
    for weights in [Weights::None, Weights::Joint, Weights::Robust] {
        let options = Options {
            weights: Some(weights),
            ..options()
        };
        let wide = run(&known(1e5), noisy("a", 0.3), &options);
        // The prior always counts against the joints' error levels.
        let all = wide.models.iter().flat_map(|model| &model.parameters);
        for parameter in all.filter(|_| weights != Weights::None) {
            let (value, sigma) = (parameter.value.unwrap(), parameter.sigma.unwrap());
            let found = parameter.with_prior.as_ref().unwrap().value.unwrap();
            let error = (found - value).abs() / sigma;
            assert!(error < 0.01, "{weights:?} {}: {error}", parameter.name);
        }
        let sharp = run(&known(1e-8), noisy("a", 0.3), &options);
        for parameter in sharp.models.iter().flat_map(|model| &model.parameters) {
            let (found, nominal) = (parameter.with_prior.as_ref(), parameter.nominal.unwrap());
            let error = (found.unwrap().value.unwrap() / nominal - 1.0).abs();
            assert!(error < 1e-4, "{weights:?} {}: {error}", parameter.name);
        }
        assert!(
            sharp
                .warnings
                .iter()
                .any(|w| w.contains("contradicts the description"))
        );
    }
}

#[test]
fn what_a_resting_joint_hides_is_filled_by_the_prior_and_named() {
    let mut still = motion("still", 0.3, 2000);
    still.q[1] = vec![0.4; 2000];
    let train = with_torque(&scara(), still);
    let found = run(&known(0.05), train, &options());
    for model in &found.models {
        let filled: Vec<&str> = model
            .parameters
            .iter()
            .filter(|p| p.with_prior.as_ref().unwrap().filled)
            .map(|p| p.name.as_str())
            .collect();
        for name in ["FV2", "FS2"] {
            assert!(filled.contains(&name), "{:?}: {filled:?}", model.name);
            let parameter = model.parameter(name).unwrap();
            let with_prior = parameter.with_prior.as_ref().unwrap();
            assert_eq!(parameter.value, None);
            assert!((with_prior.value.unwrap() / parameter.nominal.unwrap() - 1.0).abs() < 1e-6);
            let (after, before) = (with_prior.sigma.unwrap(), with_prior.sigma_before.unwrap());
            assert!((after / before - 1.0).abs() < 1e-6);
        }
        assert!(!filled.contains(&"FV1"));
        assert!(model.with_prior.as_ref().unwrap().from_prior > 2.0);
    }
    let named = |warning: &&String| warning.contains("[prior]") && warning.contains("FV2");
    assert!(
        found.warnings.iter().any(|w| named(&w)),
        "{:?}",
        found.warnings
    );
    assert!(terminal(&found).contains('*'));
}

#[test]
fn knowledge_beside_a_short_log_comes_nearer_to_the_truth() {
    // A tolerance that holds the truth: errors shrink towards it, and the sigmas with them.
    let found = run(&known(0.1), noisy("a", 0.3), &options());
    for parameter in &found.models[0].parameters {
        let with_prior = parameter.with_prior.as_ref().unwrap();
        let own = parameter.sigma_corrected.or(parameter.sigma).unwrap();
        assert!(with_prior.sigma.unwrap() < with_prior.sigma_before.unwrap());
        assert!(with_prior.sigma.unwrap() < 3.0 * own, "{}", parameter.name);
    }
}
