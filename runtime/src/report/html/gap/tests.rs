//! The page of a diagnosis, as a browser and as a person read it.

use std::collections::BTreeMap;

use super::diagnosis_html;
use crate::observe::Filtering;
use crate::report::{
    Alternative, Change, Diagnosis, EffectParameter, Estimated, Fit, FoundEffect, Gap, GapCurves,
    JointFit, Located, Pictures, RankedEffect, Refitted, RejectedEffect, Signature, Verdict,
};
use crate::settings::{Derivatives, Edges, Velocity};

fn fit(scale: f64) -> Fit {
    let joint = |name: &str, rel_pct: f64| JointFit {
        name: name.into(),
        unit: "N m",
        rmse: 0.1 * rel_pct,
        rel_pct: scale * rel_pct,
    };
    Fit {
        total_pct: 3.0 * scale,
        joints: vec![joint("shoulder", 2.0), joint("elbow", 4.0)],
    }
}

fn wave(count: usize, size: f32) -> Vec<f32> {
    (0..count).map(|i| size * (i as f32 * 0.1).sin()).collect()
}

fn found() -> FoundEffect {
    FoundEffect {
        effect: "stribeck".into(),
        joint: Some("elbow".into()),
        joints: vec![2],
        meaning: "friction near rest in excess of Coulomb's".into(),
        formula: "FST sgn(qd) exp(-(qd/velocity)^2)".into(),
        parameters: vec![EffectParameter {
            name: "FST2".into(),
            unit: "N m".into(),
            value: 1.204,
            sigma: Some(0.03),
        }],
        shape: BTreeMap::from([("velocity".to_owned(), 0.08)]),
        p_value: 1e-40,
        gain_pct: 25.0,
        alternatives: vec![Alternative {
            effect: "presliding".into(),
            joint: Some("elbow".into()),
            joints: vec![2],
            p_value: 1e-30,
            separable: false,
        }],
        experiment: "slow passes at constant speed in both directions".into(),
    }
}

fn pictures() -> Pictures {
    let double = |size: f32| wave(400, size).into_iter().map(f64::from).collect();
    let curves = |joint: &str| GapCurves {
        joint: joint.into(),
        unit: "N m".into(),
        t: (0..400).map(|i| f64::from(i) * 0.01).collect(),
        measured: double(5.0),
        before: double(4.5),
        after: double(4.9),
    };
    Pictures {
        signatures: vec![Signature {
            effect: Some(0),
            joint: "elbow".into(),
            unit: "N m".into(),
            variable: "velocity of elbow".into(),
            variable_unit: "rad/s".into(),
            x: wave(600, 1.5),
            before: wave(600, 0.6),
            after: wave(600, 0.1),
        }],
        torque: vec![curves("shoulder"), curves("elbow")],
        motion: vec![curves("shoulder"), curves("elbow")],
    }
}

fn ranked(step: usize, effect: &str, gain: f64, margin: f64) -> RankedEffect {
    RankedEffect {
        step,
        effect: effect.into(),
        joint: Some("elbow".into()),
        joints: vec![2],
        gain,
        margin,
        p_value: (-gain).exp(),
    }
}

/// A diagnosis with everything a page can show.
fn diagnosed() -> Diagnosis {
    let estimated = |value: f64, sigma: f64| Estimated {
        value,
        sigma: Some(sigma),
    };
    Diagnosis {
        robot: "arm".into(),
        logs: vec!["logs/train.csv".into()],
        validation: vec!["logs/valid.csv".into()],
        filter: Filtering {
            fq_hz: 50.0,
            order: 4,
            nd: 10,
            trim: 0,
            border: (0, 0),
            edges: Edges::Scipy,
            derivatives: Derivatives::Central,
            velocity: Velocity::Derived,
            prefilter_torque: false,
            chosen: vec![],
        },
        verdict: Verdict::Named,
        effects: vec![found()],
        ranking: vec![
            ranked(0, "stribeck", 800.0, 780.0),
            ranked(0, "presliding", 500.0, 480.0),
            ranked(1, "torque_ripple", 9.0, -20.0),
        ],
        rejected: vec![RejectedEffect {
            effect: "end_stop".into(),
            joint: Some("elbow".into()),
            joints: vec![2],
            why: "its stiffness is negative".into(),
        }],
        smooths: Vec::new(),
        located: vec![Located {
            joint: "elbow".into(),
            unexplained_pct: 93.0,
            varies_with: vec!["velocity".into()],
        }],
        gap: Gap {
            torque: Change {
                before: fit(1.0),
                after: fit(0.5),
            },
            simulation: None,
            on: "second half of logs/valid.csv".into(),
        },
        parameters: vec![
            Refitted {
                name: "FS2".into(),
                unit: "N m".into(),
                before: estimated(2.5, 0.02),
                after: estimated(2.0, 0.02),
            },
            Refitted {
                name: "ZZ2".into(),
                unit: "kg m^2".into(),
                before: estimated(0.6, 0.01),
                after: estimated(0.601, 0.01),
            },
        ],
        changed: None,
        warnings: vec![],
        command: Some("idim diagnose arm.toml train.csv --html page.html".into()),
        pictures: Some(pictures()),
    }
}

