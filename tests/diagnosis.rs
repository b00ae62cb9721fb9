//! Effects hidden in simulated logs: named where there is one, nothing where there is none.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

#[allow(dead_code, reason = "the traps use the rest")]
mod arm;

use arm::{Course, Hidden, TRAIN, VALID, names, nothing, said};
use idim::runtime::report::{Diagnosis, Verdict};

fn diagnosed(hidden: Hidden<'_>) -> Diagnosis {
    said(&[TRAIN.log(hidden)], &[VALID.log(hidden)]).unwrap()
}

/// A torque on one joint, from 0.
fn on(joint: usize, torque: fn(f64, f64) -> f64) -> impl Fn(usize, &Course) -> Vec<f64> {
    move |other, course| match other == joint {
        true => course.map(torque),
        false => nothing(other, course),
    }
}

fn assert_names(found: &Diagnosis, effect: &str, joint: usize) {
    let names = names(found);
    assert_eq!(found.verdict, Verdict::Named, "{names:?}");
    assert_eq!(names.first(), Some(&(effect, &[joint][..])), "{names:?}");
    let (before, after) = (&found.gap.torque.before, &found.gap.torque.after);
    assert!(
        after.total_pct < before.total_pct,
        "{} {}",
        before.total_pct,
        after.total_pct
    );
}

#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    let found = diagnosed(&nothing);
    assert_eq!(found.verdict, Verdict::Nothing, "{:?}", found.effects);
    assert!(found.effects.is_empty());
}

#[test]
fn a_stribeck_peak_of_the_shoulder_is_named() {
    let found = diagnosed(&on(0, |_, qd| {
        3.0 * qd.signum() * (-(qd / 0.3).powi(2)).exp()
    }));
    assert_names(&found, "stribeck", 1);
}

#[test]
fn a_ripple_of_the_elbow_is_named() {
    let found = diagnosed(&on(1, |q, _| 0.8 * (6.0 * q + 0.4).sin()));
    assert_names(&found, "torque_ripple", 2);
}

#[test]
fn an_offset_of_the_elbow_is_named() {
    assert_names(&diagnosed(&on(1, |_, _| 0.7)), "torque_offset", 2);
}
