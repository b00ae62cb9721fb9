//! Decimation of signals that come chunk by chunk, in a memory that does not grow with the log.
//!
//! The rows of a chunk are one block. What the samples up to each row and those after it inside the
//! block say is summed up at once; what the blocks behind it say reaches all of its rows through one
//! state per signal, so that a row that waits costs one number.

use std::collections::VecDeque;
use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};

use super::modal::Modes;
use super::planar::side_by_side;
use super::sums::{PARTS, Sums, Table, plus, rotated, weighted};

/// The zero-phase low-pass of [`super::Decimator`] and its decimation, over many signals whose
/// samples come chunk by chunk: signals in, rows of kept samples out as soon as the samples after
/// them are known. Rows near where it began, or near where it ended, lack the samples beyond: they
/// are for [`super::Decimator`], which knows edges.
#[derive(Clone, Debug)]
pub struct Running {
    ratio: usize,
    signals: usize,
    table: Table,
    /// Per group of signals: \\( \sum_{m \ge 0} p^m x_{n-m} \\) at the last row.
    past: Vec<f64>,
    /// Chunks on their way out.
    blocks: VecDeque<Block>,
    /// Rows of the first block that went out already.
    given: usize,
    scratch: Scratch,
}

/// The rows of a chunk, all signals side by side in groups.
#[derive(Clone, Debug, Default)]
struct Block {
    rows: usize,
    /// Per group and row: what the samples up to the end of the block give.
    values: Vec<f64>,
    /// Per group: \\( \sum_{m \ge 1} p^{m-1} x_{n+m} \\) over the samples of the block, at the last row
    /// before it.
    seen_before: Vec<f64>,
}

/// Room for one group of signals.
#[derive(Clone, Debug, Default)]
struct Scratch {
    /// Per sample.
    samples: Vec<f64>,
    /// Per row: the weighted sums of the samples since the row before.
    after: Vec<f64>,
}

impl Running {
    /// Decimation by `ratio` of `signals` signals. Without `modes` there is no low-pass.
    pub(super) fn new(modes: Option<&Modes>, ratio: usize, signals: usize) -> Self {
        let lanes = Arch::new().dispatch(Width);
        Running {
            ratio,
            signals,
            table: Table::new(modes, ratio),
            past: vec![0.0; signals.div_ceil(lanes) * PARTS * lanes],
            blocks: VecDeque::new(),
            given: 0,
            scratch: Scratch::default(),
        }
    }

    /// Takes the samples of the next `rows` rows: of each signal (planar) those after the last row
    /// so far up to the last of the new rows, `rows * ratio`. The row at which all begins never
    /// comes out.
    pub fn take(&mut self, chunk: &[f64], rows: usize) {
        if rows > 0 {
            self.table.reach(rows);
            Arch::new().dispatch(Take {
                running: self,
                chunk,
                rows,
            });
        }
    }

    /// Rows that are on their way and have at least `look_ahead` rows after them.
    pub fn ready(&self, look_ahead: usize) -> usize {
        let rows: usize = self.blocks.iter().map(|block| block.rows).sum();
        (rows - self.given).saturating_sub(look_ahead)
    }

    /// Takes out the first `rows` rows: signal by signal (planar), `rows` values each.
    pub fn give(&mut self, rows: usize, out: &mut Vec<f64>) {
        out.resize(rows * self.signals, 0.0);
        Arch::new().dispatch(Give {
            running: self,
            rows,
            out,
        });
        self.given += rows;
        while let Some(block) = self.blocks.front().filter(|block| block.rows <= self.given) {
            self.given -= block.rows;
            self.blocks.pop_front();
        }
    }
}

struct Width;

impl WithSimd for Width {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> usize {
        S::F64_LANES
    }
}

/// [`Running::take`] on the vectors of a machine.
struct Take<'a> {
    running: &'a mut Running,
    chunk: &'a [f64],
    rows: usize,
}

