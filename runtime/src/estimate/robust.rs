//! Robust weights: iteratively reweighted least squares after Huber (1964).

use super::least_squares::solve;
use super::weights::positive;
use super::{Estimate, EstimateError, Triangle};
use crate::observe::Equations;

/// Residuals beyond this many standard deviations count linearly: 95 % efficiency for normal
/// errors (Huber 1981).
const TUNING: f64 = 1.345;

/// Median absolute deviation of a normal distribution, in standard deviations.
const MEDIAN_OF_NORMAL: f64 = 0.674_489_750_196_081_7;

/// The weights settle geometrically; glitches are found in the first few rounds.
const ROUNDS: usize = 50;

/// Relative change of the parameters at which the rounds stop.
const SETTLED: f64 = 1e-9;

/// Goes on from `start` with a weight per row: 1 for residuals within [`TUNING`] standard
/// deviations of their block, falling with the residual beyond. The scale of a block is the
/// median absolute deviation of its residuals. Standard deviations are those of the final
/// weighted system. Returned with the factors of the rows of each block, roots of their weights.
pub(super) fn huber(
    blocks: &[Equations],
    start: Estimate,
    np: usize,
) -> Result<(Estimate, Vec<Vec<f64>>), EstimateError> {
    let (mut estimate, mut row_factors) = reweighted(blocks, &start.solution, np)?;
    let mut change = distance(&estimate.solution, &start.solution);
    for _ in 1..ROUNDS {
        if change < SETTLED {
            break;
        }
        let next = reweighted(blocks, &estimate.solution, np)?;
        change = distance(&next.0.solution, &estimate.solution);
        (estimate, row_factors) = next;
    }
    Ok((estimate, row_factors))
}

/// One round: weights from the residuals of `parameters`, then least squares.
fn reweighted(
    blocks: &[Equations],
    parameters: &[f64],
    np: usize,
) -> Result<(Estimate, Vec<Vec<f64>>), EstimateError> {
    let residuals: Vec<Vec<f64>> = blocks.iter().map(|b| b.residual(parameters)).collect();
    let scales = scales(&residuals, blocks);
    let of_block = |(residuals, scale): (&Vec<f64>, &f64)| {
        let factors = residuals.iter().map(|rho| row_factor(rho / scale));
        factors.collect::<Vec<f64>>()
    };
    let row_factors: Vec<Vec<f64>> = residuals.iter().zip(&scales).map(of_block).collect();
    let triangles = blocks
        .iter()
        .zip(&row_factors)
        .enumerate()
        .map(|(block, (equations, factors))| Triangle::new(equations, block, Some(factors)))
        .collect::<Result<Vec<_>, _>>()?;
    let factors: Vec<f64> = scales.iter().map(|scale| 1.0 / scale).collect();
    let estimate = Estimate {
        joint_sigma: scales,
        ..solve(&triangles, &factors, np)?
    };
    Ok((estimate, row_factors))
}

/// Factors of the rows of a block for the residuals of `parameters` and the block's scale, as the
/// last round has them.
pub fn row_factors(block: &Equations, parameters: &[f64], scale: f64) -> Vec<f64> {
    let residuals = block.residual(parameters).into_iter();
    residuals.map(|rho| row_factor(rho / scale)).collect()
}

/// Square root of Huber's weight of a residual in standard deviations.
fn row_factor(rho: f64) -> f64 {
    (TUNING / rho.abs().max(TUNING)).sqrt()
}

/// Robust standard deviation of each block's residuals; never zero.
fn scales(residuals: &[Vec<f64>], blocks: &[Equations]) -> Vec<f64> {
    let level = |block: &Equations| median_magnitude(block.y.as_deref().unwrap_or_default());
    let largest = blocks.iter().map(level).fold(0.0, f64::max);
    let scale = |(rho, block): (&Vec<f64>, &Equations)| {
        positive(
            median_magnitude(rho) / MEDIAN_OF_NORMAL,
            level(block),
            largest,
        )
    };
    residuals.iter().zip(blocks).map(scale).collect()
}

fn median_magnitude(values: &[f64]) -> f64 {
    let mut magnitudes: Vec<f64> = values.iter().map(|x| x.abs()).collect();
    magnitudes.sort_unstable_by(f64::total_cmp);
    magnitudes.get(magnitudes.len() / 2).copied().unwrap_or(0.0)
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    let norm = |values: &mut dyn Iterator<Item = f64>| values.map(|x| x * x).sum::<f64>().sqrt();
    let difference = norm(&mut a.iter().zip(b).map(|(a, b)| a - b));
    difference / norm(&mut a.iter().copied()).max(f64::MIN_POSITIVE)
}
