//! From equations to evidence.

use std::ops::Range;

use rayon::prelude::*;

use super::{Evidence, EvidenceError, Fold, Layout, Triangle};
use crate::estimate::EstimateError;
use crate::model::IdentificationModel;
use crate::observe::{Equations, Observations};

/// A column that the model does not have, on trial.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate<'a> {
    /// Its name, such as `FA2`.
    pub name: String,
    /// Joint (from 0; 0 for the power balance) and the column's values in the equations of that
    /// joint, as many as it has rows: N m, N or W per unit of the candidate's parameter. Joints
    /// that it does not act on are left out.
    pub signals: Vec<(usize, &'a [f64])>,
}

/// How equations are cut into time blocks, alike for all joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// Blocks of this many rows; a remainder of less than half of it goes to the last block.
    Rows(usize),
    /// This many blocks, equal to one row.
    Blocks(usize),
}

impl Default for Cut {
    /// 32 blocks per log: a block of a usual log then is about a second, much longer than filtered
    /// residuals remember, and there are enough to tell their spread (the standard deviation of a
    /// standard deviation from n blocks is about \\( 1/\sqrt{2n} \\)).
    fn default() -> Self {
        Cut::Blocks(32)
    }
}

impl Cut {
    /// The rows of each block, in order; no block is empty.
    pub fn ranges(self, rows: usize) -> Vec<Range<usize>> {
        let bounds: Vec<usize> = match self {
            Cut::Rows(len) => {
                let len = len.max(1);
                let blocks = ((rows + len / 2) / len).max(1);
                (0..blocks).map(|b| b * len).chain([rows]).collect()
            }
            Cut::Blocks(blocks) => {
                let blocks = blocks.clamp(1, rows.max(1));
                (0..=blocks).map(|b| b * rows / blocks).collect()
            }
        };
        let ranges = bounds.windows(2).map(|pair| pair[0]..pair[1]);
        ranges.filter(|range| !range.is_empty()).collect()
    }
}

impl Evidence {
    /// Reduces the equations of one log to evidence; evidence of several logs is merged
    /// afterwards, so that no time block spans two logs.
    ///
    /// The factors do not depend on the number of threads.
    ///
    /// # Errors
    /// [`EvidenceError::Shape`] if joints or candidates have different numbers of rows;
    /// [`EstimateError::NoMeasurements`]; [`EstimateError::NotFinite`]; those of [`Layout::new`].
    pub fn from_observations(
        model: &dyn IdentificationModel,
        observations: &Observations,
        candidates: &[Candidate<'_>],
        cut: Cut,
    ) -> Result<Self, EvidenceError> {
        let layout = Layout::new(model, observations, candidates)?;
        let rows = observations.blocks.first().map_or(0, |block| block.rows);
        let equations = observations.blocks.iter().enumerate();
        let columns = equations
            .map(|(joint, block)| planar(joint, block, candidates, rows))
            .collect::<Result<Vec<_>, _>>()?;
        let cut = cut.ranges(rows);
        let joints = layout.joints.len();
        let factors: Vec<Triangle> = (0..cut.len() * joints)
            .into_par_iter()
            .map(|k| factor(&columns[k % joints], &cut[k / joints]))
            .collect();
        let blocks = factors
            .chunks(joints.max(1))
            .map(<[Triangle]>::to_vec)
            .collect();
        Ok(Evidence { layout, blocks })
    }
}

/// The columns of `[W | candidates | Y]` of a joint, checked.
fn planar<'a>(
    joint: usize,
    equations: &'a Equations,
    candidates: &[Candidate<'a>],
    rows: usize,
) -> Result<Vec<&'a [f64]>, EvidenceError> {
    let block = joint + 1;
    let y = equations
        .y
        .as_deref()
        .ok_or(EstimateError::NoMeasurements { block })?;
    let mut columns: Vec<&[f64]> = (0..equations.columns.len())
        .map(|k| equations.column(k))
        .collect();
    for candidate in candidates {
        columns.extend(
            candidate
                .signals
                .iter()
                .find(|(on, _)| *on == joint)
                .map(|(_, s)| *s),
        );
    }
    columns.push(y);
    let last = columns.len() - 1;
    for (k, column) in columns.iter().enumerate() {
        if column.len() != rows {
            let (what, found) = ("rows of a joint's equations", column.len());
            return Err(EvidenceError::Shape {
                what,
                found,
                expected: rows,
            });
        }
        if let Some(row) = column.iter().position(|value| !value.is_finite()) {
            let what = if k == last {
                "the measurement"
            } else {
                "the regressor"
            };
            return Err(EstimateError::NotFinite { what, block, row }.into());
        }
    }
    Ok(columns)
}

/// The factor of some rows.
fn factor(columns: &[&[f64]], rows: &Range<usize>) -> Triangle {
    let chunk: Vec<&[f64]> = columns.iter().map(|column| &column[rows.clone()]).collect();
    let mut fold = Fold::new(columns.len());
    fold.rows(&chunk);
    fold.finish()
}