impl WithSimd for Take<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Take {
            running,
            chunk,
            rows,
        } = self;
        let length = rows * running.ratio;
        let groups = running.signals.div_ceil(S::F64_LANES);
        let mut block = Block {
            rows,
            values: vec![0.0; groups * rows * S::F64_LANES],
            seen_before: vec![0.0; groups * PARTS * S::F64_LANES],
        };
        let Scratch { samples, after } = &mut running.scratch;
        samples.resize(length * S::F64_LANES, 0.0);
        after.resize(rows * PARTS * S::F64_LANES, 0.0);
        let past = S::as_mut_simd_f64s(&mut running.past).0;
        let places = S::as_mut_simd_f64s(&mut block.values)
            .0
            .chunks_exact_mut(rows);
        let seen = S::as_mut_simd_f64s(&mut block.seen_before).0;
        let states = past
            .as_chunks_mut()
            .0
            .iter_mut()
            .zip(seen.as_chunks_mut().0);
        let signals = chunk.chunks(length * S::F64_LANES);
        for (signals, (values, (past, seen))) in signals.zip(places.zip(states)) {
            side_by_side::<S>(signals, length, samples);
            let samples = S::as_simd_f64s(samples).0.chunks_exact(running.ratio);
            let after = S::as_mut_simd_f64s(after).0.as_chunks_mut().0;
            forward(simd, &running.table, samples, past, values, after);
            *seen = backward(simd, &running.table, after, values);
        }
        running.blocks.push_back(block);
    }
}

/// Runs along the rows of a group of signals: what the samples up to each row give, and the sums
/// that the rows before will ask for.
#[inline(always)]
fn forward<'a, S: Simd>(
    simd: S,
    table: &Table,
    samples: impl Iterator<Item = &'a [S::f64s]>,
    past: &mut Sums<S>,
    values: &mut [S::f64s],
    after: &mut [Sums<S>],
) {
    for (x, (value, after)) in samples.zip(values.iter_mut().zip(after)) {
        let (before, later) = table.sums(simd, x);
        *past = plus(simd, &before, &rotated(simd, &table.aging, past));
        let direct = simd.mul_f64s(simd.splat_f64s(table.direct), x[x.len() - 1]);
        *value = simd.add_f64s(direct, weighted(simd, &table.weights, past));
        *after = later;
    }
}

/// Runs back along the rows: adds what the samples after each row give as far as the block reaches,
/// and returns their sums as the last row before the block sees them.
#[inline(always)]
fn backward<S: Simd>(simd: S, table: &Table, after: &[Sums<S>], values: &mut [S::f64s]) -> Sums<S> {
    let mut future = [simd.splat_f64s(0.0); PARTS];
    for (value, after) in values.iter_mut().zip(after).rev() {
        *value = simd.add_f64s(*value, weighted(simd, &table.echo[0], &future));
        future = plus(simd, after, &rotated(simd, &table.aging, &future));
    }
    future
}

/// [`Running::give`] on the vectors of a machine.
struct Give<'a> {
    running: &'a Running,
    rows: usize,
    out: &'a mut [f64],
}

impl WithSimd for Give<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let Running { blocks, given, .. } = self.running;
        let wanted = *given..*given + self.rows;
        let mut starts = Vec::with_capacity(blocks.len());
        let mut end = 0;
        for block in blocks {
            starts.push(end);
            end += block.rows;
        }
        // What the samples behind a block give, at its last row.
        let groups = self.running.signals.div_ceil(S::F64_LANES);
        let mut beyond = vec![[simd.splat_f64s(0.0); PARTS]; groups];
        for (block, start) in blocks.iter().zip(starts).rev() {
            let part = wanted.start.max(start)..wanted.end.min(start + block.rows);
            if !part.is_empty() {
                let within = part.start - start..part.end - start;
                self.hand_out(simd, block, &beyond, within, part.start - wanted.start);
            }
            let seen = S::as_simd_f64s(&block.seen_before).0.as_chunks().0;
            for (beyond, seen) in beyond.iter_mut().zip(seen) {
                let aged = rotated(simd, &self.running.table.ages[block.rows], beyond);
                *beyond = plus(simd, seen, &aged);
            }
        }
    }
}

