//! Recursive least squares in square-root information form.

use super::factor::Factor;
use super::solve::{Solution, Solver};
use super::{Equation, Instant, OnlineError, Stream};
use crate::model::IdentificationModel;

/// All equations so far, in the memory of one triangular factor:
/// \\( X = \arg\min \sum_t \lambda^{n-t} \sum_j w_j^2 (y_{jt} - w_{jt} X)^2 \\).
#[derive(Clone, Debug)]
pub struct Recursion {
    weights: Vec<f64>,
    forgetting: f64,
    factor: Factor,
    solver: Solver,
}

impl Recursion {
    /// A recursion over the equations of a stream. `weights` multiply the equations, one per joint
    /// (or a single one for the power model): one over the standard deviation of their errors.
    /// `forgetting` \\( \lambda \\) is what an instant counts one instant later, 1 for equations
    /// that are never forgotten; the memory is about \\( 1 / (1 - \lambda) \\) instants of `nd`
    /// samples each. Instants at which nothing moves neither count nor make forget.
    ///
    /// # Errors
    /// [`OnlineError::Weights`], [`OnlineError::Weight`], [`OnlineError::Forgetting`].
    pub fn new<M: IdentificationModel>(
        stream: &Stream<M>,
        weights: &[f64],
        forgetting: f64,
    ) -> Result<Recursion, OnlineError> {
        let (has, needs) = (weights.len(), stream.equations().len());
        if has != needs {
            return Err(OnlineError::Weights { has, needs });
        }
        let wrong = |weight: &f64| !(*weight > 0.0 && weight.is_finite());
        if let Some(place) = weights.iter().position(wrong) {
            let (equation, weight) = (place + 1, weights[place]);
            return Err(OnlineError::Weight { equation, weight });
        }
        if !(forgetting > 0.0 && forgetting <= 1.0) {
            return Err(OnlineError::Forgetting { factor: forgetting });
        }
        let parameters = stream.model().columns().len();
        Ok(Recursion {
            weights: weights.to_vec(),
            forgetting,
            factor: Factor::new(parameters + 1),
            solver: Solver::new(parameters),
        })
    }

    /// Takes the equations of an instant; those of joints at rest are left out.
    pub fn update(&mut self, instant: Instant<'_>) {
        let moving = |equation: &Equation| equation.moves;
        if !instant.equations.iter().any(moving) {
            return;
        }
        self.factor.forget(self.forgetting);
        for (equation, weight) in instant.equations.iter().zip(&self.weights) {
            if equation.moves {
                let Equation { columns, w, y, .. } = equation;
                self.factor.add(columns, w, *y, *weight);
            }
        }
    }

    /// Room for what [`Recursion::solve`] finds.
    pub fn solution(&self) -> Solution {
        Solution::new(self.factor.width() - 1)
    }

    /// The parameters as they are now. Costs as much as about ten updates, always the same for
    /// a model; a loop that cannot wait solves a [`Recursion::copy`] in another thread.
    ///
    /// # Errors
    /// [`OnlineError::NothingMoves`]; the solution then is as before.
    pub fn solve(&mut self, solution: &mut Solution) -> Result<(), OnlineError> {
        self.solver.solve(&self.factor, solution)
    }

    /// Takes over the equations of another recursion of the same model, without taking memory.
    pub fn copy(&mut self, other: &Recursion) {
        self.factor.copy(&other.factor);
    }

    /// Forgets all equations.
    pub fn clear(&mut self) {
        self.factor.clear();
    }
}
