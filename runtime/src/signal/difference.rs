//! Derivatives without phase shift: central differences.

/// Central difference of `x` at sample `i`, per second; one-sided first differences at the ends,
/// zero if there is only one sample.
pub fn difference_at(x: impl Fn(usize) -> f64, i: usize, len: usize, rate_hz: f64) -> f64 {
    let before = i.saturating_sub(1);
    let after = (i + 1).min(len.saturating_sub(1));
    match after.saturating_sub(before) {
        0 => 0.0,
        steps => (x(after) - x(before)) * (rate_hz / steps as f64),
    }
}

/// Derivative of a signal sampled at `rate_hz`, by [`difference_at`] at every sample.
pub fn central_difference(signal: &[f64], rate_hz: f64) -> Vec<f64> {
    (0..signal.len())
        .map(|i| difference_at(|k| signal[k], i, signal.len(), rate_hz))
        .collect()
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
}