impl Give<'_> {
    /// Writes the rows `within` a block as the rows from `first` on.
    #[inline(always)]
    fn hand_out<S: Simd>(
        &mut self,
        simd: S,
        block: &Block,
        beyond: &[Sums<S>],
        within: Range<usize>,
        first: usize,
    ) {
        let table = &self.running.table;
        let echo = table.echo[..block.rows].iter().rev();
        let echo = || echo.clone().skip(within.start);
        let values = S::as_simd_f64s(&block.values).0.chunks_exact(block.rows);
        let out = self.out.chunks_mut(self.rows * S::F64_LANES);
        let mut complete = vec![simd.splat_f64s(0.0); within.len()];
        for (out, (values, beyond)) in out.zip(values.zip(beyond)) {
            let rows = values[within.clone()].iter().zip(echo());
            for (place, (value, echo)) in complete.iter_mut().zip(rows) {
                *place = simd.add_f64s(*value, weighted(simd, echo, beyond));
            }
            let complete: &[f64] = bytemuck::cast_slice(&complete);
            for (lane, signal) in out.chunks_exact_mut(self.rows).enumerate() {
                let places = signal[first..].iter_mut();
                let values = complete[lane..].iter().step_by(S::F64_LANES);
                places
                    .zip(values)
                    .for_each(|(place, value)| *place = *value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Decimator;
    use crate::settings::Edges;

    const LEN: usize = 24_000;

    fn signals() -> Vec<Vec<f64>> {
        let wave = |s: usize, i: usize| {
            let noise = ((i * 7919 + s * 104_729) % 1009) as f64 / 1009.0;
            3.0 + (0.002 * (s + 1) as f64 * i as f64).sin() + 0.2 * noise
        };
        (0..3)
            .map(|s| (0..LEN).map(|i| wave(s, i)).collect())
            .collect()
    }

    /// All rows of a running decimation, fed in chunks of `rows` rows; the first row is lost.
    fn running(decimator: &Decimator, signals: &[Vec<f64>], rows: usize) -> Vec<Vec<f64>> {
        let (kept, ratio) = (decimator.kept(LEN), decimator.ratio());
        let mut running = decimator.running(signals.len());
        let mut all = vec![vec![f64::NAN]; signals.len()];
        let (mut at, mut out) = (0, Vec::new());
        let mut give = |running: &mut super::Running, rows: usize| {
            running.give(rows, &mut out);
            for (all, part) in all.iter_mut().zip(out.chunks(rows.max(1))) {
                all.extend(part);
            }
        };
        while kept[at] + rows * ratio < LEN {
            let samples = kept[at] + 1..kept[at] + rows * ratio + 1;
            let chunk: Vec<f64> = signals
                .iter()
                .flat_map(|s| s[samples.clone()].to_vec())
                .collect();
            running.take(&chunk, rows);
            at += rows;
            let ready = running.ready(decimator.look_ahead());
            give(&mut running, ready);
        }
        let rest = running.ready(0);
        give(&mut running, rest);
        all
    }

    #[test]
    fn running_decimation_is_that_of_the_whole_log_away_from_its_edges() {
        let signals = signals();
        for (ratio, edges, chunk) in [
            (10, Edges::Scipy, 40),
            (7, Edges::Matlab, 11),
            (1, Edges::Scipy, 300),
        ] {
            let decimator = Decimator::new(ratio, 1000.0, edges).unwrap();
            let kept = decimator.kept(LEN);
            let whole = decimator.values(signals.as_slice(), &kept).unwrap();
            let parts = running(&decimator, &signals, chunk);
            let far = decimator.look_ahead() + 1;
            for (whole, part) in whole.iter().zip(&parts) {
                assert!(part.len() > 2 * far + 100, "{} rows", part.len());
                for row in far..part.len() - far {
                    let error = (whole[row] - part[row]).abs() / 3.0;
                    assert!(error < 2e-13, "1 in {ratio}, row {row}: {error:e}");
                }
            }
        }
    }
}
