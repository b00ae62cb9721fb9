//! Answers from factors are those of the rows.

use super::super::{Candidate, Cut, Evidence, Question, Weighting};
use super::{NP, ROWS, Random, assert_close, gather, numbers, part, random};
use crate::estimate::estimate;
use crate::observe::Observations;
use crate::settings::Weights;

fn all(evidence: &Evidence, weighting: Weighting) -> Question {
    Question::parameters(evidence, weighting)
}

fn known(sigma: &[Option<f64>]) -> Vec<f64> {
    sigma.iter().map(|sigma| sigma.unwrap()).collect()
}

#[test]
fn least_squares_agree_with_those_of_the_rows() {
    let observations = random(1);
    let evidence = gather(&observations, Cut::default());
    for (weighting, weights) in [
        (Weighting::Equal, Weights::None),
        (Weighting::Residual, Weights::Joint),
    ] {
        let fit = evidence.fit(&all(&evidence, weighting)).unwrap();
        let expected = estimate(&observations.blocks, NP, weights).unwrap();
        assert_close(&expected.solution, &fit.solution, 1e-10);
        assert_close(&known(&expected.sigma), &known(&fit.sigma), 1e-10);
        let (a, b) = (expected.condition, expected.condition_unweighted);
        assert_close(&[a, b], &[fit.condition, fit.condition_unweighted], 1e-8);
        assert_eq!((expected.rows, expected.rank), (fit.rows, fit.rank));
        if !expected.joint_sigma.is_empty() {
            assert_close(&expected.joint_sigma, &fit.joint_sigma, 1e-10);
        }
    }
}

/// The equations without some columns.
fn without(observations: &Observations, dropped: &[usize]) -> Observations {
    let mut less = observations.clone();
    for block in &mut less.blocks {
        let kept: Vec<usize> = (0..block.columns.len())
            .filter(|k| !dropped.contains(&block.columns[*k]))
            .collect();
        block.w = kept
            .iter()
            .flat_map(|k| block.column(*k).to_vec())
            .collect();
        block.columns = kept.iter().map(|k| block.columns[*k]).collect();
    }
    less
}

#[test]
fn subset_agrees_with_equations_that_have_only_it() {
    let observations = random(2);
    let evidence = gather(&observations, Cut::Rows(17));
    let question = all(&evidence, Weighting::Residual).without(&[1, 4]);
    let fit = evidence.fit(&question).unwrap();
    let less = without(&observations, &[1, 4]);
    let expected = estimate(&less.blocks, NP, Weights::Joint).unwrap();
    assert_close(&expected.solution, &fit.solution, 1e-10);
    for column in question.columns {
        assert_close(
            &[expected.sigma[column].unwrap()],
            &[fit.sigma[column].unwrap()],
            1e-10,
        );
    }
}

#[test]
fn candidate_is_one_more_column() {
    let mut observations = random(3);
    let extra = Random(99).series(ROWS);
    for block in &mut observations.blocks[..2] {
        block
            .y
            .as_mut()
            .unwrap()
            .iter_mut()
            .zip(&extra)
            .for_each(|(y, e)| *y += 0.5 * e);
    }
    let signals = vec![(0, extra.as_slice()), (1, extra.as_slice())];
    let candidates = [Candidate {
        name: "FX".to_owned(),
        signals,
    }];
    let robot = numbers("arm", NP, 3);
    let cut = Cut::default();
    let evidence = Evidence::from_observations(&robot, &observations, &candidates, cut).unwrap();
    let plain = all(&evidence, Weighting::Residual);
    let fit = evidence.fit(&plain.with(&[NP])).unwrap();
    assert!((fit.solution[NP] - 0.5).abs() < 4.0 * fit.sigma[NP].unwrap());
    let test = evidence.drop_test(&fit, &[NP]).unwrap().unwrap();
    assert_eq!(test.above, 1.0);
    assert!(test.p_value < 1e-6);
    // One column: F is the square of t.
    assert_close(
        &[(fit.solution[NP] / fit.sigma[NP].unwrap()).powi(2)],
        &[test.statistic],
        1e-8,
    );
    assert!(evidence.fit(&plain).unwrap().residual_square > fit.residual_square);
}

#[test]
fn merged_halves_are_the_whole() {
    let observations = random(4);
    let whole = gather(&observations, Cut::Rows(40));
    for at in [160, 201] {
        let mut halves = gather(&part(&observations, 0..at), Cut::Rows(40));
        halves
            .merge(&gather(&part(&observations, at..ROWS), Cut::Rows(40)))
            .unwrap();
        let fit = |evidence: &Evidence| evidence.fit(&all(evidence, Weighting::Residual)).unwrap();
        let (a, b) = (fit(&whole), fit(&halves));
        assert_close(&a.solution, &b.solution, 1e-12);
        assert_close(&known(&a.sigma), &known(&b.sigma), 1e-12);
        assert_eq!(halves.rows(), 3 * ROWS);
        for (a, b) in whole.totals().iter().zip(&halves.totals()) {
            assert_close(a.packed(), b.packed(), 1e-12);
        }
    }
}

