//! Ordinary and weighted least squares from triangular factors.

use faer::Mat;

use super::identifiable::{Dependency, identifiability};
use super::triangle::{join, upper};
use super::{EstimateError, Triangle, robust, weights};
use crate::observe::Equations;
use crate::settings::{Freedom, Weights};

/// A least-squares estimate of np parameters.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// One solution, np values: it minimises the residual. Parameters that the data do not
    /// determine hold an arbitrary value of it, often zero.
    pub solution: Vec<f64>,
    /// Which parameters the data determine.
    pub determined: Vec<bool>,
    /// Standard deviations after Gautier 1996, section 7.3:
    /// \\( \sigma^2_\rho (W^T W)^{-1} \\) with \\( \sigma^2_\rho = \|Y - W X\|^2 / (r - np) \\).
    /// `None` for what is not determined, or when there are no spare equations.
    pub sigma: Vec<Option<f64>>,
    /// Number of equations r.
    pub rows: usize,
    /// Numerical rank of W.
    pub rank: usize,
    /// 2-norm condition number of the W that was solved: weighted if weights were used.
    pub condition: f64,
    /// 2-norm condition number of the unweighted W.
    pub condition_unweighted: f64,
    /// Residual's standard deviation of each block, by which its equations were divided; empty
    /// for ordinary least squares.
    pub joint_sigma: Vec<f64>,
    /// Parameters that appear in no equation, because their columns are zero.
    pub unseen: Vec<usize>,
    /// Parameters determined only in combinations.
    pub dependent: Vec<Dependency>,
}

/// Estimates `np` parameters from blocks of equations.
///
/// [`Weights::Joint`] divides the equations of each block by the standard deviation of its
/// residual under ordinary least squares, one pass; with a single block this is ordinary least
/// squares. [`Weights::Robust`] goes on from there with Huber's weights for single rows.
///
/// # Errors
/// [`EstimateError`]: no torque, values that are not finite, fewer equations than parameters,
/// nothing moves.
pub fn estimate(
    blocks: &[Equations],
    np: usize,
    weights: Weights,
) -> Result<Estimate, EstimateError> {
    let triangles = blocks
        .iter()
        .enumerate()
        .map(|(block, equations)| Triangle::new(equations, block, None))
        .collect::<Result<Vec<_>, _>>()?;
    let ordinary = solve(&triangles, &vec![1.0; blocks.len()], np)?;
    match weights {
        Weights::None => Ok(ordinary),
        Weights::Joint if blocks.len() < 2 => Ok(ordinary),
        Weights::Joint => weighted(&triangles, &ordinary, np),
        Weights::Robust => {
            let start = weighted(&triangles, &ordinary, np)?;
            let condition_unweighted = ordinary.condition;
            Ok(Estimate {
                condition_unweighted,
                ..robust::huber(blocks, start, np)?
            })
        }
    }
}

/// Weighted least squares with the joints' error levels under `ordinary`.
fn weighted(
    triangles: &[Triangle],
    ordinary: &Estimate,
    np: usize,
) -> Result<Estimate, EstimateError> {
    let joint_sigma = weights::joint_sigma(triangles, &ordinary.solution);
    let factors: Vec<f64> = joint_sigma.iter().map(|sigma| 1.0 / sigma).collect();
    let weighted = solve(triangles, &factors, np)?;
    Ok(Estimate {
        joint_sigma,
        condition_unweighted: ordinary.condition,
        ..weighted
    })
}

impl Estimate {
    /// The same estimate with the residual's degrees of freedom counted in another way: sigmas
    /// scale with the root of r - np over r - 1.
    pub fn counted(mut self, freedom: Freedom) -> Estimate {
        if freedom == Freedom::Mean && self.rows > 1 {
            let spare = self.rows.saturating_sub(self.rank) as f64;
            let factor = (spare / (self.rows - 1) as f64).sqrt();
            for sigma in self.sigma.iter_mut().flatten() {
                *sigma *= factor;
            }
        }
        self
    }
}

