//! The triangular factor of a block of equations, all that least squares needs to know of it.

use faer::{Mat, MatRef};
use rayon::prelude::*;

use super::EstimateError;
use crate::observe::Equations;

/// Rows that are triangularised at once: few enough to stay in cache.
const ROWS: usize = 1024;

/// A system with no more rows is left as it is: the last step, which is the most careful one,
/// then is the only one that rounds.
const FEW: usize = 128;

/// Triangular factor of `[W | Y]` of a block of equations: with it
/// \\( \|Y - W X\| = \|R_{[W|Y]} (X; -1)\| \\) for every X.
#[derive(Clone, Debug)]
pub struct Triangle {
    /// The parameters that the block can see, ascending.
    pub columns: Vec<usize>,
    /// Equations that went into the factor.
    pub rows: usize,
    /// Upper trapezoidal factor of `[W | Y]`, at most `columns.len() + 1` rows; or `[W | Y]` itself
    /// if it has few rows.
    r: Mat<f64>,
}

impl Triangle {
    /// The triangles of all blocks.
    ///
    /// # Errors
    /// [`EstimateError::NoMeasurements`], [`EstimateError::NotFinite`].
    pub fn of_all(blocks: &[Equations]) -> Result<Vec<Self>, EstimateError> {
        let each = blocks.iter().enumerate();
        each.map(|(block, equations)| Triangle::new(equations, block, None))
            .collect()
    }

    /// Reduces the equations of block `block` (from 0, for messages), each row multiplied by its
    /// factor in `factors` if there are any.
    ///
    /// # Errors
    /// [`EstimateError::NoMeasurements`], [`EstimateError::NotFinite`].
    pub fn new(
        equations: &Equations,
        block: usize,
        factors: Option<&[f64]>,
    ) -> Result<Self, EstimateError> {
        let block = block + 1;
        let y = equations
            .y
            .as_deref()
            .ok_or(EstimateError::NoMeasurements { block })?;
        check(equations, y, block)?;
        let width = equations.columns.len() + 1;
        let starts: Vec<usize> = (0..equations.rows).step_by(ROWS).collect();
        let parts: Vec<Mat<f64>> = starts
            .into_par_iter()
            .map(|start| {
                let rows = ROWS.min(equations.rows - start);
                upper_of_many(Mat::from_fn(rows, width, |i, k| {
                    let row = start + i;
                    let value = if k + 1 < width {
                        equations.column(k)[row]
                    } else {
                        y[row]
                    };
                    value * factors.map_or(1.0, |factors| factors[row])
                }))
            })
            .collect();
        let r = parts.into_iter().reduce(|a, b| upper(stack(&a, &b)));
        Ok(Triangle {
            columns: equations.columns.clone(),
            rows: equations.rows,
            r: r.unwrap_or_else(|| Mat::zeros(0, width)),
        })
    }

    /// From a factor that was made elsewhere: `entry(i, k)` of the upper triangle of `rows`
    /// equations over `columns` and the measurements.
    pub fn from_upper(
        columns: Vec<usize>,
        rows: usize,
        entry: impl Fn(usize, usize) -> f64,
    ) -> Self {
        let width = columns.len() + 1;
        let r = Mat::from_fn(width, width, |i, k| if i <= k { entry(i, k) } else { 0.0 });
        Triangle { columns, rows, r }
    }

    /// \\( \|Y - W X\| \\) for parameters X of the whole model.
    pub fn residual_norm(&self, parameters: &[f64]) -> f64 {
        let last = self.columns.len();
        let row = |i: usize| {
            let product = self.columns.iter().enumerate();
            let sum: f64 = product.map(|(k, c)| self.r[(i, k)] * parameters[*c]).sum();
            self.r[(i, last)] - sum
        };
        (0..self.r.nrows())
            .map(|i| row(i).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// \\( \|Y\| \\).
    pub fn measurement_norm(&self) -> f64 {
        self.r.col(self.columns.len()).norm_l2()
    }
}

/// Stacks the factors of several blocks, each multiplied by its factor, over all `np` parameters
/// and the measurements, and triangularises again unless they are few: `[W | Y]` of the whole
/// system.
pub(super) fn join(triangles: &[Triangle], factors: &[f64], np: usize) -> Mat<f64> {
    let rows = triangles.iter().map(|t| t.r.nrows()).sum();
    let mut all = Mat::zeros(rows, np + 1);
    let mut start = 0;
    for (triangle, factor) in triangles.iter().zip(factors) {
        let places = triangle.columns.iter().copied().chain([np]);
        for (k, place) in places.enumerate() {
            for i in 0..triangle.r.nrows() {
                all[(start + i, place)] = triangle.r[(i, k)] * factor;
            }
        }
        start += triangle.r.nrows();
    }
    upper_of_many(all)
}

/// A factor that is triangular unless the matrix has few rows.
fn upper_of_many(matrix: Mat<f64>) -> Mat<f64> {
    if matrix.nrows() <= FEW {
        matrix
    } else {
        upper(matrix)
    }
}

/// Whether all below the diagonal is zero.
pub(super) fn is_upper(matrix: &Mat<f64>) -> bool {
    (0..matrix.ncols()).all(|k| (k + 1..matrix.nrows()).all(|i| matrix[(i, k)] == 0.0))
}

/// Upper trapezoidal factor of the QR decomposition, with zeros below. A matrix that has this
/// form already is its own factor, without another round of rounding.
pub(super) fn upper(matrix: Mat<f64>) -> Mat<f64> {
    let columns = matrix.ncols();
    if is_upper(&matrix) {
        let rows = matrix.nrows().min(columns);
        return Mat::from_fn(rows, columns, |i, k| matrix[(i, k)]);
    }
    let qr = matrix.qr();
    let r: MatRef<'_, f64> = qr.thin_R();
    Mat::from_fn(
        r.nrows(),
        columns,
        |i, k| if i <= k { r[(i, k)] } else { 0.0 },
    )
}

fn stack(a: &Mat<f64>, b: &Mat<f64>) -> Mat<f64> {
    let row = |i: usize, k: usize| {
        if i < a.nrows() {
            a[(i, k)]
        } else {
            b[(i - a.nrows(), k)]
        }
    };
    Mat::from_fn(a.nrows() + b.nrows(), a.ncols(), row)
}

fn check(equations: &Equations, y: &[f64], block: usize) -> Result<(), EstimateError> {
    if let Some(row) = y.iter().position(|y| !y.is_finite()) {
        return Err(EstimateError::NotFinite {
            what: "the measurement",
            block,
            row,
        });
    }
    match equations.w.iter().position(|w| !w.is_finite()) {
        Some(place) => {
            let row = place % equations.rows.max(1);
            Err(EstimateError::NotFinite {
                what: "the regressor",
                block,
                row,
            })
        }
        None => Ok(()),
    }
}