#[test]
fn coarser_blocks_change_no_estimate() {
    let evidence = gather(&random(5), Cut::default());
    let coarse = evidence.coarsened(7);
    assert_eq!((coarse.blocks(), coarse.rows()), (7, evidence.rows()));
    let fit = |evidence: &Evidence| evidence.fit(&all(evidence, Weighting::Residual)).unwrap();
    assert_close(&fit(&evidence).solution, &fit(&coarse).solution, 1e-12);
}

#[test]
fn residual_squares_by_block_are_those_of_the_rows() {
    let observations = random(6);
    let evidence = gather(&observations, Cut::Blocks(5));
    let x: Vec<f64> = (0..NP).map(|k| k as f64 - 2.0).collect();
    let squares = evidence.residual_squares(&x);
    for (block, range) in Cut::Blocks(5).ranges(ROWS).into_iter().enumerate() {
        for (joint, equations) in part(&observations, range).blocks.iter().enumerate() {
            let expected: f64 = equations.residual(&x).iter().map(|r| r * r).sum();
            assert_close(&[expected], &[squares[block][joint]], 1e-12);
        }
    }
}

#[test]
fn cross_validation_agrees_with_explicit_refits() {
    let observations = random(7);
    let evidence = gather(&observations, Cut::Rows(20));
    let cross = evidence
        .cross_validate(&all(&evidence, Weighting::Residual), 4)
        .unwrap();
    let blocks = Cut::Rows(20).ranges(ROWS);
    let mut squares = [0.0; 3];
    for (fold, held) in cross.folds.iter().zip(Cut::Blocks(4).ranges(blocks.len())) {
        let rows = blocks[held.start].start..blocks[held.end - 1].end;
        let mut rest = part(&observations, 0..rows.start);
        rest.append(&part(&observations, rows.end..ROWS));
        let expected = estimate(&rest.blocks, NP, Weights::Joint).unwrap();
        assert_close(&expected.solution, &fold.solution, 1e-10);
        for (joint, equations) in part(&observations, rows).blocks.iter().enumerate() {
            let residual = equations.residual(&expected.solution);
            squares[joint] += residual.iter().map(|r| r * r).sum::<f64>();
        }
    }
    let expected = squares.map(|square| (square / ROWS as f64).sqrt());
    assert_close(&expected, &cross.joint_rms, 1e-10);
}

#[test]
fn dependent_and_unseen_columns_are_named() {
    let mut observations = random(8);
    for block in &mut observations.blocks {
        let rows = block.rows;
        let at = |c: usize| block.columns.iter().position(|k| *k == c);
        let (five, six) = (at(5).unwrap(), at(6).unwrap());
        let copy: Vec<f64> = block.column(five).iter().map(|x| -3.0 * x).collect();
        let zero = at(1);
        block.w[six * rows..(six + 1) * rows].copy_from_slice(&copy);
        if let Some(zero) = zero {
            block.w[zero * rows..(zero + 1) * rows].fill(0.0);
        }
    }
    let evidence = gather(&observations, Cut::default());
    let fit = evidence.fit(&all(&evidence, Weighting::Residual)).unwrap();
    let expected = estimate(&observations.blocks, NP, Weights::Joint).unwrap();
    assert_eq!(
        (&fit.unseen, &fit.dependent),
        (&expected.unseen, &expected.dependent)
    );
    assert_eq!(fit.dependent[0].columns, [5, 6]);
    assert_eq!(fit.determined, expected.determined);
    assert_eq!(fit.rank, NP - 2);
    let corrected = evidence.corrected(&fit).unwrap();
    let sure: Vec<bool> = corrected.sigma.iter().map(Option::is_some).collect();
    assert_eq!(sure, fit.determined);
}

#[test]
fn answers_do_not_depend_on_the_number_of_threads() {
    let observations = random(9);
    let answers = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let evidence = gather(&observations, Cut::default());
            let fit = evidence.fit(&all(&evidence, Weighting::Residual)).unwrap();
            let corrected = evidence.corrected(&fit).unwrap();
            let bootstrap = evidence.bootstrap(&fit, &Default::default()).unwrap();
            (evidence.to_bytes(), fit.solution, corrected, bootstrap)
        })
    };
    assert!(answers(1) == answers(3));
}

#[test]
fn cuts_cover_all_rows_once() {
    for rows in [0, 1, 5, 31, 32, 33, 1000] {
        for cut in [
            Cut::Rows(0),
            Cut::Rows(10),
            Cut::Rows(usize::MAX),
            Cut::Blocks(0),
            Cut::default(),
        ] {
            let ranges = cut.ranges(rows);
            assert!(ranges.iter().all(|range| !range.is_empty()));
            assert_eq!(
                ranges.into_iter().flatten().collect::<Vec<_>>(),
                Vec::from_iter(0..rows)
            );
        }
    }
}
