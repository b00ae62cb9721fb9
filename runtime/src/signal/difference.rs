//! Derivatives without phase shift: central differences.

use super::planar::LANES;

/// Derivative of a signal sampled at `rate_hz`, per second: central differences, one-sided first
/// differences at the two ends; zero for a single sample.
pub fn central_difference(signal: &[f64], rate_hz: f64) -> Vec<f64> {
    let last = signal.len().saturating_sub(1);
    (0..signal.len())
        .map(|i| {
            let (before, after) = neighbours(i, last);
            (signal[after] - signal[before]) * per_second(before, after, rate_hz)
        })
        .collect()
}

/// [`central_difference`] of signals side by side, in place.
pub(super) fn differentiate(samples: &mut [[f64; LANES]], rate_hz: f64) {
    let last = samples.len().saturating_sub(1);
    let mut previous = samples.first().copied().unwrap_or([0.0; LANES]);
    for i in 0..samples.len() {
        let (before, after) = neighbours(i, last);
        let (here, next) = (samples[i], samples[after]);
        let scale = per_second(before, after, rate_hz);
        samples[i] = std::array::from_fn(|lane| (next[lane] - previous[lane]) * scale);
        previous = here;
    }
}

/// The samples whose difference is the derivative at `i`.
fn neighbours(i: usize, last: usize) -> (usize, usize) {
    (i.saturating_sub(1), (i + 1).min(last))
}

fn per_second(before: usize, after: usize, rate_hz: f64) -> f64 {
    rate_hz / (after - before).max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_differentiated_exactly_inside() {
        let x: Vec<f64> = (0..10).map(|i| f64::from(i * i)).collect();
        let derivative = central_difference(&x, 100.0);
        assert_eq!(derivative[0], 100.0);
        assert_eq!(derivative[9], 1700.0);
        for (i, value) in derivative.iter().enumerate().take(9).skip(1) {
            assert_eq!(*value, 200.0 * i as f64);
        }
    }

    #[test]
    fn short_signals_have_a_derivative_too() {
        assert_eq!(central_difference(&[], 10.0), Vec::<f64>::new());
        assert_eq!(central_difference(&[4.0], 10.0), vec![0.0]);
        assert_eq!(central_difference(&[4.0, 5.0], 10.0), vec![10.0, 10.0]);
    }

    #[test]
    fn signals_side_by_side_have_the_derivatives_of_each() {
        for len in [0, 1, 2, 7] {
            let wave = |lane: usize, i: usize| ((lane + 1) as f64 * 0.3 * i as f64).sin();
            let mut samples: Vec<[f64; LANES]> = (0..len)
                .map(|i| std::array::from_fn(|lane| wave(lane, i)))
                .collect();
            differentiate(&mut samples, 50.0);
            for lane in 0..LANES {
                let alone: Vec<f64> = (0..len).map(|i| wave(lane, i)).collect();
                let derivative: Vec<f64> = samples.iter().map(|s| s[lane]).collect();
                assert_eq!(derivative, central_difference(&alone, 50.0));
            }
        }
    }
}
