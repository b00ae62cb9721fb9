//! Colour of the noise around a model by restricted maximum likelihood (Patterson and Thompson
//! 1971): the columns of the model take their degrees of freedom out, so that a whitener neither
//! learns what they explain nor believes what they swallow.

use std::ops::Range;

use faer::Mat;
use rayon::prelude::*;

use super::linear::{add_scaled, dot, solve};
use super::noise::{Noise, ORDER, covariance, of_rows, reflections};

/// Share of a column's square below which it repeats others.
const OWN: f64 = 1e-6;

/// Added to the square of every column, for those that whitening all but takes away.
const RIDGE: f64 = 1e-10;

/// Evaluations of the likelihood.
const MOST: usize = 240;

/// Noise of rows y around a model with the given columns, and the degrees of freedom left.
pub(super) fn noise(
    columns: &[Vec<f64>],
    y: &[f64],
    weights: &[f64],
    segments: &[Range<usize>],
) -> Noise {
    let mask: Vec<f64> = weights
        .iter()
        .map(|w| if *w > 0.0 { 1.0 } else { 0.0 })
        .collect();
    let masked =
        |rows: &[f64]| -> Vec<f64> { rows.iter().zip(&mask).map(|(r, m)| r * m).collect() };
    let unit = |rows: Vec<f64>| -> Option<Vec<f64>> {
        let length = dot(&rows, &rows).sqrt();
        (length > 0.0).then(|| rows.into_iter().map(|r| r / length).collect())
    };
    let mut all: Vec<Vec<f64>> = columns.iter().filter_map(|c| unit(masked(c))).collect();
    let y = masked(y);
    let (own, left) = projected(&all, &y, segments);
    all = own
        .into_iter()
        .map(|k| std::mem::take(&mut all[k]))
        .collect();
    all.push(y);
    let lags: Vec<Mat<f64>> = (0..=ORDER)
        .into_par_iter()
        .map(|lag| product(&all, segments, lag))
        .collect();
    let rows = mask.iter().sum::<f64>() - segments.len() as f64 * ORDER as f64;
    let start = reflections(&covariance(&left, &mask, segments));
    let start: [f64; ORDER] = start.map(|r| r.clamp(-0.97, 0.97).atanh());
    let cost =
        |free: &[f64; ORDER]| restricted(&lags, rows, free).map_or(f64::INFINITY, |(cost, _)| cost);
    let best = simplex(start, cost);
    match restricted(&lags, rows, &best) {
        Some((_, variance)) => Noise::reflected(&best.map(f64::tanh), variance.sqrt()),
        // Rounding is all that is left of the columns: the noise of what they leave.
        None => {
            let share = 1.0 - (all.len() - 1) as f64 / rows.max(all.len() as f64);
            of_rows(&left, &mask, segments, share.max(0.1))
        }
    }
}

/// Sums of products at a lag, made symmetric.
fn product(all: &[Vec<f64>], segments: &[Range<usize>], lag: usize) -> Mat<f64> {
    let m = all.len();
    let mut sum = Mat::<f64>::zeros(m, m);
    for segment in segments {
        let len = segment.len().saturating_sub(lag);
        let ahead = Mat::from_fn(len, m, |t, k| all[k][segment.start + lag + t]);
        let behind = Mat::from_fn(len, m, |t, k| all[k][segment.start + t]);
        sum += ahead.transpose() * behind;
    }
    Mat::from_fn(m, m, |i, k| 0.5 * (sum[(i, k)] + sum[(k, i)]))
}

/// The first of columns of unit length that the ones before them do not span, and what they leave of
/// y. By the sums of products of the columns: their rounding is far below [`OWN`].
fn projected(columns: &[Vec<f64>], y: &[f64], segments: &[Range<usize>]) -> (Vec<usize>, Vec<f64>) {
    let gram = product(columns, segments, 0);
    let m = columns.len();
    let gram: Vec<f64> = (0..m * m).map(|k| gram[(k / m, k % m)]).collect();
    let mut left = y.to_vec();
    let mut own = Vec::new();
    // The second time for what rounding kept of them.
    for _ in 0..2 {
        let right: Vec<f64> = columns.iter().map(|column| dot(column, &left)).collect();
        let shares = solve(&gram, &vec![1.0; m], &right, OWN);
        let shares = columns.iter().zip(shares).enumerate();
        let shares = shares.filter_map(|(k, (column, share))| Some((k, column, share?)));
        own.clear();
        for (k, column, share) in shares {
            add_scaled(&mut left, -share, column);
            own.push(k);
        }
    }
    (own, left)
}

/// What all columns but the last leave of the last, by ordinary least squares.
pub(super) fn left(mut all: Vec<Vec<f64>>) -> Vec<f64> {
    let Some(mut y) = all.pop() else {
        return Vec::new();
    };
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for mut v in all {
        for _ in 0..2 {
            for q in &basis {
                let share = dot(q, &v);
                add_scaled(&mut v, -share, q);
            }
        }
        let length = dot(&v, &v).sqrt();
        if !length.is_normal() {
            continue;
        }
        v.iter_mut().for_each(|v| *v /= length);
        let share = dot(&v, &y);
        add_scaled(&mut y, -share, &v);
        basis.push(v);
    }
    y
}

