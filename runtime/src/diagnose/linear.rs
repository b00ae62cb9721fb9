//! Sums over long vectors and small symmetric systems.

use pulp::Arch;

/// Smallest share of a column's square that must be left of it for it to count as its own.
pub(super) const OWN: f64 = 1e-10;

/// Partial sums of a product: as many as keep the widest vectors busy, and on all machines the same.
const PARTS: usize = 32;

/// Those that few rows are left to.
const FEW: usize = 8;

/// \\( a^T b \\) of two vectors of one length.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    Arch::new().dispatch(
        #[inline(always)]
        || {
            let (wide, tail) = a.as_chunks::<PARTS>();
            let (other, rest) = b.as_chunks::<PARTS>();
            let mut sums = [0.0; PARTS];
            for (a, b) in wide.iter().zip(other) {
                add_products(&mut sums, a, b);
            }
            let mut few: [f64; FEW] = std::array::from_fn(|k| {
                (sums[k] + sums[k + FEW]) + (sums[k + 2 * FEW] + sums[k + 3 * FEW])
            });
            let (wide, tail) = tail.as_chunks::<FEW>();
            let (other, rest) = rest.as_chunks::<FEW>();
            for (a, b) in wide.iter().zip(other) {
                add_products(&mut few, a, b);
            }
            add_products(&mut few, tail, rest);
            let [a, b, c, d, e, f, g, h] = few;
            ((a + b) + (c + d)) + ((e + f) + (g + h))
        },
    )
}

/// Adds products to as many sums as there are at most.
#[inline(always)]
fn add_products(sums: &mut [f64], a: &[f64], b: &[f64]) {
    for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
        *sum += a * b;
    }
}

/// \\( y \leftarrow y + s x \\).
pub(super) fn add_scaled(y: &mut [f64], s: f64, x: &[f64]) {
    Arch::new().dispatch(
        #[inline(always)]
        || {
            for (y, x) in y.iter_mut().zip(x) {
                *y += s * x;
            }
        },
    );
}

/// The solution of \\( G x = g \\), G symmetric and positive semidefinite (m x m, row-major), by
/// Cholesky with the columns in their order. A column of which less than `least` of `squares`, its
/// own square before anything was projected out, is left gets `None` and counts as zero.
pub(super) fn solve(gram: &[f64], squares: &[f64], right: &[f64], least: f64) -> Vec<Option<f64>> {
    let m = right.len();
    let mut lower = vec![0.0; m * m];
    let mut own = vec![true; m];
    for j in 0..m {
        let above = |i: usize, k: usize, lower: &[f64]| {
            (0..k)
                .map(|l| lower[i * m + l] * lower[k * m + l])
                .sum::<f64>()
        };
        let left = gram[j * m + j] - above(j, j, &lower);
        own[j] = left > least * squares[j] && left > 0.0;
        if !own[j] {
            continue;
        }
        lower[j * m + j] = left.sqrt();
        for i in j + 1..m {
            lower[i * m + j] = (gram[i * m + j] - above(i, j, &lower)) / lower[j * m + j];
        }
    }
    let mut x = vec![0.0; m];
    for i in 0..m {
        let sum: f64 = (0..i).map(|k| lower[i * m + k] * x[k]).sum();
        x[i] = if own[i] {
            (right[i] - sum) / lower[i * m + i]
        } else {
            0.0
        };
    }
    for i in (0..m).rev() {
        let sum: f64 = (i + 1..m).map(|k| lower[k * m + i] * x[k]).sum();
        x[i] = if own[i] {
            (x[i] - sum) / lower[i * m + i]
        } else {
            0.0
        };
    }
    x.into_iter()
        .zip(own)
        .map(|(x, own)| own.then_some(x))
        .collect()
}

/// Chi-square survival: the probability that a sum of `dof` squares of standard normal values is
/// larger than `x`. By the finite sums for whole numbers of degrees of freedom
/// (Abramowitz and Stegun 26.4.4, 26.4.5).
pub(super) fn chi_square_survival(x: f64, dof: usize) -> f64 {
    if x <= 0.0 || dof == 0 {
        return 1.0;
    }
    let half = 0.5 * x;
    if dof.is_multiple_of(2) {
        let mut term = 1.0;
        let mut sum = 1.0;
        for k in 1..dof / 2 {
            term *= half / k as f64;
            sum += term;
        }
        return (sum.ln() - half).exp().min(1.0);
    }
    let root = x.sqrt();
    let density = (-half).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let mut term = root;
    let mut sum = 0.0;
    for k in 0..(dof - 1) / 2 {
        sum += term;
        term *= x / (2 * k + 3) as f64;
    }
    (two_sided_tail(root) + 2.0 * density * sum).min(1.0)
}

/// Probability that a standard normal value is further from 0 than `z` > 0: continued fraction for
/// large z, series for small.
fn two_sided_tail(z: f64) -> f64 {
    let density = (-0.5 * z * z).exp() / (2.0 * std::f64::consts::PI).sqrt();
    if z > 2.5 {
        let fraction = (1..200).rev().fold(z, |below, k| z + f64::from(k) / below);
        return 2.0 * density / fraction;
    }
    let mut term = z;
    let mut sum = z;
    for k in 1..200 {
        term *= z * z / f64::from(2 * k + 1);
        sum += term;
    }
    1.0 - 2.0 * density * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_any_length_are_summed_once() {
        // Whole numbers: every order of summing gives the same.
        for len in 0..200 {
            let a: Vec<f64> = (0..len).map(|k| f64::from(k % 17) - 8.0).collect();
            let b: Vec<f64> = (0..len).map(|k| f64::from(k * k % 23) - 11.0).collect();
            let one_by_one: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
            assert_eq!(dot(&a, &b), one_by_one, "{len}");
        }
    }

    #[test]
    fn a_column_that_repeats_another_is_none() {
        let gram = [4.0, 4.0, 2.0, 4.0, 4.0, 2.0, 2.0, 2.0, 9.0];
        let x = solve(&gram, &[4.0, 4.0, 9.0], &[8.0, 8.0, 12.0], OWN);
        assert_eq!(x[1], None);
        let (a, c) = (x[0].unwrap(), x[2].unwrap());
        assert!((4.0 * a + 2.0 * c - 8.0).abs() < 1e-12);
        assert!((2.0 * a + 9.0 * c - 12.0).abs() < 1e-12);
    }

    #[test]
    fn tails_agree_with_tables() {
        // R: pchisq(x, dof, lower = FALSE).
        for (x, dof, expected) in [
            (3.841_458_820_694_124, 1, 0.05),
            (36.0, 1, 1.973_175_290_075_397e-9),
            (5.991_464_547_107_979, 2, 0.05),
            (11.344_866_730_144_37, 3, 0.01),
            (18.307_038_053_275_15, 10, 0.05),
        ] {
            let tail = chi_square_survival(x, dof);
            assert!((tail / expected - 1.0).abs() < 1e-9, "{x} {dof}: {tail}");
        }
    }
}
