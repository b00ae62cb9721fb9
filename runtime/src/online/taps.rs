//! The zero-phase prefilter and its derivatives as finite sums over a window of samples.

use super::{OnlineError, Options};
use crate::settings::{Derivatives, Edges};
use crate::signal::{REACH, ZeroPhase, butterworth, derivative};

/// What may be cut off the two tails of the impulse response, whose sum is one: the relative error
/// of q, qd and qdd alike, since a derivative of the sum is the sum of derivatives.
const TAIL: f64 = 1e-7;

/// Longest window, samples: 20 s at 1 kHz.
const MOST: usize = 20_001;

/// Weights of the samples of a window, oldest first, in position, velocity and acceleration at the
/// window's middle.
#[derive(Clone, Debug)]
pub(super) struct Taps {
    pub position: Vec<f64>,
    pub velocity: Vec<f64>,
    pub acceleration: Vec<f64>,
}

impl Taps {
    /// The impulse response of the Butterworth low-pass run forward and backward, and its first and
    /// second differences of eighth order: what the batch does, seen from the middle of a window.
    ///
    /// # Errors
    /// [`OnlineError::Filter`], [`OnlineError::TooLong`].
    pub fn new(options: &Options) -> Result<Taps, OnlineError> {
        let rate_hz = options.rate_hz;
        let smooth = response(options)?;
        // The second difference reaches twice as far as the first; what is beyond is zero.
        let padding = 3 * REACH;
        let mut position = vec![0.0; padding];
        position.extend(&smooth);
        position.resize(smooth.len() + 2 * padding, 0.0);
        let rise = derivative(&position, rate_hz, Derivatives::Eighth);
        let curve = derivative(&rise, rate_hz, Derivatives::Eighth);
        let inside = |taps: &[f64]| -> Vec<f64> {
            let kept = &taps[REACH..taps.len() - REACH];
            kept.iter().rev().copied().collect()
        };
        let taps = Taps {
            position: inside(&position),
            velocity: inside(&rise),
            acceleration: inside(&curve),
        };
        match taps.window() {
            samples if samples > MOST => Err(OnlineError::TooLong {
                fq_hz: options.fq_hz,
                rate_hz,
                samples,
                most: MOST,
            }),
            _ => Ok(taps),
        }
    }

    /// Samples of the window, an odd number.
    pub fn window(&self) -> usize {
        self.position.len()
    }

    /// Samples from the window's middle to its newest.
    pub fn lag(&self) -> usize {
        self.window() / 2
    }
}

/// The impulse response without its tails, scaled so that a constant passes unchanged.
fn response(options: &Options) -> Result<Vec<f64>, OnlineError> {
    let fail = |source| OnlineError::Filter {
        step: "prefilter",
        source,
    };
    let cascade = butterworth(options.order, options.fq_hz, options.rate_hz).map_err(fail)?;
    let filter = ZeroPhase::new(cascade, options.order, Edges::Scipy);
    let middle = filter.memory().clamp(filter.fewest_samples(), 8 * MOST);
    let mut impulse = vec![0.0; 2 * middle + 1];
    impulse[middle] = 1.0;
    let all = filter.filter(&[impulse]).map_err(fail)?.concat();
    let mut tail = 0.0;
    let beyond = all[middle..].iter().rev().take_while(|h| {
        tail += 2.0 * h.abs();
        tail <= TAIL
    });
    let reach = middle - beyond.count().min(middle);
    let kept = &all[middle - reach..=middle + reach];
    let sum: f64 = kept.iter().sum();
    Ok(kept.iter().map(|h| h / sum).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_sine_passes_with_its_derivatives() {
        let options = Options::at(1000.0);
        let taps = Taps::new(&options).unwrap();
        let omega = std::f64::consts::TAU * 2.0;
        let time = |i: usize| (i as f64 - taps.lag() as f64) / 1000.0 + 0.03;
        let sum = |taps: &[f64]| -> f64 {
            let terms = taps.iter().enumerate();
            terms.map(|(i, h)| h * (omega * time(i)).sin()).sum()
        };
        let now = omega * 0.03;
        // |H|^2 = 1/(1 + (2/40)^8) = 1 - 4e-11; the tails are cut at 1e-7.
        assert!((sum(&taps.position) - now.sin()).abs() < 2e-7);
        assert!((sum(&taps.velocity) / omega - now.cos()).abs() < 2e-7);
        assert!((sum(&taps.acceleration) / omega.powi(2) + now.sin()).abs() < 2e-7);
    }

    #[test]
    fn the_window_sees_what_the_zero_phase_filter_of_the_batch_sees() {
        let options = Options::at(200.0);
        let taps = Taps::new(&options).unwrap();
        let noise = |i: usize| ((i * i) as f64 * 0.7).sin();
        let len = 20 * taps.window();
        let signal: Vec<f64> = (0..len).map(noise).collect();
        let cascade = butterworth(4, options.fq_hz, 200.0).unwrap();
        let filter = ZeroPhase::new(cascade, 4, Edges::Scipy);
        let batch = filter
            .filter(std::slice::from_ref(&signal))
            .unwrap()
            .concat();
        let at = len / 2;
        let window = &signal[at - taps.lag()..=at + taps.lag()];
        let own: f64 = window.iter().zip(&taps.position).map(|(q, h)| q * h).sum();
        assert!((own - batch[at]).abs() < 3e-7, "{own} {}", batch[at]);
        let own: f64 = window.iter().zip(&taps.velocity).map(|(q, h)| q * h).sum();
        let eighth = derivative(&batch, 200.0, Derivatives::Eighth)[at];
        assert!((own - eighth).abs() < 3e-7 * 200.0);
    }

    #[test]
    fn impossible_prefilters_are_errors() {
        let design = |fq_hz| {
            Taps::new(&Options {
                fq_hz,
                ..Options::at(1000.0)
            })
        };
        let step = "prefilter";
        assert!(matches!(design(600.0), Err(OnlineError::Filter { step: s, .. }) if s == step));
        assert!(matches!(design(0.05), Err(OnlineError::TooLong { .. })));
    }
}
