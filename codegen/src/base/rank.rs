//! Which columns are independent.

use nalgebra::{DMatrix, DVector};

use super::BaseError;
use crate::derive::Standard;

/// The smallest gap between kept and dropped singular values that counts as a rank.
const LEAST_GAP: f64 = 1e3;

/// Kept and dropped columns.
#[derive(Clone, Debug)]
pub struct Split {
    /// Independent columns, in the order in which they were chosen.
    pub kept: Vec<usize>,
    /// Columns that depend on the kept ones.
    pub dependent: Vec<usize>,
    /// What is left of each kept column, taken as a unit vector, beside those kept before it.
    pub apart: Vec<f64>,
    /// Last kept over first dropped singular value of the scaled regressor.
    pub gap: f64,
}

/// Splits the columns: the numeric rank comes from the singular values, the choice from the
/// priority (columns earlier in it are kept).
///
/// # Errors
/// [`BaseError::NoGap`] when the singular values do not fall off clearly.
pub fn split(w: &DMatrix<f64>, priority: &[usize], all: &[Standard]) -> Result<Split, BaseError> {
    let norms: Vec<f64> = w.column_iter().map(|column| column.norm()).collect();
    let largest = norms.iter().fold(0.0, |a: f64, &b| a.max(b));
    // A column without effect is rounding at most.
    let live: Vec<usize> = priority
        .iter()
        .copied()
        .filter(|&column| norms[column] > 1e-10 * largest)
        .collect();
    let columns: Vec<DVector<f64>> = live
        .iter()
        .map(|&column| w.column(column) / norms[column])
        .collect();
    if columns.is_empty() {
        return Ok(Split {
            kept: vec![],
            dependent: vec![],
            apart: vec![],
            gap: f64::INFINITY,
        });
    }
    // An orthogonal transformation changes neither lengths nor angles of the columns: their
    // triangle tells all that many samples do.
    let triangle = DMatrix::from_columns(&columns).qr().r();
    let (rank, gap, threshold) = numeric_rank(&triangle);
    let columns: Vec<DVector<f64>> = triangle.column_iter().map(DVector::from).collect();
    let residuals = orthogonalise(&columns, threshold);
    let mut split = Split {
        kept: vec![],
        dependent: vec![],
        apart: vec![],
        gap,
    };
    for (&column, &residual) in live.iter().zip(&residuals) {
        if residual > threshold {
            split.kept.push(column);
            split.apart.push(residual);
        } else {
            split.dependent.push(column);
        }
    }
    if gap < LEAST_GAP || split.kept.len() != rank {
        let columns = near(&live, &residuals, threshold, all);
        return Err(BaseError::NoGap { gap, columns });
    }
    Ok(split)
}

/// The rank at the largest drop of the singular values, that drop, and a threshold between.
fn numeric_rank(triangle: &DMatrix<f64>) -> (usize, f64, f64) {
    let mut sigma: Vec<f64> = triangle.singular_values().iter().copied().collect();
    sigma.sort_by(|a, b| b.total_cmp(a));
    let floor = f64::EPSILON * sigma[0];
    sigma.push(floor);
    let mut best = (sigma.len() - 1, 0.0);
    for rank in 1..sigma.len() {
        let drop = sigma[rank - 1] / sigma[rank].max(floor);
        if drop > best.1 {
            best = (rank, drop);
        }
    }
    let (rank, gap) = best;
    (rank, gap, (sigma[rank - 1] * sigma[rank].max(floor)).sqrt())
}

/// What is left of each unit column after projection onto the kept ones before it
/// (Gram-Schmidt, twice, which is enough for orthogonality to rounding).
fn orthogonalise(columns: &[DVector<f64>], threshold: f64) -> Vec<f64> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let mut residuals = Vec::with_capacity(columns.len());
    for column in columns {
        let mut rest = column.clone();
        for _ in 0..2 {
            for direction in &basis {
                let along = direction.dot(&rest);
                rest.axpy(-along, direction, 1.0);
            }
        }
        let norm = rest.norm();
        residuals.push(norm);
        if norm > threshold {
            basis.push(rest / norm);
        }
    }
    residuals
}

/// What is left of a unit column that is nearly dependent: more than rounding, less than this.
const NEARLY: std::ops::Range<f64> = 1e-13..1e-3;

