//! Second-order sections and one pass of them over many signals side by side.

use pulp::{Arch, Simd, WithSimd};

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
            let (steps, start) = ((sections, steady), (start, reverse));
            match sections.len() {
                1 => sweep::<1>(steps, start, samples),
                2 => sweep::<2>(steps, start, samples),
                3 => sweep::<3>(steps, start, samples),
                _ => sweep::<SWEEP>(steps, start, samples),
            }
        }
    }
}

fn sweep<const N: usize>(
    (sections, steady): (&[Section], &[[f64; 2]]),
    (start, reverse): ([f64; LANES], bool),
    samples: &mut [[f64; LANES]],
) {
    if let (Ok(sections), Ok(steady)) = (sections.try_into(), steady.try_into()) {
        Arch::new().dispatch(Sweep::<N> {
            sections,
            steady,
            start,
            samples,
            reverse,
        });
    }
}

/// `N` sections over all samples, direct form II transposed. The recursion is serial in time, so
/// speed comes from the lanes: each holds another signal.
struct Sweep<'a, const N: usize> {
    sections: &'a [Section; N],
    steady: &'a [[f64; 2]; N],
    start: [f64; LANES],
    samples: &'a mut [[f64; LANES]],
    reverse: bool,
}

impl<const N: usize> WithSimd for Sweep<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (count, width) = (self.samples.len(), LANES / S::F64_LANES);
        let samples = S::as_mut_simd_f64s(self.samples.as_flattened_mut()).0;
        for (v, start) in S::as_simd_f64s(&self.start).0.iter().enumerate() {
            let mut states = [[*start; 2]; N];
            for (states, steady) in states.iter_mut().zip(self.steady) {
                for (state, steady) in states.iter_mut().zip(steady) {
                    *state = simd.mul_f64s(*state, simd.splat_f64s(*steady));
                }
            }
            for i in 0..count {
                let i = if self.reverse { count - 1 - i } else { i };
                let sample = &mut samples[i * width + v];
                let mut x = *sample;
                for (section, state) in self.sections.iter().zip(&mut states) {
                    x = step(simd, section, state, x);
                }
                *sample = x;
            }
        }
    }
}

/// One section at one sample of several signals.
#[inline(always)]
fn step<S: Simd>(simd: S, section: &Section, state: &mut [S::f64s; 2], x: S::f64s) -> S::f64s {
    let times = |factor: f64, x: S::f64s| simd.mul_f64s(simd.splat_f64s(factor), x);
    let Section { b, a } = section;
    let y = simd.add_f64s(times(b[0], x), state[0]);
    let inner = simd.sub_f64s(times(b[1], x), times(a[0], y));
    state[0] = simd.add_f64s(inner, state[1]);
    state[1] = simd.sub_f64s(times(b[2], x), times(a[1], y));
    y
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
