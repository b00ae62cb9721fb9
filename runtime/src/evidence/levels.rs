//! Error levels of the joints, from the residuals of ordinary least squares.

use super::{Evidence, Triangle};

/// A joint's error is taken to be at least this share of its measurements: torque is never known
/// better, and simulated data without error would otherwise get infinite weights.
const FINEST: f64 = 1e-6;

/// Standard deviation of each joint's residual for the parameters `x` of the whole layout:
/// \\( \sigma_j = \|Y_j - W_j X\| / \sqrt{r_j} \\). Never zero, so that it can divide.
pub(super) fn error_levels(evidence: &Evidence, totals: &[Triangle], x: &[f64]) -> Vec<f64> {
    let root = |factor: &Triangle| (factor.rows().max(1) as f64).sqrt();
    let signal = |factor: &Triangle| factor.column_norm(factor.width() - 1) / root(factor);
    let largest = totals.iter().map(signal).fold(0.0, f64::max);
    let level = |(joint, factor): (usize, &Triangle)| {
        let residual = factor.residual(&evidence.seen(joint, x));
        let sigma = residual.iter().map(|rho| rho * rho).sum::<f64>().sqrt() / root(factor);
        let own = if signal(factor) > 0.0 {
            signal(factor)
        } else {
            largest
        };
        match sigma.max(FINEST * own) {
            0.0 => 1.0,
            positive => positive,
        }
    };
    totals.iter().enumerate().map(level).collect()
}