/// Names of the columns that are nearly dependent, those nearest to the threshold first; where
/// there are none, of whatever is nearest to it.
fn near(live: &[usize], residuals: &[f64], threshold: f64, all: &[Standard]) -> Vec<String> {
    let mut order: Vec<usize> = (0..live.len()).collect();
    let distance = |index: usize| (residuals[index].max(f64::EPSILON) / threshold).ln().abs();
    order.sort_by(|&a, &b| distance(a).total_cmp(&distance(b)));
    let nearly = |index: &usize| NEARLY.contains(&residuals[*index]);
    if order.iter().any(nearly) {
        order.retain(nearly);
    }
    order
        .into_iter()
        .take(6)
        .map(|index| all[live[index]].name.clone())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::derive::{Columns, ParameterKind};

    fn named(names: &[String]) -> Vec<Standard> {
        let of = |name: &String| Standard {
            name: name.clone(),
            unit: "kg",
            meaning: String::new(),
            link: 0,
            kind: ParameterKind::Effect,
            columns: Columns::default(),
        };
        names.iter().map(of).collect()
    }

    /// Columns e_0 and e_0 + step^k e_k for k = 1, 2, ...
    fn ladder(count: i32, step: f64) -> DMatrix<f64> {
        DMatrix::from_fn(20, count as usize, |row, column| {
            let own = step.powi(column as i32);
            let first = if row == 0 { 1.0 } else { 0.0 };
            first + if row == column && row > 0 { own } else { 0.0 }
        })
    }

    fn split_of(w: &DMatrix<f64>) -> Result<Split, BaseError> {
        let names: Vec<String> = (0..w.ncols()).map(|column| format!("X{column}")).collect();
        let priority: Vec<usize> = (0..w.ncols()).collect();
        split(w, &priority, &named(&names))
    }

    #[test]
    fn clear_rank_comes_with_its_gap() {
        let mut w = ladder(3, 0.5);
        let twice = w.column(1) * 2.0;
        w = w.insert_column(3, 0.0);
        w.set_column(3, &twice);
        let split = split_of(&w).unwrap_or_else(|error| unreachable!("{error}"));
        assert_eq!((split.kept, split.dependent), (vec![0, 1, 2], vec![3]));
        assert!(split.gap > 1e10, "{}", split.gap);
    }

    #[test]
    fn columns_that_are_neither_dependent_nor_independent_are_named() {
        // Singular values fall by a hundred from each to the next, down to rounding.
        let Err(BaseError::NoGap { gap, columns }) = split_of(&ladder(8, 1e-2)) else {
            unreachable!("a rank was found");
        };
        assert!(gap < LEAST_GAP, "{gap}");
        assert_eq!(columns, ["X2", "X3", "X4", "X5", "X6"]);
        let error = BaseError::NoGap { gap, columns }.to_string();
        assert!(error.contains("nearly dependent: X2, X3"), "{error}");
    }

    /// Number of base parameters and the gap of a planar arm whose second axis is tilted.
    fn tilted(alpha: &str) -> (usize, f64) {
        let joint = |ant: usize, alpha: &str, d: f64| {
            format!(
                "[[joint]]\nname = \"j{ant}\"\nkind = \"revolute\"\nant = {ant}\n\
                 alpha = \"{alpha}\"\nd = {d}\n"
            )
        };
        let rows = [joint(0, "0", 0.0), joint(1, alpha, 0.3), joint(2, "0", 0.4)];
        let text = format!("name = \"arm\"\neffects = []\n{}", rows.concat());
        let robot = crate::builder::read_texts(&[("arm.toml", &text)]);
        let robot = robot.unwrap_or_else(|error| unreachable!("{error}"));
        (robot.base.parameters.len(), robot.base.gap)
    }

    #[test]
    fn nearly_parallel_axes_are_parallel_and_tilted_ones_have_a_clear_rank() {
        let (parallel, gap) = tilted("0");
        assert!(gap > 1e12, "{gap:e}");
        let (nearly, gap) = tilted("1e-9");
        assert_eq!(nearly, parallel);
        assert!(gap > 1e12, "{gap:e}");
        let (tilted, gap) = tilted("2e-3");
        assert!(tilted > parallel && gap > 1e9, "{tilted}, {gap:e}");
    }
}
