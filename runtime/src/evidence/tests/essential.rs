//! Backward elimination keeps what the data need.

use super::super::{Cut, EvidenceError, Question, Weighting};
use super::{NP, gather, random};

#[test]
fn parameters_that_are_zero_are_dropped_and_the_others_kept() {
    let mut observations = random(12);
    // The truth of column k is (k + 1) / scale: take columns 2 and 5 out of the measurements.
    for block in &mut observations.blocks {
        let mut part = vec![0.0; NP];
        (part[2], part[5]) = (3.0 / 0.1, 6.0 / 100.0);
        let lost = block.product(&part);
        block
            .y
            .as_mut()
            .unwrap()
            .iter_mut()
            .zip(lost)
            .for_each(|(y, lost)| *y -= lost);
    }
    let evidence = gather(&observations, Cut::default());
    let question = Question::parameters(&evidence, Weighting::Residual);
    let essential = evidence.essential(&question, 1e-3).unwrap();
    assert_eq!(essential.question.columns, [0, 1, 3, 4, 6]);
    let mut dropped: Vec<usize> = essential.dropped.iter().map(|drop| drop.column).collect();
    dropped.sort_unstable();
    assert_eq!(dropped, [2, 5]);
    assert!(essential.dropped.iter().all(|drop| drop.p_value > 1e-3));
}

#[test]
fn elimination_without_enough_blocks_is_an_error() {
    let evidence = gather(&random(13), Cut::Blocks(2));
    let question = Question::parameters(&evidence, Weighting::Residual);
    let error = evidence.essential(&question, 0.05).unwrap_err();
    assert!(matches!(error, EvidenceError::TooFewBlocks { .. }));
}
