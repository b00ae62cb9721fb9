//! Iterative refinement of least squares: all the digits that the equations hold.

use super::double::Double;
use super::entries::{Entries, Stacked};
use super::least_squares::solve;
use super::orthogonal::{Orthogonal, PLAIN};
use super::reduced::Reduced;
use super::{EstimateError, Triangle};
use crate::observe::Equations;

/// Each step gains as many digits as the condition number of the scaled W leaves of 16.
const STEPS: usize = 30;

/// Relative correction at which every digit of f64 stands.
const SETTLED: f64 = 1e-18;

/// A column with less than this share outside the others is made of them and rounding.
const DEPENDENT: f64 = 1e-14;

/// More digits than this cannot stand in an f64.
const MOST_DIGITS: f64 = 15.95;

/// A refined least-squares solution.
#[derive(Clone, Debug)]
pub struct Refined {
    /// The parameters, np values; zero for those that the data do not determine independently.
    pub solution: Vec<f64>,
    /// Bound of the numerical error of each parameter, in its unit: the last correction, and
    /// what the uncertainty of the entries ([`Entries::roundoff`]) can do at most. Statistical
    /// errors are not in it.
    pub error: Vec<f64>,
    /// Corrections made, the plain solution counted as the first.
    pub steps: usize,
    /// Whether the corrections became negligible.
    pub converged: bool,
}

impl Refined {
    /// Certain decimal digits of each parameter, between 0 and 16.
    pub fn digits(&self) -> Vec<f64> {
        let each = self.solution.iter().zip(&self.error);
        each.map(|(x, error)| certain(*error, x.abs())).collect()
    }

    /// Certain decimal digits of the worst parameter.
    pub fn certified_digits(&self) -> f64 {
        self.digits().into_iter().fold(MOST_DIGITS, f64::min)
    }
}

/// Decimal digits that are certain in a value of size `scale` with this error.
pub(super) fn certain(error: f64, scale: f64) -> f64 {
    match error {
        0.0 => MOST_DIGITS,
        _ => (-(error / scale).log10()).clamp(0.0, MOST_DIGITS),
    }
}

/// Solves the blocks' equations, each block multiplied by its factor (1 for ordinary least
/// squares, 1 over its error level for weighted), to full accuracy; see [`refine`]. Parameters
/// that the data do not determine are left out as in [`super::estimate`].
///
/// # Errors
/// As [`super::estimate`].
pub fn refined(blocks: &[Equations], factors: &[f64], np: usize) -> Result<Refined, EstimateError> {
    let triangles = Triangle::of_all(blocks)?;
    let plain = solve(&triangles, factors, np)?;
    let entries = Stacked {
        blocks,
        factors,
        row_factors: None,
        columns: &plain.independent,
    };
    let own = refine(&entries)?;
    let spread = |values: &[f64]| {
        let mut all = vec![0.0; np];
        for (column, value) in plain.independent.iter().zip(values) {
            all[*column] = *value;
        }
        all
    };
    Ok(Refined {
        solution: spread(&own.solution),
        error: spread(&own.error),
        ..own
    })
}

/// Least squares with iterative refinement.
///
/// The solution X and its residual r = Y - W X together solve Bjorck's augmented system
/// r + W X = Y, W' r = 0. How far they miss it is computed in about 32 digits, and corrected
/// with one factorisation in f64, until the corrections are negligible: this refines r too,
/// without which little is gained (Bjorck, "Iterative refinement of linear least squares
/// solutions I", BIT 7, 1967; Golub and Wilkinson 1966; Demmel et al. 2009).
///
/// # Errors
/// [`EstimateError::TooFewEquations`], [`EstimateError::Dependent`].
pub fn refine(entries: &impl Entries) -> Result<Refined, EstimateError> {
    let (rows, np) = (entries.rows(), entries.columns());
    if rows < np {
        return Err(EstimateError::TooFewEquations {
            rows,
            parameters: np,
        });
    }
    let factor = factor(entries)?;
    let mut state = State {
        x: vec![Double::default(); np],
        r: vec![Double::default(); rows],
        correction: vec![0.0; np],
    };
    let (mut steps, mut last, mut converged) = (0, f64::INFINITY, false);
    while steps < STEPS && !converged {
        let size = state.step(entries, &factor);
        steps += 1;
        converged = size < SETTLED;
        // Where corrections shrink no more, rounding has the last word, or the first.
        if steps > 2 && size > 0.5 * last {
            converged = size < f64::EPSILON;
            break;
        }
        last = size;
    }
    Ok(state.finished(entries, &factor, steps, converged))
}

