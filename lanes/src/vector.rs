//! Lanes as wide as the vectors of the machine that runs the program, whatever it was compiled for.

use std::ops::{Add, Mul, Neg, Sub};

use bytemuck::{cast_slice, cast_slice_mut};
use pulp::{Simd, WithSimd};

use crate::sine::{self, Turn};
use crate::{FUSES, Lane, Part};

/// `S::F64_LANES` numbers in a vector of the instructions `S`: 8 with AVX-512, 4 with AVX2, 2 with
/// NEON, else 1.
///
/// Its operations are single instructions where they are inlined into a function that runs with
/// these instructions, that is under [`pulp::Arch::dispatch`] or [`Lane::apart`]; elsewhere they
/// are slow calls.
#[derive(Clone, Copy, Debug)]
pub struct Vector<S: Simd> {
    simd: S,
    values: S::f64s,
}

impl<S: Simd> Vector<S> {
    /// Whether the instructions multiply and add with one rounding: all vectors of x86 that
    /// [`pulp::Arch`] knows do, and NEON.
    pub const FUSES: bool =
        FUSES || (S::F64_LANES > 1 && cfg!(any(target_arch = "x86_64", target_arch = "x86")));

    /// [`Lane::fused`] of single numbers, with the rounding of these lanes.
    #[inline(always)]
    pub fn fuse(a: f64, b: f64, c: f64) -> f64 {
        match Self::FUSES {
            true => a.mul_add(b, c),
            false => a * b + c,
        }
    }

    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        let values = simd.splat_f64s(value);
        Vector { simd, values }
    }

    /// The first numbers of a slice; its last one again and again where it has too few, 0 where it
    /// has none.
    #[inline(always)]
    pub fn from_slice(simd: S, slice: &[f64]) -> Self {
        if let [first, ..] = S::as_simd_f64s(slice).0 {
            return Vector {
                simd,
                values: *first,
            };
        }
        let last = slice.last().copied().unwrap_or(0.0);
        let mut filled = Vector::splat(simd, last);
        let lanes: &mut [f64] = cast_slice_mut(std::slice::from_mut(&mut filled.values));
        lanes[..slice.len()].copy_from_slice(slice);
        filled
    }

    /// The numbers, `S::F64_LANES` of them.
    #[inline(always)]
    pub fn values(&self) -> &[f64] {
        cast_slice(std::slice::from_ref(&self.values))
    }

    #[inline(always)]
    fn with(self, values: S::f64s) -> Self {
        Vector { values, ..self }
    }

    #[inline(always)]
    fn each(mut self, f: impl Fn(f64) -> f64) -> Self {
        let lanes: &mut [f64] = cast_slice_mut(std::slice::from_mut(&mut self.values));
        lanes.iter_mut().for_each(|x| *x = f(*x));
        self
    }
}

impl<S: Simd> Turn for Vector<S> {
    type Mask = S::m64s;
    /// Where the number as stored has all these bits.
    #[inline(always)]
    fn has_bit(self, bit: u64) -> S::m64s {
        let bit = self.simd.splat_u64s(bit);
        let bits = self.simd.transmute_u64s_f64s(self.values);
        self.simd.equal_u64s(self.simd.and_u64s(bits, bit), bit)
    }

    /// These numbers where the mask is set, else the others.
    #[inline(always)]
    fn where_else(self, mask: S::m64s, other: Self) -> Self {
        self.with(self.simd.select_f64s(mask, self.values, other.values))
    }
}

impl<S: Simd> Add for Vector<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(self.simd.add_f64s(self.values, other.values))
    }
}

impl<S: Simd> Sub for Vector<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(self.simd.sub_f64s(self.values, other.values))
    }
}

impl<S: Simd> Mul for Vector<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with(self.simd.mul_f64s(self.values, other.values))
    }
}

impl<S: Simd> Neg for Vector<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.splat(-0.0) - self
    }
}

impl<S: Simd> Lane for Vector<S> {
    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        Vector::splat(self.simd, value)
    }
    #[inline(always)]
    fn fused(self, factor: Self, term: Self) -> Self {
        match Self::FUSES {
            true => self.with((self.simd).mul_add_f64s(self.values, factor.values, term.values)),
            false => self * factor + term,
        }
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        sine::sin_cos(self)
    }
    #[inline(always)]
    fn sign(self) -> Self {
        let (zero, simd) = (self.splat(0.0), self.simd);
        let positive = simd.greater_than_f64s(self.values, zero.values);
        let negative = simd.less_than_f64s(self.values, zero.values);
        let else_zero = self.splat(-1.0).where_else(negative, zero * self);
        self.splat(1.0).where_else(positive, else_zero)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.with(self.simd.abs_f64s(self.values))
    }
    #[inline(always)]
    fn tanh(self) -> Self {
        self.each(f64::tanh)
    }
    #[inline(always)]
    fn bell(self) -> Self {
        self.each(Lane::bell)
    }
    #[inline(always)]
    fn abs_power(self, p: f64) -> Self {
        match p {
            0.5 => Lane::abs(self).root(),
            2.0 => self * self,
            p => self.each(|x| x.abs_power(p)),
        }
    }
    #[inline(always)]
    fn reciprocal(self) -> Self {
        let one = self.splat(1.0);
        self.with(self.simd.div_f64s(one.values, self.values))
    }
    #[inline(always)]
    fn root(self) -> Self {
        self.with(self.simd.sqrt_f64s(self.values))
    }
    #[inline(never)]
    fn apart<A>(self, part: impl Part<A>, arguments: A) {
        self.simd.vectorize(Call { part, arguments });
    }
}

/// A part of a function, to be called with the instructions of a vector.
struct Call<P, A> {
    part: P,
    arguments: A,
}

impl<P: Part<A>, A> WithSimd for Call<P, A> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.part.call(self.arguments);
    }
}
