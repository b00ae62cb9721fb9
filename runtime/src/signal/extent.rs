//! Looks along whole series, several values at a time: extremes, numbers that are none, outliers.

use pulp::{Arch, Simd, WithSimd};

/// Smallest and largest value; infinities the wrong way round of nothing.
pub(crate) fn extent(series: &[f64]) -> (f64, f64) {
    Arch::new().dispatch(Extremes(series))
}

/// [`extent`] on the vectors of a machine.
struct Extremes<'a>(&'a [f64]);

impl WithSimd for Extremes<'_> {
    type Output = (f64, f64);

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> (f64, f64) {
        let (vectors, rest) = S::as_simd_f64s(self.0);
        let mut low = simd.splat_f64s(f64::INFINITY);
        let mut high = simd.splat_f64s(f64::NEG_INFINITY);
        for &x in vectors {
            // Comparisons, which no value that is not a number passes.
            low = simd.select_f64s(simd.less_than_f64s(x, low), x, low);
            high = simd.select_f64s(simd.greater_than_f64s(x, high), x, high);
        }
        (
            rest.iter()
                .copied()
                .fold(simd.reduce_min_f64s(low), f64::min),
            rest.iter()
                .copied()
                .fold(simd.reduce_max_f64s(high), f64::max),
        )
    }
}

/// Whether all values are finite numbers.
pub(crate) fn all_finite(series: &[f64]) -> bool {
    Arch::new().dispatch(Finite(series))
}

/// [`all_finite`] on the vectors of a machine.
struct Finite<'a>(&'a [f64]);

impl WithSimd for Finite<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let (vectors, rest) = S::as_simd_f64s(self.0);
        let mut none = simd.splat_f64s(0.0);
        for &x in vectors {
            // Zero for numbers; what is none stays none.
            none = simd.add_f64s(none, simd.sub_f64s(x, x));
        }
        simd.reduce_sum_f64s(none) == 0.0 && rest.iter().all(|x| x.is_finite())
    }
}

/// What running medians of five find along a series of at least five values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Medians {
    /// The smallest median.
    pub low: f64,
    /// The largest median.
    pub high: f64,
    /// How far a value lies at most from the median about it.
    pub farthest: f64,
}

/// Looks at all medians of five neighbours.
pub(crate) fn medians(series: &[f64]) -> Medians {
    Arch::new().dispatch(Look(series))
}

/// [`medians`] on the vectors of a machine.
struct Look<'a>(&'a [f64]);

impl WithSimd for Look<'_> {
    type Output = Medians;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Medians {
        let windows = self.0.len().saturating_sub(4);
        let [a, b, c, d, e] =
            std::array::from_fn(|k| S::as_simd_f64s(&self.0[k..(k + windows).max(k)]).0);
        let mut low = simd.splat_f64s(f64::INFINITY);
        let mut high = simd.splat_f64s(f64::NEG_INFINITY);
        let mut farthest = simd.splat_f64s(0.0);
        for ((((&a, &b), &c), &d), &e) in a.iter().zip(b).zip(c).zip(d).zip(e) {
            let median = middle(simd, [a, b, c, d, e]);
            let apart = simd.abs_f64s(simd.sub_f64s(c, median));
            low = simd.min_f64s(median, low);
            high = simd.max_f64s(median, high);
            farthest = simd.max_f64s(apart, farthest);
        }
        let done = a.len() * S::F64_LANES;
        let rest = self.0[done..].windows(5);
        let found = Medians {
            low: simd.reduce_min_f64s(low),
            high: simd.reduce_max_f64s(high),
            farthest: simd.reduce_max_f64s(farthest),
        };
        rest.fold(found, |found, five| {
            let median = median(five);
            Medians {
                low: found.low.min(median),
                high: found.high.max(median),
                farthest: found.farthest.max((five[2] - median).abs()),
            }
        })
    }
}

/// The middle one of five lies between the inner values of the two outer pairs, or is the centre.
#[inline(always)]
fn middle<S: Simd>(simd: S, [a, b, c, d, e]: [S::f64s; 5]) -> S::f64s {
    let low = simd.max_f64s(simd.min_f64s(a, b), simd.min_f64s(d, e));
    let high = simd.min_f64s(simd.max_f64s(a, b), simd.max_f64s(d, e));
    let centre = simd.min_f64s(simd.max_f64s(low, high), c);
    simd.max_f64s(simd.min_f64s(low, high), centre)
}

/// The middle one of five.
pub(crate) fn median(five: &[f64]) -> f64 {
    middle(pulp::Scalar, five.try_into().unwrap_or([f64::NAN; 5]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(len: usize) -> Vec<f64> {
        let x = |i: usize| ((i * 7919) % 1009) as f64 * [-1.0, 0.5, 0.5][i % 3];
        (0..len).map(x).collect()
    }

    #[test]
    fn extremes_are_those_of_a_walk_along_the_series() {
        for len in [0, 1, 7, 8, 9, 1000] {
            let series = series(len);
            let low = series.iter().copied().fold(f64::INFINITY, f64::min);
            let high = series.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            assert_eq!(extent(&series), (low, high), "{len}");
        }
        assert_eq!(extent(&[f64::NAN, 2.0, f64::NAN, 1.0]), (1.0, 2.0));
    }

    #[test]
    fn numbers_that_are_none_are_noticed_anywhere() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for at in [0, 1, 500, 999] {
                let mut series = series(1000);
                assert!(all_finite(&series));
                series[at] = bad;
                assert!(!all_finite(&series));
            }
        }
    }

    #[test]
    fn median_of_five_in_any_order_is_the_third() {
        for k in 0..120_usize {
            let mut left = vec![1.0, 2.0, 3.0, 4.0, 5.0];
            let order = [k / 24, k / 6 % 4, k / 2 % 3, k % 2, 0];
            let five = order.map(|place| left.remove(place));
            assert_eq!(median(&five), 3.0, "{five:?}");
        }
        assert_eq!(median(&[2.0, 2.0, 7.0, 7.0, 2.0]), 2.0);
    }

    #[test]
    fn medians_side_by_side_are_those_one_by_one() {
        for len in [5, 6, 12, 13, 500] {
            let series = series(len);
            let each: Vec<f64> = series.windows(5).map(median).collect();
            let apart = each.iter().zip(&series[2..]).map(|(m, x)| (x - m).abs());
            let found = medians(&series);
            assert_eq!((found.low, found.high), extent(&each), "{len}");
            assert_eq!(found.farthest, apart.fold(0.0, f64::max), "{len}");
        }
    }
}
