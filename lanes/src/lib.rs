//! Lane types that emitted functions are generic over: one sample, or several side by side.
//!
//! One emitted source serves `f64`, `f32`, the SIMD types of `wide`, whose width is that of the
//! machine that a program is compiled for, and [`Vector`], whose width is that of the machine that
//! runs it. The functions need nothing but the trait [`Lane`]: no allocation, no other dependency.

mod joints;
mod product;
mod sine;
mod vector;

use core::ops::{Add, Mul, Neg, Sub};

pub use product::Product;
pub use pulp::{Arch, Simd, WithSimd};
pub use vector::Vector;
pub use wide::{f64x4, f64x8};

/// Whether the machine that the program is compiled for multiplies and adds in one instruction; on
/// others that would be a slow call.
const FUSES: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

/// A number, or several numbers side by side on which each operation acts alike.
pub trait Lane:
    Copy
    + Add<Output = Self>
    + Add<Product<Self>, Output = Self>
    + Sub<Output = Self>
    + Sub<Product<Self>, Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
{
    /// The same constant in every lane; `self` only says what lanes they are.
    fn splat(self, value: f64) -> Self;
    /// `self * factor + term`, rounded once where that is one instruction, else twice.
    #[inline(always)]
    fn fused(self, factor: Self, term: Self) -> Self {
        self * factor + term
    }
    /// A product that the sum it enters rounds: `a + b.times(c)` is [`Lane::fused`].
    #[inline(always)]
    fn times(self, factor: Self) -> Product<Self> {
        Product::new(self, factor)
    }
    /// Sine and cosine; argument in rad.
    fn sin_cos(self) -> (Self, Self);
    /// Sine and cosine of each of up to four angles, rad: those of one sample are computed side by
    /// side.
    #[inline(always)]
    fn sines_and_cosines<const N: usize>(angles: [Self; N]) -> [(Self, Self); N] {
        const { assert!(N <= 4) };
        let mut pairs = angles.map(|angle| (angle, angle));
        // No closure: only what is always inlined has the instructions of its caller. No loop: it
        // would keep the pairs in memory.
        if N > 0 {
            pairs[0] = angles[0].sin_cos();
        }
        if N > 1 {
            pairs[1] = angles[1].sin_cos();
        }
        if N > 2 {
            pairs[2] = angles[2].sin_cos();
        }
        if N > 3 {
            pairs[3] = angles[3].sin_cos();
        }
        pairs
    }
    /// -1, 0 or 1: the sign, zero at zero.
    fn sign(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// exp(-x^2).
    fn bell(self) -> Self;
    /// |x|^p for a constant p > 0.
    fn abs_power(self, p: f64) -> Self;
    /// 1/x.
    fn reciprocal(self) -> Self;
    /// Square root; NaN below 0.
    fn root(self) -> Self;
    /// Calls a part of a long function, compiled as a function of its own that runs with the
    /// instructions of these lanes; `self` only says what lanes they are.
    #[inline(never)]
    fn apart<A>(self, part: impl Part<A>, arguments: A) {
        part.call(arguments);
    }
}

/// A part of a long function; to be always inlined, unlike a function that is handed over.
pub trait Part<A> {
    /// What it does.
    fn call(self, arguments: A);
}

macro_rules! scalar {
    ($t:ty $(, $sines:item)?) => {
        impl Lane for $t {
            #[inline(always)]
            fn splat(self, value: f64) -> Self {
                value as $t
            }
            #[inline(always)]
            fn fused(self, factor: Self, term: Self) -> Self {
                match FUSES {
                    true => self.mul_add(factor, term),
                    false => self * factor + term,
                }
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                <$t>::sin_cos(self)
            }
            $($sines)?
            #[inline]
            fn sign(self) -> Self {
                if self > 0.0 {
                    1.0
                } else if self < 0.0 {
                    -1.0
                } else {
                    0.0 * self
                }
            }
            #[inline]
            fn abs(self) -> Self {
                <$t>::abs(self)
            }
            #[inline]
            fn tanh(self) -> Self {
                <$t>::tanh(self)
            }
            #[inline]
            fn bell(self) -> Self {
                (-self * self).exp()
            }
            #[inline]
            fn abs_power(self, p: f64) -> Self {
                // As compilers write them where they know p: to the bit the same everywhere.
                match p {
                    0.5 => <$t>::abs(self).sqrt(),
                    2.0 => self * self,
                    p => <$t>::abs(self).powf(p as $t),
                }
            }
            #[inline]
            fn reciprocal(self) -> Self {
                self.recip()
            }
            #[inline]
            fn root(self) -> Self {
                self.sqrt()
            }
        }
    };
}

scalar!(f32);
scalar!(
    f64,
    #[inline(always)]
    fn sines_and_cosines<const N: usize>(angles: [Self; N]) -> [(Self, Self); N] {
        joints::sines_and_cosines(angles)
    }
);

macro_rules! wide {
    ($t:ty) => {
        impl Lane for $t {
            #[inline(always)]
            fn splat(self, value: f64) -> Self {
                <$t>::splat(value)
            }
            #[inline(always)]
            fn fused(self, factor: Self, term: Self) -> Self {
                self.mul_add(factor, term)
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                <$t>::sin_cos(self)
            }
            #[inline]
            fn sign(self) -> Self {
                let one = <$t>::splat(1.0);
                let zero = <$t>::splat(0.0);
                (self.simd_gt(zero) & one) - (self.simd_lt(zero) & one)
            }
            #[inline]
            fn abs(self) -> Self {
                <$t>::abs(self)
            }
            #[inline]
            fn tanh(self) -> Self {
                <$t>::from(self.to_array().map(f64::tanh))
            }
            #[inline]
            fn bell(self) -> Self {
                <$t>::from(self.to_array().map(Lane::bell))
            }
            #[inline]
            fn abs_power(self, p: f64) -> Self {
                <$t>::from(self.to_array().map(|x| x.abs_power(p)))
            }
            #[inline]
            fn reciprocal(self) -> Self {
                <$t>::splat(1.0) / self
            }
            #[inline]
            fn root(self) -> Self {
                <$t>::sqrt(self)
            }
        }
    };
}

wide!(f64x4);
wide!(f64x8);

#[cfg(test)]
mod tests {
    use super::*;
    use pulp::Scalar;

    fn samples() -> Vec<f64> {
        (-40..40).map(|i| f64::from(i) * 0.173).collect()
    }

    fn agree<T: Lane>(lanes: T, samples: &[f64], values: impl Fn(T) -> Vec<f64>) {
        let (sin, cos) = lanes.sin_cos();
        let pairs = values(sin).into_iter().zip(values(cos));
        for ((s, c), x) in pairs.zip(samples) {
            assert!((s - x.sin()).abs() <= 2.0 * f64::EPSILON);
            assert!((c - x.cos()).abs() <= 2.0 * f64::EPSILON);
        }
        let one_by_one = |f: fn(f64) -> f64| samples.iter().map(|&x| f(x)).collect::<Vec<_>>();
        assert_eq!(values(lanes.sign()), one_by_one(Lane::sign));
        assert_eq!(values(Lane::abs(lanes)), one_by_one(f64::abs));
        assert_eq!(values(-lanes), one_by_one(|x| -x));
        assert_eq!(values(lanes.tanh()), one_by_one(f64::tanh));
        assert_eq!(values(lanes.bell()), one_by_one(|x| (-x * x).exp()));
        assert_eq!(
            values(lanes.abs_power(1.5)),
            one_by_one(|x| x.abs().powf(1.5))
        );
        assert_eq!(values(lanes.reciprocal()), one_by_one(f64::recip));
        assert_eq!(
            values(Lane::abs(lanes).root()),
            one_by_one(|x| x.abs().sqrt())
        );
        let sum = lanes * lanes.splat(3.0) - lanes * lanes + lanes;
        assert_eq!(values(sum), one_by_one(|x| x * 3.0 - x * x + x));
    }

    /// Rounded once or twice, a sum is exact where its product is; the signs are those of the sum.
    fn fuse<T: Lane>(lanes: T, samples: &[f64], values: impl Fn(T) -> Vec<f64>) {
        let (two, five) = (lanes.splat(2.0), lanes.splat(5.0));
        let one_by_one = |f: fn(f64) -> f64| samples.iter().map(|&x| f(x)).collect::<Vec<_>>();
        assert_eq!(
            values(lanes.fused(two, five)),
            one_by_one(|x| x * 2.0 + 5.0)
        );
        assert_eq!(
            values(lanes.times(two) + five),
            one_by_one(|x| x * 2.0 + 5.0)
        );
        assert_eq!(
            values(lanes.times(two) - five),
            one_by_one(|x| x * 2.0 - 5.0)
        );
        assert_eq!(
            values(five + lanes.times(two)),
            one_by_one(|x| 5.0 + x * 2.0)
        );
        assert_eq!(
            values(five - lanes.times(two)),
            one_by_one(|x| 5.0 - x * 2.0)
        );
    }

    struct Everywhere;

    impl WithSimd for Everywhere {
        type Output = ();
        fn with_simd<S: Simd>(self, simd: S) {
            for samples in samples().chunks(S::F64_LANES) {
                let lanes = Vector::from_slice(simd, samples);
                agree(lanes, samples, |x| x.values()[..samples.len()].to_vec());
                fuse(lanes, samples, |x| x.values()[..samples.len()].to_vec());
                let square = |x: f64| Vector::splat(simd, x).times(Vector::splat(simd, x));
                let (near, rest) = (
                    1.0 + f64::EPSILON,
                    Vector::splat(simd, 1.0 + 2.0 * f64::EPSILON),
                );
                let left = (square(near) - rest).values()[0];
                assert_eq!(left != 0.0, Vector::<S>::FUSES, "{left:e}");
                assert_eq!(left, Vector::<S>::fuse(near, near, -rest.values()[0]));
            }
        }
    }

    #[test]
    fn lanes_agree_with_one_sample() {
        for samples in samples().chunks_exact(8) {
            let lanes: [f64; 8] = std::array::from_fn(|i| samples[i]);
            agree(f64x8::from(lanes), samples, |x| x.to_array().to_vec());
            fuse(f64x8::from(lanes), samples, |x| x.to_array().to_vec());
            let lanes: [f64; 4] = std::array::from_fn(|i| samples[i]);
            agree(f64x4::from(lanes), &samples[..4], |x| x.to_array().to_vec());
            fuse(f64x4::from(lanes), &samples[..4], |x| x.to_array().to_vec());
            fuse(samples[0], &samples[..1], |x| vec![x]);
            fuse(1.5_f32, &[1.5], |x| vec![f64::from(x)]);
        }
        Arch::new().dispatch(Everywhere);
        Everywhere.with_simd(Scalar);
    }

    #[test]
    fn a_vector_with_too_few_samples_is_filled_up_with_its_last() {
        struct Filled;
        impl WithSimd for Filled {
            type Output = ();
            fn with_simd<S: Simd>(self, simd: S) {
                let samples: Vec<f64> = (0..S::F64_LANES).map(|i| i as f64 + 1.0).collect();
                for count in 1..=S::F64_LANES {
                    let lanes = Vector::from_slice(simd, &samples[..count]);
                    let expected = (0..S::F64_LANES).map(|i| samples[i.min(count - 1)]);
                    assert!(lanes.values().iter().copied().eq(expected));
                }
            }
        }
        Arch::new().dispatch(Filled);
    }

    #[test]
    fn a_part_is_called_once_with_its_arguments() {
        struct Push;
        impl Part<(&mut Vec<f64>, f64)> for Push {
            fn call(self, (calls, x): (&mut Vec<f64>, f64)) {
                calls.push(x);
            }
        }
        let mut calls = vec![];
        Vector::splat(Scalar, 0.0).apart(Push, (&mut calls, 2.0));
        0.0_f64.apart(Push, (&mut calls, 3.0));
        assert_eq!(calls, [2.0, 3.0]);
    }
}
