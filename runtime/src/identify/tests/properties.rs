//! Identities that hold for any robot and log, and the failures that have a name.

use std::f64::consts::TAU;

use super::hand_written::{HandWritten, scara};
use crate::estimate::EstimateError;
use crate::identify::{IdentifyError, Options, identify, predict};
use crate::log::Recording;
use crate::model::{IdentificationModel, Output, States};
use crate::observe::{ModelKind, Motion, ObserveError, observe};
use crate::report::{Identification, terminal};
use crate::settings::{Edges, Weights};

const X: [f64; 8] = [3.5, 0.05, 0.5, 0.06, 0.12, 0.005, 0.01, 0.1];

fn options() -> Options {
    Options {
        fq_hz: Some(20.0),
        nd: Some(5),
        trim: Some(100),
        edges: Some(Edges::Scipy),
        weights: Some(Weights::None),
        ..Options::default()
    }
}

/// A motion of several sines per joint, without torque.
fn motion(name: &str, seed: f64, len: usize) -> Recording {
    let rate_hz = 200.0;
    let joint = |j: usize| -> Vec<f64> {
        let wave = |i: usize, k: f64| {
            let phase = seed + k * 1.7 + j as f64;
            ((0.2 + 0.13 * k + 0.05 * j as f64) * TAU * i as f64 / rate_hz + phase).sin()
        };
        (0..len)
            .map(|i| (1..5).map(|k| 0.5 * wave(i, f64::from(k))).sum())
            .collect()
    };
    Recording {
        name: name.to_owned(),
        stem: name.to_owned(),
        rate_hz,
        start: 0.0,
        len,
        q: vec![joint(0), joint(1)],
        qd: None,
        tau: None,
        stamps: (0..len).map(|i| i as f64 / rate_hz).collect(),
        warnings: Vec::new(),
    }
}

/// The recording with the torque that the explicit model predicts along its filtered motion, so
/// that identification has nothing but rounding to explain.
fn with_torque(model: &HandWritten, log: Recording) -> Recording {
    let plan = options()
        .resolve(model, std::slice::from_ref(&log))
        .unwrap();
    let tau = predict(model, &log, &X, &plan.filtering, ModelKind::Explicit).unwrap();
    Recording {
        tau: Some(tau),
        ..log
    }
}

fn log(name: &str, seed: f64, len: usize) -> Recording {
    with_torque(&scara(), motion(name, seed, len))
}

fn identified(model: &HandWritten, logs: &[Recording]) -> Identification {
    identify(model, logs, &[], &options(), &()).unwrap()
}

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
            let motion = Motion::trimmed(log, 2, &plan.filtering).unwrap();
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
    let not_finite = matches!(
        error,
        IdentifyError::Estimate {
            source: EstimateError::NotFinite { block: 1, .. },
            ..
        }
    );
    assert!(not_finite, "{error}");
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

/// Torque with a disturbance that no parameter explains.
fn disturbed(tau: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let error = |i: usize| 0.05 * (i as f64 * 0.037).sin() * (i as f64 * 0.011).cos();
    tau.iter()
        .map(|s| s.iter().enumerate().map(|(i, x)| x + error(i)).collect())
        .collect()
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
        identify(&scara(), &[], &[], &options(), &()).unwrap_err(),
        IdentifyError::NoLogs
    );
}

#[test]
fn a_long_log_in_windows_gives_what_it_gives_at_once() {
    let model = scara();
    let long = motion("long", 0.0, 60_000);
    let plan = options()
        .resolve(&model, std::slice::from_ref(&long))
        .unwrap();
    let motion = Motion::trimmed(&long, 2, &plan.filtering).unwrap();
    for kind in ModelKind::ALL {
        let rows = observe(&model, kind, &motion, &plan.filtering).unwrap();
        for &(output, treatment) in kind.terms() {
            let whole = at_once(&model, output, treatment, &motion);
            for entry in model.pattern(output).entries.iter() {
                if shares_column(kind, &model, entry.row, entry.column) {
                    continue;
                }
                let block = &rows.blocks[entry.row];
                let k = block.columns.binary_search(&entry.column).unwrap();
                for (a, b) in block.column(k).iter().zip(&whole[entry.signal]) {
                    assert!(
                        (a - b).abs() < 1e-11 * b.abs().max(1.0),
                        "{output:?}: {a} against {b}"
                    );
                }
            }
        }
    }
}

