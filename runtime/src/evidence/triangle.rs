//! The triangular factor of a set of rows, and how rows and other factors are folded into it.

use super::kernel::{Column, LANES, ROWS, fold};

/// Upper triangular factor R of a matrix A of `rows` x `width`, in the field's use `[W | Y]`:
/// \\( R^T R = A^T A \\), so that \\( \|Y - W X\| = \|R (-X; 1)\| \\) for every X, whatever the
/// number of rows. The diagonal is not negative, which makes the factor unique.
///
/// Units: those of the columns. The factor comes from Householder reflections, never from
/// products of columns, and so keeps the precision of the rows (Golub and Van Loan, *Matrix
/// Computations*, section 5.2).
#[derive(Clone, Debug, PartialEq)]
pub struct Triangle {
    width: usize,
    rows: usize,
    /// Rows of the factor one after the other, row i from its diagonal on.
    packed: Vec<f64>,
}

impl Triangle {
    /// The factor of no rows, over `width` columns.
    pub fn empty(width: usize) -> Self {
        Triangle {
            width,
            rows: 0,
            packed: vec![0.0; packed_len(width)],
        }
    }

    /// From its packed rows; `None` if their number does not fit `width`.
    pub(super) fn from_packed(width: usize, rows: usize, packed: Vec<f64>) -> Option<Self> {
        (packed.len() == packed_len(width)).then_some(Triangle {
            width,
            rows,
            packed,
        })
    }

    /// Number of columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows of the matrix that this is the factor of.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// All `width (width + 1) / 2` entries, row by row, each from the diagonal on.
    pub fn packed(&self) -> &[f64] {
        &self.packed
    }

    /// Entries `i..width` of row `i < width`.
    pub fn row(&self, i: usize) -> &[f64] {
        let start = i * self.width - i * i.saturating_sub(1) / 2;
        &self.packed[start..start + self.width - i]
    }

    /// Entry in row `i`, column `k`; zero below the diagonal.
    pub fn entry(&self, i: usize, k: usize) -> f64 {
        if i <= k { self.row(i)[k - i] } else { 0.0 }
    }

    /// Norm of column `k`, which is that of the matrix's column.
    pub fn column_norm(&self, k: usize) -> f64 {
        (0..=k)
            .map(|i| self.entry(i, k).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// \\( R (-x; 1) \\): the residual of the last column in the coordinates of the factor,
    /// `width` values; `x` has `width - 1`.
    pub fn residual(&self, x: &[f64]) -> Vec<f64> {
        let residual = |i: usize| {
            let row = self.row(i);
            let (last, row) = row.split_last().unwrap_or((&0.0, &[]));
            let product: f64 = row.iter().zip(x.iter().skip(i)).map(|(r, x)| r * x).sum();
            last - product
        };
        (0..self.width).map(residual).collect()
    }

    /// The factor of both matrices together, one above the other.
    ///
    /// Both must have the same width; columns that one does not have count as zero.
    pub fn merge(&self, other: &Triangle) -> Triangle {
        let places: Vec<Option<usize>> = (0..self.width.max(other.width)).map(Some).collect();
        let mut fold = Fold::new(places.len());
        fold.factor(self, &places, 1.0);
        fold.factor(other, &places, 1.0);
        fold.finish()
    }
}

fn packed_len(width: usize) -> usize {
    width * (width + 1) / 2
}

/// Rows on their way into a [`Triangle`]: they wait until a panel of 64 is full. The factor
/// depends on the rows and their order, to the last bit, and not on how they were handed over.
#[derive(Clone, Debug)]
pub struct Fold {
    triangle: Triangle,
    panel: Vec<Column>,
    filled: usize,
}

impl Fold {
    /// Begins a factor over `width` columns.
    pub fn new(width: usize) -> Self {
        Fold {
            triangle: Triangle::empty(width),
            panel: vec![[[0.0; LANES]; ROWS / LANES]; width],
            filled: 0,
        }
    }

    /// Adds a chunk of rows, planar: `columns[k]` holds the chunk's part of column k, and as many
    /// rows are added as the shortest has. Missing columns count as zero.
    pub fn rows(&mut self, columns: &[&[f64]]) {
        let len = columns.iter().map(|column| column.len()).min().unwrap_or(0);
        let mut start = 0;
        while start < len {
            let take = (ROWS - self.filled).min(len - start);
            for (panel, column) in self.panel.iter_mut().zip(columns) {
                let places = &mut panel.as_flattened_mut()[self.filled..self.filled + take];
                places.copy_from_slice(&column[start..start + take]);
            }
            start += take;
            self.filled += take;
            self.fold_if_full();
        }
        self.triangle.rows += len;
    }

    /// Adds the rows that `factor` stands for, each multiplied by `weight`: its column k goes to
    /// column `places[k]`, or nowhere.
    pub fn factor(&mut self, factor: &Triangle, places: &[Option<usize>], weight: f64) {
        for i in 0..factor.width {
            let row = factor.row(i);
            let entries = || row.iter().zip(places.iter().skip(i));
            if entries().all(|(entry, place)| *entry == 0.0 || place.is_none()) {
                continue;
            }
            for (entry, place) in entries() {
                if let Some(column) = place.and_then(|place| self.panel.get_mut(place)) {
                    column.as_flattened_mut()[self.filled] = entry * weight;
                }
            }
            self.filled += 1;
            self.fold_if_full();
        }
        self.triangle.rows += factor.rows;
    }

    /// The factor of all rows added.
    pub fn finish(mut self) -> Triangle {
        if self.filled > 0 {
            fold(&mut self.triangle.packed, &mut self.panel);
        }
        self.triangle
    }

    fn fold_if_full(&mut self) {
        if self.filled == ROWS {
            fold(&mut self.triangle.packed, &mut self.panel);
            self.panel.fill([[0.0; LANES]; ROWS / LANES]);
            self.filled = 0;
        }
    }
}
