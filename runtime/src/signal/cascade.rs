//! Second-order sections and one pass of them over many signals side by side.

use wide::f64x8;

use super::planar::LANES;

/// One second-order section: \\( \frac{b_0 + b_1 z^{-1} + b_2 z^{-2}}{1 + a_1 z^{-1} + a_2 z^{-2}} \\).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Numerator `b0, b1, b2`.
    pub b: [f64; 3],
    /// Denominator `a1, a2`; `a0` is 1.
    pub a: [f64; 2],
}

impl Section {
    /// Magnitude of the pole nearest to the unit circle.
    fn pole_magnitude(&self) -> f64 {
        let [a1, a2] = self.a;
        match a1 * a1 - 4.0 * a2 {
            complex if complex < 0.0 => a2.sqrt(),
            real => (a1.abs() + real.sqrt()) / 2.0,
        }
    }

    /// Gain at zero frequency.
    fn gain_at_zero(&self) -> f64 {
        self.b.iter().sum::<f64>() / (1.0 + self.a[0] + self.a[1])
    }
}

/// A filter as a chain of second-order sections, and the states in which a constant passes
/// unchanged from the first sample on.
#[derive(Clone, Debug, PartialEq)]
pub struct Cascade {
    sections: Vec<Section>,
    /// Per section the two states for a constant input of 1, like SciPy's `sosfilt_zi`.
    steady: Vec<[f64; 2]>,
}

/// Sections that run in one sweep over the samples: their states fit into registers and cache.
const SWEEP: usize = 4;

impl Cascade {
    /// A filter from its sections, applied first to last.
    pub fn new(sections: Vec<Section>) -> Self {
        let mut scale = 1.0;
        let steady = sections
            .iter()
            .map(|section| {
                let gain = section.gain_at_zero();
                let states = [gain - section.b[0], section.b[2] - section.a[1] * gain];
                let steady = states.map(|s| s * scale);
                scale *= gain;
                steady
            })
            .collect();
        Cascade { sections, steady }
    }

    /// The sections, in the order of application.
    pub fn sections(&self) -> &[Section] {
        &self.sections
    }

    /// Magnitude of the frequency response of one pass at `frequency`, in cycles per sample.
    pub fn gain(&self, frequency: f64) -> f64 {
        let (s1, c1) = (-std::f64::consts::TAU * frequency).sin_cos();
        let (s2, c2) = (-2.0 * std::f64::consts::TAU * frequency).sin_cos();
        let magnitude =
            |k0: f64, k1: f64, k2: f64| (k0 + k1 * c1 + k2 * c2).hypot(k1 * s1 + k2 * s2);
        self.sections
            .iter()
            .map(|Section { b, a }| magnitude(b[0], b[1], b[2]) / magnitude(1.0, a[0], a[1]))
            .product()
    }

    /// Samples after which the impulse response has decayed to rounding.
    pub(super) fn memory(&self) -> usize {
        let slowest = self
            .sections
            .iter()
            .map(Section::pole_magnitude)
            .fold(0.0, f64::max);
        // Both passes and the overlap of neighbouring poles cost some more than one pole's decay.
        let decay = (1e-19f64).ln() / slowest.clamp(1e-3, 1.0 - 1e-9).ln();
        decay.ceil() as usize
    }

    /// Filters `samples` in place, first to last, starting from the steady state of the first.
    pub(super) fn forward(&self, samples: &mut [[f64; LANES]]) {
        self.sweeps(samples, false);
    }

    /// Filters `samples` in place, last to first, starting from the steady state of the last.
    pub(super) fn backward(&self, samples: &mut [[f64; LANES]]) {
        self.sweeps(samples, true);
    }

    fn sweeps(&self, samples: &mut [[f64; LANES]], reverse: bool) {
        let start = if reverse {
            samples.last()
        } else {
            samples.first()
        };
        let Some(&start) = start else { return };
        for (sections, steady) in self.sections.chunks(SWEEP).zip(self.steady.chunks(SWEEP)) {
            match sections.len() {
                1 => sweep::<1>(sections, steady, start, samples, reverse),
                2 => sweep::<2>(sections, steady, start, samples, reverse),
                3 => sweep::<3>(sections, steady, start, samples, reverse),
                _ => sweep::<SWEEP>(sections, steady, start, samples, reverse),
            }
        }
    }
}

/// `N` sections over all samples, direct form II transposed. The recursion is serial in time, so
/// speed comes from the lanes: each holds another signal.
fn sweep<const N: usize>(
    sections: &[Section],
    steady: &[[f64; 2]],
    start: [f64; LANES],
    samples: &mut [[f64; LANES]],
    reverse: bool,
) {
    let start = f64x8::from(start);
    let mut chain = [Stage::default(); N];
    for (stage, (section, steady)) in chain.iter_mut().zip(sections.iter().zip(steady)) {
        *stage = Stage {
            section: *section,
            state: steady.map(|s| start * f64x8::splat(s)),
        };
    }
    let mut run = |sample: &mut [f64; LANES]| {
        let output = chain
            .iter_mut()
            .fold(f64x8::from(*sample), |x, stage| stage.step(x));
        *sample = output.to_array();
    };
    match reverse {
        false => samples.iter_mut().for_each(&mut run),
        true => samples.iter_mut().rev().for_each(&mut run),
    }
}

/// A section at work: its coefficients and its two states, one signal per lane.
#[derive(Clone, Copy)]
struct Stage {
    section: Section,
    state: [f64x8; 2],
}

impl Default for Stage {
    fn default() -> Self {
        Stage {
            section: Section {
                b: [0.0; 3],
                a: [0.0; 2],
            },
            state: [f64x8::ZERO; 2],
        }
    }
}

impl Stage {
    #[inline(always)]
    fn step(&mut self, x: f64x8) -> f64x8 {
        let Section { b, a } = self.section;
        let y = x * b[0] + self.state[0];
        self.state[0] = x * b[1] - y * a[0] + self.state[1];
        self.state[1] = x * b[2] - y * a[1];
        y
    }
}

#[cfg(test)]
mod tests {
    use super::super::{butterworth, chebyshev1};
    use super::*;

    #[test]
    fn steady_state_passes_a_constant() {
        for cascade in [
            butterworth(5, 8.0, 100.0).unwrap(),
            chebyshev1(9, 0.05, 4.0, 100.0).unwrap(),
        ] {
            let mut samples = vec![[3.0; LANES]; 500];
            cascade.forward(&mut samples);
            cascade.backward(&mut samples);
            for sample in samples {
                assert!(sample.iter().all(|x| (x - 3.0).abs() < 1e-11), "{sample:?}");
            }
        }
    }

    #[test]
    fn lanes_do_not_mix() {
        let cascade = butterworth(4, 8.0, 100.0).unwrap();
        let series = |lane: usize, i: usize| ((lane + 1) as f64 * 0.05 * i as f64).sin();
        let mut together: Vec<[f64; LANES]> = (0..200)
            .map(|i| std::array::from_fn(|lane| series(lane, i)))
            .collect();
        cascade.forward(&mut together);
        for lane in 0..LANES {
            let mut alone: Vec<[f64; LANES]> = (0..200).map(|i| [series(lane, i); LANES]).collect();
            cascade.forward(&mut alone);
            assert!(together.iter().zip(&alone).all(|(t, a)| t[lane] == a[0]));
        }
    }
}
