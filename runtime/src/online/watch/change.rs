//! Whether two sets of rows have the same parameters and the same residuals.

use super::super::factor::Factor;

/// A pivot this much smaller than its column is rounding.
const ROUNDING: f64 = 1e-9;

/// Columns that a factor of `[w | e]` determines, as a number of degrees of freedom.
pub(super) fn rank(factor: &Factor) -> f64 {
    let real = |k: &usize| factor.entry(*k, *k) > ROUNDING * factor.column_norm(*k);
    (0..factor.width() - 1).filter(real).count() as f64
}

/// Square of the residual that least squares leaves.
pub(super) fn rest(factor: &Factor) -> f64 {
    factor.entry(factor.width() - 1, factor.width() - 1).powi(2)
}

/// What least squares takes off the residual of no parameters at all.
pub(super) fn gain(factor: &Factor) -> f64 {
    let last = factor.width() - 1;
    (0..last).map(|i| factor.entry(i, last).powi(2)).sum()
}

/// Least-squares parameters by back substitution, zero where a column tells nothing.
pub(super) fn solve(factor: &Factor, x: &mut [f64]) {
    let last = factor.width() - 1;
    for k in (0..last).rev() {
        let row = factor.row(k);
        let others = row[1..].iter().zip(&x[k + 1..]).take(last - k - 1);
        let sum: f64 = others.map(|(r, x)| r * x).sum();
        x[k] = match row[0] > ROUNDING * factor.column_norm(k) {
            true => (factor.entry(k, last) - sum) / row[0],
            false => 0.0,
        };
    }
}

/// \\( \|e - w x\|^2 \\) of a factor's rows.
pub(super) fn square(factor: &Factor, x: &[f64]) -> f64 {
    let last = factor.width() - 1;
    let residual = |i: usize| {
        let products = factor.row(i).iter().zip(x.iter().skip(i));
        factor.entry(i, last) - products.take(last - i).map(|(r, x)| r * x).sum::<f64>()
    };
    (0..=last).map(|i| residual(i).powi(2)).sum()
}

/// Residuals left, and how many rows are left for them.
pub(super) fn variance(factor: &Factor) -> (f64, f64) {
    variance_of(factor, rank(factor))
}

/// The same where the rank is known.
pub(super) fn variance_of(factor: &Factor, rank: f64) -> (f64, f64) {
    let freedom = (factor.rows - rank).max(1.0);
    (rest(factor) / freedom, freedom)
}

/// Two sets of rows, their union, and by how much more than chance allows they differ, in standard
/// deviations. Chow, "Tests of equality between sets of coefficients in two linear regressions",
/// Econometrica 28, 1960. `spread` is how much more blocks of one healthy robot differ.
pub(super) fn parameters(old: &Factor, new: &Factor, both: &Factor, spread: f64) -> f64 {
    let common = rank(old) + rank(new) - rank(both);
    if common < 1.0 {
        return 0.0;
    }
    let more = (rest(both) - rest(old) - rest(new)).max(0.0);
    let freedom = (old.rows + new.rows - rank(old) - rank(new)).max(1.0);
    let level = (rest(old) + rest(new)) / freedom;
    normal(more / common / level / spread, common, freedom)
}

/// By how much more than chance allows the residuals of new rows are larger than those of old ones,
/// in standard deviations.
pub(super) fn residuals(old: &Factor, new: &Factor, spread: f64) -> f64 {
    let ((old, many), (new, few)) = (variance(old), variance(new));
    normal(new / old, few / spread, many / spread)
}

/// The standard normal value that is passed as rarely as `f` is in Fisher's distribution with
/// `above` and `below` degrees of freedom (Paulson, "An approximate normalization of the analysis of
/// variance distribution", Annals of Mathematical Statistics 13, 1942): no iteration.
pub(super) fn normal(f: f64, above: f64, below: f64) -> f64 {
    if !f.is_finite() {
        return if f > 0.0 { f64::MAX } else { 0.0 };
    }
    let (a, b) = (2.0 / (9.0 * above), 2.0 / (9.0 * below));
    let root = f.max(0.0).cbrt();
    ((1.0 - b) * root - (1.0 - a)) / (b * root * root + a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_values_are_those_of_fishers_tables() {
        // Upper points of F by SciPy (`f.isf`): 5 %, 0.1 % and 1e-9, that is 1.645, 3.090 and 5.998
        // standard deviations, of (8, 200) and (20, 1000) degrees of freedom.
        for (f, above, below, expected) in [
            (1.98492, 8.0, 200.0, 1.64485),
            (3.43430, 8.0, 200.0, 3.09023),
            (8.32222, 8.0, 200.0, 5.99781),
            (1.58106, 20.0, 1000.0, 1.64485),
            (2.29683, 20.0, 1000.0, 3.09023),
            (4.31302, 20.0, 1000.0, 5.99781),
        ] {
            // Paulson's approximation is 2.5 % too careful far out.
            let share = normal(f, above, below) / expected;
            assert!(share > 0.975 && share < 1.002, "{share}");
        }
    }

    #[test]
    fn only_what_changed_counts() {
        let x = |i: usize| ((i * i) as f64 * 0.37).sin();
        let noise = |i: usize| 0.1 * ((i * i) as f64 * 1.71).cos();
        let rows = |slope: f64, size: f64, start: usize| {
            let mut factor = Factor::new(3);
            for i in start..start + 400 {
                let e = slope * x(i) + size * noise(i);
                factor.add(&[0, 1], &[x(i), 1.0], e, 1.0);
            }
            factor
        };
        let with = |slope, size| {
            let (old, new) = (rows(0.0, 1.0, 0), rows(slope, size, 400));
            let mut both = old.clone();
            both.merge(&new);
            (
                parameters(&old, &new, &both, 1.0),
                residuals(&old, &new, 1.0),
            )
        };
        let (same, as_large) = with(0.0, 1.0);
        assert!(same < 3.0 && as_large.abs() < 3.0, "{same} {as_large}");
        let (changed, as_large) = with(0.1, 1.0);
        assert!(
            changed > 8.0 && as_large.abs() < 3.0,
            "{changed} {as_large}"
        );
        let (same, larger) = with(0.0, 2.0);
        assert!(same < 3.0 && larger > 8.0, "{same} {larger}");
    }
}
