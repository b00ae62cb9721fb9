//! The kernel: folds a panel of 64 rows into a triangular factor by Householder reflections.
//!
//! A reflection of row k of the factor and the panel's column k sees nothing else of the factor,
//! because the rest of its column k is zero: that is the triangle, exploited. Several reflections
//! are applied together (their products among themselves are known), so each column of the panel
//! travels through the registers once per group.

use pulp::{Arch, Simd, WithSimd};

/// Rows of a panel: enough to make the arithmetic dear and the memory cheap, few enough that 60
/// columns stay in the first-level cache.
pub(super) const ROWS: usize = 64;

/// Rows that are worked on side by side: those of the widest registers.
pub(super) const LANES: usize = 8;

/// Some rows of a column.
type Lanes = [f64; LANES];

/// A column of a panel.
pub(super) type Column = [Lanes; ROWS / LANES];

/// Reflections applied together: as many as the registers hold.
const GROUP: usize = 4;

/// Columns that a group of reflections is applied to side by side.
const ABREAST: usize = 2;

/// The reflection that takes \\( (\alpha, a) \\) to \\( (\mu, 0) \\) with
/// \\( \mu = \sqrt{\alpha^2 + a^T a} \ge 0 \\): it has \\( v = (\alpha + \mu, a) \\), and its sign
/// in the factor's row is turned, so that the diagonal is never negative and nothing cancels.
#[derive(Clone, Copy, Default)]
struct Reflection {
    alpha: f64,
    /// \\( 1 / \mu \\), zero if there is nothing to reflect.
    over_mu: f64,
    /// \\( 1 / (\alpha + \mu) \\).
    over_sum: f64,
}

impl Reflection {
    /// The reflection of a diagonal entry and the panel's column below it, and the new entry.
    #[inline(always)]
    fn new(alpha: f64, a: &Column) -> (Self, f64) {
        let mu = (alpha * alpha + dot(a, a)).sqrt();
        let inverse = |x: f64| if x > 0.0 { 1.0 / x } else { 0.0 };
        let over_sum = inverse(alpha + mu);
        (
            Reflection {
                alpha,
                over_mu: inverse(mu),
                over_sum,
            },
            mu,
        )
    }

    /// Reflects an entry of the factor's row, given the product of `a` and the column below that
    /// entry; returns what is to be subtracted from the column, in units of `a`.
    #[inline(always)]
    fn apply(&self, entry: &mut f64, product: f64) -> f64 {
        let step = (*entry + product * self.over_sum) * self.over_mu;
        *entry = (self.alpha * *entry + product) * self.over_mu;
        step
    }
}

/// Folds a panel into the upper triangular factor `r`, packed by rows: afterwards
/// \\( R'^T R' = R^T R + A^T A \\). The panel is overwritten. `r` has `n (n + 1) / 2` entries for
/// n columns; all diagonal entries must be and are non-negative.
pub(super) fn fold(r: &mut [f64], panel: &mut [Column]) {
    Arch::new().dispatch(Folding { r, panel });
}

/// [`fold`] on the vectors of a machine.
struct Folding<'a> {
    r: &'a mut [f64],
    panel: &'a mut [Column],
}

impl WithSimd for Folding<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (mut r, mut panel) = (self.r, self.panel);
        while panel.len() >= GROUP {
            (r, panel) = fold_group::<GROUP>(r, panel);
        }
        while !panel.is_empty() {
            (r, panel) = fold_group::<1>(r, panel);
        }
    }
}

/// Eliminates the first `G` columns of the panel; returns the rows and columns that are left.
#[inline(always)]
fn fold_group<'a, const G: usize>(
    r: &'a mut [f64],
    panel: &'a mut [Column],
) -> (&'a mut [f64], &'a mut [Column]) {
    let width = panel.len();
    let (rows, r) = r.split_at_mut((0..G).map(|g| width - g).sum());
    let Some((v, panel)) = panel.split_first_chunk_mut::<G>() else {
        return (r, &mut []);
    };
    let group = Group::new(v, rows, width);
    let mut at = G;
    let mut some = panel.chunks_exact_mut(ABREAST);
    for columns in &mut some {
        if let Ok(columns) = columns.try_into() {
            group.apply::<ABREAST>(rows, at, columns);
        }
        at += ABREAST;
    }
    for column in some.into_remainder() {
        group.apply(rows, at, std::array::from_mut(column));
        at += 1;
    }
    (r, panel)
}