/// Whether two terms of a model add to the same column.
fn shares_column(kind: ModelKind, model: &HandWritten, row: usize, column: usize) -> bool {
    let has = |output| {
        let entries = model.pattern(output).entries.iter();
        entries
            .filter(|e| (e.row, e.column) == (row, column))
            .count()
    };
    kind.terms().iter().map(|term| has(term.0)).sum::<usize>() > 1
}

/// The decimated signals of an output, filtered over the whole motion.
fn at_once(
    model: &HandWritten,
    output: Output,
    treatment: crate::observe::Treatment,
    motion: &Motion,
) -> Vec<Vec<f64>> {
    let flat = |series: &[Vec<f64>]| series.concat();
    let (q, qd, qdd) = (flat(&motion.q), flat(&motion.qd), flat(&motion.qdd));
    let states = States {
        len: motion.len,
        q: &q,
        qd: &qd,
        qdd: &qdd,
    };
    let mut signals = vec![0.0; model.pattern(output).signals * motion.len];
    model.evaluate(output, &states, &mut signals);
    let series: Vec<Vec<f64>> = signals.chunks(motion.len).map(<[f64]>::to_vec).collect();
    let decimator = crate::signal::Decimator::new(5, motion.rate_hz, Edges::Scipy).unwrap();
    let kept = decimator.kept(motion.len);
    match treatment {
        crate::observe::Treatment::Value => decimator.values(series.as_slice(), &kept).unwrap(),
        crate::observe::Treatment::Rate => decimator.rates(series.as_slice(), &kept).unwrap(),
    }
}

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

#[test]
fn the_json_has_the_shape_of_the_contract() {
    let found = identify(
        &scara(),
        &[log("a", 0.0, 3000)],
        &[log("b", 1.0, 3000)],
        &options(),
        &(),
    )
    .unwrap();
    let json = serde_json::to_value(&found).unwrap();
    assert_eq!(json["robot"], "hand-written");
    assert_eq!(json["samples"], 3000);
    assert_eq!(json["rate_hz"], 200.0);
    for (key, value) in [
        ("fq_hz", 20.0),
        ("order", 4.0),
        ("nd", 5.0),
        ("trim", 100.0),
    ] {
        assert_eq!(json["filter"][key].as_f64(), Some(value));
    }
    let names: Vec<_> = found.models.iter().map(|m| m.name.name()).collect();
    assert_eq!(names, ["explicit", "implicit", "power"]);
    let model = &json["models"][2];
    assert_eq!(model["name"], "power");
    assert!(model["rows"].is_u64() && model["rank"].is_u64() && model["condition"].is_f64());
    let parameter = &model["parameters"][0];
    for key in ["value", "sigma", "sigma_pct"] {
        assert!(parameter[key].is_f64(), "{key}");
    }
    assert!(parameter["sigma_corrected"].is_null());
    assert_eq!(parameter["joint"], 1);
    for key in ["name", "unit", "relation"] {
        assert!(parameter[key].is_string());
    }
    for fit in [&model["fit"], &model["validation"][0]] {
        assert!(fit["total_pct"].is_f64());
        assert_eq!(fit["joints"][1]["name"], "elbow");
        assert!(fit["joints"][1]["rmse"].is_f64() && fit["joints"][1]["rel_pct"].is_f64());
    }
    assert_eq!(model["validation"][0]["log"], "b");
}
