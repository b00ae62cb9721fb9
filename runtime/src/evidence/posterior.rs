//! Evidence and prior knowledge together: Gaussian rows beside the factors.

use faer::Mat;

use super::levels::error_levels;
use super::rank::{Rank, rank};
use super::reduced::Reduced;
use super::{Evidence, EvidenceError, Fold, Question, Triangle, Weighting};
use crate::estimate::EstimateError;

/// What the log and the prior together say of the np parameters of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Posterior {
    /// Mean, np values; what neither determines holds an arbitrary value, often zero.
    pub mean: Vec<f64>,
    /// Standard deviations; `None` for what neither determines.
    pub sigma: Vec<Option<f64>>,
    /// Standard deviations under the prior alone; `None` for what it leaves open.
    pub before: Vec<Option<f64>>,
    /// How many of the np parameters, as a real number, the prior decides rather than the log:
    /// the trace of \\( H^{-1} A^T A \\) with the information H of both together.
    pub from_prior: f64,
    /// How far log and prior are apart, in standard deviations of their difference: the root mean
    /// square over the directions that both know, \\( \sqrt{(J - J_{log}) / f} \\) with the
    /// minima J with and without the prior. About 1 if they agree; 0 if both know nothing alike.
    pub misfit: f64,
}

impl Evidence {
    /// The mean and the covariance of the parameters given the log and a prior of Gaussian rows
    /// \\( A X = b + \epsilon \\) with independent errors of variance one (row-major, np factors and
    /// then b): the minimum of
    /// \\( \sum_j \|Y_j - W_j X\|^2 / (\lambda \sigma_j)^2 + \|A X - b\|^2 \\), solved by
    /// folding the rows of the prior into the factors.
    ///
    /// \\( \sigma_j \\) is the error level of joint j: given, or the standard deviation of its
    /// residual under ordinary least squares. `inflation` \\( \lambda \\) is how much wider errors
    /// really are than independent ones would be; 1 for white residuals.
    ///
    /// # Errors
    /// [`EvidenceError::Weights`]; those of [`Evidence::fit`].
    pub fn posterior(
        &self,
        weighting: &Weighting,
        inflation: f64,
        prior: &[f64],
    ) -> Result<Posterior, EvidenceError> {
        let np = self.layout.parameters;
        let totals = self.totals();
        let question = Question::parameters(self, weighting.clone());
        question.check(self)?;
        let columns = question.columns;
        let levels = match weighting {
            Weighting::Given(levels) => levels[..totals.len()].to_vec(),
            Weighting::Equal | Weighting::Residual => {
                let ordinary = Question::parameters(self, Weighting::Equal);
                error_levels(self, &totals, &self.fit(&ordinary)?.solution)
            }
        };
        let rows = planar(prior, np + 1);
        let mut both = Fold::new(np + 1);
        for (joint, (factor, level)) in totals.iter().zip(&levels).enumerate() {
            let places = self.layout.places(joint, &columns);
            both.factor(factor, &places, 1.0 / (inflation * level));
        }
        let log = both.clone().finish();
        let mut alone = Fold::new(np + 1);
        for fold in [&mut both, &mut alone] {
            fold.rows(&rows.iter().map(Vec::as_slice).collect::<Vec<_>>());
        }
        let (solved, found) = solve(&both.finish(), &columns)?;
        let mean = placed(&solved, &solved.solution(), np);
        let product = Mat::from_fn(rows[0].len(), solved.columns.len(), |i, k| {
            rows[solved.columns[k]][i] * solved.scale[k]
        }) * &solved.inverse;
        Ok(Posterior {
            sigma: deviations(&solved, &found, np),
            before: before(&alone.finish(), &columns, np),
            from_prior: product.squared_norm_l2(),
            misfit: misfit(&log, (&solved, &found), rows[0].len(), &columns)?,
            mean,
        })
    }
}

/// Columns of row-major rows.
fn planar(rows: &[f64], width: usize) -> Vec<Vec<f64>> {
    let column = |k| rows.chunks_exact(width).map(|row| row[k]).collect();
    (0..width).map(column).collect()
}

fn solve(factor: &Triangle, columns: &[usize]) -> Result<(Reduced, Rank), EstimateError> {
    let found = rank(factor)?;
    Ok((Reduced::new(factor, columns, &found.independent), found))
}

fn placed(solved: &Reduced, values: &[f64], np: usize) -> Vec<f64> {
    let mut all = vec![0.0; np];
    for (column, value) in solved.columns.iter().zip(values) {
        all[*column] = *value;
    }
    all
}

/// Standard deviations of what is determined, for errors of variance one.
fn deviations(solved: &Reduced, found: &Rank, np: usize) -> Vec<Option<f64>> {
    let norms = placed(solved, &solved.inverse_norms(), np);
    let own = |(k, norm): (usize, &f64)| found.determines(k).then_some(*norm);
    norms.iter().enumerate().map(own).collect()
}

/// Standard deviations under the prior alone.
fn before(prior: &Triangle, columns: &[usize], np: usize) -> Vec<Option<f64>> {
    match solve(prior, columns) {
        Ok((solved, found)) => deviations(&solved, &found, np),
        Err(_) => vec![None; np],
    }
}

fn misfit(
    log: &Triangle,
    (both, found): (&Reduced, &Rank),
    rows: usize,
    columns: &[usize],
) -> Result<f64, EstimateError> {
    let (log, before) = solve(log, columns)?;
    let known = rows + before.independent.len() - found.independent.len();
    let square = both.residual().powi(2) - log.residual().powi(2);
    Ok((square.max(0.0) / known.max(1) as f64).sqrt())
}
