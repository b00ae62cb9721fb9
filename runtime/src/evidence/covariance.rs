//! Covariances of parameters that do not take the residuals for white.

use faer::Mat;

use super::{Fit, student_quantile};

/// Covariance of the parameters that respects correlated residuals, with the degrees of freedom
/// with which it is known. Intervals take both: [`Covariance::half_width`].
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance {
    /// By column of the layout: standard deviation; `None` for what the data do not determine or
    /// the time blocks cannot tell.
    pub sigma: Vec<Option<f64>>,
    /// By column of the layout: effective degrees of freedom of `sigma`.
    pub dof: Vec<Option<f64>>,
    /// The p columns that the matrix is about, ascending.
    pub columns: Vec<usize>,
    /// The covariance matrix of these columns, p x p, row-major; units are the products of those
    /// of the parameters.
    pub matrix: Vec<f64>,
}

impl Covariance {
    /// Half the width of the confidence interval of a column: `level` 0.95 for 95 %. The true
    /// value lies in estimate plus or minus this with that probability.
    pub fn half_width(&self, column: usize, level: f64) -> Option<f64> {
        let sigma = self.sigma.get(column).copied().flatten()?;
        let dof = self.dof.get(column).copied().flatten()?;
        Some(sigma * student_quantile(level, dof))
    }

    /// From the covariance of the scaled parameters in the coordinates of a fit and the degrees
    /// of freedom of each; a degree below 1 tells nothing.
    pub(super) fn of(fit: &Fit, scaled: &Mat<f64>, dof: &[f64]) -> Self {
        let (columns, scale) = (&fit.reduced.columns, &fit.reduced.scale);
        let p = columns.len();
        let entry = |i: usize, k: usize| scaled[(i, k)] * scale[i] * scale[k];
        let mut covariance = Covariance {
            sigma: vec![None; fit.solution.len()],
            dof: vec![None; fit.solution.len()],
            columns: columns.clone(),
            matrix: (0..p * p)
                .map(|place| entry(place / p, place % p))
                .collect(),
        };
        for (k, column) in columns.iter().enumerate() {
            if fit.determined[*column] && dof[k] >= 1.0 {
                covariance.sigma[*column] = Some(entry(k, k).max(0.0).sqrt());
                covariance.dof[*column] = Some(dof[k]);
            }
        }
        covariance
    }
}
