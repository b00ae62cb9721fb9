//! Modified Gram-Schmidt with column pivoting: the factorisation of small systems.

use super::double;

/// How vectors are combined.
#[derive(Clone, Copy)]
pub(super) struct Arithmetic {
    /// \\( a^T b \\).
    dot: fn(&[f64], &[f64]) -> f64,
    /// \\( a \leftarrow a - s b \\), arguments a, s, b.
    subtract: fn(&mut [f64], f64, &[f64]),
}

/// In f64, for many rows.
pub(super) const PLAIN: Arithmetic = Arithmetic { dot, subtract };

/// With products and sums of products rounded once, for the last digits of small systems.
pub(super) const CAREFUL: Arithmetic = Arithmetic {
    dot: double::accurate_dot,
    subtract: double::accurate_subtract,
};

/// W = Q U S^-1 with orthogonal (not normalised) columns of Q, unit upper triangular U, and
/// powers of two S that bring the columns of W, which come in different units, to norms near one
/// without rounding. Columns are taken largest remainder first.
///
/// Modified Gram-Schmidt is as stable for least squares as Householder's method when right-hand
/// sides are projected column by column, as here (Bjorck 1967; Bjorck and Paige 1992), and it
/// needs no sign choices or row order to be so for rows of different magnitude.
pub(super) struct Orthogonal {
    /// Columns of Q in pivoted order.
    q: Vec<Vec<f64>>,
    /// Their squared norms.
    squares: Vec<f64>,
    /// U by columns, in pivoted order; column k has k entries above its unit diagonal.
    u: Vec<Vec<f64>>,
    /// The column of W at each place.
    order: Vec<usize>,
    /// S: what each column of W was multiplied by.
    scale: Vec<f64>,
    arithmetic: Arithmetic,
}

impl Orthogonal {
    /// Factors the columns of W, all of one length and none zero.
    pub fn new(mut columns: Vec<Vec<f64>>, arithmetic: Arithmetic) -> Self {
        let Arithmetic { dot, subtract } = arithmetic;
        let np = columns.len();
        let scale: Vec<f64> = columns.iter_mut().map(|c| scaled(c)).collect();
        let mut left: Vec<f64> = columns.iter().map(|c| dot(c, c)).collect();
        let mut order: Vec<usize> = (0..np).collect();
        let mut u = vec![Vec::with_capacity(np); np];
        let mut squares = Vec::with_capacity(np);
        for k in 0..np {
            let pivot = (k..np).fold(k, |best, j| if left[j] > left[best] { j } else { best });
            columns.swap(k, pivot);
            left.swap(k, pivot);
            order.swap(k, pivot);
            u.swap(k, pivot);
            let (done, open) = columns.split_at_mut(k + 1);
            let q = &done[k];
            let square = dot(q, q);
            for (j, column) in open.iter_mut().enumerate() {
                let share = dot(q, column) / square;
                subtract(column, share, q);
                // Rounding spoils this difference long before the pivots would suffer.
                left[k + 1 + j] -= share * share * square;
                u[k + 1 + j].push(share);
            }
            squares.push(square);
        }
        Orthogonal {
            q: columns,
            squares,
            u,
            order,
            scale,
            arithmetic,
        }
    }

    /// Coefficients of `f` along the columns of Q; `f` becomes what is orthogonal to them.
    pub fn project(&self, f: &mut [f64]) -> Vec<f64> {
        let Arithmetic { dot, subtract } = self.arithmetic;
        let columns = self.q.iter().zip(&self.squares);
        columns
            .map(|(q, square)| {
                let share = dot(q, f) / square;
                subtract(f, share, q);
                share
            })
            .collect()
    }

    /// X with W X = Q `coefficients`, in the order of W's columns.
    pub fn solution(&self, mut coefficients: Vec<f64>) -> Vec<f64> {
        let mut x = vec![0.0; self.order.len()];
        for k in (0..self.order.len()).rev() {
            let own = coefficients[k];
            (self.arithmetic.subtract)(&mut coefficients, own, &self.u[k]);
            x[self.order[k]] = own * self.scale[self.order[k]];
        }
        x
    }

    /// Solves Bjorck's augmented system
    /// \\( \begin{pmatrix} I & W \\\\ W^T & 0 \end{pmatrix} \begin{pmatrix} r \\\\ x \end{pmatrix}
    /// = \begin{pmatrix} f \\\\ g \end{pmatrix} \\), that is r + W x = f and W' r = g.
    /// `f` becomes r; x is returned (Bjorck 1967, algorithm 5).
    pub fn augmented(&self, f: &mut [f64], g: &[f64]) -> Vec<f64> {
        let mut h: Vec<f64> = self.order.iter().map(|c| g[*c] * self.scale[*c]).collect();
        for k in 0..h.len() {
            let known: f64 = self.u[k].iter().zip(&h).map(|(u, h)| u * h).sum();
            h[k] -= known;
        }
        let Arithmetic { dot, subtract } = self.arithmetic;
        let mut coefficients = self.project(f);
        for (k, coefficient) in coefficients.iter_mut().enumerate() {
            *coefficient -= h[k] / self.squares[k];
        }
        // From last to first, with what rounding left along each column taken out again.
        for (k, q) in self.q.iter().enumerate().rev() {
            let share = (dot(q, f) - h[k]) / self.squares[k];
            subtract(f, share, q);
        }
        self.solution(coefficients)
    }

    /// Entry of the triangular factor of W, of row i and column k in the order of
    /// [`Orthogonal::order`], without the weight of its row.
    pub fn unit(&self, i: usize, k: usize) -> f64 {
        match i.cmp(&k) {
            std::cmp::Ordering::Less => self.u[k][i],
            std::cmp::Ordering::Equal => 1.0,
            std::cmp::Ordering::Greater => 0.0,
        }
    }

    /// Norms of Q's columns: the diagonal of the triangular factor.
    pub fn norms(&self) -> Vec<f64> {
        self.squares.iter().map(|square| square.sqrt()).collect()
    }

    /// The column of W at each place.
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// What each column of W was multiplied by.
    pub fn scale(&self) -> &[f64] {
        &self.scale
    }
}

/// Inner product in four strands, which the processor can overlap.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut strands = [0.0; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4
        .remainder()
        .iter()
        .zip(b4.remainder())
        .map(|(a, b)| a * b)
        .sum();
    for (a, b) in a4.zip(b4) {
        for (strand, (a, b)) in strands.iter_mut().zip(a.iter().zip(b)) {
            *strand += a * b;
        }
    }
    (strands[0] + strands[1]) + (strands[2] + strands[3]) + rest
}

/// The power of two that brings a norm to between 0.7 and 1.4; 1 for a zero.
pub(super) fn power_of_two(norm: f64) -> f64 {
    if norm > 0.0 {
        (-norm.log2().round()).exp2()
    } else {
        1.0
    }
}

/// Scales a column in place and returns the factor.
fn scaled(column: &mut [f64]) -> f64 {
    // The largest entry first: squares of very large or small entries would leave the range.
    let rough = power_of_two(column.iter().fold(0.0, |most, x| x.abs().max(most)));
    column.iter_mut().for_each(|x| *x *= rough);
    let fine = power_of_two(dot(column, column).sqrt());
    column.iter_mut().for_each(|x| *x *= fine);
    rough * fine
}

fn subtract(from: &mut [f64], share: f64, direction: &[f64]) {
    for (value, direction) in from.iter_mut().zip(direction) {
        *value -= share * direction;
    }
}
