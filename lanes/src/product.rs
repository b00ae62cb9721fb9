//! Products that the sum they enter rounds.

use core::ops::{Add, Sub};

use crate::{Lane, Simd, Vector, f64x4, f64x8};

/// A product on its way into a sum: [`Lane::times`].
///
/// `a + b.times(c)` is `a + b * c`, but rounded once, in one instruction, where the machine has it.
#[derive(Clone, Copy, Debug)]
pub struct Product<T> {
    first: T,
    second: T,
}

impl<T: Lane> Product<T> {
    #[inline(always)]
    pub(crate) fn new(first: T, second: T) -> Self {
        Product { first, second }
    }
}

impl<T: Lane> Add<T> for Product<T> {
    type Output = T;
    #[inline(always)]
    fn add(self, term: T) -> T {
        self.first.fused(self.second, term)
    }
}

impl<T: Lane> Sub<T> for Product<T> {
    type Output = T;
    #[inline(always)]
    fn sub(self, term: T) -> T {
        self.first.fused(self.second, -term)
    }
}

macro_rules! sums {
    ($t:ty $(, $s:ident: $bound:ident)?) => {
        impl$(<$s: $bound>)? Add<Product<$t>> for $t {
            type Output = $t;
            #[inline(always)]
            fn add(self, product: Product<$t>) -> $t {
                product.first.fused(product.second, self)
            }
        }

        impl$(<$s: $bound>)? Sub<Product<$t>> for $t {
            type Output = $t;
            #[inline(always)]
            fn sub(self, product: Product<$t>) -> $t {
                (-product.first).fused(product.second, self)
            }
        }
    };
}

sums!(f32);
sums!(f64);
sums!(f64x4);
sums!(f64x8);
sums!(Vector<S>, S: Simd);
