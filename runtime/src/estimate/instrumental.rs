//! Instrumental variables: unbiased where noise of the positions is in W (Janot, Vandanjon and
//! Gautier, "A generic instrumental variable approach for industrial robot identification", IEEE
//! Trans. Control Systems Technology 22, 2014).

use faer::Mat;
use faer::linalg::solvers::Solve;

use super::identifiable::{Identifiability, identifiability};
use super::triangle::{join, upper};
use super::weights::joint_sigma;
use super::{EstimateError, Triangle};
use crate::observe::Equations;

/// Estimate with instruments, beside the least squares on the same equations and weights.
#[derive(Clone, Debug)]
pub struct Instrumental {
    /// \\( X = (Z^T W)^{-1} Z^T Y \\), np values; what the instruments do not reach is zero.
    pub solution: Vec<f64>,
    /// Which parameters the instruments determine.
    pub determined: Vec<bool>,
    /// Standard deviations for independent errors:
    /// \\( \sigma^2_\rho (Z^T W)^{-1} Z^T Z (W^T Z)^{-1} \\).
    pub sigma: Vec<Option<f64>>,
    /// Error level of each joint by which its equations were divided.
    pub joint_sigma: Vec<f64>,
    /// Weighted least squares \\( (W^T W)^{-1} W^T Y \\) over the same columns.
    pub ordinary: Vec<f64>,
    /// What each row of the equations changes in the solution per unit of its error: by block, p
    /// values for each row.
    pub influence: Vec<Vec<f64>>,
    /// The same for the difference of least squares and this estimate.
    pub influence_of_difference: Vec<Vec<f64>>,
    /// The p columns that were solved for, ascending.
    pub columns: Vec<usize>,
}

/// Estimates np parameters from blocks of equations and instruments Z of the same shape, row by
/// row. Equations of each joint are divided by the standard deviation of their residual under
/// `start`.
///
/// Z is never multiplied with W: the triangular factor of `[Z | W | Y]` holds \\( Q^T W \\) and
/// \\( Q^T Y \\) with the orthogonal factor Q of Z, and \\( Q^T W X = Q^T Y \\) is what remains.
///
/// # Errors
/// [`EstimateError`]; [`EstimateError::Singular`] if the instruments say nothing of W, or have
/// another shape.
pub fn instrumental(
    blocks: &[Equations],
    instruments: &[Equations],
    np: usize,
    start: &[f64],
) -> Result<Instrumental, EstimateError> {
    let levels = joint_sigma(&Triangle::of_all(blocks)?, start);
    let factors: Vec<f64> = levels.iter().map(|level| 1.0 / level).collect();
    let pairs = || instruments.iter().zip(blocks);
    let reached = reached(pairs(), &factors, np)?;
    let columns = reached.independent.clone();
    let p = columns.len();
    let triangles = side_by_side(pairs(), &columns)?;
    let rows: usize = triangles.iter().map(|t| t.rows).sum();
    if rows <= p {
        return Err(EstimateError::TooFewEquations {
            rows,
            parameters: p,
        });
    }
    let solved = Solved::new(&upper(join(&triangles, &factors, 2 * p)), p)?;
    let level = residual(&triangles, &factors, &solved.x) / ((rows - p) as f64).sqrt();
    let sigma = |k: usize| level * solved.inverse.row(k).norm_l2();
    let gains = (&solved.instrument_gain, &solved.ordinary_gain);
    let influences = pairs()
        .zip(&factors)
        .map(|(pair, factor)| influences(pair, &columns, gains, factor * factor));
    let (influence, influence_of_difference) = influences.unzip();
    let mut estimate = Instrumental {
        solution: vec![0.0; np],
        determined: (0..np).map(|column| reached.determines(column)).collect(),
        sigma: vec![None; np],
        joint_sigma: levels,
        ordinary: vec![0.0; np],
        influence,
        influence_of_difference,
        columns,
    };
    for (k, &column) in estimate.columns.iter().enumerate() {
        estimate.solution[column] = solved.x[k];
        estimate.ordinary[column] = solved.ordinary[k];
        estimate.sigma[column] = estimate.determined[column].then(|| sigma(k));
    }
    Ok(estimate)
}

