//! Sine and cosine of all lanes at once.
//!
//! The argument is reduced by multiples of a right angle whose two parts make the first difference
//! exact (W. J. Cody, W. Waite, Software Manual for the Elementary Functions, 1980); on
//! [-pi/4, pi/4] the polynomials are those of fdlibm's `k_sin.c` and `k_cos.c` (Sun Microsystems,
//! 1993). Sums round the products that enter them: all machines that do so in one instruction agree to
//! the bit.

use std::f64::consts::FRAC_2_PI;

use crate::Lane;

/// Lanes whose sines are computed here.
pub trait Turn: Lane {
    /// Which lanes.
    type Mask: Copy;
    /// Where the number as stored has all these bits.
    fn has_bit(self, bit: u64) -> Self::Mask;
    /// These numbers where the mask is set, else the others.
    fn where_else(self, mask: Self::Mask, other: Self) -> Self;
}

/// A right angle: 33 bits, and the rest.
const RIGHT: [f64; 2] = [1.570_796_326_734_125_6, 6.077_100_506_506_192e-11];

/// Magnitude, rad, up to which an angle's sine is exact to the last digits.
pub const FARTHEST: f64 = 1e5;

/// Added to a number and taken off again, it leaves the nearest integer, whose last bits stand last.
const INTEGER: f64 = 1.5 * (1_u64 << 52) as f64;

/// Coefficients of r^3, r^5, ... of the sine.
const SINE: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_007e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];

/// Coefficients of r^4, r^6, ... of the cosine.
const COSINE: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Sine and cosine, rad; each within 2.3e-16 for |x| <= 1e5.
#[inline(always)]
pub fn sin_cos<T: Turn>(x: T) -> (T, T) {
    let turned = x.times(x.splat(FRAC_2_PI)) + x.splat(INTEGER);
    let angles = turned - x.splat(INTEGER);
    let rest = x - angles.times(x.splat(RIGHT[0])) - angles.times(x.splat(RIGHT[1]));
    let (sine, cosine) = within_an_eighth(rest);
    let odd = turned.has_bit(1);
    let (sin, cos) = (cosine.where_else(odd, sine), sine.where_else(odd, cosine));
    // The sine is negative after two right angles, the cosine after one.
    let after = turned + x.splat(1.0);
    (
        (-sin).where_else(turned.has_bit(2), sin),
        (-cos).where_else(after.has_bit(2), cos),
    )
}

/// Sine and cosine of an angle of at most an eighth of a turn.
#[inline(always)]
fn within_an_eighth<T: Turn>(r: T) -> (T, T) {
    let square = r * r;
    let sine = r + (r * square).times(polynomial(square, SINE));
    let (one, half) = (r.splat(1.0), r.splat(0.5) * square);
    let most = one - half;
    let cosine =
        most + (((one - most) - half) + (square * square).times(polynomial(square, COSINE)));
    (sine, cosine)
}

/// a + b x + ... + f x^5. No closure and no loop: only what is always inlined has the instructions
/// of its caller.
#[inline(always)]
fn polynomial<T: Turn>(x: T, [a, b, c, d, e, f]: [f64; 6]) -> T {
    let high = (x.times(x.splat(f)) + x.splat(e)).times(x) + x.splat(d);
    ((high.times(x) + x.splat(c)).times(x) + x.splat(b)).times(x) + x.splat(a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vector;
    use pulp::{Arch, Scalar, Simd, WithSimd};

    /// The largest error of sine and cosine against the library of the system, all values, and
    /// whether they are fused.
    struct Errors<'a>(&'a [f64]);

    impl WithSimd for Errors<'_> {
        type Output = (f64, Vec<f64>, bool);

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let (mut worst, mut all) = (0.0_f64, vec![]);
            for angles in self.0.chunks(S::F64_LANES) {
                let (sin, cos) = sin_cos(Vector::from_slice(simd, angles));
                for ((&angle, &s), &c) in angles.iter().zip(sin.values()).zip(cos.values()) {
                    worst = worst
                        .max((s - angle.sin()).abs())
                        .max((c - angle.cos()).abs());
                    all.extend([s, c]);
                }
            }
            (worst, all, Vector::<S>::FUSES)
        }
    }

    /// The library is itself within an ulp of the truth, at most 1.1e-16; what is left is ours.
    #[test]
    fn sine_and_cosine_are_exact_to_the_last_digits_and_alike_on_all_vectors() {
        for size in [1e-3, 1.0, 7.0, 100.0, 1e4, 1e5] {
            let golden = 0.618_033_988_749_894_9_f64;
            let mut angles: Vec<f64> = (0..40_000)
                .map(|i| size * (2.0 * (f64::from(i) * golden).fract() - 1.0))
                .collect();
            angles.extend((-64..=64).map(|n| f64::from(n) * std::f64::consts::FRAC_PI_4));
            let widest = Arch::new().dispatch(Errors(&angles));
            let mut all = vec![Errors(&angles).with_simd(Scalar)];
            #[cfg(target_arch = "x86_64")]
            all.extend(pulp::x86::V3::try_new().map(|simd| Simd::vectorize(simd, Errors(&angles))));
            assert!(widest.0 <= 2.3e-16, "{:e} up to {size}", widest.0);
            for (worst, values, fused) in all {
                assert!(worst <= 2.3e-16, "{worst:e} up to {size}");
                assert!(values == widest.1 || fused != widest.2);
            }
        }
    }

    #[test]
    fn what_is_no_angle_has_no_sine() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let (s, c) = sin_cos(Vector::splat(Scalar, bad));
            assert!(s.values()[0].is_nan() && c.values()[0].is_nan());
        }
    }
}
