//! Weighted least squares with instruments, that grows by columns.

use std::ops::Range;
use std::sync::Arc;

use faer::Mat;
use faer::linalg::solvers::{DenseSolveCore, Solve};
use rayon::prelude::*;

use super::linear::{OWN, add_scaled, dot, solve};

/// Share of a column's length that must be left of it for it to be determined.
const DETERMINED: f64 = 1e-7;

/// Share of its instrument's own part that a column must have: less is no instrument for it.
const STRONG: f64 = 0.1;

/// Rows of every joint that are multiplied with many columns while they are in cache.
const PART: usize = 256;

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

    /// The sum of its products with a vector of all joints' rows.
    fn dot_dense(&self, dense: &[f64], rows: usize) -> f64 {
        let part = |(joint, values): &(usize, Vec<f64>)| {
            dot(&dense[joint * rows..][..values.len()], values)
        };
        self.0.iter().map(part).sum()
    }

    fn add_to(&self, dense: &mut [f64], rows: usize, factor: f64) {
        for (joint, values) in &self.0 {
            add_scaled(&mut dense[joint * rows..][..values.len()], factor, values);
        }
    }
}

/// A column along the measured motion and its instrument, the same column along a motion without
/// noise.
pub(super) type Pair = (Sparse, Sparse);

/// \\( y = W x + n \\) by instrumental variables, \\( Z^T (y - W x) = 0 \\): W follows the measured
/// motion and has its noise, Z follows one without (Söderström and Stoica 1989). With Z = W this is
/// least squares.
#[derive(Clone, Debug)]
pub(super) struct System {
    /// Rows of each joint.
    rows: usize,
    y: Arc<Vec<f64>>,
    /// Orthonormal columns Q that span Z.
    basis: Vec<Arc<Vec<f64>>>,
    /// The columns of W that are determined.
    columns: Vec<Arc<Sparse>>,
    /// \\( Q^T w \\) of each of them.
    products: Vec<Vec<f64>>,
    /// Place in the basis of every column appended; `None` if the others already span it.
    places: Vec<Option<usize>>,
    /// The solution for the determined columns, and \\( (Q^T W)^{-1} \\).
    solution: Vec<f64>,
    inverse: Arc<Mat<f64>>,
    /// What is left of y; nothing of it lies along Q.
    residual: Vec<f64>,
}