/// Factors W as far as f64 holds it.
fn factor(entries: &impl Entries) -> Result<Orthogonal, EstimateError> {
    let mut column = vec![Double::default(); entries.rows()];
    let columns = (0..entries.columns()).map(|k| {
        entries.column(k, &mut column);
        column.iter().map(|entry| entry.rounded()).collect()
    });
    let factor = Orthogonal::new(columns.collect(), PLAIN);
    let norms = factor.norms();
    match norms
        .iter()
        .position(|norm| norm.is_nan() || *norm <= DEPENDENT)
    {
        Some(place) => Err(EstimateError::Dependent {
            column: factor.order()[place],
        }),
        None => Ok(factor),
    }
}

/// Solution and residual so far.
struct State {
    x: Vec<Double>,
    r: Vec<Double>,
    /// The last correction of x.
    correction: Vec<f64>,
}

impl State {
    /// Corrects x and r once; returns the largest relative correction of a parameter.
    fn step(&mut self, entries: &impl Entries, factor: &Orthogonal) -> f64 {
        let (mut f, g) = self.missing(entries);
        self.correction = factor.augmented(&mut f, &g);
        for (r, correction) in self.r.iter_mut().zip(&f) {
            *r = *r + Double::from(*correction);
        }
        for (x, correction) in self.x.iter_mut().zip(&self.correction) {
            *x = *x + Double::from(*correction);
        }
        let relative = |(x, correction): (&Double, &f64)| match correction.abs() {
            0.0 => 0.0,
            correction => correction / x.hi.abs(),
        };
        let each = self.x.iter().zip(&self.correction).map(relative);
        each.fold(0.0, f64::max)
    }

    /// What the augmented system is missed by: Y - r - W X and -W' r.
    fn missing(&self, entries: &impl Entries) -> (Vec<f64>, Vec<f64>) {
        let mut column = vec![Double::default(); self.r.len()];
        let mut f = vec![Double::default(); self.r.len()];
        entries.measurements(&mut f);
        for (f, r) in f.iter_mut().zip(&self.r) {
            *f = *f - *r;
        }
        let mut g = Vec::with_capacity(self.x.len());
        for (k, x) in self.x.iter().enumerate() {
            entries.column(k, &mut column);
            let mut sum = Double::default();
            for ((f, r), w) in f.iter_mut().zip(&self.r).zip(&column) {
                *f = *f - *w * *x;
                sum = sum - *w * *r;
            }
            g.push(sum.rounded());
        }
        (f.iter().map(|f| f.rounded()).collect(), g)
    }

    fn finished(
        self,
        entries: &impl Entries,
        factor: &Orthogonal,
        steps: usize,
        converged: bool,
    ) -> Refined {
        let solution: Vec<f64> = self.x.iter().map(|x| x.rounded()).collect();
        let mut y = vec![Double::default(); entries.rows()];
        entries.measurements(&mut y);
        let y = y.iter().map(|y| y.rounded()).collect();
        let sensitivity = Reduced::of(factor, y).sensitivity(&solution);
        let each = solution.iter().zip(&self.correction).zip(sensitivity);
        let error = each.map(|((x, correction), sensitivity)| {
            // The result itself is rounded to f64.
            let stored = 0.5 * f64::EPSILON * x.abs();
            correction.abs() + stored + entries.roundoff() * sensitivity
        });
        Refined {
            error: error.collect(),
            solution,
            steps,
            converged,
        }
    }
}
