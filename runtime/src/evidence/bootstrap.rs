//! Block bootstrap: the spread of estimates over resampled time blocks.

use faer::prelude::Solve;
use faer::{Col, Mat, Side};
use rayon::prelude::*;

use super::covariance::Covariance;
use super::scores::Scores;
use super::{Evidence, EvidenceError, Fit};

/// Resamples whose least determined direction keeps less than this share of its information are
/// left out: their estimate is an extrapolation.
const LEAST_SHARE: f64 = 1e-4;

/// How to resample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resampling {
    /// Number of resamples.
    pub replications: usize,
    /// Neighbouring blocks that are drawn together, at any place (moving blocks, around the end:
    /// Künsch 1989, Politis and Romano 1992); 1 if residuals forget within a block.
    pub run: usize,
    /// Seed: the same seed gives the same result, on any number of threads.
    pub seed: u64,
}

impl Default for Resampling {
    /// 999 resamples, which know a standard deviation to 2 %, of runs of two blocks.
    fn default() -> Self {
        Resampling {
            replications: 999,
            run: 2,
            seed: 1,
        }
    }
}

/// Result of a block bootstrap.
#[derive(Clone, Debug, PartialEq)]
pub struct Bootstrap {
    /// Spread of the estimates, times n / (n - 1) for n independent draws per resample: resampled
    /// residuals are smaller than errors. Degrees of freedom n - 1.
    pub covariance: Covariance,
    /// Resamples left out because they determine a parameter badly or not at all. Many of them
    /// mean that some parameters hang on a few time blocks.
    pub discarded: usize,
}

impl Evidence {
    /// Covariance of an estimate of this evidence by resampling time blocks with replacement and
    /// solving anew each time, with the weights of the fit. Residuals of all joints in a block
    /// stay together, and so does their correlation.
    ///
    /// # Errors
    /// [`EvidenceError::TooFewBlocks`] for fewer than two runs of blocks, or if every resample
    /// was left out.
    pub fn bootstrap(
        &self,
        fit: &Fit,
        resampling: &Resampling,
    ) -> Result<Bootstrap, EvidenceError> {
        let run = resampling.run.max(1);
        let (blocks, purpose) = (self.blocks(), "the block bootstrap");
        let too_few = |needs| EvidenceError::TooFewBlocks {
            purpose,
            needs,
            blocks,
        };
        if blocks / run < 2 {
            return Err(too_few(2 * run));
        }
        let scores = Scores::new(self, fit);
        let changes: Vec<Option<Col<f64>>> = (0..resampling.replications)
            .into_par_iter()
            .map(|k| change(&scores, &draw(blocks, run, resampling.seed, k as u64)))
            .collect();
        let kept: Vec<&Col<f64>> = changes.iter().flatten().collect();
        if kept.len() < 2 {
            return Err(too_few(blocks + 1));
        }
        let draws = blocks as f64 / run as f64;
        let spread = spread(&kept, &fit.reduced.inverse, draws / (draws - 1.0));
        let dof = vec![draws - 1.0; spread.nrows()];
        Ok(Bootstrap {
            covariance: Covariance::of(fit, &spread, &dof),
            discarded: changes.len() - kept.len(),
        })
    }
}

/// How often each block is in resample `replication`.
fn draw(blocks: usize, run: usize, seed: u64, replication: u64) -> Vec<f64> {
    let mut times = vec![0.0; blocks];
    let mut state = mix(seed).wrapping_add(mix(replication.wrapping_add(1)));
    let mut left = blocks;
    while left > 0 {
        state = state.wrapping_add(GOLDEN);
        let first = ((u128::from(mix(state)) * blocks as u128) >> 64) as usize;
        let taken = run.min(left);
        (0..taken).for_each(|k| times[(first + k) % blocks] += 1.0);
        left -= taken;
    }
    times
}

/// Increment of the generator SplitMix64 (Steele, Lea and Flood 2014): 2^64 over the golden ratio.
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// Output function of SplitMix64.
fn mix(state: u64) -> u64 {
    let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// Change of the estimate when block b counts `times[b]` times, in the coordinates of the scores:
/// there all blocks together are the identity, so normal equations lose nothing.
fn change(scores: &Scores, times: &[f64]) -> Option<Col<f64>> {
    let p = scores.scores.first()?.nrows();
    let mut information = Mat::<f64>::zeros(p, p);
    let mut score = Col::<f64>::zeros(p);
    for (b, times) in times.iter().enumerate().filter(|(_, times)| **times > 0.0) {
        information += faer::Scale(*times) * &scores.shares[b];
        score += faer::Scale(*times) * &scores.scores[b];
    }
    let cholesky = information.llt(Side::Lower).ok()?;
    let pivots = cholesky.L().diagonal().column_vector();
    let determined = pivots.iter().all(|pivot| pivot * pivot > LEAST_SHARE);
    determined.then(|| cholesky.solve(&score))
}

/// Covariance of the scaled parameters over the resamples, times `factor`.
fn spread(changes: &[&Col<f64>], inverse: &Mat<f64>, factor: f64) -> Mat<f64> {
    let (p, n) = (inverse.nrows(), changes.len());
    let all = inverse * Mat::from_fn(p, n, |i, k| changes[k][i]);
    let mean: Vec<f64> = (0..p)
        .map(|i| all.row(i).iter().sum::<f64>() / n as f64)
        .collect();
    let centred = Mat::from_fn(p, n, |i, k| all[(i, k)] - mean[i]);
    let factor = factor / (n - 1) as f64;
    faer::Scale(factor) * (&centred * centred.transpose())
}