/// What some more columns would gain.
#[derive(Clone, Debug)]
pub(super) struct Gain {
    /// By how much the sum of squares along the instruments would fall.
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
            columns: Vec::new(),
            products: Vec::new(),
            places: Vec::new(),
            solution: Vec::new(),
            inverse: Arc::new(Mat::zeros(0, 0)),
            residual: y.clone(),
            y: Arc::new(y),
        }
    }

    /// The system with more columns, solved again.
    pub fn with(&self, pairs: &[Pair]) -> System {
        let mut grown = self.clone();
        for (column, instrument) in pairs {
            grown.push(column, instrument);
        }
        grown.solve();
        grown
    }

    /// Appends a column, unless the others span its instrument.
    fn push(&mut self, column: &Sparse, instrument: &Sparse) {
        let mut z = vec![0.0; self.y.len()];
        instrument.add_to(&mut z, self.rows, 1.0);
        let length = dot(&z, &z).sqrt();
        // Twice is enough (Giraud et al. 2005).
        for _ in 0..2 {
            let shares: Vec<f64> = self.basis.par_iter().map(|q| dot(q, &z)).collect();
            for (q, share) in self.basis.iter().zip(shares) {
                add_scaled(&mut z, -share, q);
            }
        }
        let left = dot(&z, &z).sqrt();
        z.iter_mut().for_each(|z| *z /= left);
        let shared = column.dot_dense(&z, self.rows);
        let own = left > DETERMINED * length && left.is_normal() && shared > STRONG * left;
        self.places.push(own.then_some(self.basis.len()));
        if !own {
            return;
        }
        let z = Arc::new(z);
        let rows = self.rows;
        let others = self.columns.par_iter().zip(&mut self.products);
        others.for_each(|(column, products)| products.push(column.dot_dense(&z, rows)));
        self.basis.push(z);
        let products = self.basis.par_iter();
        self.products
            .push(products.map(|q| column.dot_dense(q, rows)).collect());
        self.columns.push(Arc::new(column.clone()));
    }

    fn solve(&mut self) {
        let n = self.basis.len();
        let matrix = Mat::from_fn(n, n, |i, k| self.products[k][i]);
        let shares = Mat::from_fn(n, 1, |i, _| dot(&self.basis[i], &self.y));
        let lu = matrix.partial_piv_lu();
        let x = lu.solve(&shares);
        self.solution = (0..n).map(|k| x[(k, 0)]).collect();
        self.inverse = Arc::new(lu.inverse());
        let mut residual = self.y.to_vec();
        for (column, x) in self.columns.iter().zip(&self.solution) {
            column.add_to(&mut residual, self.rows, -x);
        }
        self.residual = residual;
    }

    /// Coefficients of all columns appended; zero for those that the others span.
    pub fn solution(&self) -> Vec<f64> {
        let value = |place: &Option<usize>| place.map_or(0.0, |k| self.solution[k]);
        self.places.iter().map(value).collect()
    }

    /// Standard deviations of the last `count` columns appended, for rows of variance one: lengths
    /// of the rows of \\( (Q^T W)^{-1} \\).
    pub fn sigmas(&self, count: usize) -> Vec<Option<f64>> {
        let sigma = |k: usize| {
            let squares = (0..self.basis.len()).map(|i| self.inverse[(k, i)].powi(2));
            squares.sum::<f64>().sqrt()
        };
        let first = self.places.len() - count;
        self.places[first..]
            .iter()
            .map(|place| place.map(sigma))
            .collect()
    }

    /// The same for residuals of any colour and size, from their sums over blocks of rows (Liang and
    /// Zeger 1986): the errors of different blocks are independent, those inside one need not be.
    pub fn block_sigmas(&self, count: usize, blocks: &[Range<usize>]) -> Vec<Option<f64>> {
        let joints = self.y.len() / self.rows.max(1);
        let of_block = |q: &Arc<Vec<f64>>, block: &Range<usize>| -> f64 {
            let rows = (0..joints).map(|j| j * self.rows + block.start..j * self.rows + block.end);
            rows.map(|rows| dot(&q[rows.clone()], &self.residual[rows]))
                .sum()
        };
        let scores: Vec<Vec<f64>> = blocks
            .iter()
            .map(|block| self.basis.iter().map(|q| of_block(q, block)).collect())
            .collect();
        let sigma = |k: usize| {
            let change = |scores: &Vec<f64>| -> f64 {
                let terms = scores.iter().enumerate();
                terms.map(|(i, score)| self.inverse[(k, i)] * score).sum()
            };
            scores.iter().map(|s| change(s).powi(2)).sum::<f64>().sqrt()
        };
        let first = self.places.len() - count;
        self.places[first..]
            .iter()
            .map(|place| place.map(sigma))
            .collect()
    }

    /// What is left of the rows of a joint.
    pub fn residual(&self, joint: usize) -> &[f64] {
        &self.residual[joint * self.rows..(joint + 1) * self.rows]
    }

    /// How many of the coefficients the rows of a joint decide.
    pub fn leverage(&self, joint: usize) -> f64 {
        let rows = joint * self.rows..(joint + 1) * self.rows;
        self.basis
            .iter()
            .map(|q| dot(&q[rows.clone()], &q[rows.clone()]))
            .sum()
    }

    /// \\( Q^T z \\) for the basis from place `first` on.
    pub fn shares(&self, instrument: &Sparse, first: usize) -> Vec<f64> {
        self.basis[first.min(self.basis.len())..]
            .iter()
            .map(|q| instrument.dot_dense(q, self.rows))
            .collect()
    }

    /// \\( Q^T z \\) of several columns of the logs' rows at once. The basis is longer than a cache: a
    /// part of its rows serves them all before the next is fetched.
    pub fn shares_of(&self, instruments: &[&Sparse]) -> Vec<Vec<f64>> {
        let mut all = vec![vec![0.0; self.basis.len()]; instruments.len()];
        for start in (0..self.rows).step_by(PART) {
            for (place, q) in self.basis.iter().enumerate() {
                for (shares, instrument) in all.iter_mut().zip(instruments) {
                    for (joint, values) in &instrument.0 {
                        let part = start..values.len().min(start + PART);
                        let values = values.get(part).unwrap_or_default();
                        let own = &q[joint * self.rows + start..][..values.len()];
                        shares[place] += dot(own, values);
                    }
                }
            }
        }
        all
    }

    /// What columns would gain, by their instruments. `known` holds, for each, its shares of the
    /// first columns of the basis, from [`System::shares`] of a system that this one grew from; it
    /// may be empty.
    pub fn gain(&self, instruments: &[Sparse], known: &[Vec<f64>]) -> Gain {
        self.gain_of(instruments, known, OWN)
    }

    /// The same for columns that count only if at least the share `least` of their squares is
    /// their own.
    pub fn gain_of(&self, instruments: &[Sparse], known: &[Vec<f64>], least: f64) -> Gain {
        let m = instruments.len();
        let all: Vec<Vec<f64>> = (0..m)
            .map(|k| {
                let mut shares = known.get(k).cloned().unwrap_or_default();
                shares.extend(self.shares(&instruments[k], shares.len()));
                shares
            })
            .collect();
        let mut gram = vec![0.0; m * m];
        let mut squares = vec![0.0; m];
        for i in 0..m {
            for k in i..m {
                let product = instruments[i].dot(&instruments[k]);
                if i == k {
                    squares[i] = product;
                }
                gram[i * m + k] = product - dot(&all[i], &all[k]);
                gram[k * m + i] = gram[i * m + k];
            }
        }
        let right: Vec<f64> = instruments
            .iter()
            .map(|z| z.dot_dense(&self.residual, self.rows))
            .collect();
        let values = solve(&gram, &squares, &right, least);
        let square = values
            .iter()
            .zip(&right)
            .map(|(x, g)| x.unwrap_or(0.0) * g)
            .sum();
        Gain { square, values }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniform values between -0.5 and 0.5, by a linear congruence.
    fn noise(random: &mut u64, len: usize) -> Vec<f64> {
        let mut value = || {
            *random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (*random >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        (0..len).map(|_| value()).collect()
    }

    fn sum(a: &[f64], factor: f64, b: &[f64]) -> Vec<f64> {
        a.iter().zip(b).map(|(a, b)| a + factor * b).collect()
    }

    #[test]
    fn instruments_see_through_noise_in_the_columns() {
        // A column whose noise comes back in y, as position noise does through a controller.
        let len = 20_000;
        let mut random = 1_u64;
        let clean: Vec<f64> = (0..len).map(|t| (0.01 * t as f64).sin()).collect();
        let noise = noise(&mut random, len);
        let measured = sum(&clean, 1.0, &noise);
        let y = sum(&clean, -1.0, &noise);
        let column = |rows: &[f64]| Sparse(vec![(0, rows.to_vec())]);
        let least = System::new(len, y.clone()).with(&[(column(&measured), column(&measured))]);
        let through = System::new(len, y).with(&[(column(&measured), column(&clean))]);
        // By least squares: (1/2 - 1/12) / (1/2 + 1/12) = 5/7.
        assert!((least.solution()[0] - 5.0 / 7.0).abs() < 0.02);
        let (found, sigma) = (through.solution()[0], through.sigmas(1)[0].unwrap());
        // The error of each row is 2 * noise, of variance 4/12; rows of variance one are assumed.
        assert!((found - 1.0).abs() < 3.0 * sigma, "{found} +- {sigma}");
        assert!((sigma - (2.0 / len as f64).sqrt()).abs() < 0.05 * sigma);
    }

    #[test]
    fn shares_of_several_columns_are_those_of_each() {
        let len = 1100;
        let mut random = 7_u64;
        let y = noise(&mut random, 2 * len);
        let mut column = |joint: usize| Sparse(vec![(joint, noise(&mut random, len))]);
        let pairs: Vec<Pair> = (0..5)
            .map(|k| column(k % 2))
            .map(|column| (column.clone(), column))
            .collect();
        let both = Sparse([column(0).0, column(1).0].concat());
        let system = System::new(len, y).with(&pairs);
        let columns = [both, column(1), Sparse::default()];
        let all = system.shares_of(&columns.iter().collect::<Vec<_>>());
        for (column, shares) in columns.iter().zip(all) {
            let alone = system.shares(column, 0);
            assert_eq!(shares.len(), alone.len());
            let mut pairs = shares.iter().zip(&alone);
            assert!(pairs.all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }

    #[test]
    fn what_a_column_would_gain_is_what_it_gains() {
        let len = 500;
        let mut random = 3_u64;
        let mut column = || Sparse(vec![(0, noise(&mut random, len))]);
        let (first, second, y) = (column(), column(), column());
        let y = y.0[0].1.clone();
        let with_first = System::new(len, y).with(&[(first.clone(), first)]);
        let promised = with_first.gain(std::slice::from_ref(&second), &[]);
        let both = with_first.with(&[(second.clone(), second)]);
        let square = |system: &System| dot(system.residual(0), system.residual(0));
        let gained = square(&with_first) - square(&both);
        assert!((gained - promised.square).abs() < 1e-9 * gained.abs().max(1e-3));
        let value = both.solution()[1];
        assert!((value - promised.values[0].unwrap()).abs() < 1e-12);
    }

    #[test]
    fn a_column_that_its_instrument_does_not_follow_is_left_out() {
        let len = 400;
        let mut random = 5_u64;
        let mut column = || Sparse(vec![(0, noise(&mut random, len))]);
        let (column, instrument, y) = (Sparse(vec![(0, vec![0.0; len])]), column(), column());
        let system = System::new(len, y.0[0].1.clone()).with(&[(column, instrument)]);
        assert_eq!(system.solution(), [0.0]);
        assert_eq!(system.sigmas(1), [None]);
    }
}
