//! An upper triangular factor that takes rows one at a time and forgets.

/// Entries smaller than this are zero: what has been forgotten for hours must not become numbers so
/// small that the processor slows down over them.
const FORGOTTEN: f64 = 1e-140;

/// Upper triangular R of weighted rows `[w | y]`, \\( R^T R = \sum_i \lambda^{n-i} a_i^T a_i \\):
/// the square root of the information, updated by Givens rotations (Golub and Van Loan, *Matrix
/// Computations*, section 6.5.2), so that no products of rows lose half the digits. The diagonal is
/// not negative.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Factor {
    width: usize,
    /// Row-major, `width` x `width`; nothing below the diagonal.
    entries: Vec<f64>,
    /// Rows, each counted as often as it is remembered.
    pub rows: f64,
    /// The row that is being folded in.
    row: Vec<f64>,
}

impl Factor {
    pub fn new(width: usize) -> Factor {
        Factor {
            width,
            entries: vec![0.0; width * width],
            rows: 0.0,
            row: vec![0.0; width],
        }
    }

    pub fn width(&self) -> usize {
        self.width
    }

    /// Row `i` from its diagonal on.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.entries[i * self.width + i..(i + 1) * self.width]
    }

    pub fn entry(&self, i: usize, k: usize) -> f64 {
        if i <= k { self.row(i)[k - i] } else { 0.0 }
    }

    /// Norm of column `k`.
    pub fn column_norm(&self, k: usize) -> f64 {
        let squares = (0..=k).map(|i| self.entry(i, k).powi(2));
        squares.sum::<f64>().sqrt()
    }

    pub fn clear(&mut self) {
        self.entries.fill(0.0);
        self.rows = 0.0;
    }

    /// Takes over another factor of the same width.
    pub fn copy(&mut self, other: &Factor) {
        self.entries.copy_from_slice(&other.entries);
        self.rows = other.rows;
    }

    /// Counts all rows so far `factor` times.
    pub fn forget(&mut self, factor: f64) {
        if factor >= 1.0 {
            return;
        }
        let root = factor.sqrt();
        for entry in &mut self.entries {
            let less = *entry * root;
            *entry = if less.abs() < FORGOTTEN { 0.0 } else { less };
        }
        self.rows *= factor;
    }

    /// Adds the row with `values` in ascending `columns` and `y` in the last, times `weight`.
    pub fn add(&mut self, columns: &[usize], values: &[f64], y: f64, weight: f64) {
        let Some((first, last)) = columns.first().zip(self.width.checked_sub(1)) else {
            return;
        };
        self.row[*first..].fill(0.0);
        for (column, value) in columns.iter().zip(values) {
            self.row[*column] = value * weight;
        }
        self.row[last] = y * weight;
        self.rotate(*first);
        self.rows += 1.0;
    }

    /// Adds all rows of another factor of the same width.
    pub fn merge(&mut self, other: &Factor) {
        for i in 0..other.width.min(self.width) {
            self.row[i..].copy_from_slice(other.row(i));
            self.rotate(i);
        }
        self.rows += other.rows;
    }

    /// Rotates the waiting row, zero before column `first`, into the factor.
    fn rotate(&mut self, first: usize) {
        for k in first..self.width {
            let below = self.row[k];
            if below == 0.0 {
                continue;
            }
            let start = k * self.width + k;
            let own = &mut self.entries[start..start + self.width - k];
            let long = (own[0] * own[0] + below * below).sqrt();
            if long == 0.0 {
                continue;
            }
            let (cosine, sine) = (own[0] / long, below / long);
            for (own, row) in own.iter_mut().zip(&mut self.row[k..]) {
                let turned = cosine * *own + sine * *row;
                *row = cosine * *row - sine * *own;
                *own = turned;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows with every second column missing, by turns.
    fn rows() -> impl Iterator<Item = ([usize; 2], [f64; 2], f64)> {
        let x = |i: usize| (i as f64 * 1.3).sin();
        (0..40).map(move |i| ([i % 2, 2 + i % 2], [x(i), x(3 * i + 1)], x(7 * i)))
    }

    #[test]
    fn the_square_of_the_factor_is_that_of_the_remembered_rows() {
        let (mut factor, mut square) = (Factor::new(5), [[0.0; 5]; 5]);
        for (columns, values, y) in rows() {
            factor.forget(0.9);
            factor.add(&columns, &values, y, 2.0);
            let mut row = [0.0; 5];
            (row[columns[0]], row[columns[1]], row[4]) = (values[0], values[1], y);
            for (i, square) in square.iter_mut().enumerate() {
                for (k, square) in square.iter_mut().enumerate() {
                    *square = 0.9 * *square + 4.0 * row[i] * row[k];
                }
            }
        }
        for (i, square) in square.iter().enumerate() {
            assert!(factor.entry(i, i) >= 0.0);
            for (k, square) in square.iter().enumerate() {
                let product = |m: usize| factor.entry(m, i) * factor.entry(m, k);
                let own: f64 = (0..5).map(product).sum();
                assert!((own - square).abs() < 1e-13, "{own} {square}");
            }
        }
        assert!((factor.rows - 10.0).abs() < 0.2);
    }

    #[test]
    fn merged_factors_are_the_factor_of_all_rows() {
        let (mut all, mut parts) = (Factor::new(5), [Factor::new(5), Factor::new(5)]);
        for (i, (columns, values, y)) in rows().enumerate() {
            all.add(&columns, &values, y, 1.0);
            parts[i / 15 % 2].add(&columns, &values, y, 1.0);
        }
        let [mut first, second] = parts;
        first.merge(&second);
        for i in 0..5 {
            for (a, b) in first.row(i).iter().zip(all.row(i)) {
                assert!((a - b).abs() < 1e-13);
            }
        }
        assert_eq!(first.rows, all.rows);
    }

    #[test]
    fn what_is_forgotten_is_zero_and_never_slows_the_loop_down() {
        let mut factor = Factor::new(3);
        factor.add(&[0, 1], &[1.0, 2.0], 3.0, 1.0);
        (0..20_000).for_each(|_| factor.forget(0.95));
        assert_eq!(
            factor,
            Factor {
                rows: factor.rows,
                row: factor.row.clone(),
                ..Factor::new(3)
            }
        );
    }
}
