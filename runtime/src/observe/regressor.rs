//! A model's outputs along a motion: decimated, or multiplied by parameters at the full rate.

use std::ops::Range;

use rayon::prelude::*;

use super::{Motion, Treatment};
use crate::model::{IdentificationModel, Output, States};
use crate::signal::{BLOCK, Decimator, Planar, SignalError};

/// Kept samples of a long log come from windows of at least this length, so that memory does not
/// grow with the log times the number of signals.
const WINDOW: usize = 16_384;

/// The distinct signals of an output along a motion, low-passed in parallel, at the samples `kept`:
/// one series per signal.
///
/// A long log is worked off in windows that overlap by what the low-pass remembers; the result
/// is that of the whole log to rounding.
///
/// # Errors
/// [`SignalError::TooShort`].
pub fn decimated(
    model: &dyn IdentificationModel,
    (output, treatment): (Output, Treatment),
    motion: &Motion,
    decimator: &Decimator,
    kept: &[usize],
) -> Result<Vec<Vec<f64>>, SignalError> {
    let memory = decimator.memory();
    let mut rows = vec![Vec::with_capacity(kept.len()); model.pattern(output).signals];
    for part in windows(motion.len, WINDOW.max(8 * memory)) {
        let reach = part.start.saturating_sub(memory)..(part.end + memory).min(motion.len);
        let local: Vec<usize> = kept
            .iter()
            .filter(|i| part.contains(i))
            .map(|i| i - reach.start)
            .collect();
        let signals = evaluate(model, output, motion, reach);
        let window = match treatment {
            Treatment::Value => decimator.values(&signals, &local)?,
            Treatment::Rate => decimator.rates(&signals, &local)?,
        };
        for (row, part) in rows.iter_mut().zip(window) {
            row.extend(part);
        }
    }
    Ok(rows)
}

/// The product of an output with the np `parameters` along a motion: one series per joint.
pub(crate) fn contract(
    model: &dyn IdentificationModel,
    output: Output,
    motion: &Motion,
    parameters: &[f64],
) -> Vec<Vec<f64>> {
    let pattern = model.pattern(output);
    let rows = pattern.entries.iter().map(|e| e.row + 1).max().unwrap_or(0);
    let mut products = vec![Vec::with_capacity(motion.len); rows.max(model.joints().len())];
    for part in windows(motion.len, WINDOW) {
        let signals = evaluate(model, output, motion, part);
        for block in &signals.blocks {
            let length = block.len() / signals.count.max(1);
            for (row, product) in products.iter_mut().enumerate() {
                let start = product.len();
                product.resize(start + length, 0.0);
                for entry in pattern.entries.iter().filter(|e| e.row == row) {
                    let signal = &block[entry.signal * length..][..length];
                    for (sum, value) in product[start..].iter_mut().zip(signal) {
                        *sum += value * parameters[entry.column];
                    }
                }
            }
        }
    }
    products
        .iter_mut()
        .for_each(|product| product.resize(motion.len, 0.0));
    products
}

/// Consecutive ranges that cover `len` samples, each of at most about `size`.
fn windows(len: usize, size: usize) -> impl Iterator<Item = Range<usize>> {
    let parts = len.div_ceil(size).max(1);
    (0..parts).map(move |part| part * len / parts..(part + 1) * len / parts)
}

/// Evaluates the distinct signals of an output on the samples `range` of a motion.
fn evaluate(
    model: &dyn IdentificationModel,
    output: Output,
    motion: &Motion,
    range: Range<usize>,
) -> Planar {
    let count = model.pattern(output).signals;
    let starts: Vec<usize> = range.clone().step_by(BLOCK).collect();
    let blocks = starts
        .into_par_iter()
        .map(|start| {
            let block = start..(start + BLOCK).min(range.end);
            let states = |series: &[Vec<f64>]| -> Vec<f64> {
                series
                    .iter()
                    .flat_map(|joint| &joint[block.clone()])
                    .copied()
                    .collect()
            };
            let (q, qd, qdd) = (states(&motion.q), states(&motion.qd), states(&motion.qdd));
            let slip = states(&motion.slip);
            let len = block.len();
            let mut signals = vec![0.0; count * len];
            if count > 0 {
                let states = States {
                    len,
                    q: &q,
                    qd: &qd,
                    qdd: &qdd,
                    slip: &slip,
                };
                model.evaluate(output, &states, &mut signals);
            }
            signals
        })
        .collect();
    Planar {
        count,
        samples: range.len(),
        blocks,
    }
}