/// `G` reflections in a row.
struct Group<'a, const G: usize> {
    v: &'a [Column; G],
    reflections: [Reflection; G],
    /// Products of the reflections' columns with those of the earlier ones.
    products: [[f64; G]; G],
    /// Entries in the first row of the factor.
    width: usize,
}

#[expect(
    clippy::needless_range_loop,
    reason = "the indices name registers of several arrays"
)]
impl<'a, const G: usize> Group<'a, G> {
    /// Reflects the first `G` columns of a panel among themselves.
    #[inline(always)]
    fn new(v: &'a mut [Column; G], rows: &mut [f64], width: usize) -> Self {
        let mut reflections = [Reflection::default(); G];
        let mut products = [[0.0; G]; G];
        let mut start = 0;
        for g in 0..G {
            let (done, rest) = v.split_at_mut(g + 1);
            let a = &done[g];
            (reflections[g], rows[start]) = Reflection::new(rows[start], a);
            for (k, column) in rest.iter_mut().enumerate() {
                let step = reflections[g].apply(&mut rows[start + 1 + k], dot(a, column));
                subtract(step, a, column);
            }
            for (e, earlier) in done[..g].iter().enumerate() {
                products[g][e] = dot(earlier, a);
            }
            start += width - g;
        }
        Group {
            v,
            reflections,
            products,
            width,
        }
    }

    /// Applies the reflections to `M` columns of the panel, whose entries in the first row of the
    /// factor stand at `at`.
    #[inline(always)]
    fn apply<const M: usize>(&self, rows: &mut [f64], at: usize, columns: &mut [Column; M]) {
        let mut sums = [[[0.0; LANES]; G]; M];
        for k in 0..ROWS / LANES {
            for m in 0..M {
                for g in 0..G {
                    sums[m][g] = plus(&sums[m][g], &times(&self.v[g][k], &columns[m][k]));
                }
            }
        }
        let mut steps = [[[0.0; LANES]; G]; M];
        for m in 0..M {
            let mut dots = [0.0; G];
            for g in 0..G {
                dots[g] = total(&sums[m][g]);
            }
            let all = self.steps(rows, at + m, dots);
            for g in 0..G {
                steps[m][g] = [all[g]; LANES];
            }
        }
        for k in 0..ROWS / LANES {
            for m in 0..M {
                let mut c = columns[m][k];
                for g in 0..G {
                    c = minus(&c, &times(&steps[m][g], &self.v[g][k]));
                }
                columns[m][k] = c;
            }
        }
    }

    /// Reflects the entries of the factor above one column of the panel. Each reflection sees the
    /// column as the earlier ones leave it, which the products account for.
    #[inline(always)]
    fn steps(&self, rows: &mut [f64], at: usize, dots: [f64; G]) -> [f64; G] {
        let mut steps = [0.0; G];
        let mut place = at;
        for g in 0..G {
            let mut product = dots[g];
            for e in 0..g {
                product -= steps[e] * self.products[g][e];
            }
            steps[g] = self.reflections[g].apply(&mut rows[place], product);
            place += self.width - g - 1;
        }
        steps
    }
}

/// Sum of the lanes, in a fixed order.
#[inline(always)]
fn total(lanes: &Lanes) -> f64 {
    let [a, b, c, d, e, f, g, h] = lanes;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

#[inline(always)]
fn dot(a: &Column, b: &Column) -> f64 {
    let mut sum = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        sum = plus(&sum, &times(a, b));
    }
    total(&sum)
}

#[inline(always)]
fn subtract(step: f64, a: &Column, from: &mut Column) {
    for (x, a) in from.iter_mut().zip(a) {
        *x = minus(x, &times(&[step; LANES], a));
    }
}

#[inline(always)]
fn times(a: &Lanes, b: &Lanes) -> Lanes {
    let mut result = *a;
    for (a, b) in result.iter_mut().zip(b) {
        *a *= b;
    }
    result
}

#[inline(always)]
fn plus(a: &Lanes, b: &Lanes) -> Lanes {
    let mut result = *a;
    for (a, b) in result.iter_mut().zip(b) {
        *a += b;
    }
    result
}

#[inline(always)]
fn minus(a: &Lanes, b: &Lanes) -> Lanes {
    let mut result = *a;
    for (a, b) in result.iter_mut().zip(b) {
        *a -= b;
    }
    result
}
