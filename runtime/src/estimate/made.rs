//! Ill-conditioned systems with known exact answers, made from their formulas.

use super::nist::{Set, correct_digits, powers};
use super::{Double, EstimateError, estimate, refine, refined};
use crate::observe::Equations;
use crate::settings::Weights;

/// Noise of Wampler's sets 3 to 5, orthogonal to every polynomial of degree 5 on 0, 1, ..., 20.
const WAMPLER_NOISE: [f64; 21] = [
    759.0, -2048.0, 2048.0, -2048.0, 2523.0, -2048.0, 2048.0, -2048.0, 1838.0, -2048.0, 2048.0,
    -2048.0, 1838.0, -2048.0, 2048.0, -2048.0, 2523.0, -2048.0, 2048.0, -2048.0, 759.0,
];

/// Wampler (1970): y = sum of x^k for k up to 5, plus noise; every parameter is 1.
fn wampler(noise: f64) -> Set {
    let x: Vec<Double> = (0..21).map(|x| Double::from(f64::from(x))).collect();
    let columns = powers(&x, 5);
    let mut y: Vec<Double> = WAMPLER_NOISE.map(|e| Double::from(noise * e)).to_vec();
    for column in &columns {
        for (y, power) in y.iter_mut().zip(column) {
            *y = *y + *power;
        }
    }
    Set {
        columns,
        y,
        beta: vec![1.0; 6],
        sigma: Vec::new(),
    }
}

/// The equations in two blocks of which the second is in other units, and its factor.
fn in_two_blocks(set: &Set, unit: f64) -> Vec<Equations> {
    let all = set.equations();
    let part = |rows: std::ops::Range<usize>, unit: f64| Equations {
        columns: all.columns.clone(),
        rows: rows.len(),
        w: (0..all.columns.len())
            .flat_map(|k| all.column(k)[rows.clone()].to_vec())
            .map(|w| w * unit)
            .collect(),
        y: all.y.as_ref().map(|y| {
            let part = y[rows.clone()].iter();
            part.map(|y| y * unit).collect()
        }),
    };
    vec![part(0..8, 1.0), part(8..21, unit)]
}

#[test]
fn wampler_sets_have_the_digits_of_the_factorisation_and_15_when_refined() {
    for (noise, least) in [(0.0, 9.5), (1.0, 9.5), (100.0, 9.0), (1e4, 7.2)] {
        let set = wampler(noise);
        let (plain, _, certified) = set.plain();
        let plain = correct_digits(&plain, &set.beta);
        let refined = set.refined();
        assert!(plain >= least, "noise {noise}: {plain}");
        assert!(
            certified <= plain,
            "noise {noise}: {certified} claimed, {plain} right"
        );
        assert_eq!(refined.solution, set.beta, "noise {noise}");
        assert!(refined.converged && refined.certified_digits() >= certified);
        // The entries are integers, so that nothing but the refinement limits the digits.
        assert!(refine(&set).unwrap().certified_digits() > 15.0);
    }
}

#[test]
fn wampler_noise_is_orthogonal_to_the_polynomials() {
    for column in wampler(0.0).columns {
        let terms = column.iter().zip(WAMPLER_NOISE).map(|(x, e)| x.hi * e);
        assert_eq!(terms.sum::<f64>(), 0.0);
    }
}

#[test]
fn blocks_in_other_units_weighted_back_give_the_same_digits() {
    let set = wampler(1e4);
    let blocks = in_two_blocks(&set, 1024.0);
    let found = refined(&blocks, &[1.0, 1.0 / 1024.0], 6).unwrap();
    assert_eq!(found.solution, set.beta);
}

#[test]
fn hilbert_like_system_of_condition_1e10_is_solved_to_the_last_digit() {
    // W_ik = 1 / (i + k + 1), of which the first bits of y = W (1, ..., 1) are kept.
    let entry = |i: usize, k: usize| Double::ratio(1.0, (i + k + 1) as f64);
    let columns: Vec<Vec<Double>> = (0..8)
        .map(|k| (0..12).map(|i| entry(i, k)).collect())
        .collect();
    let sum = |i: usize| columns.iter().fold(Double::default(), |y, c| y + c[i]);
    let set = Set {
        y: (0..12).map(sum).collect(),
        columns,
        beta: vec![1.0; 8],
        sigma: Vec::new(),
    };
    let found = refine(&set).unwrap();
    assert!(found.converged && found.steps > 2, "{}", found.steps);
    assert_eq!(found.solution, set.beta);
}

#[test]
fn estimates_are_refined_with_any_weights() {
    let set = wampler(0.0);
    let blocks = in_two_blocks(&set, 1024.0);
    for weights in [Weights::None, Weights::Joint, Weights::Robust] {
        let found = estimate(&blocks, 6, weights).unwrap();
        let digits = correct_digits(&found.solution, &set.beta);
        assert!(digits >= 14.0, "{weights:?}: {digits}");
        let certified = found.certified_digits();
        assert!(
            (5.0..digits).contains(&certified),
            "{weights:?}: {certified}"
        );
    }
}

#[test]
fn parameters_that_are_not_determined_stay_zero_and_do_not_count() {
    let mut block = wampler(1.0).equations();
    let copy = block.column(2).to_vec();
    block.w.extend(copy);
    block.w.extend(vec![0.0; 21]);
    block.columns = (0..8).collect();
    let found = refined(std::slice::from_ref(&block), &[1.0], 8).unwrap();
    assert_eq!(found.solution.iter().filter(|x| **x == 0.0).count(), 2);
    let found = estimate(&[block], 8, Weights::None).unwrap();
    assert_eq!(found.rank, 6);
    assert!(found.certified_digits() > 5.0);
}

#[test]
fn dependent_columns_and_too_few_rows_are_errors() {
    let mut set = wampler(1.0);
    set.columns[4] = set.columns[3].clone();
    assert!(matches!(refine(&set), Err(EstimateError::Dependent { .. })));
    set.columns[4].fill(Double::default());
    let zero = refine(&set);
    assert!(matches!(zero, Err(EstimateError::Dependent { column: 4 })));
    set.y.truncate(5);
    set.columns.iter_mut().for_each(|c| c.truncate(5));
    let few = refine(&set);
    assert!(matches!(few, Err(EstimateError::TooFewEquations { .. })));
}
