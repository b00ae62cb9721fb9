//! Identities that hold for any robot and log.

use super::hand_written::scara;
use super::synthetic::{X, disturbed, identified, log, options};
use crate::identify::identify;
use crate::log::Recording;
use crate::observe::{ModelKind, Motion, ObserveError, observe};

#[test]
fn exact_torque_gives_exact_parameters() {
    let found = identified(&scara(), &[log("a", 0.0, 4000)]);
    let explicit = found.model(ModelKind::Explicit).unwrap();
    for (parameter, x) in explicit.parameters.iter().zip(X) {
        let error = parameter.value.unwrap() / x - 1.0;
        assert!(error.abs() < 1e-9, "{}: {error:e}", parameter.name);
        assert!(parameter.sigma.unwrap() < 1e-9);
    }
    assert!(explicit.fit.total_pct < 1e-9);
    // The other two differ from it by the central differences: (w h)^2 / 6.
    for kind in [ModelKind::Implicit, ModelKind::Power] {
        let fit = &found.model(kind).unwrap().fit;
        assert!(fit.total_pct < 0.05, "{kind:?}: {}", fit.total_pct);
    }
}

#[test]
fn torque_never_enters_the_observation_matrix() {
    let model = scara();
    let clean = log("a", 0.0, 3000);
    let spoiled = Recording {
        tau: Some(vec![vec![f64::NAN; 3000]; 2]),
        ..clean.clone()
    };
    let silent = Recording {
        tau: None,
        ..clean.clone()
    };
    let plan = options()
        .resolve(&model, std::slice::from_ref(&clean))
        .unwrap();
    for kind in ModelKind::ALL {
        let blocks = |log: &Recording| {
            let motion = Motion::trimmed(log, &model, &plan.filtering).unwrap();
            observe(&model, kind, &motion, &plan.filtering)
                .unwrap()
                .blocks
        };
        for other in [&spoiled, &silent] {
            for (a, b) in blocks(&clean).iter().zip(&blocks(other)) {
                let bits = |w: &[f64]| w.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(&a.w), bits(&b.w));
            }
        }
        assert!(blocks(&silent).iter().all(|block| block.y.is_none()));
    }
    let error = identify(&model, &[spoiled], &[], &options(), &()).unwrap_err();
    let first = ObserveError::NotFinite {
        log: "a".into(),
        series: "tau",
        joint: 1,
        sample: 0,
    };
    assert_eq!(error, first.into());
    let error = identify(&model, &[silent], &[], &options(), &()).unwrap_err();
    assert_eq!(error, ObserveError::NoTorque { log: "a".into() }.into());
}

#[test]
fn permuting_columns_permutes_results() {
    let order = [5, 0, 7, 2, 1, 6, 4, 3];
    let log = log("a", 0.3, 3000);
    let noisy = Recording {
        tau: log.tau.map(|tau| disturbed(&tau)),
        ..log
    };
    let straight = identified(&scara(), std::slice::from_ref(&noisy));
    let permuted = identified(&scara().permuted(&order), &[noisy]);
    for (a, b) in straight.models.iter().zip(&permuted.models) {
        assert!((a.condition / b.condition - 1.0).abs() < 1e-9);
        for (k, old) in order.iter().enumerate() {
            let (new, old) = (&b.parameters[k], &a.parameters[*old]);
            assert_eq!(new.name, old.name);
            let scale = old.sigma.unwrap();
            assert!((new.value.unwrap() - old.value.unwrap()).abs() < 1e-9 * scale.max(1.0));
            assert!((new.sigma.unwrap() / scale - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn several_logs_are_identified_together() {
    let logs = [log("a", 0.0, 3000), log("b", 1.0, 2000)];
    let both = identified(&scara(), &logs);
    let rows = |logs: &[Recording]| identified(&scara(), logs).models[0].rows;
    assert_eq!(both.models[0].rows, rows(&logs[..1]) + rows(&logs[1..]));
    assert_eq!(both.samples, 5000);
    // A filter that ran over the seam would leave an error there.
    assert!(both.models[0].fit.total_pct < 1e-9);
}
