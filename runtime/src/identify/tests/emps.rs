//! EMPS: every digit that Janot, Gautier and Brunot (2019) printed.

use super::hand_written::emps;
use super::reading::recording;
use crate::identify::{Options, identify, predict};
use crate::observe::ModelKind;
use crate::report::Identification;
use crate::settings::{Edges, Settings};

const TRAIN: &str = "data/real/emps/log_train.csv.gz";
const VALID: &str = "data/real/emps/log_valid_pulses.csv.gz";

/// The published script's choices, as a robot's settings.
fn settings() -> Settings {
    Settings {
        fq_hz: Some(100.0),
        order: Some(4),
        nd: Some(10),
        trim: Some(0),
        border: Some((49, 0)),
        edges: Some(Edges::Matlab),
        ..Settings::default()
    }
}

fn identified() -> Option<Identification> {
    let (train, valid) = (recording(TRAIN, 1, 1000.0)?, recording(VALID, 1, 1000.0)?);
    let mut model = emps();
    model.settings = settings();
    Some(identify(&model, &[train], &[valid], &Options::default(), &()).unwrap())
}

#[test]
fn emps_reproduces_every_published_digit() {
    let Some(found) = identified() else { return };
    let explicit = found.model(ModelKind::Explicit).unwrap();
    assert_eq!(explicit.rows, 2480);
    assert_eq!(explicit.rank, 4);
    assert_eq!(format!("{:.4}", explicit.condition), "25.9883");
    assert_eq!(format!("{:.4}", explicit.fit.total_pct), "4.0834");
    assert_eq!(
        format!("{:.4}", explicit.validation[0].fit.total_pct),
        "5.9824"
    );
    let published = [
        ("M1", "95.1089", "0.1085", "0.1141"),
        ("FV1", "203.5034", "1.1460", "0.5631"),
        ("FS1", "20.3935", "0.1012", "0.4964"),
        ("OFF1", "-3.1648", "0.0444", "1.4021"),
    ];
    for (name, value, sigma, pct) in published {
        let parameter = explicit.parameter(name).unwrap();
        assert_eq!(format!("{:.4}", parameter.value.unwrap()), value);
        // The script divides the residual by r - 1; Gautier 1996, section 7.3, by r - np.
        let divisor = (2476f64 / 2479.0).sqrt();
        assert_eq!(
            format!("{:.4}", parameter.sigma.unwrap() * divisor),
            sigma,
            "{name}"
        );
        assert_eq!(
            format!("{:.4}", parameter.sigma_pct.unwrap() * divisor),
            pct,
            "{name}"
        );
    }
}

#[test]
fn emps_models_agree_with_each_other() {
    let Some(found) = identified() else { return };
    let mass = |kind| {
        found
            .model(kind)
            .unwrap()
            .parameter("M1")
            .unwrap()
            .value
            .unwrap()
    };
    let explicit = mass(ModelKind::Explicit);
    for kind in [ModelKind::Implicit, ModelKind::Power] {
        assert!(
            (mass(kind) / explicit - 1.0).abs() < 0.01,
            "{kind:?}: {}",
            mass(kind)
        );
    }
}

#[test]
fn emps_prediction_has_the_error_of_the_baseline() {
    let Some(found) = identified() else { return };
    let Some(valid) = recording(VALID, 1, 1000.0) else {
        return;
    };
    let x = found.model(ModelKind::Explicit).unwrap().solution();
    let predicted = predict(&emps(), &valid, &x, &found.filter, ModelKind::Explicit).unwrap();
    let implicit = predict(&emps(), &valid, &x, &found.filter, ModelKind::Implicit).unwrap();
    let tau = &valid.tau.as_ref().unwrap()[0];
    assert_eq!(predicted[0].len(), tau.len());
    let norm = |x: &mut dyn Iterator<Item = f64>| x.map(|x| x * x).sum::<f64>().sqrt();
    // baseline.json, raw_full_rate.valid_rmse, over the samples after the border of 49.
    let kept = tau[49..]
        .iter()
        .zip(&predicted[0][49..])
        .map(|(a, b)| a - b);
    let rmse = norm(&mut kept.clone()) / (kept.len() as f64).sqrt();
    assert!((rmse - 7.274_915).abs() < 1e-5, "{rmse}");
    let between = predicted[0].iter().zip(&implicit[0]).map(|(a, b)| a - b);
    assert!(norm(&mut between.clone()) < 1e-9 * norm(&mut tau.iter().copied()));
}
