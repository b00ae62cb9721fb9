//! Weighted least squares that grows column by column.

use rayon::prelude::*;

use super::linear::{OWN, add_scaled, dot, solve};

/// Share of a column's length that must be left of it for it to be determined.
const DETERMINED: f64 = 1e-7;

/// A column of whitened rows: what it is on each joint that it acts on. The rows of prior
/// knowledge come after those of the last joint, as one more.
#[derive(Clone, Debug, Default)]
pub(super) struct Sparse(pub Vec<(usize, Vec<f64>)>);

impl Sparse {
    pub fn dot(&self, other: &Sparse) -> f64 {
        let part = |(joint, values): &(usize, Vec<f64>)| -> f64 {
            let same = other.0.iter().filter(|(j, _)| j == joint);
            same.map(|(_, other)| dot(values, other)).sum()
        };
        self.0.iter().map(part).sum()
    }
}

/// \\( \min \|y - W x\|^2 \\) with \\( W = Q R \\), columns appended one at a time.
#[derive(Clone, Debug)]
pub(super) struct System {
    /// Rows of each joint.
    rows: usize,
    /// Orthonormal columns.
    basis: Vec<Vec<f64>>,
    /// Columns of R.
    upper: Vec<Vec<f64>>,
    /// Place in the basis of every column appended; `None` if the others already span it.
    places: Vec<Option<usize>>,
    /// \\( Q^T y \\).
    shares: Vec<f64>,
    /// What is left of y.
    residual: Vec<f64>,
}

/// What some more columns would gain.
#[derive(Clone, Debug)]
pub(super) struct Gain {
    /// By how much the sum of squares would fall.
    pub square: f64,
    /// Coefficients; `None` for what the columns before it, or the system's, already span.
    pub values: Vec<Option<f64>>,
}

impl Gain {
    /// Columns that count.
    pub fn columns(&self) -> usize {
        self.values.iter().flatten().count()
    }
}

impl System {
    /// No columns yet, `rows` rows of each joint.
    pub fn new(rows: usize, y: Vec<f64>) -> System {
        System {
            rows,
            basis: Vec::new(),
            upper: Vec::new(),
            places: Vec::new(),
            shares: Vec::new(),
            residual: y,
        }
    }

    /// Appends a column; false if the others span it.
    pub fn push(&mut self, column: &Sparse) -> bool {
        let mut v = vec![0.0; self.residual.len()];
        for (joint, values) in &column.0 {
            let start = joint * self.rows;
            add_scaled(&mut v[start..start + values.len()], 1.0, values);
        }
        let length = dot(&v, &v).sqrt();
        let mut upper = vec![0.0; self.basis.len()];
        // Twice is enough (Giraud et al. 2005).
        for _ in 0..2 {
            let shares: Vec<f64> = self.basis.par_iter().map(|q| dot(q, &v)).collect();
            for ((q, share), sum) in self.basis.iter().zip(shares).zip(&mut upper) {
                add_scaled(&mut v, -share, q);
                *sum += share;
            }
        }
        let left = dot(&v, &v).sqrt();
        let own = left > DETERMINED * length && left.is_normal();
        self.places.push(own.then_some(self.basis.len()));
        if own {
            v.iter_mut().for_each(|v| *v /= left);
            let share = dot(&v, &self.residual);
            add_scaled(&mut self.residual, -share, &v);
            upper.push(left);
            self.upper.push(upper);
            self.shares.push(share);
            self.basis.push(v);
        }
        own
    }

    /// Coefficients of all columns appended; zero for those that the others span.
    pub fn solution(&self) -> Vec<f64> {
        let mut x = self.shares.clone();
        for k in (0..x.len()).rev() {
            x[k] /= self.upper[k][k];
            let value = x[k];
            for (i, r) in self.upper[k][..k].iter().enumerate() {
                x[i] -= r * value;
            }
        }
        let value = |place: &Option<usize>| place.map_or(0.0, |k| x[k]);
        self.places.iter().map(value).collect()
    }

    /// Standard deviations of the last `count` columns appended, for rows of variance one.
    pub fn sigmas(&self, count: usize) -> Vec<Option<f64>> {
        let first = self.places.len() - count;
        self.places[first..]
            .iter()
            .map(|place| place.map(|k| self.sigma(k)))
            .collect()
    }

    /// Length of row `k` of the inverse of R.
    fn sigma(&self, k: usize) -> f64 {
        let n = self.basis.len();
        let mut row = vec![0.0; n];
        row[k] = 1.0 / self.upper[k][k];
        for j in k + 1..n {
            let sum: f64 = (k..j).map(|i| row[i] * self.upper[j][i]).sum();
            row[j] = -sum / self.upper[j][j];
        }
        dot(&row, &row).sqrt()
    }

    /// What is left of the rows of a joint.
    pub fn residual(&self, joint: usize) -> &[f64] {
        &self.residual[joint * self.rows..(joint + 1) * self.rows]
    }

    /// Sum of squares.
    pub fn square(&self) -> f64 {
        dot(&self.residual, &self.residual)
    }

    /// How many of the coefficients the rows of a joint decide.
    pub fn leverage(&self, joint: usize) -> f64 {
        let rows = joint * self.rows..(joint + 1) * self.rows;
        self.basis
            .iter()
            .map(|q| dot(&q[rows.clone()], &q[rows.clone()]))
            .sum()
    }

    /// \\( Q^T c \\) for the basis from place `first` on.
    pub fn shares(&self, column: &Sparse, first: usize) -> Vec<f64> {
        let share = |q: &Vec<f64>| -> f64 {
            let part = |(joint, values): &(usize, Vec<f64>)| {
                dot(&q[joint * self.rows..][..values.len()], values)
            };
            column.0.iter().map(part).sum()
        };
        self.basis[first.min(self.basis.len())..]
            .iter()
            .map(share)
            .collect()
    }

    /// What is left of y along a column.
    fn along(&self, column: &Sparse) -> f64 {
        let part = |(joint, values): &(usize, Vec<f64>)| {
            dot(&self.residual[joint * self.rows..][..values.len()], values)
        };
        column.0.iter().map(part).sum()
    }

    /// What columns would gain. `known` holds, for each, its shares of the first columns of the
    /// basis, from [`System::shares`] of a system that this one grew from; it may be empty.
    pub fn gain(&self, columns: &[Sparse], known: &[Vec<f64>]) -> Gain {
        self.gain_of(columns, known, OWN)
    }

    /// The same for columns that count only if at least the share `least` of their squares is
    /// their own.
    pub fn gain_of(&self, columns: &[Sparse], known: &[Vec<f64>], least: f64) -> Gain {
        let m = columns.len();
        let all: Vec<Vec<f64>> = (0..m)
            .map(|k| {
                let mut shares = known.get(k).cloned().unwrap_or_default();
                shares.extend(self.shares(&columns[k], shares.len()));
                shares
            })
            .collect();
        let mut gram = vec![0.0; m * m];
        let mut squares = vec![0.0; m];
        for i in 0..m {
            for k in i..m {
                let product = columns[i].dot(&columns[k]);
                if i == k {
                    squares[i] = product;
                }
                gram[i * m + k] = product - dot(&all[i], &all[k]);
                gram[k * m + i] = gram[i * m + k];
            }
        }
        let right: Vec<f64> = columns.iter().map(|column| self.along(column)).collect();
        let values = solve(&gram, &squares, &right, least);
        let square = values
            .iter()
            .zip(&right)
            .map(|(x, g)| x.unwrap_or(0.0) * g)
            .sum();
        Gain { square, values }
    }
}