/// The page without its first line, which is no XML.
fn document(page: &str) -> roxmltree::Document<'_> {
    let (first, rest) = page.split_once('\n').unwrap();
    assert_eq!(first, "<!DOCTYPE html>");
    roxmltree::Document::parse(rest).unwrap()
}

fn marks(page: &str, class: &str) -> usize {
    let document = document(page);
    let of_class = |node: &roxmltree::Node<'_, '_>| node.attribute("class") == Some(class);
    document.descendants().filter(of_class).count()
}

#[test]
fn the_page_says_what_was_found_where_and_how_sure() {
    let page = diagnosis_html(&diagnosed());
    for piece in [
        "<title>arm: stribeck on joint 2 (elbow)</title>",
        "falls from 3.00 % to 1.50 %, on data that were not used to find it",
        "On second half of valid.csv",
        "1.204 \u{b1} 0.060",
        "presliding on joint 2 (elbow): these logs do not tell it apart",
        "slow passes at constant speed",
        "its stiffness is negative",
        "move by more than 3 \u{3c3}: FS2",
        "idim diagnose arm.toml train.csv --html page.html --write found.toml",
    ] {
        assert!(page.contains(piece), "{piece}");
    }
}

#[test]
fn every_drawing_has_its_marks() {
    let page = diagnosis_html(&diagnosed());
    assert_eq!(marks(&page, "dots before"), 1);
    assert_eq!(marks(&page, "dots after"), 1);
    // Torque and position of two joints.
    for class in ["curve measured", "curve before", "curve after"] {
        // One more is the key beside the switch of each section.
        assert_eq!(marks(&page, class), 2 * 2 + 2, "{class}");
    }
    assert_eq!(marks(&page, "curve after residual"), 4);
    assert_eq!(marks(&page, "whisker after"), 2);
    // Two joints and all of them; and where the gap is.
    assert_eq!(marks(&page, "bar before"), 3 + 1);
    // Three more bars after; the one that was taken.
    assert_eq!(marks(&page, "bar held"), 3 + 1);
    assert_eq!(marks(&page, "bar chance"), 1);
    assert!(!page.contains("NaN"));
}

#[test]
fn the_page_asks_nobody_for_anything_and_is_the_same_every_time() {
    let page = diagnosis_html(&diagnosed());
    for piece in [
        "http:", "https:", "src=", "url(", "@import", "<link", "fetch(",
    ] {
        assert!(!page.contains(piece), "{piece}");
    }
    assert_eq!(page, diagnosis_html(&diagnosed()));
}

#[test]
fn other_verdicts_are_said_as_they_are() {
    let mut nothing = diagnosed();
    nothing.verdict = Verdict::Nothing;
    nothing.effects.clear();
    nothing.located.clear();
    nothing.pictures = None;
    let page = diagnosis_html(&nothing);
    assert!(page.contains("nothing is missing that these logs could show"));
    assert!(page.contains("At no joint does the residual hold more than noise"));
    assert!(!page.contains("What was found") && !page.contains("--write"));
    let mut unknown = diagnosed();
    unknown.verdict = Verdict::Unknown;
    unknown.effects.clear();
    for signature in unknown.pictures.iter_mut().flat_map(|p| &mut p.signatures) {
        (signature.effect, signature.after) = (None, Vec::new());
    }
    let page = diagnosis_html(&unknown);
    assert!(page.contains("something is missing that has no name"));
    assert!(page.contains("What it looks like"));
    assert_eq!(marks(&page, "dots before"), 1);
    let mut hint = diagnosed();
    hint.verdict = Verdict::Unknown;
    assert!(diagnosis_html(&hint).contains("take the name for a hint"));
    let mut hidden = diagnosed();
    hidden.gap.torque.after = fit(1.0);
    let page = diagnosis_html(&hidden);
    assert!(page.contains("the torque error stays at 3.00 %; it shows against what is known"));
    hidden.validation.clear();
    hidden.gap.torque.after = fit(0.5);
    assert!(diagnosis_html(&hidden).contains("nothing else proves it"));
}

#[test]
fn no_name_becomes_markup_and_no_number_breaks_the_page() {
    const EVIL: &str = "</title><script>alert('\"&\u{7}')</script><img onerror=x>";
    let mut evil = diagnosed();
    evil.robot = EVIL.into();
    evil.warnings = vec![EVIL.into()];
    evil.command = Some(EVIL.into());
    evil.effects[0].joint = Some(EVIL.into());
    evil.effects[0].parameters[0].sigma = None;
    evil.effects[0].p_value = 0.0;
    evil.parameters[0].after.sigma = None;
    evil.parameters[1].before.value = f64::NAN;
    evil.gap.torque.before.total_pct = f64::NAN;
    if let Some(pictures) = &mut evil.pictures {
        pictures.signatures[0].variable = EVIL.into();
        pictures.signatures[0].x.fill(f32::NAN);
        pictures.torque[0].joint = EVIL.into();
        pictures.torque[0].after.fill(f64::INFINITY);
        pictures.torque[1].t.clear();
    }
    let page = diagnosis_html(&evil);
    let document = document(&page);
    let count = |name| {
        document
            .descendants()
            .filter(|n| n.has_tag_name(name))
            .count()
    };
    assert_eq!((count("script"), count("img")), (1, 0));
    assert!(
        !page.contains("NaN") && !page.contains("inf\""),
        "no number is drawn"
    );
}
