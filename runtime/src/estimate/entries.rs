//! Equations Y = W X for refinement: entry by entry, in as many digits as there are.

use super::Double;
use crate::observe::Equations;

/// A system Y = W X whose entries are known to up to 32 digits, by columns.
pub trait Entries {
    /// Number of equations r.
    fn rows(&self) -> usize;

    /// Number of parameters np.
    fn columns(&self) -> usize;

    /// Writes column `k` of W (r values, in the unit of Y per unit of parameter k).
    fn column(&self, k: usize, out: &mut [Double]);

    /// Writes Y (r values).
    fn measurements(&self, out: &mut [Double]);

    /// Relative uncertainty of the entries: how far the true ones may be from these. Half a unit
    /// in the last place of f64 unless the entries say better; 0 for exact ones.
    fn roundoff(&self) -> f64 {
        0.5 * f64::EPSILON
    }
}

/// Blocks of equations on top of each other, each row multiplied by its factors without rounding.
pub(super) struct Stacked<'a> {
    pub blocks: &'a [Equations],
    /// A factor per block.
    pub factors: &'a [f64],
    /// A factor per row of each block besides, for robust weights.
    pub row_factors: Option<&'a [Vec<f64>]>,
    /// The parameters that are solved for, ascending.
    pub columns: &'a [usize],
}

impl Stacked<'_> {
    /// Writes a value per row of each block, zero where a block has none.
    fn write<'b>(
        &'b self,
        out: &mut [Double],
        values: impl Fn(&'b Equations) -> Option<&'b [f64]>,
    ) {
        out.fill(Double::default());
        let mut rest = out;
        for (place, block) in self.blocks.iter().enumerate() {
            let (own, next) = rest.split_at_mut(block.rows);
            rest = next;
            let Some(values) = values(block) else {
                continue;
            };
            let row_factors = self.row_factors.map(|all| all[place].as_slice());
            for (row, (out, value)) in own.iter_mut().zip(values).enumerate() {
                let factor = self.factors[place] * row_factors.map_or(1.0, |all| all[row]);
                *out = Double::product(*value, factor);
            }
        }
    }
}

impl Entries for Stacked<'_> {
    fn rows(&self) -> usize {
        self.blocks.iter().map(|block| block.rows).sum()
    }

    fn columns(&self) -> usize {
        self.columns.len()
    }

    fn column(&self, k: usize, out: &mut [Double]) {
        self.write(out, |block| {
            let place = block.columns.binary_search(&self.columns[k]).ok()?;
            Some(block.column(place))
        });
    }

    fn measurements(&self, out: &mut [Double]) {
        self.write(out, |block| block.y.as_deref());
    }
}
