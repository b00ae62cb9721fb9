//! Parameters, their standard deviations and which of them are determined, from a factor, in
//! memory taken beforehand and in a number of operations that depends on the model alone.

use super::OnlineError;
use super::factor::Factor;

/// A column this much smaller than the largest is rounding, not data (as in [`crate::evidence`]).
const UNSEEN: f64 = 1e-13;

/// Pivots of the normalised columns below this share of the first are rounding.
const RANK: f64 = 1e-10;

/// A column with smaller factors in every dependency is determined.
const INVOLVED: f64 = 1e-6;

/// What the equations so far say of the np parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// The least-squares parameters. Those that are not determined hold arbitrary values, often
    /// zero, that fit the equations together.
    pub values: Vec<f64>,
    /// Standard deviations for independent errors of equations; `None` for parameters that are not
    /// determined, and as long as there are no more equations than parameters.
    pub sigma: Vec<Option<f64>>,
    /// Whether the equations determine each parameter by itself.
    pub determined: Vec<bool>,
    /// How many combinations of parameters the equations determine.
    pub rank: usize,
    /// Equations, each counted as often as it is remembered.
    pub rows: f64,
    /// Standard deviation of a weighted equation's residual; 1 where weights are one over the
    /// true deviations. `None` as long as there are no more equations than parameters.
    pub level: Option<f64>,
}

impl Solution {
    /// Room for np parameters, none of them determined.
    pub fn new(parameters: usize) -> Solution {
        Solution {
            values: vec![0.0; parameters],
            sigma: vec![None; parameters],
            determined: vec![false; parameters],
            rank: 0,
            rows: 0.0,
            level: None,
        }
    }

    /// The value of parameter `k`, if it is determined.
    pub fn value(&self, k: usize) -> Option<f64> {
        let determined = self.determined.get(k).copied().unwrap_or(false);
        determined.then(|| self.values[k])
    }
}

/// Memory for solving factors of np + 1 columns.
#[derive(Clone, Debug)]
pub(super) struct Solver {
    /// Columns of the factor, each divided by its norm, in the order of `order`; column-major.
    columns: Vec<Vec<f64>>,
    /// Which parameter each column belongs to.
    order: Vec<usize>,
    norms: Vec<f64>,
    y: Vec<f64>,
    reflector: Vec<f64>,
    solved: Vec<f64>,
}

impl Solver {
    pub fn new(parameters: usize) -> Solver {
        let zeros = || vec![0.0; parameters];
        Solver {
            columns: (0..parameters).map(|_| zeros()).collect(),
            order: (0..parameters).collect(),
            norms: zeros(),
            y: zeros(),
            reflector: zeros(),
            solved: zeros(),
        }
    }

    /// Solves by Householder reflections with column pivoting (Golub and Van Loan, section 5.4).
    /// A parameter is determined if it has no part in the null space \\( (-R_{11}^{-1} R_{12}; I) \\).
    ///
    /// # Errors
    /// [`OnlineError::NothingMoves`]; the solution then is as before.
    pub fn solve(&mut self, factor: &Factor, solution: &mut Solution) -> Result<(), OnlineError> {
        let seen = self.load(factor);
        if seen == 0 {
            return Err(OnlineError::NothingMoves);
        }
        let mut rank = 0;
        let mut first = 0.0;
        for k in 0..seen {
            let pivot = self.pivot(k, seen);
            first = if k == 0 { pivot } else { first };
            if pivot > RANK * first {
                rank = k + 1;
            }
        }
        let rest: f64 = self.y[rank..].iter().map(|y| y * y).sum();
        let last = factor.width() - 1;
        let square = rest + factor.entry(last, last).powi(2);
        let freedom = factor.rows - rank as f64;
        solution.rank = rank;
        solution.rows = factor.rows;
        solution.level = (freedom >= 1.0).then(|| (square / freedom).sqrt());
        self.find(rank, solution);
        self.judge(rank, seen, solution);
        Ok(())
    }

    /// Normalised columns of the factor, those that are zero last; how many are not.
    fn load(&mut self, factor: &Factor) -> usize {
        let count = self.order.len();
        for (k, norm) in self.norms.iter_mut().enumerate() {
            *norm = factor.column_norm(k);
        }
        let largest = self.norms.iter().copied().fold(0.0, f64::max);
        let (mut seen, mut unseen) = (0, count);
        for (k, norm) in self.norms.iter().enumerate() {
            if *norm <= UNSEEN * largest {
                unseen -= 1;
                self.order[unseen] = k;
                continue;
            }
            self.order[seen] = k;
            for (i, entry) in self.columns[seen].iter_mut().enumerate() {
                *entry = factor.entry(i, k) / norm;
            }
            seen += 1;
        }
        for (i, y) in self.y.iter_mut().enumerate() {
            *y = factor.entry(i, count);
        }
        seen
    }

