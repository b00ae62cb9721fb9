//! What an identification along a motion can be expected to know.

use faer::prelude::Solve;
use faer::{Mat, Side};
use serde::Serialize;

use super::regressor::Regressor;
use super::space::Path;

/// Instants that are evaluated at once.
const BLOCK: usize = 256;

/// Noise of the torque: white, independent between joints.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Noise {
    /// Standard deviation of one sample of each joint, N m or N.
    pub sigma: Vec<f64>,
    /// Samples per second, Hz.
    pub rate_hz: f64,
}

/// W'W along a path, block by block; rows weighted as the regressor says.
pub(super) fn gram(regressor: &Regressor<'_>, path: &Path, columns: usize) -> Mat<f64> {
    let joints = path.q.len() / path.len.max(1);
    let mut gram = Mat::zeros(columns, columns);
    for start in (0..path.len).step_by(BLOCK) {
        let len = BLOCK.min(path.len - start);
        let cut = |series: &[f64]| -> Vec<f64> {
            (0..joints)
                .flat_map(|joint| &series[joint * path.len + start..][..len])
                .copied()
                .collect()
        };
        let block = Path {
            len,
            q: cut(&path.q),
            qd: cut(&path.qd),
            qdd: cut(&path.qdd),
        };
        let w = regressor.matrix(&regressor.evaluate(&block), len);
        gram += w.transpose() * &w;
    }
    gram
}

/// Diagonal of the inverse, and for each column the share of its norm that the others do not
/// explain; through columns of unit norm, so that units do not cost digits. `None` if singular.
pub(super) fn inverse(gram: &Mat<f64>) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = gram.nrows();
    let norm: Vec<f64> = (0..n).map(|i| gram[(i, i)].sqrt()).collect();
    if !norm.iter().all(|norm| *norm > 0.0) {
        return None;
    }
    let unit = Mat::from_fn(n, n, |i, k| gram[(i, k)] / (norm[i] * norm[k]));
    let inverse = unit
        .llt(Side::Lower)
        .ok()?
        .solve(Mat::<f64>::identity(n, n));
    let diagonal = (0..n).map(|i| inverse[(i, i)] / (norm[i] * norm[i]));
    let alone = (0..n).map(|i| inverse[(i, i)].recip().sqrt());
    Some((diagonal.collect(), alone.collect()))
}

/// Condition number of W as it is, and with columns of unit norm.
pub(super) fn conditions(w: &Mat<f64>) -> Option<(f64, f64)> {
    let norms: Vec<f64> = (0..w.ncols()).map(|k| w.col(k).norm_l2()).collect();
    let unit = Mat::from_fn(w.nrows(), w.ncols(), |i, k| w[(i, k)] / norms[k]);
    Some((condition(w)?, condition(&unit)?))
}

fn condition(w: &Mat<f64>) -> Option<f64> {
    let singular = w.singular_values().ok()?;
    let (first, last) = singular.first().zip(singular.last())?;
    Some(first / last)
}
