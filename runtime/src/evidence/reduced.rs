//! The small triangular system over independent columns, and what follows from it.

use faer::Mat;

use super::{Fold, Triangle};
use crate::estimate::EstimateError;

/// The factor of `[W | Y]` over independent columns. They are scaled by powers of two, so that
/// columns in different units meet with norms near one, without any rounding.
#[derive(Clone, Debug)]
pub(super) struct Reduced {
    /// The columns, as the layout counts them.
    pub columns: Vec<usize>,
    /// What each column is multiplied by.
    pub scale: Vec<f64>,
    /// Inverse of the scaled factor of W, p x p, upper triangular: the columns are independent.
    pub inverse: Mat<f64>,
    factor: Triangle,
}

impl Reduced {
    /// Keeps the columns at `kept` of a factor over `columns`.
    pub fn new(full: &Triangle, columns: &[usize], kept: &[usize]) -> Self {
        let mut places = vec![None; full.width()];
        for (place, k) in kept.iter().chain([&columns.len()]).enumerate() {
            places[*k] = Some(place);
        }
        let mut fold = Fold::new(kept.len() + 1);
        fold.factor(full, &places, 1.0);
        let factor = fold.finish();
        let power = |k: usize| (-factor.column_norm(k).log2().round()).exp2();
        let scale: Vec<f64> = (0..kept.len()).map(power).collect();
        Reduced {
            columns: kept.iter().map(|k| columns[*k]).collect(),
            inverse: inverse(&factor, &scale),
            scale,
            factor,
        }
    }

    /// The solution, one value per column, by back substitution.
    pub fn solution(&self) -> Vec<f64> {
        let p = self.columns.len();
        let entry = |i: usize, k: usize| self.factor.entry(i, k) * self.scale[k];
        let mut x = vec![0.0; p];
        for i in (0..p).rev() {
            let sum: f64 = (i + 1..p).map(|k| entry(i, k) * x[k]).sum();
            x[i] = (self.factor.entry(i, p) - sum) / entry(i, i);
        }
        x.iter()
            .zip(&self.scale)
            .map(|(x, scale)| x * scale)
            .collect()
    }

    /// Norm of the residual, which stands in the corner of the factor.
    pub fn residual(&self) -> f64 {
        let p = self.columns.len();
        self.factor.entry(p, p)
    }

    /// Square roots of the diagonal of \\( (W^T W)^{-1} \\).
    pub fn inverse_norms(&self) -> Vec<f64> {
        let norm = |(k, scale): (usize, &f64)| self.inverse.row(k).norm_l2() * scale;
        self.scale.iter().enumerate().map(norm).collect()
    }

    /// 2-norm condition number of the columns as they are, not scaled.
    pub fn condition(&self) -> Result<f64, EstimateError> {
        let p = self.columns.len();
        let unscaled = Mat::from_fn(p, p, |i, k| self.factor.entry(i, k));
        let singular = unscaled
            .singular_values()
            .map_err(|_| EstimateError::Singular)?;
        let bounds = singular.first().zip(singular.last());
        Ok(bounds.map_or(1.0, |(largest, smallest)| largest / smallest))
    }
}

/// Inverse of the scaled factor, column by column.
fn inverse(factor: &Triangle, scale: &[f64]) -> Mat<f64> {
    let p = scale.len();
    let mut inverse = Mat::zeros(p, p);
    for column in 0..p {
        for i in (0..=column).rev() {
            let row = factor.row(i);
            let product = |k: usize| row[k - i] * scale[k] * inverse[(k, column)];
            let sum: f64 = (i + 1..=column).map(product).sum();
            let unit = if i == column { 1.0 } else { 0.0 };
            inverse[(i, column)] = (unit - sum) / (row[0] * scale[i]);
        }
    }
    inverse
}
