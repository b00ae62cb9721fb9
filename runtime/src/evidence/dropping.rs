//! Tests of dropping columns: partial F, classical and under correlated errors.

use faer::prelude::Solve;
use faer::{Col, Mat, Side};

use super::{Covariance, Evidence, EvidenceError, Fit, Question, f_survival};

/// A test of the hypothesis that the parameters of some columns are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FTest {
    /// Value of the statistic; about 1 if the columns are not needed.
    pub statistic: f64,
    /// Number of parameters tested.
    pub above: f64,
    /// Degrees of freedom of the error.
    pub below: f64,
    /// Probability of a larger statistic if the columns are not needed.
    pub p_value: f64,
}

impl FTest {
    fn new(statistic: f64, above: f64, below: f64) -> Self {
        FTest {
            statistic,
            above,
            below,
            p_value: f_survival(statistic, above, below),
        }
    }
}

impl Evidence {
    /// Partial F test of dropping `columns` from `question`, classical: residuals are taken for
    /// white,
    /// \\( F = \frac{(S_{without} - S) / q}{S / (r - \mathrm{rank})} \\) with the sums S of
    /// squares and q the loss of rank. `fit` answers `question`; its weights are kept. Residuals
    /// of filtered logs are not white and make this test see too much: see [`Covariance::zero`].
    ///
    /// `None` if dropping loses no rank, or if there are no equations to spare.
    ///
    /// # Errors
    /// Those of [`Evidence::fit`].
    pub fn drop_test(&self, fit: &Fit, columns: &[usize]) -> Result<Option<FTest>, EvidenceError> {
        let asked = Question {
            columns: fit.columns.clone(),
            weighting: fit.weighting(),
        };
        let (square, lost) = match asked.without(columns) {
            rest if rest.columns.is_empty() => (self.weighted_measurements(fit), fit.rank),
            rest => {
                let rest = self.fit(&rest)?;
                (rest.residual_square, fit.rank - rest.rank.min(fit.rank))
            }
        };
        if lost == 0 || fit.spare() == 0 {
            return Ok(None);
        }
        let (above, below) = (lost as f64, fit.spare() as f64);
        let gain = (square - fit.residual_square).max(0.0) / above;
        Ok(Some(FTest::new(
            gain * below / fit.residual_square,
            above,
            below,
        )))
    }

    /// \\( \|Y\|^2 \\), weighted.
    fn weighted_measurements(&self, fit: &Fit) -> f64 {
        let squares = self.residual_squares(&[]);
        let of_block = |block: &Vec<f64>| -> f64 {
            block
                .iter()
                .zip(&fit.joint_sigma)
                .map(|(square, s)| square / (s * s))
                .sum()
        };
        squares.iter().map(of_block).sum()
    }
}

impl Covariance {
    /// Test of the hypothesis that the parameters of q `columns` are zero, under correlated
    /// errors: Wald's statistic, with Hotelling's reduction for a covariance that is itself known
    /// with \\( \nu \\) degrees of freedom only, \\( F = \frac{\nu - q + 1}{\nu q} X_q^T C_q^{-1}
    /// X_q \\) with q and \\( \nu - q + 1 \\) degrees of freedom. `solution` is that of the fit.
    ///
    /// `None` if a column is not determined or if the time blocks are too few for q columns.
    pub fn zero(&self, solution: &[f64], columns: &[usize]) -> Option<FTest> {
        let p = self.columns.len();
        let place = |column: &usize| self.columns.binary_search(column).ok();
        let places = columns.iter().map(place).collect::<Option<Vec<_>>>()?;
        let dof = columns.iter().map(|c| self.dof.get(*c).copied().flatten());
        let dof = dof
            .collect::<Option<Vec<_>>>()?
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        let q = columns.len() as f64;
        let below = dof - q + 1.0;
        if columns.is_empty() || below < 1.0 {
            return None;
        }
        let sigma: Vec<f64> = places
            .iter()
            .map(|k| self.matrix[k * p + k].sqrt())
            .collect();
        let correlation = Mat::from_fn(places.len(), places.len(), |i, k| {
            self.matrix[places[i] * p + places[k]] / (sigma[i] * sigma[k])
        });
        let t = Col::from_fn(places.len(), |i| solution[columns[i]] / sigma[i]);
        let whitened = correlation.llt(Side::Lower).ok()?.solve(&t);
        let wald: f64 = t.transpose() * whitened;
        Some(FTest::new(wald * below / (dof * q), q, below))
    }
}