/// What the instruments determine.
fn reached<'a>(
    pairs: impl Iterator<Item = (&'a Equations, &'a Equations)>,
    factors: &[f64],
    np: usize,
) -> Result<Identifiability, EstimateError> {
    let all: Vec<usize> = (0..np).collect();
    let r = join(&side_by_side(pairs, &all)?, factors, 2 * np);
    let place = |k: usize| if k < np { k } else { 2 * np };
    let alone = Mat::from_fn(r.nrows(), np + 1, |i, k| r[(i, place(k))]);
    identifiability(&upper(alone), np)
}

/// Weighted norm of \\( Y - W X \\) from triangles of `[Z | W | Y]`.
fn residual(triangles: &[Triangle], factors: &[f64], x: &[f64]) -> f64 {
    let x: Vec<f64> = std::iter::repeat_n(0.0, x.len())
        .chain(x.iter().copied())
        .collect();
    let norms = triangles.iter().zip(factors);
    let squares = norms.map(|(t, factor)| (factor * t.residual_norm(&x)).powi(2));
    squares.sum::<f64>().sqrt()
}

/// Influence of the rows of a block on the estimate, and on the difference from least squares.
fn influences(
    (z, w): (&Equations, &Equations),
    columns: &[usize],
    (instrument, ordinary): (&Mat<f64>, &Mat<f64>),
    factor: f64,
) -> (Vec<f64>, Vec<f64>) {
    let own = rows_times(z, columns, instrument, factor);
    let other = rows_times(w, columns, ordinary, factor);
    let difference = other.iter().zip(&own).map(|(a, b)| a - b).collect();
    (own, difference)
}

/// Triangles of `[Z | W | Y]` of each block, over some columns of either.
fn side_by_side<'a>(
    pairs: impl Iterator<Item = (&'a Equations, &'a Equations)>,
    columns: &[usize],
) -> Result<Vec<Triangle>, EstimateError> {
    let one = |(block, (z, w)): (usize, (&Equations, &Equations))| {
        if z.rows != w.rows || z.columns != w.columns {
            // Not the same filters on the same samples: nothing can be said.
            return Err(EstimateError::Singular);
        }
        let place = |c: &usize| columns.binary_search(c).ok();
        let kept: Vec<(usize, usize)> = (w.columns.iter().enumerate())
            .filter_map(|(k, c)| Some((k, place(c)?)))
            .collect();
        let part = |from: &Equations| -> Vec<f64> {
            kept.iter()
                .flat_map(|(k, _)| from.column(*k).to_vec())
                .collect()
        };
        let both = Equations {
            columns: (kept.iter().map(|(_, place)| *place))
                .chain(kept.iter().map(|(_, place)| columns.len() + place))
                .collect(),
            rows: w.rows,
            w: [part(z), part(w)].concat(),
            y: w.y.clone(),
        };
        Triangle::new(&both, block, None)
    };
    pairs.enumerate().map(one).collect()
}

/// The small systems of both estimates.
struct Solved {
    x: Vec<f64>,
    ordinary: Vec<f64>,
    /// \\( (Q^T W)^{-1} \\).
    inverse: Mat<f64>,
    /// \\( (Z^T W)^{-1} \\) and \\( (W^T W)^{-1} \\).
    instrument_gain: Mat<f64>,
    ordinary_gain: Mat<f64>,
}

