//! How the equations of different joints are weighted.

use super::Triangle;

/// A joint's error is taken to be at least this share of its measurements: torque is never known
/// better, and simulated data without error would otherwise get infinite weights.
const FINEST: f64 = 1e-6;

/// Standard deviation of the residual of each block, from the residual of ordinary least squares:
/// \\( \sigma_j = \|Y_j - W_j X\| / \sqrt{r_j} \\). Never zero, so that it can divide.
pub(super) fn joint_sigma(triangles: &[Triangle], parameters: &[f64]) -> Vec<f64> {
    let root = |t: &Triangle| (t.rows.max(1) as f64).sqrt();
    let level = |t: &Triangle| t.measurement_norm() / root(t);
    let sigma = |t: &Triangle| t.residual_norm(parameters) / root(t);
    let largest = triangles.iter().map(level).fold(0.0, f64::max);
    triangles
        .iter()
        .map(|t| positive(sigma(t), level(t), largest))
        .collect()
}

/// An error level that can divide: at least [`FINEST`] of the block's measurements, or of the
/// largest of all blocks if it has none, or 1 if nobody has any.
pub(super) fn positive(sigma: f64, level: f64, largest: f64) -> f64 {
    let own = if level > 0.0 { level } else { largest };
    match sigma.max(FINEST * own) {
        0.0 => 1.0,
        positive => positive,
    }
}
