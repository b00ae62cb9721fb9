//! The factor: identities, merging, and that chunks leave no trace.

use faer::Mat;

use super::super::{Fold, Triangle};
use super::{Random, assert_close};

fn columns(rows: usize, width: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut random = Random(seed);
    (0..width)
        .map(|k| {
            random
                .series(rows)
                .iter()
                .map(|x| x * 10f64.powi(k as i32 % 5))
                .collect()
        })
        .collect()
}

fn factor(columns: &[Vec<f64>], chunk: usize) -> Triangle {
    let mut fold = Fold::new(columns.len());
    let rows = columns[0].len();
    for start in (0..rows).step_by(chunk) {
        let end = (start + chunk).min(rows);
        let part: Vec<&[f64]> = columns.iter().map(|c| &c[start..end]).collect();
        fold.rows(&part);
    }
    fold.finish()
}

/// LAPACK's ratio for R'R = A'A: the error in units of rows x epsilon x the columns' norms.
fn ratio(columns: &[Vec<f64>], triangle: &Triangle) -> f64 {
    let norm = |c: &[f64]| c.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut worst: f64 = 0.0;
    for (i, a) in columns.iter().enumerate() {
        for (k, b) in columns.iter().enumerate().skip(i) {
            let product: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
            let of_factor: f64 = (0..=i)
                .map(|l| triangle.entry(l, i) * triangle.entry(l, k))
                .sum();
            let size = norm(a) * norm(b) * f64::EPSILON * a.len().max(columns.len()) as f64;
            worst = worst.max((product - of_factor).abs() / size);
        }
    }
    worst
}

#[test]
fn factor_of_random_rows_has_their_products() {
    for (rows, width) in [
        (1, 1),
        (3, 9),
        (64, 5),
        (65, 64),
        (200, 61),
        (5000, 12),
        (130, 130),
    ] {
        let columns = columns(rows, width, 7 + rows as u64);
        let triangle = factor(&columns, 1000);
        let ratio = ratio(&columns, &triangle);
        assert!(ratio < 30.0, "{rows} x {width}: {ratio}");
        assert!((0..width).all(|k| triangle.entry(k, k) >= 0.0));
        assert_eq!(triangle.rows(), rows);
    }
}

#[test]
fn factor_agrees_with_an_independent_one() {
    let columns = columns(700, 23, 3);
    let triangle = factor(&columns, 700);
    let qr = Mat::from_fn(700, 23, |i, k| columns[k][i]).qr();
    let r = qr.thin_R();
    for i in 0..23 {
        let sign = r[(i, i)].signum();
        let expected: Vec<f64> = (i..23).map(|k| sign * r[(i, k)]).collect();
        assert_close(&expected, triangle.row(i), 1e-11);
    }
}

#[test]
fn factor_does_not_depend_on_the_chunks() {
    let columns = columns(777, 19, 11);
    let whole = factor(&columns, 777);
    for chunk in [1, 5, 63, 64, 65, 300] {
        assert_eq!(factor(&columns, chunk), whole);
    }
}

#[test]
fn merged_factors_are_the_factor_of_all_rows() {
    let all = columns(900, 21, 5);
    let whole = factor(&all, 900);
    for at in [0, 1, 20, 450, 899] {
        let part = |range: std::ops::Range<usize>| -> Triangle {
            let part: Vec<Vec<f64>> = all.iter().map(|c| c[range.clone()].to_vec()).collect();
            factor(&part, 64)
        };
        let merged = part(0..at).merge(&part(at..900));
        assert_eq!(merged.rows(), 900);
        assert_close(whole.packed(), merged.packed(), 1e-12);
    }
}

#[test]
fn residual_of_the_factor_has_the_norm_of_that_of_the_rows() {
    let columns = columns(300, 6, 23);
    let triangle = factor(&columns, 300);
    let x = [1.0, -0.3, 0.2, 0.01, 3.0];
    let row = |i: usize| columns[5][i] - (0..5).map(|k| columns[k][i] * x[k]).sum::<f64>();
    let square: f64 = (0..300).map(|i| row(i).powi(2)).sum();
    let of_factor: f64 = triangle.residual(&x).iter().map(|r| r * r).sum();
    assert_close(&[square], &[of_factor], 1e-13);
}

#[test]
fn zero_and_repeated_columns_stay_finite() {
    let mut columns = columns(100, 5, 2);
    columns[1].fill(0.0);
    columns[3] = columns[0].clone();
    let triangle = factor(&columns, 100);
    assert!(triangle.packed().iter().all(|x| x.is_finite()));
    assert!(ratio(&[columns[0].clone()], &triangle) < 30.0);
    assert_eq!(triangle.column_norm(1), 0.0);
    assert!(triangle.entry(3, 3) < 1e-12 * triangle.entry(0, 0));
}
