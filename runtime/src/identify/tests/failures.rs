//! What cannot be identified has a name.

use std::ops::Range;

use super::hand_written::scara;
use super::synthetic::{identified, log, motion, options, with_torque};
use crate::estimate::EstimateError;
use crate::identify::{IdentifyError, Options, identify};
use crate::log::{LogError, Recording, Samples};
use crate::observe::{ModelKind, ObserveError};
use crate::report::terminal;
use crate::settings::Weights;

#[test]
fn a_joint_that_never_moves_is_named() {
    let mut still = motion("still.csv", 0.0, 3000);
    still.q[1].fill(0.7);
    let found = identified(&scara(), &[with_torque(&scara(), still)]);
    let says = |text: &str| found.warnings.iter().any(|w| w.contains(text));
    assert!(says(
        "joint 2 (elbow) never moves: FV2, FS2 cannot be identified"
    ));
    assert!(
        says("ZZR1, ZZ2, LMX2, LMY2 cannot be identified one by one"),
        "{:?}",
        found.warnings
    );
    let explicit = found.model(ModelKind::Explicit).unwrap();
    for name in ["FV2", "FS2", "LMX2"] {
        let parameter = explicit.parameter(name).unwrap();
        assert_eq!((parameter.value, parameter.sigma), (None, None));
    }
    for (name, x) in [("FV1", 0.05), ("FS1", 0.5)] {
        assert!((explicit.parameter(name).unwrap().value.unwrap() - x).abs() < 1e-9);
    }
    assert!(explicit.fit.total_pct < 1e-9);
    assert!(explicit.rank < 8 && explicit.condition.is_finite());
    assert!(terminal(&found).contains("warning: joint 2 (elbow) never moves"));
}

#[test]
fn sensor_noise_of_a_resting_joint_is_no_motion() {
    let mut still = motion("still.csv", 0.0, 3000);
    still.q[1] = (0..3000).map(|i| 0.7 + 3e-6 * f64::from(i % 2)).collect();
    let found = identified(&scara(), &[with_torque(&scara(), still)]);
    assert!(found.models[0].parameter("FS2").unwrap().value.is_none());
}

#[test]
fn too_short_a_log_is_an_error() {
    let short = Recording {
        tau: Some(vec![vec![0.0; 10]; 2]),
        ..motion("short.csv", 0.0, 10)
    };
    let error = identify(&scara(), &[short], &[], &options(), &()).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("short.csv: prefilter") && text.contains("needs at least 16"),
        "{text}"
    );
    let trimmed = log("a", 0.0, 190);
    let error = identify(&scara(), &[trimmed], &[], &options(), &()).unwrap_err();
    assert!(error.to_string().contains("leaves nothing"), "{error}");
}

#[test]
fn fewer_equations_than_parameters_is_an_error() {
    let options = Options {
        nd: Some(20),
        models: vec![ModelKind::Power],
        ..options()
    };
    let error = identify(&scara(), &[log("a", 0.0, 300)], &[], &options, &()).unwrap_err();
    let source = EstimateError::TooFewEquations {
        rows: 5,
        parameters: 8,
    };
    assert_eq!(
        error,
        IdentifyError::Estimate {
            model: ModelKind::Power,
            source
        }
    );
}

#[test]
fn a_log_of_another_robot_is_an_error() {
    let mut other = log("other.csv", 0.0, 3000);
    other.q.push(vec![0.0; 3000]);
    let error = identify(&scara(), &[other], &[], &options(), &()).unwrap_err();
    let joints = ObserveError::Joints {
        log: "other.csv".into(),
        has: 3,
        needs: 2,
    };
    assert_eq!(error, joints.into());
    assert_eq!(
        identify::<Recording>(&scara(), &[], &[], &options(), &()).unwrap_err(),
        IdentifyError::NoLogs
    );
}

#[test]
fn log_in_which_nothing_moves_is_an_error_that_says_what_was_seen() {
    let mut still = motion("still.csv", 0.0, 3000);
    // One joint constant; the other flickers by its encoder's last digit.
    still.q[0].fill(0.7);
    still.q[1] = (0..3000)
        .map(|i| 1e-3 * f64::from((i * 7 + i * i * 3) % 3))
        .collect();
    still.tau = Some(vec![vec![3.0; 3000]; 2]);
    for options in [options(), Options::default()] {
        let error = identify(&scara(), &[still.clone()], &[], &options, &()).unwrap_err();
        let text = error.to_string();
        assert!(text.starts_with("no joint moves in still.csv"), "{text}");
        assert!(
            text.contains("q1 constant; q2 within 2.0e-3, 2 encoder steps"),
            "{text}"
        );
        assert!(
            text.contains("every joint moves through a good part"),
            "{text}"
        );
    }
}

#[test]
fn noise_of_sensors_is_no_motion() {
    let mut still = motion("still.csv", 0.0, 3000);
    let mut state = 1u32;
    let mut noise = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        1e-3 * (f64::from(state) / f64::from(u32::MAX) - 0.5)
    };
    still.q = vec![
        (0..3000).map(|_| noise()).collect(),
        (0..3000).map(|_| noise()).collect(),
    ];
    still.tau = Some(vec![vec![3.0; 3000]; 2]);
    let error = identify(&scara(), &[still], &[], &options(), &()).unwrap_err();
    assert!(
        matches!(error, IdentifyError::NothingMoves { .. }),
        "{error}"
    );
}

/// A log without end: the same samples again and again.
struct Endless(Recording);

impl Samples for Endless {
    fn name(&self) -> &str {
        &self.0.name
    }

    fn rate_hz(&self) -> f64 {
        self.0.rate_hz
    }

    fn len(&self) -> usize {
        1_000_000_000
    }

    fn doubtful(&self) -> &[Range<usize>] {
        &[]
    }

    fn warnings(&self) -> &[String] {
        &[]
    }

    fn window(&self, range: Range<usize>) -> Result<Recording, LogError> {
        let start = range.start % (self.0.len / 2);
        self.0
            .window(start..start + range.len().min(self.0.len / 2))
    }
}

#[test]
fn a_log_too_long_to_weight_row_by_row_is_refused() {
    let log = Endless(with_torque(&scara(), motion("endless.csv", 0.0, 80_000)));
    let mut choices = options();
    choices.weights = Some(Weights::Robust);
    let error = identify(&scara(), &[log], &[], &choices, &()).unwrap_err();
    assert!(
        matches!(
            &error,
            IdentifyError::TooLongForRobust {
                samples: 1_000_000_000,
                ..
            }
        ),
        "{error}"
    );
    assert!(error.to_string().contains("--weights joint"));
}
