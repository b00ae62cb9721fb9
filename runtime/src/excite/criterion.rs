//! What makes a motion exciting, as a function of the normal matrix.

use faer::prelude::Solve;
use faer::{Mat, Side};
use serde::Serialize;

/// What is minimised over the motions.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Criterion {
    /// cond(W), columns in SI units as they are: what an identification prints.
    Condition,
    /// cond(W) with columns of unit norm: whether parameters can be told apart, however large.
    Scaled,
    /// det(W' S^-1 W)^(-1/2), S the noise of the joints (D-optimal): the volume in which the
    /// parameters are known to lie, in any units.
    Determinant,
    /// Standard deviations of some columns, all others being estimated, too: the reciprocal norms
    /// of what remains of a column after regression on all others.
    Separate {
        /// Columns of the model, counted from 0.
        columns: Vec<usize>,
    },
}

/// A criterion and its slopes with respect to the normal matrix.
pub(super) struct Slope {
    pub value: f64,
    pub of_gram: Mat<f64>,
}

impl Criterion {
    /// Whether the rows of a joint are divided by its noise.
    pub(super) fn is_weighted(&self) -> bool {
        matches!(self, Criterion::Determinant | Criterion::Separate { .. })
    }

    /// The logarithm of the criterion for W'W. Condition numbers are smoothed: norms of order
    /// `sharpness` of the eigenvalues and of their reciprocals stand for the largest of each, so
    /// that the value is an upper bound. `columns` are those of [`Criterion::Separate`] among the
    /// columns of W. `None` if W'W is numerically singular.
    pub(super) fn slope(
        &self,
        gram: &Mat<f64>,
        sharpness: f64,
        columns: &[usize],
    ) -> Option<Slope> {
        match self {
            Criterion::Condition => condition(gram, sharpness),
            Criterion::Scaled => scaled(gram, sharpness),
            Criterion::Determinant => determinant(gram),
            Criterion::Separate { .. } => separate(gram, columns),
        }
    }
}

/// 1/(2p) (ln sum lambda^p + ln sum lambda^-p), at least ln cond(W) = 1/2 ln(largest / smallest).
fn condition(gram: &Mat<f64>, p: f64) -> Option<Slope> {
    let n = gram.nrows();
    let eigen = gram.self_adjoint_eigen(Side::Lower).ok()?;
    let values: Vec<f64> = eigen.S().column_vector().iter().copied().collect();
    let largest = values.iter().copied().fold(0.0, f64::max);
    if !values.iter().all(|value| *value > 1e-14 * largest) {
        return None;
    }
    let logs: Vec<f64> = values.iter().map(|value| value.ln()).collect();
    let [(up, shares_up), (down, shares_down)] = [p, -p].map(|power| {
        let top = logs.iter().map(|log| power * log).fold(f64::MIN, f64::max);
        let terms: Vec<f64> = logs.iter().map(|log| (power * log - top).exp()).collect();
        let sum: f64 = terms.iter().sum();
        (
            top + sum.ln(),
            terms.into_iter().map(move |term| term / sum),
        )
    });
    let slopes: Vec<f64> = shares_up
        .zip(shares_down)
        .zip(&values)
        .map(|((up, down), value)| 0.5 * (up - down) / value)
        .collect();
    let u = eigen.U();
    let turned = Mat::from_fn(n, n, |i, k| u[(i, k)] * slopes[k]);
    Some(Slope {
        value: (up + down) / (2.0 * p),
        of_gram: turned * u.transpose(),
    })
}

/// The same with columns of unit norm.
fn scaled(gram: &Mat<f64>, p: f64) -> Option<Slope> {
    let n = gram.nrows();
    let scale: Vec<f64> = (0..n).map(|i| 1.0 / gram[(i, i)].sqrt()).collect();
    if !scale.iter().all(|scale| scale.is_finite()) {
        return None;
    }
    let unit = Mat::from_fn(n, n, |i, k| scale[i] * gram[(i, k)] * scale[k]);
    let Slope { value, of_gram } = condition(&unit, p)?;
    let turned = &of_gram * &unit;
    let slopes = Mat::from_fn(n, n, |i, k| {
        let through_norm = if i == k {
            turned[(i, i)] / gram[(i, i)]
        } else {
            0.0
        };
        scale[i] * of_gram[(i, k)] * scale[k] - through_norm
    });
    Some(Slope {
        value,
        of_gram: slopes,
    })
}

