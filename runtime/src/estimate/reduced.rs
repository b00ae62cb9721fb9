//! Solution, standard deviations and sensitivity from a triangular factor.

use faer::Mat;

use super::EstimateError;
use super::double::accurate_dot;
use super::orthogonal::{CAREFUL, Orthogonal, power_of_two};
use super::triangle::is_upper;

/// The system over independent columns, scaled by powers of two so that columns in different
/// units meet with norms near one, without any rounding.
pub(super) struct Reduced {
    /// Upper triangular factor of W over the scaled columns, and Q'Y as its last column; row i
    /// without its weight.
    r: Mat<f64>,
    /// What the rows are to be multiplied by.
    weight: Vec<f64>,
    /// The column at each place of the factor.
    order: Vec<usize>,
    /// What each column was multiplied by.
    scale: Vec<f64>,
    /// Norm of the residual.
    residual: f64,
}

impl Reduced {
    /// From any factor of `[W | Y]`: an upper triangle over all columns is taken as it is, without
    /// another round of rounding.
    pub fn new(full: &Mat<f64>, columns: &[usize]) -> Self {
        let last = full.ncols() - 1;
        if columns.len() == last && full.nrows() >= last && is_upper(full) {
            return Self::of_triangle(full);
        }
        let column = |c: usize| full.col(c).iter().copied().collect::<Vec<f64>>();
        let w = columns.iter().map(|c| column(*c)).collect();
        Self::of(&Orthogonal::new(w, CAREFUL), column(last))
    }

    fn of_triangle(full: &Mat<f64>) -> Self {
        let np = full.ncols() - 1;
        let norms = (0..np).map(|c| full.col(c).norm_l2());
        let scale: Vec<f64> = norms.map(power_of_two).collect();
        Reduced {
            r: Mat::from_fn(np, np + 1, |i, k| {
                full[(i, k)] * scale.get(k).copied().unwrap_or(1.0)
            }),
            weight: vec![1.0; np],
            order: (0..np).collect(),
            residual: match full.nrows() > np {
                true => full[(np, np)].abs(),
                false => 0.0,
            },
            scale,
        }
    }

    /// From the factor of W and the measurements Y.
    pub fn of(factor: &Orthogonal, mut y: Vec<f64>) -> Self {
        let shares = factor.project(&mut y);
        let np = shares.len();
        Reduced {
            r: Mat::from_fn(np, np + 1, |i, k| match k == np {
                true => shares[i],
                false => factor.unit(i, k),
            }),
            weight: factor.norms(),
            order: factor.order().to_vec(),
            scale: factor.scale().to_vec(),
            residual: accurate_dot(&y, &y).sqrt(),
        }
    }

    /// Back substitution.
    pub fn solution(&self) -> Vec<f64> {
        let np = self.scale.len();
        let mut x = vec![0.0; np];
        for i in (0..np).rev() {
            let sum: f64 = (i + 1..np).map(|k| self.r[(i, k)] * x[k]).sum();
            x[i] = (self.r[(i, np)] - sum) / self.r[(i, i)];
        }
        self.placed(|place| x[place])
    }

    /// Standard deviations: the row norms of the inverse factor times the residual's.
    pub fn sigma(&self, spare: usize) -> Vec<f64> {
        let norms = row_norms(&self.inverse());
        let sigma_rho = self.residual / (spare as f64).sqrt();
        self.placed(|place| sigma_rho * norms[place])
    }

    /// How much each parameter changes at most, to first order, per relative change of all
    /// entries of W and Y (Golub and Wilkinson 1966; Wedin 1973):
    /// \\( \|P_k\| (\|Y\| + \sum_j \|W_j\| |x_j|) + \sum_j |P P^T|_{kj} \|W_j\| \|\rho\| \\) with the
    /// rows P_k of the inverse factor and the columns W_j of W. `solution` as from
    /// [`Reduced::solution`].
    pub fn sensitivity(&self, solution: &[f64]) -> Vec<f64> {
        let np = self.scale.len();
        let inverse = self.inverse();
        let covariance = &inverse * inverse.transpose();
        let norms = row_norms(&inverse);
        let norm = |k: usize| {
            let squares = (0..np).map(|i| (self.weight[i] * self.r[(i, k)]).powi(2));
            squares.sum::<f64>().sqrt()
        };
        let columns: Vec<f64> = (0..np).map(norm).collect();
        let parts = self.order.iter().zip(&columns);
        let explained: f64 = parts
            .map(|(c, norm)| norm * (solution[*c] / self.scale[*c]).abs())
            .sum();
        let direct = norm(np).hypot(self.residual) + explained;
        self.placed(|place| {
            let turned: f64 = (0..np)
                .map(|j| covariance[(place, j)].abs() * columns[j])
                .sum();
            norms[place] * direct + turned * self.residual
        })
    }

    /// 2-norm condition number of the unscaled columns.
    pub fn condition(&self) -> Result<f64, EstimateError> {
        let np = self.scale.len();
        let unscaled = Mat::from_fn(np, np, |i, k| {
            self.weight[i] * self.r[(i, k)] / self.scale[self.order[k]]
        });
        let singular = unscaled
            .singular_values()
            .map_err(|_| EstimateError::Singular)?;
        let bounds = singular.first().zip(singular.last());
        Ok(bounds.map_or(1.0, |(largest, smallest)| largest / smallest))
    }

    /// Inverse of the triangular factor of the scaled W.
    fn inverse(&self) -> Mat<f64> {
        let np = self.scale.len();
        let mut inverse = Mat::zeros(np, np);
        for column in 0..np {
            inverse[(column, column)] = 1.0 / (self.weight[column] * self.r[(column, column)]);
            for i in (0..column).rev() {
                let sum: f64 = (i + 1..=column)
                    .map(|k| self.r[(i, k)] * inverse[(k, column)])
                    .sum();
                inverse[(i, column)] = -sum / self.r[(i, i)];
            }
        }
        inverse
    }

    /// Values by place, unscaled, in the order of the columns.
    fn placed(&self, value: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut placed = vec![0.0; self.scale.len()];
        for (place, column) in self.order.iter().enumerate() {
            placed[*column] = value(place) * self.scale[*column];
        }
        placed
    }
}

fn row_norms(matrix: &Mat<f64>) -> Vec<f64> {
    (0..matrix.nrows())
        .map(|i| matrix.row(i).norm_l2())
        .collect()
}
