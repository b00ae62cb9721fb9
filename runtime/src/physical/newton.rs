//! The minimum by damped Newton steps, while the weight of the description falls to what was asked.

use faer::prelude::Solve;
use faer::{Mat, Side};

use super::bodies::{divergence, value};
use super::pseudo::Square;
use super::{PhysicalError, Problem, Scalar};

/// At first the description counts as much as the data speak against it, and a tenth of that in
/// every further round: each begins where Newton's method converges fast.
const FALL: f64 = 0.1;

/// Steps of one round, and half the squared Newton decrement at which it ends, as a share of the
/// weight: the method converges quadratically there.
const STEPS: usize = 100;
const ENOUGH: f64 = 1e-12;

/// What free scalars are held to zero with, per unit squared, as a share of the weight; far below
/// what any log says of them.
const HELD: f64 = 1e-8;

/// The unknowns at the minimum, and the steps taken.
pub(super) fn minimum(problem: &Problem) -> Result<(Vec<f64>, usize), PhysicalError> {
    let solver = Solver::new(problem)?;
    let mut at = solver.start();
    let mut steps = 0;
    let against = problem.misfit(&problem.parameters(&at));
    let mut weight = against.max(problem.weight);
    loop {
        steps += solver.round(&mut at, weight)?;
        if weight <= problem.weight {
            return Ok((at, steps));
        }
        weight = (FALL * weight).max(problem.weight);
    }
}

/// What is added to a Hessian of unit diagonal that rounding has made indefinite.
const RIDGES: [f64; 6] = [0.0, 1e-15, 1e-13, 1e-11, 1e-9, 1e-7];

struct Solver<'a> {
    problem: &'a Problem,
    /// Inverse and log det of each described body.
    described: Vec<(Square, f64)>,
    /// K^T G K and K^T G X, with what is known beside.
    normal: Mat<f64>,
    right: Vec<f64>,
}

impl<'a> Solver<'a> {
    fn new(problem: &'a Problem) -> Result<Self, PhysicalError> {
        let described = problem.links.iter().enumerate().map(|(link, prior)| {
            prior.pseudo.inverse().ok_or(PhysicalError::Value {
                what: format!("the pseudo-inertia described for link {}", link + 1),
                value: f64::NAN,
                must: "positive definite",
            })
        });
        let described = described.collect::<Result<Vec<_>, _>>()?;
        let (normal, right) = normal_equations(problem);
        Ok(Solver {
            problem,
            described,
            normal,
            right,
        })
    }

    /// The description.
    fn start(&self) -> Vec<f64> {
        let links = self.problem.links.iter().flat_map(|p| p.pseudo.values());
        let scalars = self.problem.scalars.iter().map(|scalar| match scalar {
            Scalar::Positive(described) => *described,
            Scalar::Free => 0.0,
        });
        links.chain(scalars).collect()
    }

    /// Newton's method at one weight; the steps it took.
    fn round(&self, at: &mut Vec<f64>, weight: f64) -> Result<usize, PhysicalError> {
        for step in 0..STEPS {
            let no_end = PhysicalError::NoEnd { steps: step };
            let (gradient, hessian) = self.derivatives(at, weight).ok_or(no_end.clone())?;
            let direction = descent(&gradient, &hessian).ok_or(no_end.clone())?;
            let slope: f64 = gradient.iter().zip(&direction).map(|(g, d)| g * d).sum();
            if -0.5 * slope <= ENOUGH * weight {
                return Ok(step);
            }
            match self.along(at, &direction, slope, weight) {
                Some(next) => *at = next,
                // Rounding leaves nothing to gain.
                None => return Ok(step),
            }
        }
        Err(PhysicalError::NoEnd { steps: STEPS })
    }

    /// As far along a direction as the objective falls well.
    fn along(&self, at: &[f64], direction: &[f64], slope: f64, weight: f64) -> Option<Vec<f64>> {
        let here = self.value(at, weight)?;
        let mut length = 1.0;
        while length > 1e-12 {
            let next: Vec<f64> = at
                .iter()
                .zip(direction)
                .map(|(x, d)| x + length * d)
                .collect();
            let there = self.value(&next, weight);
            if there.is_some_and(|there| there < here + 1e-4 * length * slope) {
                return Some(next);
            }
            length *= 0.5;
        }
        None
    }