/// Least squares of blocks multiplied by `factors`.
pub(super) fn solve(
    triangles: &[Triangle],
    factors: &[f64],
    np: usize,
) -> Result<Estimate, EstimateError> {
    let rows: usize = triangles.iter().map(|t| t.rows).sum();
    let r = join(triangles, factors, np);
    let found = identifiability(&r, np)?;
    let parameters = np - found.unseen.len();
    if rows < parameters {
        return Err(EstimateError::TooFewEquations { rows, parameters });
    }
    let reduced = Reduced::new(&r, &found.independent);
    let values = reduced.solution();
    let spare = rows - found.rank();
    let sigma = (spare > 0).then(|| reduced.sigma(spare));
    let condition = reduced.condition()?;
    let mut solution = vec![0.0; np];
    let mut deviations = vec![None; np];
    for (k, &column) in found.independent.iter().enumerate() {
        solution[column] = values[k];
        let own = sigma.as_ref().map(|sigma| sigma[k]);
        deviations[column] = own.filter(|_| found.determines(column));
    }
    Ok(Estimate {
        solution,
        determined: (0..np).map(|column| found.determines(column)).collect(),
        sigma: deviations,
        rows,
        rank: found.rank(),
        condition,
        condition_unweighted: condition,
        joint_sigma: Vec::new(),
        unseen: found.unseen,
        dependent: found.dependent,
    })
}

/// The system over independent columns, scaled by powers of two so that columns in different
/// units meet with norms near one, without any rounding.
struct Reduced {
    /// Upper triangular factor of `[W | Y]` over the scaled columns.
    r: Mat<f64>,
    /// What each column was multiplied by.
    scale: Vec<f64>,
}

impl Reduced {
    fn new(full: &Mat<f64>, columns: &[usize]) -> Self {
        let last = full.ncols() - 1;
        let scale: Vec<f64> = columns
            .iter()
            .map(|c| (-full.col(*c).norm_l2().log2().round()).exp2())
            .collect();
        let r = upper(Mat::from_fn(full.nrows(), columns.len() + 1, |i, k| {
            columns
                .get(k)
                .map_or(full[(i, last)], |c| full[(i, *c)] * scale[k])
        }));
        Reduced { r, scale }
    }

    /// Back substitution.
    fn solution(&self) -> Vec<f64> {
        let np = self.scale.len();
        let mut x = vec![0.0; np];
        for i in (0..np).rev() {
            let sum: f64 = (i + 1..np).map(|k| self.r[(i, k)] * x[k]).sum();
            x[i] = (self.r[(i, np)] - sum) / self.r[(i, i)];
        }
        x.iter()
            .zip(&self.scale)
            .map(|(x, scale)| x * scale)
            .collect()
    }

    /// Standard deviations: the row norms of the inverse factor times the residual's, which
    /// stands in the corner of the factor.
    fn sigma(&self, spare: usize) -> Vec<f64> {
        let np = self.scale.len();
        let residual = if self.r.nrows() > np {
            self.r[(np, np)].abs()
        } else {
            0.0
        };
        let sigma_rho = residual / (spare as f64).sqrt();
        let mut squares = vec![0.0; np];
        for column in 0..np {
            let inverse = self.inverse_column(column);
            for (square, entry) in squares.iter_mut().zip(&inverse) {
                *square += entry * entry;
            }
        }
        squares
            .iter()
            .zip(&self.scale)
            .map(|(s, scale)| sigma_rho * s.sqrt() * scale)
            .collect()
    }

    /// Column of the inverse of the triangular factor of W.
    fn inverse_column(&self, column: usize) -> Vec<f64> {
        let mut x = vec![0.0; self.scale.len()];
        x[column] = 1.0 / self.r[(column, column)];
        for i in (0..column).rev() {
            let sum: f64 = (i + 1..=column).map(|k| self.r[(i, k)] * x[k]).sum();
            x[i] = -sum / self.r[(i, i)];
        }
        x
    }

    /// 2-norm condition number of the unscaled columns.
    fn condition(&self) -> Result<f64, EstimateError> {
        let np = self.scale.len();
        let unscaled = Mat::from_fn(np, np, |i, k| self.r[(i, k)] / self.scale[k]);
        let singular = unscaled
            .singular_values()
            .map_err(|_| EstimateError::Singular)?;
        let bounds = singular.first().zip(singular.last());
        Ok(bounds.map_or(1.0, |(largest, smallest)| largest / smallest))
    }
}
