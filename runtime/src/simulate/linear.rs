//! Dense linear algebra of the size of a robot, in place and without allocation.

/// Cholesky factorisation M = L L^T of an n x n matrix, row-major, in place; only the lower
/// triangle is read and written.
///
/// # Errors
/// Row and value of the first pivot that is not clearly positive.
pub(super) fn factor(m: &mut [f64], n: usize) -> Result<(), (usize, f64)> {
    let largest = (0..n).map(|i| m[i * n + i].abs()).fold(0.0, f64::max);
    let smallest = largest * n as f64 * f64::EPSILON;
    for j in 0..n {
        let square: f64 = (0..j).map(|k| m[j * n + k] * m[j * n + k]).sum();
        let pivot = m[j * n + j] - square;
        // Written so that NaN fails too.
        if !(pivot > smallest && pivot.is_finite()) {
            return Err((j, pivot));
        }
        let root = pivot.sqrt();
        m[j * n + j] = root;
        for i in j + 1..n {
            let product: f64 = (0..j).map(|k| m[i * n + k] * m[j * n + k]).sum();
            m[i * n + j] = (m[i * n + j] - product) / root;
        }
    }
    Ok(())
}

/// Solves L L^T x = b in place, with L from [`factor`].
pub(super) fn solve(l: &[f64], n: usize, x: &mut [f64]) {
    for i in 0..n {
        let product: f64 = (0..i).map(|k| l[i * n + k] * x[k]).sum();
        x[i] = (x[i] - product) / l[i * n + i];
    }
    for i in (0..n).rev() {
        let product: f64 = (i + 1..n).map(|k| l[k * n + i] * x[k]).sum();
        x[i] = (x[i] - product) / l[i * n + i];
    }
}

/// Solves A x = b for a small general matrix, n x n, row-major, by elimination with row pivoting;
/// A is destroyed, x replaces b. An unknown whose pivot vanishes is zero.
pub(super) fn eliminate(a: &mut [f64], n: usize, b: &mut [f64]) {
    let largest = a[..n * n].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let vanishing = 1e-14 * largest;
    for j in 0..n {
        let pivot = (j..n).fold(j, |p, i| {
            if a[i * n + j].abs() > a[p * n + j].abs() {
                i
            } else {
                p
            }
        });
        if pivot != j {
            (0..n).for_each(|k| a.swap(pivot * n + k, j * n + k));
            b.swap(pivot, j);
        }
        if a[j * n + j].abs() <= vanishing {
            continue;
        }
        for i in j + 1..n {
            let ratio = a[i * n + j] / a[j * n + j];
            (j..n).for_each(|k| a[i * n + k] -= ratio * a[j * n + k]);
            b[i] -= ratio * b[j];
        }
    }
    for i in (0..n).rev() {
        let product: f64 = (i + 1..n).map(|k| a[i * n + k] * b[k]).sum();
        let pivot = a[i * n + i];
        b[i] = if pivot.abs() <= vanishing {
            0.0
        } else {
            (b[i] - product) / pivot
        };
    }
}

/// Scalar product.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `y += factor * x`.
pub(super) fn add(y: &mut [f64], factor: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}
