//! From independent deviations to Gaussian rows of variance one.

use nalgebra::{DMatrix, DVector};

use super::spread::Deviations;

/// What is left of a unit vector after projection below this is rounding.
const ROUNDING: f64 = 1e-8;

/// A combination known better than this, beside the others, counts as known to this.
const SHARPEST: f64 = 1e-9;

/// Rows `[A | b]` with \\( A X = b + \epsilon \\), \\( \epsilon \\) independent with variance one,
/// that say what the bounded deviations about `mean` leave of X whatever size the free ones have.
///
/// With N a basis of the combinations that the free deviations do not reach and B the bounded
/// ones: the covariance of \\( N^T X \\) is \\( N^T B B^T N = R^T R \\), and
/// \\( A = R^{-T} N^T \\).
pub fn rows(deviations: &Deviations, mean: &DVector<f64>) -> Vec<Vec<f64>> {
    let np = mean.len();
    if deviations.bounded.is_empty() {
        return Vec::new();
    }
    let bounded = DMatrix::from_columns(&deviations.bounded);
    // Parameters in different units meet with spreads near one.
    let scale: Vec<f64> = (0..np).map(|k| scale(&bounded, deviations, k)).collect();
    let scaled = |column: &DVector<f64>| {
        let values = column.iter().zip(&scale).map(|(x, scale)| x * scale);
        DVector::from_iterator(np, values)
    };
    let free: Vec<DVector<f64>> = deviations.free.iter().map(scaled).collect();
    let known = out_of_reach(np, &free);
    if known.is_empty() {
        return Vec::new();
    }
    let n = DMatrix::from_columns(&known);
    let spread: Vec<DVector<f64>> = deviations.bounded.iter().map(scaled).collect();
    let spread = n.transpose() * DMatrix::from_columns(&spread);
    let mut r = triangle(&spread.transpose());
    let largest = r.diagonal().amax();
    for k in 0..r.nrows() {
        if r[(k, k)].abs() < SHARPEST * largest {
            r[(k, k)] = SHARPEST * largest;
        }
    }
    let Some(a) = r.transpose().solve_lower_triangular(&n.transpose()) else {
        return Vec::new();
    };
    let row = |i: usize| {
        let factors: Vec<f64> = (0..np).map(|k| round(a[(i, k)] * scale[k])).collect();
        let value = factors.iter().zip(mean.iter()).map(|(a, x)| a * x).sum();
        factors.into_iter().chain([round(value)]).collect()
    };
    (0..a.nrows()).map(row).collect()
}

/// What to multiply parameter `k` by.
fn scale(bounded: &DMatrix<f64>, deviations: &Deviations, k: usize) -> f64 {
    let own = bounded.row(k).norm();
    let free = || {
        let squares = deviations.free.iter().map(|column| column[k] * column[k]);
        squares.sum::<f64>().sqrt()
    };
    let spread = if own > 0.0 { own } else { free() };
    if spread > 0.0 { 1.0 / spread } else { 1.0 }
}

/// An orthonormal basis of what is orthogonal to all of `free`; unit vectors stay what they are.
fn out_of_reach(np: usize, free: &[DVector<f64>]) -> Vec<DVector<f64>> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for column in free {
        extend(&mut basis, column);
    }
    let reached = basis.len();
    for k in 0..np {
        let mut unit = DVector::zeros(np);
        unit[k] = 1.0;
        extend(&mut basis, &unit);
    }
    basis.split_off(reached)
}

/// Adds the direction of a vector that the basis lacks (Gram-Schmidt, twice), if there is any.
fn extend(basis: &mut Vec<DVector<f64>>, vector: &DVector<f64>) {
    let size = vector.norm();
    let mut rest = vector.clone();
    for _ in 0..2 {
        for direction in basis.iter() {
            let along = direction.dot(&rest);
            rest.axpy(-along, direction, 1.0);
        }
    }
    let left = rest.norm();
    if left > ROUNDING * size {
        basis.push(rest / left);
    }
}

/// Square upper triangular factor; rows of zeros where there are fewer rows than columns.
fn triangle(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let columns = matrix.ncols();
    let r = matrix.clone().qr().r();
    DMatrix::from_fn(columns, columns, |i, k| match i < r.nrows() {
        true => r[(i, k)],
        false => 0.0,
    })
}

/// Twelve digits: what is certain, and the same on every machine.
fn round(x: f64) -> f64 {
    format!("{x:.11e}").parse().unwrap_or(x)
}