    fn links<'b>(&'b self, at: &'b [f64]) -> impl Iterator<Item = ([f64; 10], &'b (Square, f64))> {
        let links = at.chunks_exact(10).zip(&self.described);
        links.map(|(link, described)| (std::array::from_fn(|i| link[i]), described))
    }

    /// The objective; `None` outside of what exists.
    fn value(&self, at: &[f64], weight: f64) -> Option<f64> {
        let mut away = 0.0;
        for (link, described) in self.links(at) {
            away += value(&link, described)?;
        }
        let scalars = at.iter().skip(10 * self.described.len());
        for (x, scalar) in scalars.zip(&self.problem.scalars) {
            away += match scalar {
                Scalar::Positive(_) if *x <= 0.0 => return None,
                Scalar::Positive(described) => x / described - (x / described).ln() - 1.0,
                Scalar::Free => 0.5 * HELD * x * x,
            };
        }
        let known = self.problem.known.iter().map(|known| {
            let reached: f64 = known.factors.iter().map(|(k, f)| f * at[*k]).sum();
            0.5 * ((reached - known.value) / known.sigma).powi(2)
        });
        let misfit = self.problem.misfit(&self.problem.parameters(at));
        Some(misfit + known.sum::<f64>() + weight * away)
    }

    /// Gradient and Hessian.
    fn derivatives(&self, at: &[f64], weight: f64) -> Option<(Vec<f64>, Mat<f64>)> {
        let mut hessian = self.normal.clone();
        let mut gradient: Vec<f64> = (0..at.len())
            .map(|i| {
                (0..at.len())
                    .map(|k| self.normal[(i, k)] * at[k])
                    .sum::<f64>()
            })
            .zip(&self.right)
            .map(|(pull, right)| pull - right)
            .collect();
        for (place, (link, described)) in self.links(at).enumerate() {
            let divergence = divergence(&link, described)?;
            for i in 0..10 {
                gradient[10 * place + i] += weight * divergence.gradient[i];
                for k in 0..10 {
                    hessian[(10 * place + i, 10 * place + k)] += weight * divergence.hessian[i][k];
                }
            }
        }
        let first = 10 * self.described.len();
        for (place, scalar) in self.problem.scalars.iter().enumerate() {
            let (place, x) = (first + place, at[first + place]);
            let (slope, curve) = match scalar {
                Scalar::Positive(described) => (1.0 / described - 1.0 / x, 1.0 / (x * x)),
                Scalar::Free => (HELD * x, HELD),
            };
            gradient[place] += weight * slope;
            hessian[(place, place)] += weight * curve;
        }
        Some((gradient, hessian))
    }
}

/// K^T G K and K^T G X, and rows of what is known beside.
fn normal_equations(problem: &Problem) -> (Mat<f64>, Vec<f64>) {
    let (np, count) = (problem.estimate.len(), problem.unknowns());
    let mut normal = Mat::zeros(count, count);
    let mut right = vec![0.0; count];
    for i in 0..np {
        for k in 0..np {
            let g = problem.precision[i * np + k];
            for (a, fa) in &problem.map[i] {
                right[*a] += fa * g * problem.estimate[k];
                for (b, fb) in &problem.map[k] {
                    normal[(*a, *b)] += fa * g * fb;
                }
            }
        }
    }
    for known in &problem.known {
        let weight = known.sigma.powi(-2);
        for (a, fa) in &known.factors {
            right[*a] += weight * fa * known.value;
            for (b, fb) in &known.factors {
                normal[(*a, *b)] += weight * fa * fb;
            }
        }
    }
    (normal, right)
}

/// -H^-1 g, in units that make the diagonal of H one. Where a body all but vanishes, rounding may
/// take the definiteness away; the least that gives it back is added.
fn descent(gradient: &[f64], hessian: &Mat<f64>) -> Option<Vec<f64>> {
    let count = gradient.len();
    let scale: Vec<f64> = (0..count).map(|i| hessian[(i, i)].sqrt().recip()).collect();
    let right = Mat::from_fn(count, 1, |i, _| -scale[i] * gradient[i]);
    RIDGES.iter().find_map(|ridge| {
        let scaled = Mat::from_fn(count, count, |i, k| {
            let own = if i == k { *ridge } else { 0.0 };
            scale[i] * hessian[(i, k)] * scale[k] + own
        });
        let solution = scaled.llt(Side::Lower).ok()?.solve(&right);
        let direction: Vec<f64> = (0..count).map(|i| scale[i] * solution[(i, 0)]).collect();
        direction.iter().all(|d| d.is_finite()).then_some(direction)
    })
}