impl Solved {
    /// From the triangular factor of `[Z | W | Y]`.
    fn new(r: &Mat<f64>, p: usize) -> Result<Self, EstimateError> {
        let part = |first: usize, count: usize| Mat::from_fn(p, count, |i, k| r[(i, first + k)]);
        let w = upper(Mat::from_fn(r.nrows(), p + 1, |i, k| r[(i, p + k)]));
        let square = Mat::from_fn(p, p, |i, k| w[(i, k)]);
        let inverse = scaled_inverse(&part(p, p))?;
        let (z_inverse, w_inverse) = (scaled_inverse(&part(0, p))?, scaled_inverse(&square)?);
        let x = &inverse * part(2 * p, 1);
        let ordinary = &w_inverse * Mat::from_fn(p, 1, |i, _| w[(i, p)]);
        Ok(Solved {
            x: (0..p).map(|k| x[(k, 0)]).collect(),
            ordinary: (0..p).map(|k| ordinary[(k, 0)]).collect(),
            instrument_gain: &inverse * z_inverse.transpose(),
            ordinary_gain: &w_inverse * w_inverse.transpose(),
            inverse,
        })
    }
}

/// Inverse of a square matrix whose columns come in different units.
fn scaled_inverse(matrix: &Mat<f64>) -> Result<Mat<f64>, EstimateError> {
    let p = matrix.nrows();
    let norms: Vec<f64> = (0..p).map(|k| matrix.col(k).norm_l2()).collect();
    let scaled = Mat::from_fn(p, p, |i, k| matrix[(i, k)] / norms[k]);
    let unit = Mat::<f64>::identity(p, p);
    let inverse = scaled.full_piv_lu().solve(&unit);
    let inverse = Mat::from_fn(p, p, |i, k| inverse[(i, k)] / norms[i]);
    let finite = (0..p).all(|k| inverse.col(k).norm_l2().is_finite());
    if finite {
        Ok(inverse)
    } else {
        Err(EstimateError::Singular)
    }
}

/// For each row of a block, gain times the row's entries, times `factor`: p values a row.
fn rows_times(block: &Equations, columns: &[usize], gain: &Mat<f64>, factor: f64) -> Vec<f64> {
    let p = columns.len();
    let mut out = vec![0.0; block.rows * p];
    for (k, column) in block.columns.iter().enumerate() {
        let Ok(place) = columns.binary_search(column) else {
            continue;
        };
        for (row, value) in out.chunks_exact_mut(p).zip(block.column(k)) {
            for (i, sum) in row.iter_mut().enumerate() {
                *sum += gain[(i, place)] * value * factor;
            }
        }
    }
    out
}

