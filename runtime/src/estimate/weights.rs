//! How the equations of different joints are weighted.

use super::Triangle;

/// Error level below which a block counts as exact, relative to the measurements of all blocks.
const EXACT: f64 = 1e-10;

/// Standard deviation of the residual of each block, from the residual of ordinary least squares:
/// \\( \sigma_j = \|Y_j - W_j X\| / \sqrt{r_j} \\). Never zero, so that it can divide.
pub(super) fn joint_sigma(triangles: &[Triangle], parameters: &[f64]) -> Vec<f64> {
    let rows: usize = triangles.iter().map(|t| t.rows).sum();
    let square: f64 = triangles.iter().map(|t| t.measurement_norm().powi(2)).sum();
    let level = (square / rows.max(1) as f64).sqrt();
    let floor = if level > 0.0 { EXACT * level } else { 1.0 };
    let sigma = |t: &Triangle| t.residual_norm(parameters) / (t.rows.max(1) as f64).sqrt();
    triangles.iter().map(|t| sigma(t).max(floor)).collect()
}