/// -1/(2n) ln det.
fn determinant(gram: &Mat<f64>) -> Option<Slope> {
    let n = gram.nrows();
    let factor = gram.llt(Side::Lower).ok()?;
    let l = factor.L();
    let logs = (0..n).map(|i| l[(i, i)].ln()).sum::<f64>() / n as f64;
    let inverse = factor.solve(Mat::<f64>::identity(n, n));
    Some(Slope {
        value: -logs,
        of_gram: inverse * faer::Scale(-0.5 / n as f64),
    })
    .filter(|slope| slope.value.is_finite())
}

/// 1/2 mean over the columns c of ln (W'W)^-1_cc: of ln sigma_c.
fn separate(gram: &Mat<f64>, columns: &[usize]) -> Option<Slope> {
    let n = gram.nrows();
    let factor = gram.llt(Side::Lower).ok()?;
    let inverse = factor.solve(Mat::<f64>::identity(n, n));
    let share = 0.5 / columns.len().max(1) as f64;
    let mut slope = Slope {
        value: 0.0,
        of_gram: Mat::zeros(n, n),
    };
    for &c in columns {
        slope.value += share * inverse[(c, c)].ln();
        for k in 0..n {
            for i in 0..n {
                slope.of_gram[(i, k)] -=
                    share * inverse[(i, c)] * inverse[(c, k)] / inverse[(c, c)];
            }
        }
    }
    Some(slope).filter(|slope| slope.value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A positive definite matrix of no special form.
    fn gram(shift: f64) -> Mat<f64> {
        let w = Mat::from_fn(9, 4, |i, k| {
            ((3 * i + 5 * k * k) as f64 + shift * (i * k) as f64).sin()
        });
        w.transpose() * &w
    }

    fn all() -> [Criterion; 4] {
        let columns = vec![1, 3];
        [
            Criterion::Condition,
            Criterion::Scaled,
            Criterion::Determinant,
            Criterion::Separate { columns },
        ]
    }

    #[test]
    fn slopes_are_those_of_differences() {
        let step = 1e-6;
        let [before, at, after] = [-step, 0.0, step].map(|shift| gram(0.3 + shift));
        for criterion in all() {
            let of = |gram: &Mat<f64>| criterion.slope(gram, 3.0, &[1, 3]).unwrap();
            let slope = of(&at).of_gram;
            let terms = (0..4).flat_map(|i| (0..4).map(move |k| (i, k)));
            let expected: f64 = terms
                .map(|place| slope[place] * (after[place] - before[place]))
                .sum();
            let found = of(&after).value - of(&before).value;
            assert!(
                (found - expected).abs() < 1e-4 * expected.abs(),
                "{criterion:?}"
            );
        }
    }

    #[test]
    fn smoothed_condition_is_an_upper_bound_that_sharpens() {
        let w = Mat::from_fn(4, 4, |i, k| if i == k { (i + 1) as f64 } else { 0.0 });
        let gram = w.transpose() * &w;
        let value = |p: f64| {
            Criterion::Condition
                .slope(&gram, p, &[])
                .unwrap()
                .value
                .exp()
        };
        assert!(value(1.0) > value(4.0) && value(4.0) > 4.0);
        assert!((value(40.0) - 4.0).abs() < 1e-3);
        let scaled = Criterion::Scaled.slope(&gram, 40.0, &[]).unwrap().value;
        assert!((scaled.exp() - 1.0).abs() < 0.05);
    }

    #[test]
    fn singular_normal_matrices_have_no_value() {
        let gram = Mat::from_fn(3, 3, |_, _| 1.0);
        for criterion in all() {
            assert!(criterion.slope(&gram, 2.0, &[1]).is_none(), "{criterion:?}");
        }
    }
}
