//! The metric of the data: what the equations say about all parameters together.

use crate::estimate::Estimate;
use crate::evidence::Evidence;

/// The inverse covariance \\( W^T \Sigma^{-1} W \\) of np parameters for independent errors
/// (Gautier 1996, section 7.3), its lower triangle by rows: row k has k + 1 entries. Directions that the
/// data do not determine have none.
pub(super) fn precision(evidence: &Evidence, estimate: &Estimate) -> Vec<Vec<f64>> {
    let np = estimate.solution.len();
    let mut full = vec![vec![0.0; np]; np];
    let columns = &evidence.layout().joints;
    let weights = weights(evidence, estimate);
    for ((columns, total), weight) in columns.iter().zip(evidence.totals()).zip(weights) {
        for (k, a) in columns.iter().enumerate() {
            for (l, b) in columns.iter().enumerate().take(k + 1) {
                let product = |i: usize| total.entry(i, k) * total.entry(i, l);
                let sum: f64 = (0..=l).map(product).sum();
                full[*a.max(b)][*a.min(b)] += weight * sum;
            }
        }
    }
    for (k, row) in full.iter_mut().enumerate() {
        row.truncate(k + 1);
    }
    full
}

/// One over the variance of each joint's residual: of its own where joints were weighted,
/// otherwise of all together.
fn weights(evidence: &Evidence, estimate: &Estimate) -> Vec<f64> {
    let joints = evidence.layout().joints.len();
    if estimate.joint_sigma.len() == joints {
        return estimate.joint_sigma.iter().map(|s| s.powi(-2)).collect();
    }
    let residuals = evidence.residual_squares(&estimate.solution);
    let sum: f64 = residuals.iter().flatten().sum();
    let spare = estimate.rows.saturating_sub(estimate.rank).max(1);
    vec![spare as f64 / sum; joints]
}
