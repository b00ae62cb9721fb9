//! Sums over the modes of a low-pass, of signals side by side.
//!
//! Every lane of a register holds another signal. A product is fused with the sum that it enters
//! where the machine has an instruction for both, so that machines agree to rounding, not to the
//! bit. There are loops where closures would do: a closure that is not inlined runs without the
//! registers of the machine.

use pulp::Simd;

use super::modal::{Modes, PAIRS, State};

/// Real and imaginary parts of the sums over all pole pairs.
pub(super) const PARTS: usize = 2 * PAIRS;

/// The sums of several signals, real parts first.
pub(super) type Sums<S> = [<S as Simd>::f64s; PARTS];

/// Weights of sums, the imaginary parts with the sign of \\( \mathrm{Re}\,(w z) \\).
pub(super) type Weights = [f64; PARTS];

/// What the sums are weighted with.
#[derive(Clone, Debug)]
pub(super) struct Table {
    modes: Option<Modes>,
    ratio: usize,
    /// \\( (p^{n-1-i} \pm p^i) / 2 \\) for the first half of the samples between two rows, whose
    /// other half mirrors them.
    even: Vec<Weights>,
    odd: Vec<Weights>,
    /// \\( p^{n_d} \\), by which a sum ages from row to row.
    pub aging: State,
    /// Weights of the past in the result.
    pub weights: Weights,
    pub direct: f64,
    /// \\( p^{k n_d} \\).
    pub ages: Vec<State>,
    /// Weights of the future in the result k rows before: it begins one sample after a row.
    pub echo: Vec<Weights>,
}

impl Table {
    pub fn new(modes: Option<&Modes>, ratio: usize) -> Self {
        let half = ratio.div_ceil(2);
        let nothing = State::default();
        let power = |m: usize| modes.map_or(nothing, |modes| modes.powers(m));
        let pair = |i: usize, sign: f64| -> Weights {
            let (later, sooner) = (power(ratio - 1 - i), power(i));
            std::array::from_fn(|lane| {
                let (part, k) = (lane / PAIRS, lane % PAIRS);
                0.5 * (later[part][k] + sign * sooner[part][k])
            })
        };
        let mut table = Table {
            even: (0..half).map(|i| pair(i, 1.0)).collect(),
            odd: (0..half).map(|i| pair(i, -1.0)).collect(),
            aging: power(ratio),
            weights: weights(modes, 0),
            direct: modes.map_or(1.0, |modes| modes.direct),
            ages: Vec::new(),
            echo: Vec::new(),
            modes: modes.cloned(),
            ratio,
        };
        table.reach(1);
        table
    }

    /// Makes room for blocks of `rows` rows.
    pub fn reach(&mut self, rows: usize) {
        let modes = self.modes.as_ref();
        for k in self.ages.len()..=rows {
            let age = modes.map_or(State::default(), |modes| modes.powers(k * self.ratio));
            self.ages.push(age);
            self.echo.push(weights(modes, k * self.ratio + 1));
        }
    }

    /// \\( \sum_i p^{n-1-i} x_i \\) and \\( \sum_i p^i x_i \\).
    #[inline(always)]
    pub fn sums<S: Simd>(&self, simd: S, x: &[S::f64s]) -> (Sums<S>, Sums<S>) {
        let zero = simd.splat_f64s(0.0);
        let (mut even, mut odd) = ([zero; PARTS], [zero; PARTS]);
        let half = x.len() / 2;
        let pairs = x[..half].iter().zip(x.iter().rev());
        for ((&a, &b), (e, o)) in pairs.zip(self.even.iter().zip(&self.odd)) {
            accumulate(simd, &mut even, e, simd.add_f64s(a, b));
            accumulate(simd, &mut odd, o, simd.sub_f64s(a, b));
        }
        if x.len() % 2 == 1 {
            accumulate(simd, &mut even, &self.even[half], x[half]);
        }
        let mut minus = even;
        for (minus, odd) in minus.iter_mut().zip(odd) {
            *minus = simd.sub_f64s(*minus, odd);
        }
        (plus(simd, &even, &odd), minus)
    }
}

/// Weights of sums in the result `m` samples away: \\( w p^m \\).
fn weights(modes: Option<&Modes>, m: usize) -> Weights {
    let Some(modes) = modes else {
        return [0.0; PARTS];
    };
    let [re, im] = modes.powers(m);
    std::array::from_fn(|lane| {
        let (weight, k) = (modes.weights[lane % PAIRS], lane % PAIRS);
        match lane / PAIRS {
            0 => weight.re * re[k] - weight.im * im[k],
            _ => -(weight.re * im[k] + weight.im * re[k]),
        }
    })
}

#[inline(always)]
fn accumulate<S: Simd>(simd: S, sums: &mut Sums<S>, weights: &Weights, x: S::f64s) {
    for (sum, weight) in sums.iter_mut().zip(weights) {
        *sum = simd.mul_add_e_f64s(simd.splat_f64s(*weight), x, *sum);
    }
}

/// The products of complex numbers with those of `state`.
#[inline(always)]
pub(super) fn rotated<S: Simd>(simd: S, by: &State, state: &Sums<S>) -> Sums<S> {
    let mut product = *state;
    for k in 0..PAIRS {
        let (cos, sin) = (simd.splat_f64s(by[0][k]), simd.splat_f64s(by[1][k]));
        let (re, im) = (state[k], state[k + PAIRS]);
        let minus_sin = simd.neg_f64s(sin);
        product[k] = simd.mul_add_e_f64s(minus_sin, im, simd.mul_f64s(cos, re));
        product[k + PAIRS] = simd.mul_add_e_f64s(sin, re, simd.mul_f64s(cos, im));
    }
    product
}

#[inline(always)]
pub(super) fn plus<S: Simd>(simd: S, a: &Sums<S>, b: &Sums<S>) -> Sums<S> {
    let mut sum = *a;
    for (sum, b) in sum.iter_mut().zip(b) {
        *sum = simd.add_f64s(*sum, *b);
    }
    sum
}

/// Sum of the products, in a fixed order that leaves additions independent as long as possible.
#[inline(always)]
pub(super) fn weighted<S: Simd>(simd: S, weights: &Weights, state: &Sums<S>) -> S::f64s {
    let mut half = [simd.splat_f64s(0.0); PAIRS];
    for (k, half) in half.iter_mut().enumerate() {
        let re = simd.mul_f64s(simd.splat_f64s(weights[k]), state[k]);
        *half = simd.mul_add_e_f64s(simd.splat_f64s(weights[k + PAIRS]), state[k + PAIRS], re);
    }
    let [a, b, c, d] = half;
    simd.add_f64s(simd.add_f64s(a, c), simd.add_f64s(b, d))
}
