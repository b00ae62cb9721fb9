//! The noise of one equation: learned from its residuals, and taken out of its rows.

use crate::diagnose::noise::{Noise, ORDER, reflections};

/// The last rows `[w | e]` of an equation, newest last, as far as they follow each other.
#[derive(Clone, Debug)]
pub(super) struct Past {
    width: usize,
    filled: usize,
    rows: Vec<f64>,
}

impl Past {
    pub fn new(width: usize) -> Past {
        Past {
            width,
            filled: 0,
            rows: vec![0.0; (ORDER + 1) * width],
        }
    }

    /// Forgets: the next row does not follow the last.
    pub fn clear(&mut self) {
        self.filled = 0;
    }

    /// Makes room for a row and hands it out to be written.
    pub fn next(&mut self) -> &mut [f64] {
        self.rows.copy_within(self.width.., 0);
        self.filled = (self.filled + 1).min(ORDER + 1);
        &mut self.rows[ORDER * self.width..]
    }

    /// The row `age` rows before the newest, if it is there.
    fn aged(&self, age: usize) -> Option<&[f64]> {
        let start = ORDER.checked_sub(age)? * self.width;
        (age < self.filled).then(|| &self.rows[start..start + self.width])
    }

    /// The newest row less what the noise's memory says of it, over its deviation: white rows of
    /// variance one. `false` while rows are missing.
    pub fn whiten(&self, noise: &Noise, white: &mut [f64]) -> bool {
        if self.filled <= ORDER {
            return false;
        }
        for age in 0..=ORDER {
            let Some(row) = self.aged(age) else {
                return false;
            };
            let factor = match age {
                0 => 1.0,
                _ => -noise.ar[age - 1],
            };
            for (white, value) in white.iter_mut().zip(row) {
                let sum = if age == 0 { 0.0 } else { *white };
                *white = sum + factor / noise.sigma * value;
            }
        }
        true
    }

    fn residual(&self, age: usize) -> Option<f64> {
        self.aged(age)?.last().copied()
    }
}

/// Sums of products of residuals, by distance.
#[derive(Clone, Debug, Default)]
pub(super) struct Colour {
    sums: [f64; ORDER + 1],
    counts: [f64; ORDER + 1],
}

impl Colour {
    /// Adds the newest residual of the past.
    pub fn add(&mut self, past: &Past) {
        let Some(newest) = past.residual(0) else {
            return;
        };
        for (age, (sum, count)) in self.sums.iter_mut().zip(&mut self.counts).enumerate() {
            if let Some(residual) = past.residual(age) {
                *sum += newest * residual;
                *count += 1.0;
            }
        }
    }

    /// Residuals so far.
    pub fn count(&self) -> f64 {
        self.counts[0]
    }

    /// The autoregression of the residuals.
    pub fn noise(&self) -> Noise {
        let covariance: [f64; ORDER + 1] = std::array::from_fn(|age| {
            // A slightly heavier zero lag keeps it positive definite.
            let scale = if age == 0 { 1.0 + 1e-9 } else { 1.0 };
            scale * self.sums[age] / self.counts[age].max(1.0)
        });
        let reflections = reflections(&covariance);
        let left: f64 = reflections.iter().map(|r| 1.0 - r * r).product();
        Noise::reflected(&reflections, (covariance[0] * left).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colour_is_learned_and_taken_out() {
        let (mut past, mut colour) = (Past::new(1), Colour::default());
        let mut state = 7u64;
        let mut draw = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(99991);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let mut x = 0.0;
        for _ in 0..40_000 {
            x = 0.7 * x + draw();
            past.next()[0] = x;
            colour.add(&past);
        }
        let noise = colour.noise();
        assert!((noise.ar[0] - 0.7).abs() < 0.03, "{:?}", noise.ar);
        let (mut squares, mut neighbours, mut before) = (0.0, 0.0, 0.0);
        for _ in 0..40_000 {
            x = 0.7 * x + draw();
            past.next()[0] = x;
            let mut white = [0.0];
            assert!(past.whiten(&noise, &mut white));
            squares += white[0] * white[0] / 40_000.0;
            neighbours += white[0] * before / 40_000.0;
            before = white[0];
        }
        assert!((squares - 1.0).abs() < 0.03 && neighbours.abs() < 0.03);
    }

    #[test]
    fn rows_across_a_gap_do_not_meet() {
        let mut past = Past::new(2);
        let noise = Noise::white(1.0);
        let mut white = [0.0; 2];
        for i in 0..10 {
            past.next().copy_from_slice(&[f64::from(i), 0.0]);
            assert_eq!(past.whiten(&noise, &mut white), i >= ORDER as i32);
        }
        past.clear();
        past.next().fill(1.0);
        assert!(!past.whiten(&noise, &mut white));
    }
}
