//! Derivatives of running signals: central differences of eighth order, four samples late.

use crate::signal::{EIGHTH, REACH};

const DEPTH: usize = 2 * REACH + 1;

/// The last nine samples of several signals.
#[derive(Clone, Debug)]
pub(super) struct Delay {
    signals: usize,
    next: usize,
    filled: usize,
    samples: Vec<f64>,
}

impl Delay {
    /// Samples that values and rates come late.
    pub const LAG: usize = REACH;

    pub fn new(signals: usize) -> Delay {
        Delay {
            signals,
            next: 0,
            filled: 0,
            samples: vec![0.0; DEPTH * signals],
        }
    }

    pub fn push(&mut self, sample: &[f64]) {
        let at = self.next * self.signals;
        self.samples[at..at + self.signals].copy_from_slice(sample);
        self.next = (self.next + 1) % DEPTH;
        self.filled = (self.filled + 1).min(DEPTH);
    }

    pub fn clear(&mut self) {
        self.filled = 0;
    }

    pub fn full(&self) -> bool {
        self.filled == DEPTH
    }

    /// The sample `age` samples before the newest.
    fn aged(&self, age: usize) -> &[f64] {
        let at = (self.next + DEPTH - 1 - age) % DEPTH * self.signals;
        &self.samples[at..at + self.signals]
    }

    /// The values in the middle.
    pub fn values(&self) -> &[f64] {
        self.aged(REACH)
    }

    /// The derivatives in the middle, per second.
    pub fn rates(&self, rate_hz: f64, rates: &mut [f64]) {
        rates.fill(0.0);
        for (k, weight) in EIGHTH.iter().enumerate() {
            let (later, earlier) = (self.aged(REACH - 1 - k), self.aged(REACH + 1 + k));
            for ((rate, later), earlier) in rates.iter_mut().zip(later).zip(earlier) {
                *rate += weight * rate_hz * (later - earlier);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_rates_belong_to_one_instant() {
        let mut delay = Delay::new(2);
        let x = |i: usize| 0.1 * i as f64;
        for i in 0..12 {
            delay.push(&[x(i).powi(5), x(i)]);
        }
        assert!(delay.full());
        let middle = x(11 - Delay::LAG);
        let mut rates = [0.0; 2];
        delay.rates(10.0, &mut rates);
        assert_eq!(delay.values()[1], middle);
        assert!((rates[0] - 5.0 * middle.powi(4)).abs() < 1e-13);
        assert!((rates[1] - 1.0).abs() < 1e-13);
    }
}
