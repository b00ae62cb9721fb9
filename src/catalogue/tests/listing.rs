//! What the catalogue lists: names, hypotheses, the guide.

use std::collections::HashSet;

use idim_runtime::diagnose::{Catalogue, EntryKind};

use super::arm::{Course, PLAIN};
use crate::catalogue::{Effects, entries, guide};

#[test]
fn every_entry_is_asked_for_and_gives_finite_columns_of_the_motion() {
    let robot = PLAIN.robot();
    let course = Course::of(&robot);
    let effects = Effects::new(&robot);
    let along = effects.along(course.signals());
    let all = effects.hypotheses(&course.signals());
    let asked: HashSet<usize> = all.iter().map(|hypothesis| hypothesis.entry).collect();
    assert_eq!(asked.len(), entries().len());
    for hypothesis in &all {
        let entry = &effects.entries()[hypothesis.entry];
        assert_eq!(hypothesis.bounds.len(), entry.shape.len(), "{}", entry.name);
        for shape in &hypothesis.grid {
            assert_eq!(shape.len(), entry.shape.len(), "{}", entry.name);
            for (value, bounds) in shape.iter().zip(&hypothesis.bounds) {
                let inside = bounds.start <= *value && *value <= bounds.end;
                assert!(inside, "{}: {value} in {bounds:?}", entry.name);
            }
            let columns = along(hypothesis, shape);
            assert!(!columns.is_empty(), "{}", entry.name);
            assert!(columns.len() <= entry.parameters.len(), "{}", entry.name);
            for (joint, torque) in columns.iter().flat_map(|column| &column.torque) {
                let finite = torque.iter().all(|tau| tau.is_finite());
                assert!(
                    *joint < 4 && torque.len() == course.t.len() && finite,
                    "{}",
                    entry.name
                );
            }
        }
    }
}

#[test]
fn joints_that_rest_are_not_asked_for() {
    let robot = PLAIN.robot();
    let mut course = Course::of(&robot);
    for series in [&mut course.qd[2], &mut course.qdd[2]] {
        series.fill(0.0);
    }
    let effects = Effects::new(&robot);
    let all = effects.hypotheses(&course.signals());
    let length = |entry: usize| effects.entries()[entry].name == "link_length";
    assert!(
        all.iter()
            .all(|h| length(h.entry) || !h.joints.contains(&2))
    );
}

#[test]
fn impossible_signs_are_refused_with_a_reason() {
    let effects = Effects::new(&PLAIN.robot());
    let course = Course::of(&PLAIN.robot());
    let all = effects.hypotheses(&course.signals());
    let refused = |name: &str, value: f64| {
        let of_name = |h: &&_| {
            let h: &idim_runtime::diagnose::Hypothesis = h;
            effects.entries()[h.entry].name == name
        };
        let hypothesis = all.iter().find(of_name).unwrap();
        effects
            .implausible(hypothesis, &hypothesis.grid[0], &[value])
            .is_some()
    };
    for name in [
        "stribeck",
        "load_dependent_friction",
        "joint_elasticity",
        "backlash",
        "presliding",
        "end_stop",
    ] {
        assert!(refused(name, -0.01) && !refused(name, 0.01), "{name}");
    }
    assert!(!refused("torque_offset", -3.0) && !refused("viscous_asymmetry", -3.0));
}

#[test]
fn references_between_entries_are_to_entries() {
    let names: Vec<&str> = entries().iter().map(|entry| entry.name).collect();
    for entry in entries() {
        for other in entry.confused_with {
            assert!(
                names.contains(other) && *other != entry.name,
                "{}: {other}",
                entry.name
            );
        }
    }
    let of_kind = |kind| entries().iter().filter(|entry| entry.kind == kind).count();
    let counts = [
        EntryKind::Static,
        EntryKind::ModelDependent,
        EntryKind::Memory,
        EntryKind::Yielding,
    ]
    .map(of_kind);
    assert_eq!(counts, [13, 7, 2, 2]);
}

/// `docs/effects.md` is what [`guide`] writes. `IDIM_WRITE_GUIDE=1` writes it again.
#[test]
fn the_guide_in_docs_is_that_of_the_entries() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/effects.md");
    if std::env::var_os("IDIM_WRITE_GUIDE").is_some() {
        std::fs::write(path, guide()).unwrap();
    }
    let text = std::fs::read_to_string(path).unwrap();
    assert!(
        text == guide(),
        "docs/effects.md is not what the entries say"
    );
}

/// The pictures are what `cargo run --example effect_pictures` writes.
#[test]
fn every_entry_has_a_picture() {
    for entry in entries() {
        let path = format!(
            "{}/docs/effects/{}.svg",
            env!("CARGO_MANIFEST_DIR"),
            entry.name
        );
        let picture = std::fs::read_to_string(&path).unwrap();
        assert!(picture.matches("h0").count() > 500, "{path}: no marks");
        assert!(!picture.contains("NaN") && picture.len() < 20_000, "{path}");
    }
}