/// Minus twice the restricted log likelihood, and the variance of the noise.
fn restricted(lags: &[Mat<f64>], rows: f64, free: &[f64; ORDER]) -> Option<(f64, f64)> {
    let ar = Noise::reflected(&free.map(f64::tanh), 1.0).ar;
    let taps: Vec<f64> = std::iter::once(1.0).chain(ar.iter().map(|a| -a)).collect();
    let mut factors = [0.0; ORDER + 1];
    for (i, a) in taps.iter().enumerate() {
        for (k, b) in taps.iter().enumerate() {
            factors[i.abs_diff(k)] += a * b;
        }
    }
    let m = lags.first()?.nrows();
    let p = m - 1;
    // Cholesky of the sums; the last pivot is the sum of squares that is left.
    let mut lower = vec![0.0; m * m];
    let mut log_det = 0.0;
    for i in 0..m {
        for k in 0..=i {
            let ridge = if i == k && i < p {
                RIDGE * factors[0]
            } else {
                0.0
            };
            let terms = factors.iter().zip(lags).map(|(f, lag)| f * lag[(i, k)]);
            let sum = ridge + terms.sum::<f64>();
            let (row, other) = (&lower[i * m..i * m + k], &lower[k * m..k * m + k]);
            let rest = sum - dot(row, other);
            lower[i * m + k] = if i > k {
                rest / lower[k * m + k]
            } else if rest > 0.0 {
                rest.sqrt()
            } else {
                return None;
            };
        }
        if i < p {
            log_det += 2.0 * lower[i * m + i].ln();
        }
    }
    let freedom = (rows - p as f64).max(1.0);
    let variance = lower[m * m - 1].powi(2) / freedom;
    Some((freedom * variance.ln() + log_det, variance))
}

/// Nelder and Mead's simplex.
fn simplex(start: [f64; ORDER], cost: impl Fn(&[f64; ORDER]) -> f64) -> [f64; ORDER] {
    let mut points: Vec<([f64; ORDER], f64)> = vec![(start, cost(&start))];
    for k in 0..ORDER {
        let mut point = start;
        point[k] += 0.15;
        points.push((point, cost(&point)));
    }
    for _ in 0..MOST {
        points.sort_by(|a, b| a.1.total_cmp(&b.1));
        if points[ORDER].1 - points[0].1 < 1e-3 {
            break;
        }
        let centre: [f64; ORDER] = std::array::from_fn(|i| {
            points[..ORDER].iter().map(|(p, _)| p[i]).sum::<f64>() / ORDER as f64
        });
        let worst = points[ORDER];
        let step = |far: f64| -> ([f64; ORDER], f64) {
            let point = std::array::from_fn(|i| centre[i] + far * (worst.0[i] - centre[i]));
            (point, cost(&point))
        };
        let reflected = step(-1.0);
        let next = if reflected.1 < points[0].1 {
            let expanded = step(-2.0);
            if expanded.1 < reflected.1 {
                expanded
            } else {
                reflected
            }
        } else if reflected.1 < points[ORDER - 1].1 {
            reflected
        } else {
            step(if reflected.1 < worst.1 { -0.5 } else { 0.5 })
        };
        if next.1 < worst.1 {
            points[ORDER] = next;
            continue;
        }
        let best = points[0].0;
        for point in &mut points[1..] {
            point.0 = std::array::from_fn(|i| 0.5 * (best[i] + point.0[i]));
            point.1 = cost(&point.0);
        }
    }
    points.sort_by(|a, b| a.1.total_cmp(&b.1));
    points[0].0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_columns_leave_is_what_they_leave_one_by_one() {
        let len = 2000;
        let wave = |n: usize| -> Vec<f64> {
            let size = (2.0 / len as f64).sqrt();
            let turn = n as f64 * std::f64::consts::TAU / len as f64;
            (0..len).map(|t| size * (turn * t as f64).sin()).collect()
        };
        let mixed = |a: Vec<f64>, b: Vec<f64>| -> Vec<f64> {
            a.iter().zip(b).map(|(a, b)| 0.6 * a + 0.8 * b).collect()
        };
        // The third is spanned by the two before it; the fourth almost.
        let mut almost = wave(2);
        add_scaled(&mut almost, 0.01, &wave(5));
        let columns = [wave(1), wave(2), mixed(wave(1), wave(2)), almost];
        let y: Vec<f64> = (0..len).map(|t| ((t * t) % 97) as f64 / 97.0).collect();
        let (own, rest) = projected(&columns, &y, &[0..700, 700..len]);
        assert_eq!(own, [0, 1, 3]);
        let [first, second, _, almost] = columns;
        let orthogonal = left(vec![first, second, almost, y]);
        for (a, b) in rest.iter().zip(orthogonal) {
            assert!((a - b).abs() < 1e-12, "{a} against {b}");
        }
    }

    #[test]
    fn columns_do_not_bias_the_colour() {
        // Slow noise, and slow columns that would swallow a good deal of it.
        let (len, ar) = (3000, 0.95);
        let mut state = 7_u64;
        let mut y = vec![0.0; len];
        for t in 1..len {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            y[t] = ar * y[t - 1] + (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
        }
        let wave = |n: usize| {
            move |t: usize| (n as f64 * t as f64 * std::f64::consts::TAU / len as f64).sin()
        };
        let columns: Vec<Vec<f64>> = (1..40).map(|n| (0..len).map(wave(n)).collect()).collect();
        let found = noise(
            &columns,
            &y,
            &vec![1.0; len],
            std::slice::from_ref(&(0..len)),
        );
        let gain = 1.0 - found.ar.iter().sum::<f64>();
        assert!((0.035..0.07).contains(&gain), "{:?}", found.ar);
        assert!(
            (found.sigma / (1.0_f64 / 12.0).sqrt() - 1.0).abs() < 0.04,
            "{}",
            found.sigma
        );
    }
}
