//! What cannot be gathered or answered is an error that says why.

use super::super::{Cut, Evidence, EvidenceError, Question, Weighting};
use super::{NP, ROWS, gather, numbers, part, random};
use crate::estimate::EstimateError;
use crate::observe::Observations;

#[test]
fn impossible_questions_are_errors() {
    let observations = random(10);
    let evidence = gather(&observations, Cut::Blocks(3));
    let question = Question::parameters(&evidence, Weighting::Equal);
    let fit = evidence.fit(&question).unwrap();
    let wrong = |question: &Question| evidence.fit(question).unwrap_err();
    assert!(matches!(
        wrong(&question.with(&[NP])),
        EvidenceError::NoSuchColumn { .. }
    ));
    let given = |levels: &[f64]| Question::parameters(&evidence, Weighting::Given(levels.to_vec()));
    assert!(matches!(
        wrong(&given(&[1.0])),
        EvidenceError::Weights { joint: 2 }
    ));
    assert!(matches!(
        wrong(&given(&[1.0, 2.0, 0.0])),
        EvidenceError::Weights { joint: 3 }
    ));
    assert!(matches!(
        evidence.corrected(&fit),
        Err(EvidenceError::TooFewBlocks { .. })
    ));
    assert!(evidence.cross_validate(&question, 4).is_err());
    assert!(evidence.select(&[3]).is_err());
    let nothing = evidence.select(&[]).unwrap().fit(&question);
    assert!(matches!(
        nothing,
        Err(EvidenceError::Estimate(EstimateError::NothingMoves))
    ));
    let short = gather(&part(&observations, 0..2), Cut::default())
        .fit(&question)
        .unwrap_err();
    let expected = EstimateError::TooFewEquations {
        rows: 6,
        parameters: NP,
    };
    assert!(matches!(short, EvidenceError::Estimate(error) if error == expected));
}

#[test]
fn useless_equations_are_errors() {
    let robot = numbers("arm", NP, 3);
    let gather = |observations: &Observations| {
        Evidence::from_observations(&robot, observations, &[], Cut::default()).unwrap_err()
    };
    let mut without = random(11);
    without.blocks[1].y = None;
    let error = EstimateError::NoMeasurements { block: 2 };
    assert!(matches!(gather(&without), EvidenceError::Estimate(e) if e == error));
    let mut strange = random(11);
    strange.blocks[2].w[ROWS + 5] = f64::NAN;
    let error = EstimateError::NotFinite {
        what: "the regressor",
        block: 3,
        row: 5,
    };
    assert!(matches!(gather(&strange), EvidenceError::Estimate(e) if e == error));
    let mut unequal = random(11);
    unequal.blocks[1] = part(&unequal, 0..50).blocks[1].clone();
    assert!(matches!(
        gather(&unequal),
        EvidenceError::Shape { found: 50, .. }
    ));
}
