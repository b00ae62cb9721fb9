//! The equations Y = W X of each joint, or of the power balance.

use std::ops::Range;

use super::{Filtering, ModelKind, Motion, ObserveError, decimated};
use crate::model::IdentificationModel;
use crate::signal::{Decimator, SignalError};

/// Equations that share one error level: those of a joint, or the power balance.
#[derive(Clone, Debug, PartialEq)]
pub struct Equations {
    /// The columns of X that these equations can see, ascending.
    pub columns: Vec<usize>,
    /// Number of equations.
    pub rows: usize,
    /// Observation matrix W, `rows` x `columns.len()`, column-major.
    pub w: Vec<f64>,
    /// Measurements Y, `rows` values: N m, N, or W for the power balance. `None` without torque.
    pub y: Option<Vec<f64>>,
}

/// The equations of one model along one or several logs.
#[derive(Clone, Debug, PartialEq)]
pub struct Observations {
    /// Which model.
    pub model: ModelKind,
    /// One block per joint; a single block for the power model.
    pub blocks: Vec<Equations>,
}

/// Equations of one model along a motion, low-passed and decimated in parallel (Gautier 1996,
/// eqs. 17, 19 and 23). `motion` comes from [`Motion::trimmed`].
///
/// # Errors
/// [`ObserveError::NothingLeft`], [`ObserveError::Filter`].
pub fn observe(
    model: &dyn IdentificationModel,
    kind: ModelKind,
    motion: &Motion,
    filtering: &Filtering,
) -> Result<Observations, ObserveError> {
    let fail = ObserveError::filter(&motion.log, "parallel filter");
    let decimator = filtering.decimator(motion.rate_hz).map_err(&fail)?;
    let kept = decimator.kept(motion.len);
    let believed = rows_believed(motion, filtering, &kept)?;
    let kept = pick(&kept, &believed);
    equations_at(model, kind, motion, &decimator, &kept).map_err(&fail)
}

/// The equations at the samples `kept` of a motion.
pub(crate) fn equations_at(
    model: &dyn IdentificationModel,
    kind: ModelKind,
    motion: &Motion,
    decimator: &Decimator,
    kept: &[usize],
) -> Result<Observations, SignalError> {
    let mut blocks = empty_blocks(model, kind, kept.len());
    for &term in kind.terms() {
        let signals = decimated(model, term, motion, decimator, kept)?;
        for entry in model.pattern(term.0).entries.iter() {
            if let Some(block) = blocks.get_mut(entry.row) {
                block.add(entry.column, &signals[entry.signal]);
            }
        }
    }
    if let Some(y) = measurements(kind, motion, decimator, kept)? {
        for (block, y) in blocks.iter_mut().zip(y) {
            block.y = Some(y);
        }
    }
    Ok(Observations {
        model: kind,
        blocks,
    })
}

impl Observations {
    /// No equations of a model, with the columns that they would see.
    pub fn none(model: &dyn IdentificationModel, kind: ModelKind) -> Self {
        Observations {
            model: kind,
            blocks: empty_blocks(model, kind, 0),
        }
    }

    /// Appends the equations of another log.
    pub fn append(&mut self, other: &Observations) {
        for (block, more) in self.blocks.iter_mut().zip(&other.blocks) {
            block.append(more);
        }
    }

    /// Number of equations.
    pub fn rows(&self) -> usize {
        self.blocks.iter().map(|block| block.rows).sum()
    }
}

impl Equations {
    /// Column `k` of W, of those in `columns`.
    pub fn column(&self, k: usize) -> &[f64] {
        &self.w[k * self.rows..(k + 1) * self.rows]
    }

    /// \\( W X \\) for the np parameters X of the model, `rows` values.
    pub fn product(&self, parameters: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.rows];
        for (k, column) in self.columns.iter().enumerate() {
            for (sum, value) in product.iter_mut().zip(self.column(k)) {
                *sum += value * parameters[*column];
            }
        }
        product
    }

    /// \\( Y - W X \\) for the np parameters X of the model; empty without measurements.
    pub fn residual(&self, parameters: &[f64]) -> Vec<f64> {
        let Some(y) = &self.y else { return Vec::new() };
        y.iter()
            .zip(self.product(parameters))
            .map(|(y, product)| y - product)
            .collect()
    }

    /// Adds a signal to the column of parameter `column`.
    fn add(&mut self, column: usize, signal: &[f64]) {
        let Ok(k) = self.columns.binary_search(&column) else {
            return;
        };
        let rows = self.rows;
        for (sum, value) in self.w[k * rows..(k + 1) * rows].iter_mut().zip(signal) {
            *sum += value;
        }
    }

    fn append(&mut self, more: &Equations) {
        let columns = 0..self.columns.len();
        let w = columns
            .flat_map(|k| self.column(k).iter().chain(more.column(k)))
            .copied();
        self.w = w.collect();
        self.rows += more.rows;
        self.y = match (self.y.take(), &more.y) {
            (Some(y), Some(more)) => Some(y.into_iter().chain(more.iter().copied()).collect()),
            _ => None,
        };
    }
}

