//! Where the choices of an identification come from.

use super::hand_written::scara;
use crate::identify::Options;
use crate::log::Recording;
use crate::observe::ModelKind;
use crate::settings::{Edges, Settings, Velocity, Weights};

fn log() -> Recording {
    let wave = |phase: f64| {
        (0..4000)
            .map(|i| (f64::from(i) * 0.01 + phase).sin())
            .collect()
    };
    Recording {
        doubtful: vec![],
        name: "log".into(),
        stem: "log".into(),
        rate_hz: 100.0,
        start: 0.0,
        len: 4000,
        q: vec![wave(0.0), wave(1.0)],
        qd: None,
        tau: None,
        stamps: Vec::new(),
        warnings: Vec::new(),
    }
}

#[test]
fn an_option_overrides_the_robot_and_the_robot_overrides_the_data() {
    let mut model = scara();
    model.settings = Settings {
        fq_hz: Some(7.0),
        nd: Some(3),
        velocity: Some(Velocity::Measured),
        weights: Some(Weights::None),
        ..Settings::default()
    };
    let options = Options {
        nd: Some(4),
        models: vec![ModelKind::Power],
        ..Options::default()
    };
    let plan = options.resolve(&model, &[log()]).unwrap();
    assert_eq!((plan.filtering.fq_hz, plan.filtering.nd), (7.0, 4));
    assert_eq!(plan.filtering.velocity, Velocity::Measured);
    assert_eq!(plan.weights, Weights::None);
    assert_eq!(plan.filtering.chosen, ["trim"]);
    assert_eq!(plan.filtering.trim, 29);
    assert_eq!(plan.models, [ModelKind::Power]);
}

#[test]
fn a_trim_of_the_robot_is_not_used_with_another_edge_rule() {
    // 500 samples before decimation must not become 500 decimated rows.
    let mut model = scara();
    model.settings = Settings {
        trim: Some(500),
        fq_hz: Some(8.0),
        ..Settings::default()
    };
    let plan = Options::default().resolve(&model, &[log()]).unwrap();
    assert_eq!(plan.filtering.trim, 500);
    let options = Options {
        edges: Some(Edges::Matlab),
        nd: Some(10),
        ..Options::default()
    };
    let plan = options.resolve(&model, &[log()]).unwrap();
    assert_eq!(plan.filtering.trim, 10);
    assert_eq!(plan.filtering.chosen, ["trim"]);
}
