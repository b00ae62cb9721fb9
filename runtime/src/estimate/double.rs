//! Numbers of about 32 decimal digits as the unevaluated sum of two f64 (Dekker 1971).

use std::ops::{Add, Mul, Sub};

/// Splits 53 bits into halves of 26 whose products are exact: 2^27 + 1.
const SPLITTER: f64 = 134_217_729.0;

/// A number `hi + lo` with \\( |lo| \le \frac12 \mathrm{ulp}(hi) \\): relative precision about
/// 2^-104. Magnitudes beyond 1e290 overflow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Double {
    /// The nearest f64.
    pub hi: f64,
    /// What is missing from it.
    pub lo: f64,
}

impl Double {
    /// \\( a b \\) without rounding. Products are split by hand (Dekker): a fused multiply-add
    /// would be a library call on machines without the instruction.
    pub fn product(a: f64, b: f64) -> Double {
        let hi = a * b;
        let ((a1, a2), (b1, b2)) = (split(a), split(b));
        let lo = ((a1 * b1 - hi) + a1 * b2 + a2 * b1) + a2 * b2;
        Double { hi, lo }
    }

    /// \\( a / b \\), with a relative error of about 2^-104. A decimal number is the ratio of an
    /// integer and a power of ten, both exact in f64 up to 15 digits.
    pub fn ratio(a: f64, b: f64) -> Double {
        let hi = a / b;
        let back = Double::product(hi, b);
        quick(hi, ((a - back.hi) - back.lo) / b)
    }

    /// The nearest f64.
    pub fn rounded(self) -> f64 {
        self.hi + self.lo
    }
}

impl From<f64> for Double {
    fn from(hi: f64) -> Double {
        Double { hi, lo: 0.0 }
    }
}

impl Add for Double {
    type Output = Double;

    fn add(self, other: Double) -> Double {
        let high = sum(self.hi, other.hi);
        let low = sum(self.lo, other.lo);
        let first = quick(high.hi, high.lo + low.hi);
        quick(first.hi, first.lo + low.lo)
    }
}

impl Sub for Double {
    type Output = Double;

    fn sub(self, other: Double) -> Double {
        self + Double {
            hi: -other.hi,
            lo: -other.lo,
        }
    }
}

impl Mul for Double {
    type Output = Double;

    fn mul(self, other: Double) -> Double {
        let product = Double::product(self.hi, other.hi);
        let cross = self.hi * other.lo + self.lo * other.hi;
        quick(product.hi, product.lo + cross)
    }
}

/// \\( \sum a_i b_i \\) as if in twice the precision (Ogita, Rump and Oishi 2005, Dot2).
pub(super) fn accurate_dot(a: &[f64], b: &[f64]) -> f64 {
    let (mut total, mut error) = (0.0, 0.0);
    for (a, b) in a.iter().zip(b) {
        let product = Double::product(*a, *b);
        let next = sum(total, product.hi);
        total = next.hi;
        error += next.lo + product.lo;
    }
    total + error
}

/// \\( a \leftarrow a - s b \\) with the product kept exact.
pub(super) fn accurate_subtract(a: &mut [f64], s: f64, b: &[f64]) {
    for (a, b) in a.iter_mut().zip(b) {
        let product = Double::product(s, *b);
        let difference = sum(*a, -product.hi);
        *a = difference.hi + (difference.lo - product.lo);
    }
}

/// \\( a + b \\) without rounding (Knuth).
fn sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    let b1 = hi - a;
    let lo = (a - (hi - b1)) + (b - b1);
    Double { hi, lo }
}

/// \\( a + b \\) without rounding if |a| >= |b| (Dekker).
fn quick(a: f64, b: f64) -> Double {
    let hi = a + b;
    Double {
        hi,
        lo: b - (hi - a),
    }
}

fn split(a: f64) -> (f64, f64) {
    let shifted = SPLITTER * a;
    let high = shifted - (shifted - a);
    (high, a - high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn product_of_two_f64_keeps_every_bit() {
        let a = 1.0 + f64::EPSILON;
        let square = Double::product(a, a);
        assert_eq!(square.hi, 1.0 + 2.0 * f64::EPSILON);
        assert_eq!(square.lo, f64::EPSILON * f64::EPSILON);
    }

    #[test]
    fn sum_keeps_what_f64_loses() {
        let large = Double::from(1e20) + Double::from(1.5);
        assert_eq!(large - Double::from(1e20), Double::from(1.5));
    }

    #[test]
    fn third_times_three_is_one_to_the_last_bit() {
        let error = Double::ratio(1.0, 3.0) * Double::from(3.0) - Double::from(1.0);
        assert!(error.rounded().abs() < 2f64.powi(-103), "{error:?}");
    }

    #[test]
    fn dot_survives_cancellation() {
        let dot = accurate_dot(&[1e16, 1.0, -1e16, 1e-3], &[1e3, 1.0, 1e3, 1e-3]);
        assert_eq!(dot, 1.000001);
    }
}
