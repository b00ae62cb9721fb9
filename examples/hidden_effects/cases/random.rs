//! Random numbers that are the same everywhere for the same seed.

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

/// A stream of random numbers.
pub struct Random(Pcg64Mcg);

impl Random {
    /// The stream of one case of a seed.
    pub fn new(seed: u64, case: u64) -> Random {
        let state = u128::from(seed) << 64 | u128::from(case.wrapping_mul(2).wrapping_add(1));
        let mut random = Random(Pcg64Mcg::new(
            state.wrapping_mul(0x9e37_79b9_7f4a_7c15_f39c),
        ));
        // Neighbouring seeds begin alike.
        (0..16).for_each(|_| {
            random.0.next_u64();
        });
        random
    }

    /// Uniform in low..high.
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * unit
    }

    /// Uniform in the logarithm.
    pub fn ratio(&mut self, low: f64, high: f64) -> f64 {
        self.uniform(low.ln(), high.ln()).exp()
    }

    /// Standard normal.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * self.uniform(f64::MIN_POSITIVE, 1.0).ln()).sqrt();
        radius * self.uniform(0.0, std::f64::consts::TAU).cos()
    }

    /// 1 or -1.
    pub fn sign(&mut self) -> f64 {
        if self.uniform(0.0, 1.0) < 0.5 {
            1.0
        } else {
            -1.0
        }
    }

    /// A whole number from low to high, both included.
    pub fn whole(&mut self, low: usize, high: usize) -> usize {
        let number = self.uniform(low as f64, high as f64 + 1.0) as usize;
        number.clamp(low, high)
    }

    /// One of several.
    pub fn one_of<T: Clone>(&mut self, all: &[T]) -> T {
        all[self.whole(0, all.len() - 1)].clone()
    }
}
