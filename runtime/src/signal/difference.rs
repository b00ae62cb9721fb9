//! Derivatives without phase shift: central differences.

use super::planar::LANES;
use crate::settings::Derivatives;

/// Weights of the differences of neighbours 1, 2, 3, 4 samples away, eighth order.
pub(crate) const EIGHTH: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// The same of fourth order.
const FOURTH: [f64; 2] = [2.0 / 3.0, -1.0 / 12.0];

/// Samples on either side that a derivative looks at, at most.
pub(crate) const REACH: usize = EIGHTH.len();

/// Derivative of a signal sampled at `rate_hz`, per second: central differences, one-sided first
/// differences at the two ends; zero for a single sample.
pub fn central_difference(signal: &[f64], rate_hz: f64) -> Vec<f64> {
    let last = signal.len().saturating_sub(1);
    let at = |i: usize| {
        let (before, after) = neighbours(i, last);
        (signal[after] - signal[before]) * per_second(before, after, rate_hz)
    };
    // Inside, where most samples are, neighbours need no thought.
    let scale = per_second(0, 2, rate_hz);
    let mut all = Vec::with_capacity(signal.len());
    all.extend((0..last.min(1)).map(at));
    all.extend(signal.windows(3).map(|near| (near[2] - near[0]) * scale));
    all.extend((all.len()..signal.len()).map(at));
    all
}

/// Derivative of a signal sampled at `rate_hz`, per second. Near the two ends, where neighbours
/// are missing, and for [`Derivatives::Central`], that of [`central_difference`].
pub fn derivative(signal: &[f64], rate_hz: f64, by: Derivatives) -> Vec<f64> {
    let mut all = central_difference(signal, rate_hz);
    if by == Derivatives::Eighth {
        improve(signal, &EIGHTH, rate_hz, &mut all);
    }
    all
}

/// How uncertain the derivative of eighth order is: its difference from that of fourth order, the
/// largest of three neighbours.
pub(crate) fn uncertainty(signal: &[f64], rate_hz: f64) -> Vec<f64> {
    let mut fourth = central_difference(signal, rate_hz);
    improve(signal, &FOURTH, rate_hz, &mut fourth);
    let eighth = derivative(signal, rate_hz, Derivatives::Eighth);
    let apart: Vec<f64> = eighth
        .iter()
        .zip(&fourth)
        .map(|(a, b)| (a - b).abs())
        .collect();
    let last = apart.len().saturating_sub(1);
    let near = |i: usize| apart[i.saturating_sub(1)..=(i + 1).min(last)].iter();
    (0..apart.len())
        .map(|i| near(i).copied().fold(0.0, f64::max))
        .collect()
}

/// Replaces derivatives away from the ends by weighted differences of neighbours.
fn improve(signal: &[f64], weights: &[f64], rate_hz: f64, all: &mut [f64]) {
    let reach = weights.len();
    for i in reach..signal.len().saturating_sub(reach) {
        let terms = weights.iter().enumerate();
        let sum: f64 = terms
            .map(|(k, w)| w * (signal[i + k + 1] - signal[i - k - 1]))
            .sum();
        all[i] = sum * rate_hz;
    }
}

/// [`derivative`] of signals side by side, in place.
pub(super) fn differentiate(samples: &mut [[f64; LANES]], rate_hz: f64, by: Derivatives) {
    if by == Derivatives::Eighth {
        for lane in 0..LANES {
            let signal: Vec<f64> = samples.iter().map(|sample| sample[lane]).collect();
            let all = derivative(&signal, rate_hz, by);
            samples
                .iter_mut()
                .zip(all)
                .for_each(|(sample, x)| sample[lane] = x);
        }
        return;
    }
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
            differentiate(&mut samples, 50.0, Derivatives::Central);
            for lane in 0..LANES {
                let alone: Vec<f64> = (0..len).map(|i| wave(lane, i)).collect();
                let derivative: Vec<f64> = samples.iter().map(|s| s[lane]).collect();
                assert_eq!(derivative, central_difference(&alone, 50.0));
            }
        }
    }

    #[test]
    fn eighth_order_is_exact_for_polynomials_up_to_degree_eight() {
        let x = |i: usize| 0.1 * i as f64 - 0.7;
        let signal: Vec<f64> = (0..16).map(|i| x(i).powi(8) - x(i)).collect();
        let all = derivative(&signal, 10.0, Derivatives::Eighth);
        for (i, value) in all.iter().enumerate().take(12).skip(4) {
            let truth = 8.0 * x(i).powi(7) - 1.0;
            assert!((value - truth).abs() < 1e-12, "{value} against {truth}");
        }
        assert_eq!(all[3], central_difference(&signal, 10.0)[3]);
    }

    #[test]
    fn eighth_order_is_right_to_a_thousandth_up_to_0_3_of_the_half_rate() {
        let omega = 0.3 * std::f64::consts::PI;
        let signal: Vec<f64> = (0..40).map(|i| (omega * f64::from(i)).sin()).collect();
        let all = derivative(&signal, 1.0, Derivatives::Eighth);
        let doubt = uncertainty(&signal, 1.0);
        for (i, (value, doubt)) in all.iter().zip(doubt).enumerate().take(36).skip(4) {
            let error = (value - omega * (omega * i as f64).cos()).abs();
            assert!(
                error < 1e-3 * omega && error <= doubt,
                "{error:e}, {doubt:e}"
            );
        }
    }
}
