//! A small fixed part of the cases that the diagnosis is measured on: clear ones are named, and
//! where nothing is hidden nothing is said.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

#[path = "../examples/hidden_effects/cases/mod.rs"]
#[allow(dead_code, reason = "the example uses the rest")]
mod cases;

use cases::draw::draw;
use cases::score::Scored;
use cases::truth::Category;
use cases::{answer, files, table};
use idim::runtime::report::Verdict;

/// Draws a case, writes it, has it diagnosed from its files.
fn diagnosed(seed: u64, number: usize, only: &str) -> Scored {
    let folder = tempfile::tempdir().unwrap();
    let case = draw(seed, number, Some(only)).unwrap();
    files::write(folder.path(), &case).unwrap();
    let [truth] = files::truths(folder.path()).unwrap().try_into().unwrap();
    let answer = answer::answer(&folder.path().join("cases").join(&truth.case)).unwrap();
    Scored { truth, answer }
}

fn assert_named(seed: u64, number: usize, name: &str) {
    let case = diagnosed(seed, number, name);
    assert!(case.right(), "{}", table::line(&case));
    assert_eq!(case.joints(), [true], "{}", table::line(&case));
}

#[test]
fn nothing_is_said_of_robots_that_are_as_described() {
    let case = diagnosed(6, 7, "nothing");
    assert_eq!(case.truth.category, Category::Nothing);
    assert_eq!(
        case.answer.verdict,
        Verdict::Nothing,
        "{}",
        table::line(&case)
    );
}

#[test]
fn clear_ripple_is_named() {
    assert_named(21, 0, "torque_ripple");
}

#[test]
fn clear_offset_is_named() {
    assert_named(23, 1, "torque_offset");
}

#[test]
fn clear_tilt_of_the_base_is_named() {
    assert_named(23, 2, "base_tilt");
}

#[test]
fn clear_excess_of_friction_near_rest_is_named() {
    assert_named(21, 3, "stribeck");
}

#[test]
fn faint_curve_of_friction_is_named_where_two_motions_agree() {
    // 6.6 standard deviations, too little on the training log alone.
    let case = diagnosed(402, 39, "one");
    assert!(case.right(), "{}", table::line(&case));
}

#[test]
fn friction_that_comes_and_goes_is_not_passed_over() {
    let case = diagnosed(403, 14, "outside");
    assert_eq!(
        case.answer.verdict,
        Verdict::Unknown,
        "{}",
        table::line(&case)
    );
}

#[test]
fn case_is_the_same_for_the_same_seed() {
    let [one, other] = [0, 1].map(|_| draw(6, 7, Some("nothing")).unwrap());
    assert_eq!(
        (&one.train.q, &one.train.tau),
        (&other.train.q, &other.train.tau)
    );
    assert_ne!(
        one.train.tau,
        draw(7, 7, Some("nothing")).unwrap().train.tau
    );
}
