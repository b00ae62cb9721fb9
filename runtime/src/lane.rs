//! Lane types that emitted regressors are generic over: one sample, or several side by side.
//!
//! One emitted source serves `f64`, `f32` and the SIMD types of `wide`. The functions need nothing
//! but this trait: no allocation, no other dependency.

use core::ops::{Add, Mul, Neg, Sub};

use wide::f64x4;

/// A number, or several numbers side by side on which each operation acts alike.
pub trait Lane:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// The same constant in every lane.
    fn splat(value: f64) -> Self;
    /// Sine and cosine; argument in rad.
    fn sin_cos(self) -> (Self, Self);
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
}

macro_rules! scalar {
    ($t:ty) => {
        impl Lane for $t {
            fn splat(value: f64) -> Self {
                value as $t
            }
            fn sin_cos(self) -> (Self, Self) {
                <$t>::sin_cos(self)
            }
            fn sign(self) -> Self {
                if self > 0.0 {
                    1.0
                } else if self < 0.0 {
                    -1.0
                } else {
                    0.0 * self
                }
            }
            fn abs(self) -> Self {
                <$t>::abs(self)
            }
            fn tanh(self) -> Self {
                <$t>::tanh(self)
            }
            fn bell(self) -> Self {
                (-self * self).exp()
            }
            fn abs_power(self, p: f64) -> Self {
                <$t>::abs(self).powf(p as $t)
            }
            fn reciprocal(self) -> Self {
                self.recip()
            }
            fn root(self) -> Self {
                self.sqrt()
            }
        }
    };
}

scalar!(f32);
scalar!(f64);

impl Lane for f64x4 {
    fn splat(value: f64) -> Self {
        f64x4::splat(value)
    }
    fn sin_cos(self) -> (Self, Self) {
        f64x4::sin_cos(self)
    }
    fn sign(self) -> Self {
        let one = f64x4::splat(1.0);
        let zero = f64x4::splat(0.0);
        (self.simd_gt(zero) & one) - (self.simd_lt(zero) & one)
    }
    fn abs(self) -> Self {
        f64x4::abs(self)
    }
    fn tanh(self) -> Self {
        let values = self.to_array();
        f64x4::from(values.map(f64::tanh))
    }
    fn bell(self) -> Self {
        f64x4::from(self.to_array().map(Lane::bell))
    }
    fn abs_power(self, p: f64) -> Self {
        f64x4::from(self.to_array().map(|x| x.abs_power(p)))
    }
    fn reciprocal(self) -> Self {
        f64x4::splat(1.0) / self
    }
    fn root(self) -> Self {
        f64x4::sqrt(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_of_four_agree_with_one_sample() {
        let samples: Vec<f64> = (-40..40).map(|i| f64::from(i) * 0.173).collect();
        for quad in samples.chunks_exact(4) {
            let lanes = f64x4::from([quad[0], quad[1], quad[2], quad[3]]);
            let (sin, cos) = Lane::sin_cos(lanes);
            for (i, &x) in quad.iter().enumerate() {
                assert!((sin.to_array()[i] - x.sin()).abs() <= 2.0 * f64::EPSILON);
                assert!((cos.to_array()[i] - x.cos()).abs() <= 2.0 * f64::EPSILON);
                assert_eq!(Lane::sign(lanes).to_array()[i], Lane::sign(x));
                assert_eq!(Lane::abs(lanes).to_array()[i], x.abs());
                assert_eq!(Lane::tanh(lanes).to_array()[i], x.tanh());
                assert_eq!(lanes.bell().to_array()[i], (-x * x).exp());
                assert_eq!(lanes.abs_power(1.5).to_array()[i], x.abs().powf(1.5));
                assert_eq!(lanes.reciprocal().to_array()[i], x.recip());
                assert_eq!(lanes.abs().root().to_array()[i], x.abs().sqrt());
            }
        }
    }
}
