//! The noise of each joint's rows: its colour as an autoregression, its size, and what whitens it.

use std::ops::Range;

use super::linear::dot;

/// Order of the autoregression; 4 was enough for a low-pass of 50 Hz.
pub(crate) const ORDER: usize = 4;

/// No drive tells its torque better than this share of its usual size.
const LEAST: f64 = 1e-3;

/// Rows after which an impulse is forgotten.
const REMEMBERED: usize = 500;

/// Noise of one joint: \\( x_t = \sum_k a_k x_{t-k} + \sigma e_t \\).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Noise {
    pub ar: [f64; ORDER],
    pub sigma: f64,
}

impl Noise {
    /// White noise.
    pub fn white(sigma: f64) -> Noise {
        let ar = [0.0; ORDER];
        Noise {
            ar,
            sigma: positive(sigma),
        }
    }

    /// Of given reflection coefficients, each inside -1..1.
    pub fn reflected(reflections: &[f64; ORDER], sigma: f64) -> Noise {
        let mut ar = [0.0; ORDER];
        for (k, r) in reflections.iter().enumerate() {
            let before = ar;
            for i in 0..k {
                ar[i] = before[i] - r * before[k - 1 - i];
            }
            ar[k] = *r;
        }
        Noise {
            ar,
            sigma: positive(sigma),
        }
    }

    /// Standard deviation of what it makes.
    fn size(&self) -> f64 {
        // The response to one impulse, until it has died away.
        let (mut past, mut energy) = ([0.0; ORDER], 0.0);
        let mut next = 1.0;
        for _ in 0..REMEMBERED {
            energy += next * next;
            past.rotate_right(1);
            past[0] = next;
            next = self.ar.iter().zip(past).map(|(a, x)| a * x).sum();
        }
        self.sigma * energy.sqrt()
    }

    /// This noise, or white noise of the least size that torque `y` can have: a simulation without
    /// any must not make every rounding of it an effect.
    pub fn credible(self, y: &[f64]) -> Noise {
        let least = LEAST * (dot(y, y) / y.len().max(1) as f64).sqrt();
        match self.size() < least {
            true => Noise::white(least),
            false => self,
        }
    }

    /// Whitens rows that may follow each other only inside `segments`; the first rows of each count
    /// for nothing. A row counts as much as the least of those that it is made of.
    pub fn whiten(&self, rows: &[f64], weights: &[f64], segments: &[Range<usize>]) -> Vec<f64> {
        let mut out = vec![0.0; rows.len()];
        for segment in segments {
            for t in segment.start + ORDER..segment.end {
                let weight = effective(weights, t);
                let past = self.ar.iter().enumerate();
                let expected: f64 = past.map(|(k, a)| a * rows[t - 1 - k]).sum();
                out[t] = weight * (rows[t] - expected) / self.sigma;
            }
        }
        out
    }
}

/// What a whitened row counts for: as much as the least of the rows that it is made of.
pub(crate) fn effective(weights: &[f64], t: usize) -> f64 {
    weights[t.saturating_sub(ORDER)..=t]
        .iter()
        .copied()
        .fold(1.0, f64::min)
}

fn positive(sigma: f64) -> f64 {
    if sigma.is_normal() && sigma > 0.0 {
        sigma
    } else {
        f64::MIN_POSITIVE.sqrt()
    }
}

/// Reflection coefficients of an autocovariance (lags 0 to [`ORDER`]) by Levinson's recursion.
pub(crate) fn reflections(covariance: &[f64; ORDER + 1]) -> [f64; ORDER] {
    let mut ar = [0.0; ORDER];
    let mut error = covariance[0];
    let mut found = [0.0; ORDER];
    for k in 0..ORDER {
        if error <= 0.0 {
            break;
        }
        let past: f64 = (0..k).map(|i| ar[i] * covariance[k - i]).sum();
        let r = ((covariance[k + 1] - past) / error).clamp(-0.999, 0.999);
        let before = ar;
        for i in 0..k {
            ar[i] = before[i] - r * before[k - 1 - i];
        }
        ar[k] = r;
        found[k] = r;
        error *= 1.0 - r * r;
    }
    found
}