/// The decimated rows, of those at the samples `kept`, that become equations: far from the edges
/// and from samples that cannot be believed.
pub(super) fn rows_believed(
    motion: &Motion,
    filtering: &Filtering,
    kept: &[usize],
) -> Result<Vec<usize>, ObserveError> {
    let within = rows_kept(&motion.log, kept.len(), filtering.cut_after())?;
    let doubtful = touched(&motion.doubtful, filtering, motion.rate_hz);
    let believed = |row: &usize| doubtful.iter().all(|range| !range.contains(&kept[*row]));
    let rows: Vec<usize> = within.filter(believed).collect();
    match rows.is_empty() {
        true => Err(ObserveError::NothingBelieved {
            log: motion.log.clone(),
        }),
        false => Ok(rows),
    }
}

pub(super) fn pick<T: Copy>(signal: &[T], keep: &[usize]) -> Vec<T> {
    keep.iter().map(|&row| signal[row]).collect()
}

/// The samples that `doubtful` ones reach through the filters; short bridges leave no trace.
pub(super) fn touched(
    doubtful: &[Range<usize>],
    filtering: &Filtering,
    rate_hz: f64,
) -> Vec<Range<usize>> {
    let (reach, short) = (filtering.reach(rate_hz), filtering.bridgeable(rate_hz));
    let long = doubtful.iter().filter(|range| range.len() > short);
    long.map(|range| range.start.saturating_sub(reach)..range.end.saturating_add(reach))
        .collect()
}

/// The decimated rows that remain after cutting `cut` at either end.
pub(super) fn rows_kept(
    log: &str,
    rows: usize,
    cut: usize,
) -> Result<std::ops::Range<usize>, ObserveError> {
    match cut.saturating_mul(2) {
        both if both < rows => Ok(cut..rows - cut),
        both => Err(ObserveError::NothingLeft {
            log: log.to_owned(),
            cut: both,
            has: rows,
            unit: "decimated rows",
        }),
    }
}

/// Blocks of zeros with the columns that each joint can see in any term of the model.
pub(super) fn empty_blocks(
    model: &dyn IdentificationModel,
    kind: ModelKind,
    rows: usize,
) -> Vec<Equations> {
    let count = if kind == ModelKind::Power {
        1
    } else {
        model.joints().len()
    };
    let seen = |row: usize| {
        let terms = kind.terms().iter().map(|term| model.pattern(term.0));
        let entries = terms.flat_map(|pattern| pattern.entries.iter());
        let mut columns: Vec<usize> = entries
            .filter(|entry| entry.row == row)
            .map(|entry| entry.column)
            .collect();
        columns.sort_unstable();
        columns.dedup();
        columns
    };
    (0..count)
        .map(|row| {
            let columns = seen(row);
            Equations {
                rows,
                w: vec![0.0; rows * columns.len()],
                y: None,
                columns,
            }
        })
        .collect()
}

/// Low-passed, decimated measurements: the torque of each joint, or the motors' power.
fn measurements(
    kind: ModelKind,
    motion: &Motion,
    decimator: &Decimator,
    kept: &[usize],
) -> Result<Option<Vec<Vec<f64>>>, SignalError> {
    let Some(tau) = &motion.tau else {
        return Ok(None);
    };
    let power: Vec<Vec<f64>>;
    let measured = match kind {
        ModelKind::Power => {
            power = vec![
                (0..motion.len)
                    .map(|i| motor_power(tau, &motion.qd, i))
                    .collect(),
            ];
            &power
        }
        ModelKind::Explicit | ModelKind::Implicit => tau,
    };
    decimator.values(measured.as_slice(), kept).map(Some)
}

/// Power of all motors at sample `i`, W.
pub(super) fn motor_power(tau: &[Vec<f64>], qd: &[Vec<f64>], i: usize) -> f64 {
    tau.iter().zip(qd).map(|(tau, qd)| tau[i] * qd[i]).sum()
}
