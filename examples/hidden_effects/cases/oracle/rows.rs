//! Weighted least squares of whitened rows.

/// Order of the residuals' autoregression.
const ORDER: usize = 4;

/// Factors of an autoregression and the standard deviation of its innovations.
pub type Colour = (Vec<f64>, f64);

/// Equations of a joint, with the columns beyond the model's at the end.
pub struct Joint {
    /// Parameter and rows of each column.
    pub columns: Vec<(usize, Vec<f64>)>,
    /// Measurements.
    pub y: Vec<f64>,
    /// Rows at which the joint may stand still: what friction does there, no log tells.
    pub rests: Vec<bool>,
}

/// What parameters leave.
pub fn residual(joint: &Joint, x: &[f64]) -> Vec<f64> {
    let mut left = joint.y.clone();
    for (k, rows) in &joint.columns {
        left.iter_mut()
            .zip(rows)
            .for_each(|(left, w)| *left -= x[*k] * w);
    }
    left
}

impl Joint {
    /// Innovations that count.
    pub fn whiten(&self, series: &[f64], noise: &Colour) -> Vec<f64> {
        let mut white = whiten(series, noise);
        white
            .iter_mut()
            .zip(&self.rests)
            .filter(|(_, rests)| **rests)
            .for_each(|(w, _)| *w = 0.0);
        white
    }
}

/// Rows within the reach of the filters of a reversal, or of a velocity that is not certain.
pub fn rests(qd: &[f64], kept: &[usize]) -> Vec<bool> {
    const REACH: usize = 40;
    let still = |k: usize| k > 0 && (qd[k] == 0.0 || qd[k] * qd[k - 1] < 0.0);
    let mut rests = vec![false; kept.len()];
    for k in (0..qd.len()).filter(|&k| still(k)) {
        let from = kept.partition_point(|&at| at + REACH < k);
        let to = kept.partition_point(|&at| at <= k + REACH);
        rests[from..to].fill(true);
    }
    rests
}

/// Least-squares autoregression of what counts.
pub fn autoregression(series: &[f64], rests: &[bool]) -> Colour {
    let counted: Vec<f64> = series
        .iter()
        .zip(rests)
        .map(|(value, rests)| if *rests { 0.0 } else { *value })
        .collect();
    let lag = |k: usize| &counted[ORDER - k..series.len() - k];
    let mut normal = vec![0.0; ORDER * ORDER];
    let mut right = vec![0.0; ORDER];
    for a in 0..ORDER {
        right[a] = dot(lag(a + 1), lag(0));
        for b in 0..ORDER {
            normal[a * ORDER + b] = dot(lag(a + 1), lag(b + 1));
        }
    }
    let factors = cholesky(normal, right);
    let mut left = whiten(series, &(factors.clone(), 1.0));
    let mut k = 0;
    left.retain(|_| {
        k += 1;
        k > ORDER && !rests[k - 1]
    });
    (factors, rms(&left).max(f64::MIN_POSITIVE))
}

/// Innovations in units of their standard deviation; the first rows, which have no past, are zero.
fn whiten(series: &[f64], (factors, sigma): &Colour) -> Vec<f64> {
    let order = factors.len();
    let mut white = vec![0.0; series.len()];
    for k in order..series.len() {
        let past = factors.iter().enumerate();
        let expected: f64 = past
            .map(|(back, factor)| factor * series[k - 1 - back])
            .sum();
        white[k] = (series[k] - expected) / sigma;
    }
    white
}

/// Solves symmetric equations; a parameter that nothing determines is zero.
pub fn cholesky(mut a: Vec<f64>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    let scale: Vec<f64> = (0..n).map(|i| a[i * n + i].max(0.0).sqrt()).collect();
    let factor = |i: usize| if scale[i] > 0.0 { 1.0 / scale[i] } else { 0.0 };
    for i in 0..n {
        b[i] *= factor(i);
        (0..n).for_each(|j| a[i * n + j] *= factor(i) * factor(j));
        a[i * n + i] += 1e-11;
    }
    for j in 0..n {
        let square: f64 = (0..j).map(|k| a[j * n + k] * a[j * n + k]).sum();
        let root = (a[j * n + j] - square).max(1e-13).sqrt();
        a[j * n + j] = root;
        for i in j + 1..n {
            let product: f64 = (0..j).map(|k| a[i * n + k] * a[j * n + k]).sum();
            a[i * n + j] = (a[i * n + j] - product) / root;
        }
    }
    for i in 0..n {
        let known: f64 = (0..i).map(|k| a[i * n + k] * b[k]).sum();
        b[i] = (b[i] - known) / a[i * n + i];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| a[k * n + i] * b[k]).sum();
        b[i] = (b[i] - known) / a[i * n + i];
    }
    (0..n).map(|i| b[i] * factor(i)).collect()
}

/// -1, 0 or 1.
pub fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

/// Scalar product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Root mean square.
pub fn rms(series: &[f64]) -> f64 {
    (dot(series, series) / series.len().max(1) as f64).sqrt()
}