/// Standard deviations of sums over time of `influence` times the `errors` of the blocks, when
/// errors remember each other and joints are disturbed together, with their degrees of freedom:
/// equal-weighted cosines over time blocks (Lazarus et al. 2018, as in
/// [`crate::evidence::Evidence::corrected`]). `None` for too few rows.
pub fn long_run(influence: &[Vec<f64>], errors: &[Vec<f64>], p: usize) -> Option<(Vec<f64>, f64)> {
    const BLOCKS: usize = 32;
    const COSINES: usize = 10;
    let rows = errors.first().map_or(0, Vec::len);
    if rows < 2 * BLOCKS || rows <= p {
        return None;
    }
    let mut sums = vec![vec![0.0; p]; BLOCKS];
    for (influence, errors) in influence.iter().zip(errors) {
        for (t, (row, error)) in influence.chunks_exact(p).zip(errors).enumerate() {
            let sum = &mut sums[t * BLOCKS / rows];
            sum.iter_mut()
                .zip(row)
                .for_each(|(sum, x)| *sum += x * error);
        }
    }
    // Residuals are smaller than errors by what the parameters took.
    let total: usize = errors.iter().map(Vec::len).sum();
    let spare = total as f64 / (total.saturating_sub(p)).max(1) as f64;
    let cosine = |c: usize, b: usize| {
        let angle = std::f64::consts::PI * (c + 1) as f64 * (b as f64 + 0.5) / BLOCKS as f64;
        2f64.sqrt() * angle.cos()
    };
    let square = |k: usize| {
        let parts = (0..COSINES).map(|c| {
            let sum: f64 = (0..BLOCKS).map(|b| cosine(c, b) * sums[b][k]).sum();
            sum * sum
        });
        parts.sum::<f64>() / COSINES as f64
    };
    let sigma = (0..p).map(|k| (spare * square(k)).sqrt()).collect();
    Some((sigma, COSINES as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniform numbers in -1..1 (SplitMix64).
    fn noise(seed: u64, len: usize) -> Vec<f64> {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        (0..len).map(|_| next()).collect()
    }

    /// A noisy column and its noise-free instrument, in two blocks.
    fn systems(size: f64) -> (Vec<Equations>, Vec<Equations>) {
        let rows = 4000;
        let make = |seed: u64| {
            let series = |s: u64| noise(seed * 10 + s, rows);
            let clean = [series(1), series(2)];
            let y: Vec<f64> = (0..rows)
                .map(|t| 2.0 * clean[0][t] - 3.0 * clean[1][t] + 0.1 * series(5)[t])
                .collect();
            let column = |k: usize, noise: &[f64]| -> Vec<f64> {
                clean[k]
                    .iter()
                    .zip(noise)
                    .map(|(x, e)| x + size * e)
                    .collect()
            };
            let of = |w: Vec<f64>| Equations {
                columns: vec![0, 1],
                rows,
                w,
                y: Some(y.clone()),
            };
            let noisy = [column(0, &series(3)), column(1, &series(4))].concat();
            (of(noisy), of(clean.concat()))
        };
        [make(1), make(2)].into_iter().unzip()
    }

    #[test]
    fn instruments_remove_the_bias_of_noisy_columns() {
        let (w, z) = systems(0.5);
        let found = instrumental(&w, &z, 2, &[2.0, -3.0]).unwrap();
        for (k, truth) in [2.0, -3.0].into_iter().enumerate() {
            let sigma = found.sigma[k].unwrap();
            assert!((found.solution[k] - truth).abs() < 4.0 * sigma, "{found:?}");
            assert!((found.ordinary[k] - truth).abs() > 10.0 * sigma);
        }
    }

    #[test]
    fn noise_free_instruments_are_least_squares() {
        let (w, _) = systems(0.0);
        let found = instrumental(&w, &w, 2, &[0.0, 0.0]).unwrap();
        for k in 0..2 {
            assert!((found.solution[k] - found.ordinary[k]).abs() < 1e-12);
        }
        assert!(
            found
                .influence_of_difference
                .iter()
                .flatten()
                .all(|x| x.abs() < 1e-12)
        );
    }

    #[test]
    fn influence_times_measurements_is_the_estimate() {
        let (w, z) = systems(0.3);
        let found = instrumental(&w, &z, 2, &[0.0, 0.0]).unwrap();
        let mut sums = [0.0; 2];
        for (influence, block) in found.influence.iter().zip(&w) {
            for (row, y) in influence.chunks_exact(2).zip(block.y.as_ref().unwrap()) {
                sums[0] += row[0] * y;
                sums[1] += row[1] * y;
            }
        }
        for (sum, x) in sums.iter().zip(&found.solution) {
            assert!((sum - x).abs() < 1e-10);
        }
    }

    #[test]
    fn long_run_sigma_of_white_errors_is_the_classical_one() {
        const LOGS: u64 = 60;
        let ratio = |log: u64| {
            let (influence, errors) = (noise(1000 + log, 4000), noise(9000 + 7 * log, 4000));
            let square = influence.iter().zip(&errors).map(|(a, b)| (a * b).powi(2));
            let square: f64 = square.sum();
            let (sigma, dof) = long_run(&[influence], &[errors], 1).unwrap();
            assert!(dof > 5.0);
            sigma[0].powi(2) / square
        };
        let mean = (0..LOGS).map(ratio).sum::<f64>() / LOGS as f64;
        // It scatters by sqrt(2 / dof / logs) = 6 %.
        assert!((mean - 1.0).abs() < 0.2, "{mean}");
    }
}
