//! Ordinary and weighted least squares from triangular factors.

use super::entries::Stacked;
use super::identifiable::{Dependency, identifiability};
use super::reduced::Reduced;
use super::refine::{certain, refine};
use super::triangle::join;
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
    /// Bound of the numerical error of each parameter, in its unit; zero for one that was left
    /// out. Entries of W and Y are taken to be uncertain by their last bit. This is no statement
    /// about noise: that is `sigma`.
    pub numerical_error: Vec<f64>,
    /// The parameters that were solved for, ascending.
    pub(super) independent: Vec<usize>,
}

/// Systems with more entries than this are not refined: the factorisation of all rows at once
/// would take more time and memory (16 MB) than all else that is done with them.
const REFINED: usize = 2_000_000;

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
    let triangles = Triangle::of_all(blocks)?;
    let ordinary = solve(&triangles, &vec![1.0; blocks.len()], np)?;
    match weights {
        Weights::None => Ok(ordinary.refined(blocks, None)),
        Weights::Joint if blocks.len() < 2 => Ok(ordinary.refined(blocks, None)),
        Weights::Joint => Ok(weighted(&triangles, &ordinary, np)?.refined(blocks, None)),
        Weights::Robust => {
            let start = weighted(&triangles, &ordinary, np)?;
            let (robust, row_factors) = robust::huber(blocks, start, np)?;
            let refined = robust.refined(blocks, Some(&row_factors));
            Ok(Estimate {
                condition_unweighted: ordinary.condition,
                ..refined
            })
        }
    }
}

/// Estimates `np` parameters from the factors of blocks of equations, when the equations
/// themselves are not at hand: without refinement, and without weights for single rows
/// ([`Weights::Robust`] is then [`Weights::Joint`]).
///
/// # Errors
/// As [`estimate`].
pub fn from_triangles(
    triangles: &[Triangle],
    np: usize,
    weights: Weights,
) -> Result<Estimate, EstimateError> {
    let ordinary = solve(triangles, &vec![1.0; triangles.len()], np)?;
    match weights {
        Weights::Joint | Weights::Robust if triangles.len() > 1 => {
            weighted(triangles, &ordinary, np)
        }
        _ => Ok(ordinary),
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
    /// Decimal digits that rounding leaves certain in the worst of the determined parameters,
    /// between 0 and 16. They are counted from the parameter or from its sigma, whichever is
    /// larger: digits beyond both would mean nothing.
    pub fn certified_digits(&self) -> f64 {
        let digits = |k: usize| {
            let sigma = self.sigma[k].unwrap_or(0.0);
            certain(self.numerical_error[k], sigma.max(self.solution[k].abs()))
        };
        (0..self.solution.len())
            .filter(|k| self.determined[*k])
            .map(digits)
            .fold(certain(0.0, 1.0), f64::min)
    }

    /// The same estimate with all the digits that the equations hold, where that is cheap.
    fn refined(mut self, blocks: &[Equations], row_factors: Option<&[Vec<f64>]>) -> Estimate {
        if self.rows.saturating_mul(self.independent.len()) > REFINED {
            return self;
        }
        let factors: Vec<f64> = match self.joint_sigma.is_empty() {
            true => vec![1.0; blocks.len()],
            false => self.joint_sigma.iter().map(|sigma| 1.0 / sigma).collect(),
        };
        let entries = Stacked {
            blocks,
            factors: &factors,
            row_factors,
            columns: &self.independent,
        };
        // Without convergence the plain solution is the better one, and its bound holds.
        if let Some(refined) = refine(&entries).ok().filter(|refined| refined.converged) {
            for (k, column) in self.independent.iter().enumerate() {
                self.solution[*column] = refined.solution[k];
                self.numerical_error[*column] = refined.error[k];
            }
        }
        self
    }

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
    let sensitivity = reduced.sensitivity(&values);
    // Rounding in an orthogonal factorisation acts as if the entries were uncertain by a few
    // units in the last place per column (Higham 2002, theorem 19.3).
    let roundoff = 0.5 * f64::EPSILON * (1 + found.rank()) as f64;
    let mut solution = vec![0.0; np];
    let mut numerical_error = vec![0.0; np];
    let mut deviations = vec![None; np];
    for (k, &column) in found.independent.iter().enumerate() {
        solution[column] = values[k];
        numerical_error[column] = roundoff * sensitivity[k];
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
        numerical_error,
        independent: found.independent,
        unseen: found.unseen,
        dependent: found.dependent,
    })
}
