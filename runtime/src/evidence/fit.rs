//! Least squares on evidence.

use super::levels::error_levels;
use super::rank::{Rank, rank};
use super::reduced::Reduced;
use super::{Evidence, EvidenceError, Fold, Layout, Question, Triangle, Weighting};
use crate::estimate::{Dependency, EstimateError};

/// A least-squares estimate. Columns are counted as in [`super::Layout`]; vectors "by column" have
/// a value for each of them, asked for or not.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The columns that were asked for.
    pub columns: Vec<usize>,
    /// By column: one solution, which minimises the residual. Zero for columns not asked for;
    /// what the data do not determine holds an arbitrary value, often zero.
    pub solution: Vec<f64>,
    /// By column: whether the data determine it.
    pub determined: Vec<bool>,
    /// By column: classical standard deviation (Gautier 1996, section 7.3), the square root of
    /// the diagonal of \\( \sigma^2_\rho (W^T W)^{-1} \\) with
    /// \\( \sigma^2_\rho = \|Y - W X\|^2 / (r - \mathrm{rank}) \\). It takes the residuals for
    /// white; see [`Evidence::corrected`]. `None` for what is not determined or not asked for.
    pub sigma: Vec<Option<f64>>,
    /// Number of equations r.
    pub rows: usize,
    /// Numerical rank of W.
    pub rank: usize,
    /// 2-norm condition number of the W that was solved, weighted if weights were used.
    pub condition: f64,
    /// 2-norm condition number of the unweighted W.
    pub condition_unweighted: f64,
    /// What the equations of each joint were divided by; 1 for ordinary least squares.
    pub joint_sigma: Vec<f64>,
    /// \\( \|Y - W X\|^2 \\), weighted.
    pub residual_square: f64,
    /// Columns that appear in no equation, because they are zero.
    pub unseen: Vec<usize>,
    /// Columns that the data determine only in combinations.
    pub dependent: Vec<Dependency>,
    pub(super) reduced: Reduced,
}

impl Fit {
    /// The same weights for other questions: tests compare fits of one weighting.
    pub fn weighting(&self) -> Weighting {
        Weighting::Given(self.joint_sigma.clone())
    }

    /// Equations to spare, \\( r - \mathrm{rank} \\).
    pub fn spare(&self) -> usize {
        self.rows - self.rank
    }
}

impl Evidence {
    /// Solves a least-squares problem from the factors alone.
    ///
    /// # Errors
    /// [`EvidenceError::NoSuchColumn`], [`EvidenceError::Weights`];
    /// [`EstimateError::TooFewEquations`], [`EstimateError::NothingMoves`],
    /// [`EstimateError::Singular`].
    pub fn fit(&self, question: &Question) -> Result<Fit, EvidenceError> {
        question.check(self)?;
        let totals = self.totals();
        let columns = &question.columns;
        let equal = vec![1.0; totals.len()];
        let ordinary = solve(&self.layout, &totals, columns, equal)?;
        let joint_sigma = match &question.weighting {
            Weighting::Equal => return Ok(ordinary),
            Weighting::Residual if totals.len() < 2 => return Ok(ordinary),
            Weighting::Residual => error_levels(self, &totals, &ordinary.solution),
            Weighting::Given(levels) => levels[..totals.len()].to_vec(),
        };
        let weighted = solve(&self.layout, &totals, columns, joint_sigma)?;
        let condition_unweighted = ordinary.condition;
        Ok(Fit {
            condition_unweighted,
            ..weighted
        })
    }
}

/// Least squares with the equations of each joint divided by `joint_sigma`.
fn solve(
    layout: &Layout,
    totals: &[Triangle],
    columns: &[usize],
    joint_sigma: Vec<f64>,
) -> Result<Fit, EstimateError> {
    let mut fold = Fold::new(columns.len() + 1);
    for (joint, (factor, sigma)) in totals.iter().zip(&joint_sigma).enumerate() {
        fold.factor(factor, &layout.places(joint, columns), 1.0 / sigma);
    }
    let all = fold.finish();
    let found = rank(&all)?;
    let (rows, parameters) = (all.rows(), columns.len() - found.unseen.len());
    if rows < parameters {
        return Err(EstimateError::TooFewEquations { rows, parameters });
    }
    let reduced = Reduced::new(&all, columns, &found.independent);
    let condition = reduced.condition()?;
    let mut fit = Fit {
        columns: columns.to_vec(),
        solution: vec![0.0; layout.columns()],
        determined: vec![false; layout.columns()],
        sigma: vec![None; layout.columns()],
        rows,
        rank: found.independent.len(),
        condition,
        condition_unweighted: condition,
        joint_sigma,
        residual_square: reduced.residual().powi(2),
        unseen: found.unseen.iter().map(|k| columns[*k]).collect(),
        dependent: named(&found, columns),
        reduced,
    };
    fill(&mut fit, &found);
    Ok(fit)
}

/// Puts values and standard deviations in their columns.
fn fill(fit: &mut Fit, found: &Rank) {
    let spare = fit.spare();
    let level = (spare > 0).then(|| (fit.residual_square / spare as f64).sqrt());
    let (values, norms) = (fit.reduced.solution(), fit.reduced.inverse_norms());
    for (place, k) in found.independent.iter().enumerate() {
        let column = fit.columns[*k];
        fit.solution[column] = values[place];
        fit.determined[column] = found.determines(*k);
        let sigma = level.map(|level| level * norms[place]);
        fit.sigma[column] = sigma.filter(|_| fit.determined[column]);
    }
}

/// Dependencies, counted as the layout does.
fn named(found: &Rank, columns: &[usize]) -> Vec<Dependency> {
    let named = |group: &Dependency| Dependency {
        columns: group.columns.iter().map(|k| columns[*k]).collect(),
        combinations: group.combinations,
    };
    found.dependent.iter().map(named).collect()
}
