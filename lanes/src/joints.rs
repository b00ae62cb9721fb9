//! Sines and cosines of one sample: four angles side by side, as most machines have vectors of four.

use std::array::from_fn;

use bytemuck::cast;
use wide::i64x4;

use crate::f64x4;
use crate::sine::{self, FARTHEST, Turn};

impl Turn for f64x4 {
    type Mask = f64x4;
    #[inline(always)]
    fn has_bit(self, bit: u64) -> f64x4 {
        let bit = i64x4::splat(bit.cast_signed());
        let bits: i64x4 = cast(self);
        cast((bits & bit).simd_eq(bit))
    }
    #[inline(always)]
    fn where_else(self, mask: f64x4, other: f64x4) -> f64x4 {
        mask.select(self, other)
    }
}

/// Sine and cosine of up to four angles, rad, each within 2.3e-16; by the library of the system
/// where an angle is too far, or none, or alone.
#[inline(always)]
pub fn sines_and_cosines<const N: usize>(angles: [f64; N]) -> [(f64, f64); N] {
    let near = angles.iter().all(|angle| angle.abs() <= FARTHEST);
    if N < 2 || !near {
        return angles.map(f64::sin_cos);
    }
    let four = from_fn(|k| if k < N { angles[k] } else { 0.0 });
    let (sines, cosines) = sine::sin_cos(f64x4::from(four));
    let (sines, cosines) = (sines.to_array(), cosines.to_array());
    from_fn(|k| (sines[k], cosines[k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn worst(angles: [f64; 4]) -> f64 {
        let pairs = sines_and_cosines(angles).into_iter().zip(angles);
        let errors = pairs.map(|((s, c), x)| (s - x.sin()).abs().max((c - x.cos()).abs()));
        errors.fold(0.0, f64::max)
    }

    #[test]
    fn angles_of_one_sample_have_exact_sines_and_cosines() {
        for size in [1e-3, 1.0, 7.0, 100.0, 1e4, 1e5] {
            for sample in 0..6000 {
                let golden = 0.618_033_988_749_894_9_f64;
                let turn = |joint: usize| (f64::from(sample) * golden * (joint + 1) as f64).fract();
                let worst = worst(from_fn(|joint| size * (2.0 * turn(joint) - 1.0)));
                assert!(worst <= 2.3e-16, "{worst:e} up to {size}");
            }
        }
    }

    #[test]
    fn angles_too_far_or_none_are_those_of_the_library() {
        assert_eq!(worst([0.1, -3e5, 1e15, 0.3]), 0.0);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let [(s, c), (sine, _)] = sines_and_cosines([bad, 0.5]);
            assert!(s.is_nan() && c.is_nan() && sine == 0.5_f64.sin());
        }
    }
}
