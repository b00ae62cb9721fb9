//! What each time block says about an estimate, in coordinates in which all blocks together are
//! the identity.

use faer::{Col, Mat};
use rayon::prelude::*;

use super::{Evidence, Fit};

/// Contributions of the time blocks to an estimate of p independent parameters. With the weighted
/// \\( W = Q R \\) and \\( Q_b \\) the rows of block b, all joints together:
/// \\( \sum_b Q_b^T Q_b = I \\), and \\( \hat X = X + R^{-1} \sum_b Q_b^T \rho_b \\).
/// Residuals of different joints at the same time add up within a block before anything is
/// squared, so their correlation is respected.
pub(super) struct Scores {
    /// \\( Q_b^T Q_b \\), p x p: the share of the information that block b holds.
    pub shares: Vec<Mat<f64>>,
    /// \\( Q_b^T (Y_b - W_b \hat X) \\), p values; their sum is zero.
    pub scores: Vec<Col<f64>>,
}

impl Scores {
    /// Of all blocks, for a fit of the same evidence.
    pub fn new(evidence: &Evidence, fit: &Fit) -> Self {
        let blocks = (0..evidence.blocks()).into_par_iter();
        let (shares, scores) = blocks.map(|block| of_block(evidence, fit, block)).unzip();
        Scores { shares, scores }
    }
}

fn of_block(evidence: &Evidence, fit: &Fit, block: usize) -> (Mat<f64>, Col<f64>) {
    let p = fit.reduced.columns.len();
    let mut share = Mat::zeros(p, p);
    let mut score = Col::zeros(p);
    for (joint, factor) in evidence.factors(block).iter().enumerate() {
        let weight = 1.0 / fit.joint_sigma[joint];
        let places = evidence.layout.places(joint, &fit.reduced.columns);
        let columns = factor.width() - 1;
        let mut w = Mat::zeros(columns, p);
        for (k, place) in places[..columns].iter().enumerate() {
            let Some(place) = *place else { continue };
            for i in 0..=k {
                w[(i, place)] = factor.entry(i, k) * fit.reduced.scale[place] * weight;
            }
        }
        let residual = factor.residual(&evidence.seen(joint, &fit.solution));
        let rho = Col::from_fn(columns, |i| residual[i] * weight);
        let q = w * &fit.reduced.inverse;
        share += q.transpose() * &q;
        score += q.transpose() * rho;
    }
    (share, score)
}
