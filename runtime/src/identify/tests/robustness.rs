//! No input makes identification panic.

use proptest::prelude::*;

use super::hand_written::scara;
use crate::identify::{Options, identify, predict};
use crate::log::Recording;
use crate::observe::ModelKind;
use crate::report::terminal;
use crate::settings::{Edges, Velocity, Weights};

/// Any number, and what is not a number.
fn value() -> impl Strategy<Value = f64> {
    prop_oneof![
        20 => ordinary(),
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), extreme()],
    ]
}

fn ordinary() -> impl Strategy<Value = f64> {
    prop_oneof![10 => -3.0..3.0f64, 1 => Just(0.0)]
}

/// Finite numbers whose squares are not.
fn extreme() -> impl Strategy<Value = f64> {
    prop_oneof![Just(1e300), Just(-1e-300), Just(1e160)]
}

/// Two series: ordinary, at rest, with extreme values, or with anything in them.
fn series(len: usize) -> impl Strategy<Value = Vec<Vec<f64>>> {
    let one = prop_oneof![
        12 => prop::collection::vec(ordinary(), len),
        2 => ordinary().prop_map(move |x| vec![x; len]),
        1 => prop::collection::vec(prop_oneof![20 => ordinary(), 1 => extreme()], len),
        1 => prop::collection::vec(value(), len),
    ];
    prop::collection::vec(one, 2)
}

prop_compose! {
    fn recording()(len in prop_oneof![1 => 0usize..40, 3 => 60usize..150])(
        q in series(len),
        qd in prop::option::of(series(len)),
        tau in prop::option::weighted(0.9, series(len)),
        rate_hz in prop_oneof![12 => Just(100.0), 1 => value()],
        len in Just(len),
    ) -> Recording {
        Recording {
            doubtful: vec![],
            name: "log".into(), stem: "log".into(), rate_hz, start: 0.0, len,
            q, qd, tau, stamps: Vec::new(), warnings: Vec::new(),
        }
    }
}

prop_compose! {
    fn options()(
        fq_hz in prop::option::of(prop_oneof![9 => 1.0..49.0f64, 1 => value()]),
        order in prop::option::of(prop_oneof![9 => 1usize..6, 1 => 0usize..26]),
        nd in prop::option::of(prop_oneof![9 => 1usize..6, 1 => Just(0), 1 => Just(usize::MAX)]),
        trim in prop::option::of(prop_oneof![9 => 0usize..4, 1 => Just(usize::MAX)]),
        border in prop::option::of((0usize..4, prop_oneof![9 => 0usize..4, 1 => Just(usize::MAX)])),
        matlab in any::<bool>(),
        measured in prop::bool::weighted(0.2),
        prefilter_torque in prop::option::of(any::<bool>()),
        weights in prop_oneof![Just(Weights::None), Just(Weights::Joint), Just(Weights::Robust)],
    ) -> Options {
        Options {
            models: Vec::new(), fq_hz, order, nd, trim, border, prefilter_torque,
            edges: matlab.then_some(Edges::Matlab),
            velocity: measured.then_some(Velocity::Measured),
            weights: Some(weights),
            ..Options::default()
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn identification_never_panics(
        logs in prop_oneof![
            1 => Just(Vec::new()),
            9 => prop::collection::vec(recording(), 1..3),
        ],
        validation in prop::collection::vec(recording(), 0..2),
        options in options(),
    ) {
        match identify(&scara(), &logs, &validation, &options, &()) {
            Ok(found) => prop_assert!(!terminal(&found).is_empty()),
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }

    #[test]
    fn prediction_never_panics(
        log in recording(),
        options in options(),
        parameters in prop::collection::vec(value(), 7..10),
    ) {
        if let Ok(plan) = options.resolve(&scara(), std::slice::from_ref(&log)) {
            for kind in ModelKind::ALL {
                if let Ok(tau) = predict(&scara(), &log, &parameters, &plan.filtering, kind) {
                    prop_assert!(tau.len() == 2 && tau.iter().all(|joint| joint.len() == log.len));
                }
            }
        }
    }
}