    /// Moves the longest column left to place `k` and reflects it onto the axis; its length.
    fn pivot(&mut self, k: usize, seen: usize) -> f64 {
        let square = |column: &Vec<f64>| column[k..].iter().map(|x| x * x).sum::<f64>();
        let (mut longest, mut most) = (k, -1.0);
        for (place, column) in self.columns[..seen].iter().enumerate().skip(k) {
            let square = square(column);
            if square > most {
                (longest, most) = (place, square);
            }
        }
        self.columns.swap(k, longest);
        self.order.swap(k, longest);
        let length = most.max(0.0).sqrt();
        if length == 0.0 {
            return 0.0;
        }
        let reflector = &mut self.reflector[k..];
        reflector.copy_from_slice(&self.columns[k][k..]);
        let sign = if reflector[0] < 0.0 { -1.0 } else { 1.0 };
        reflector[0] += sign * length;
        let scale = 1.0 / (length * reflector[0].abs());
        let others = self.columns[k + 1..seen].iter_mut();
        for column in others.chain([&mut self.y]) {
            let pairs = column[k..].iter().zip(reflector.iter());
            let share = scale * pairs.map(|(x, v)| x * v).sum::<f64>();
            let pairs = column[k..].iter_mut().zip(reflector.iter());
            pairs.for_each(|(x, v)| *x -= share * v);
        }
        self.columns[k][k] = -sign * length;
        length
    }

    /// Back substitution of `solved` in the first `rank` columns.
    fn substitute(&mut self, rank: usize) {
        for k in (0..rank).rev() {
            let x = self.solved[k] / self.columns[k][k];
            self.solved[k] = x;
            let above = self.solved[..k].iter_mut().zip(&self.columns[k]);
            above.for_each(|(sum, r)| *sum -= r * x);
        }
    }

    fn find(&mut self, rank: usize, solution: &mut Solution) {
        solution.values.fill(0.0);
        self.solved[..rank].copy_from_slice(&self.y[..rank]);
        self.substitute(rank);
        for (k, x) in self.order.iter().zip(&self.solved[..rank]) {
            solution.values[*k] = x / self.norms[*k];
        }
    }

    /// Which parameters are determined, and how well.
    fn judge(&mut self, rank: usize, seen: usize, solution: &mut Solution) {
        solution.determined.fill(false);
        for k in &self.order[..rank] {
            solution.determined[*k] = true;
        }
        for place in rank..seen {
            self.solved[..rank].copy_from_slice(&self.columns[place][..rank]);
            self.substitute(rank);
            for (k, part) in self.order.iter().zip(&self.solved[..rank]) {
                solution.determined[*k] &= part.abs() < INVOLVED;
            }
        }
        // Squares of the rows of the inverse, column by column of it, gathered in the reflector.
        self.reflector.fill(0.0);
        for unit in 0..rank {
            self.solved[..rank].fill(0.0);
            self.solved[unit] = 1.0;
            self.substitute(unit + 1);
            let sums = self.reflector.iter_mut().zip(&self.solved[..=unit]);
            sums.for_each(|(sum, x)| *sum += x * x);
        }
        solution.sigma.fill(None);
        for (k, square) in self.order.iter().zip(&self.reflector[..rank]) {
            let own = |level: f64| level * square.sqrt() / self.norms[*k];
            solution.sigma[*k] = solution.level.map(own).filter(|_| solution.determined[*k]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_its_textbook_parameters_and_deviations() {
        // y = a + b t by least squares: Sxx = 10, sums in closed form.
        let y = [1.0, 3.0, 2.0, 5.0, 4.0];
        let mut factor = Factor::new(3);
        for (t, y) in y.iter().enumerate() {
            factor.add(&[0, 1], &[1.0, t as f64], *y, 1.0);
        }
        let mut solution = Solution::new(2);
        Solver::new(2).solve(&factor, &mut solution).unwrap();
        // b = 8/10, a = 3 - 0.8 * 2; residual squares 10 - 6.4 = 3.6 over 3 degrees of freedom.
        assert!((solution.values[1] - 0.8).abs() < 1e-14);
        assert!((solution.values[0] - 1.4).abs() < 1e-14);
        let level = 1.2f64.sqrt();
        assert!((solution.level.unwrap() - level).abs() < 1e-14);
        assert!((solution.sigma[1].unwrap() - level / 10f64.sqrt()).abs() < 1e-14);
        let sigma = level * (1.0 / 5.0 + 4.0 / 10.0f64).sqrt();
        assert!((solution.sigma[0].unwrap() - sigma).abs() < 1e-14);
    }

    #[test]
    fn what_depends_on_each_other_is_not_determined_and_the_others_are() {
        // Columns 1 and 3 are proportional, column 2 never moves; 0 and 4 stand for themselves.
        let x = |i: usize| (i as f64 * 0.7).sin();
        let mut factor = Factor::new(6);
        for i in 0..50 {
            let row = [x(i), x(2 * i), 0.0, -3.0 * x(2 * i), x(5 * i + 1)];
            let y = 2.0 * row[0] + row[1] - row[4];
            factor.add(&[0, 1, 2, 3, 4], &row, y, 1.0);
        }
        let mut solution = Solution::new(5);
        Solver::new(5).solve(&factor, &mut solution).unwrap();
        assert_eq!(solution.determined, [true, false, false, false, true]);
        assert_eq!(solution.rank, 3);
        assert!((solution.value(0).unwrap() - 2.0).abs() < 1e-12);
        assert!((solution.value(4).unwrap() + 1.0).abs() < 1e-12);
        assert_eq!(solution.value(1), None);
        assert_eq!(solution.sigma[3], None);
        // Together they still fit.
        assert!((solution.values[1] - 3.0 * solution.values[3] - 1.0).abs() < 1e-12);
        assert!(solution.level.unwrap() < 1e-13);
    }

    #[test]
    fn nothing_is_an_error() {
        let mut solution = Solution::new(2);
        let solved = Solver::new(2).solve(&Factor::new(3), &mut solution);
        assert_eq!(solved, Err(OnlineError::NothingMoves));
    }
}