/// Autocovariance of rows with weights (0 leaves a row out) inside segments.
pub(crate) fn covariance(
    rows: &[f64],
    weights: &[f64],
    segments: &[Range<usize>],
) -> [f64; ORDER + 1] {
    std::array::from_fn(|lag| {
        let (mut sum, mut count) = (0.0, 0.0);
        for segment in segments {
            let end = segment.end.saturating_sub(lag);
            for t in segment.start..end.max(segment.start) {
                let weight = weights[t] * weights[t + lag];
                sum += weight * rows[t] * rows[t + lag];
                count += weight;
            }
        }
        // A slightly heavier zero lag keeps it positive definite.
        let scale = if lag == 0 { 1.0 + 1e-9 } else { 1.0 };
        if count > 0.0 {
            scale * sum / count
        } else {
            0.0
        }
    })
}

/// Noise whose whitened rows have variance one, from rows that are nothing but noise, `share` of
/// whose squares was lost on the way to them.
pub(crate) fn of_rows(
    rows: &[f64],
    weights: &[f64],
    segments: &[Range<usize>],
    share: f64,
) -> Noise {
    let certain: Vec<f64> = weights
        .iter()
        .map(|w| if *w >= 1.0 { 1.0 } else { 0.0 })
        .collect();
    let reflections = reflections(&covariance(rows, &certain, segments));
    let mut noise = Noise::reflected(&reflections, 1.0);
    let white = noise.whiten(rows, &certain, segments);
    let inside = segments.iter().flat_map(|s| s.start + ORDER..s.end);
    let count = inside.filter(|&t| effective(&certain, t) > 0.0).count();
    noise.sigma = positive((dot(&white, &white) / (count.max(1) as f64 * share)).sqrt());
    noise
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_below_what_a_drive_can_tell_is_that() {
        let y = [3.0, -4.0, 5.0, 0.0];
        let rms = 50f64.sqrt() / 2.0;
        assert_eq!(Noise::white(1e-9).credible(&y), Noise::white(1e-3 * rms));
        // Of innovations far smaller than itself: an AR(1) with 0.99 is seven times as large.
        let slow = Noise::reflected(&[0.99, 0.0, 0.0, 0.0], 2e-4 * rms);
        assert_eq!(slow.clone().credible(&y), slow);
        assert!((slow.size() / slow.sigma - (1.0_f64 - 0.99 * 0.99).sqrt().recip()).abs() < 1e-3);
    }

    /// Uniform noise from a linear congruence; its colour is what matters.
    fn coloured(ar: [f64; ORDER], len: usize) -> Vec<f64> {
        let mut state = 12345_u64;
        let mut rows = vec![0.0; len];
        for t in ORDER..len {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            let e = (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
            rows[t] = e + (0..ORDER).map(|k| ar[k] * rows[t - 1 - k]).sum::<f64>();
        }
        rows
    }

    #[test]
    fn colour_is_found_and_taken_away() {
        let ar = [1.2, -0.6, 0.2, -0.1];
        let rows = coloured(ar, 40_000);
        let weights = vec![1.0; rows.len()];
        let noise = of_rows(&rows, &weights, std::slice::from_ref(&(0..rows.len())), 1.0);
        for (found, true_value) in noise.ar.iter().zip(ar) {
            assert!((found - true_value).abs() < 0.03, "{:?}", noise.ar);
        }
        // Uniform on a unit interval: variance 1/12.
        assert!((noise.sigma / (1.0_f64 / 12.0).sqrt() - 1.0).abs() < 0.02);
        let white = noise.whiten(&rows, &weights, std::slice::from_ref(&(0..rows.len())));
        let next: f64 = white.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / rows.len() as f64;
        assert!(next.abs() < 0.02, "{next}");
    }

    #[test]
    fn whitening_never_reaches_across_logs() {
        let noise = Noise {
            ar: [1.0, 0.0, 0.0, 0.0],
            sigma: 1.0,
        };
        let rows: Vec<f64> = (0..20).map(f64::from).collect();
        let white = noise.whiten(&rows, &[1.0; 20], &[0..10, 10..20]);
        assert_eq!(white[9], 1.0);
        assert_eq!(&white[10..14], &[0.0; 4]);
        assert_eq!(white[14], 1.0);
    }
}
