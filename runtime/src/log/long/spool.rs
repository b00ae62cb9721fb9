//! Columns of numbers in a temporary file that has no name and goes with the process.

use std::fs::File;
use std::io::{self, Write};
use std::ops::Range;

use super::super::error::{Found, Problem};
use super::super::stamps::{Ends, Stamps};
use super::place;

/// Rows per block of the file; within a block, column follows column.
const BLOCK: usize = 4096;

/// Columns on disk; the first one holds the stamps.
#[derive(Debug)]
pub(super) struct Spool {
    file: File,
    columns: usize,
    pub rows: usize,
    /// The first stamp of every block.
    index: Vec<f64>,
    ends: Ends,
}

impl Spool {
    /// The values of a column in these rows.
    pub fn read(&self, column: usize, rows: Range<usize>) -> Found<Vec<f64>> {
        self.read_into(column, rows, Vec::new())
    }

    /// The same in a series that is not needed any more: memory that is known already costs less.
    pub fn read_into(
        &self,
        column: usize,
        rows: Range<usize>,
        mut values: Vec<f64>,
    ) -> Found<Vec<f64>> {
        values.resize(rows.len(), 0.0);
        self.each_piece(column, rows, |at, piece| {
            let values = values.get_mut(piece).unwrap_or_default();
            place::read(&self.file, at, bytemuck::cast_slice_mut(values))
        })?;
        Ok(values)
    }

    /// Replaces the values of a column from a row on.
    pub fn write(&self, column: usize, row: usize, values: &[f64]) -> Found<()> {
        self.each_piece(column, row..row + values.len(), |at, piece| {
            let values = values.get(piece).unwrap_or_default();
            place::write(&self.file, at, bytemuck::cast_slice(values))
        })
    }

    /// Every stretch of the file that holds these rows of a column: its byte, and which of the rows.
    fn each_piece(
        &self,
        column: usize,
        rows: Range<usize>,
        mut with: impl FnMut(u64, Range<usize>) -> io::Result<()>,
    ) -> Found<()> {
        let mut row = rows.start;
        while row < rows.end {
            let (block, within) = (row / BLOCK, row % BLOCK);
            let len = (BLOCK - within).min(rows.end - row);
            let value = (block * self.columns + column) * BLOCK + within;
            let piece = row - rows.start..row - rows.start + len;
            with((value * size_of::<f64>()) as u64, piece).map_err(Problem::Spool)?;
            row += len;
        }
        Ok(())
    }

    /// How many rows are stamped before `time`, and how many at it at the latest.
    pub fn rows_until(&self, time: f64) -> Found<(usize, usize)> {
        let count = |first: usize, belongs: &dyn Fn(&f64) -> bool| {
            let Some(block) = first.checked_sub(1) else {
                return Ok(0);
            };
            let rows = block * BLOCK..((block + 1) * BLOCK).min(self.rows);
            let stamps = self.read(0, rows)?;
            Ok(block * BLOCK + stamps.partition_point(belongs))
        };
        let before = self.index.partition_point(|&stamp| stamp < time);
        let until = self.index.partition_point(|&stamp| stamp <= time);
        Ok((
            count(before, &|&stamp| stamp < time)?,
            count(until, &|&stamp| stamp <= time)?,
        ))
    }
}

impl Stamps for Spool {
    fn each(&self, see: &mut dyn FnMut(&[f64])) -> Found<()> {
        const PIECE: usize = 16 * BLOCK;
        let mut stamps = Vec::new();
        for start in (0..self.rows).step_by(PIECE) {
            stamps = self.read_into(0, start..(start + PIECE).min(self.rows), stamps)?;
            see(&stamps);
        }
        Ok(())
    }

    fn ends(&self) -> Ends {
        self.ends
    }
}

/// Fills a [`Spool`] from the first row to the last.
pub(super) struct Spooler {
    spool: Spool,
    block: Vec<f64>,
    filled: usize,
}

impl Spooler {
    /// An empty spool of so many columns.
    pub fn new(columns: usize) -> Found<Spooler> {
        let file = tempfile::tempfile().map_err(Problem::Spool)?;
        Ok(Spooler {
            spool: Spool {
                file,
                columns,
                rows: 0,
                index: Vec::new(),
                ends: Ends::default(),
            },
            block: vec![0.0; columns * BLOCK],
            filled: 0,
        })
    }

    /// Rows so far.
    pub fn rows(&self) -> usize {
        self.spool.rows
    }

    /// Takes rows; `column` gives their values, `rows.len()` of them, column by column.
    pub fn append<'a>(
        &mut self,
        rows: Range<usize>,
        column: impl Fn(usize) -> &'a [f64],
    ) -> Found<()> {
        let mut from = rows.start;
        while from < rows.end {
            let len = (BLOCK - self.filled).min(rows.end - from);
            for (k, block) in self.block.chunks_exact_mut(BLOCK).enumerate() {
                let values = column(k).get(from..from + len).unwrap_or_default();
                if let Some(place) = block.get_mut(self.filled..self.filled + values.len()) {
                    place.copy_from_slice(values);
                }
            }
            self.filled += len;
            self.spool.rows += len;
            from += len;
            if self.filled == BLOCK {
                self.flush()?;
            }
        }
        Ok(())
    }

    fn flush(&mut self) -> Found<()> {
        let (Some(&first), Some(&last)) = (
            self.block.first(),
            self.block.get(self.filled.saturating_sub(1)),
        ) else {
            return Ok(());
        };
        if self.spool.index.is_empty() {
            self.spool.ends.first = first;
        }
        self.spool.index.push(first);
        self.spool.ends.last = last;
        self.spool.ends.len += self.filled;
        self.filled = 0;
        let block = bytemuck::cast_slice(&self.block);
        self.spool.file.write_all(block).map_err(Problem::Spool)
    }

    /// The spool with all rows.
    pub fn finish(mut self) -> Found<Spool> {
        if self.filled > 0 {
            self.flush()?;
        }
        Ok(self.spool)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spool(rows: usize, step: usize) -> Spool {
        let columns: Vec<Vec<f64>> = (0..3)
            .map(|c| {
                (0..rows)
                    .map(|k| k as f64 * 0.5 + 1e6 * f64::from(c))
                    .collect()
            })
            .collect();
        let mut spooler = Spooler::new(3).unwrap();
        for from in (0..rows).step_by(step) {
            let range = from..(from + step).min(rows);
            spooler.append(range, |c| &columns[c]).unwrap();
        }
        spooler.finish().unwrap()
    }

    #[test]
    fn column_of_any_rows_is_what_was_put_in() {
        for (rows, step) in [(1, 1), (BLOCK, 100), (3 * BLOCK + 7, 5000)] {
            let spool = spool(rows, step);
            assert_eq!(
                spool.ends(),
                Ends {
                    first: 0.0,
                    last: 0.5 * (rows - 1) as f64,
                    len: rows
                }
            );
            for range in [0..rows, rows / 2..rows, rows - 1..rows, 0..0] {
                let expected: Vec<f64> = range.clone().map(|k| k as f64 * 0.5 + 2e6).collect();
                assert_eq!(spool.read(2, range).unwrap(), expected);
            }
        }
    }

    #[test]
    fn values_written_over_are_read_back_and_others_stay() {
        let spool = spool(2 * BLOCK, 999);
        spool.write(1, BLOCK - 2, &[-1.0, -2.0, -3.0]).unwrap();
        let found = spool.read(1, BLOCK - 3..BLOCK + 2).unwrap();
        let kept = |k: usize| k as f64 * 0.5 + 1e6;
        assert_eq!(found, [kept(BLOCK - 3), -1.0, -2.0, -3.0, kept(BLOCK + 1)]);
        assert_eq!(
            spool.read(2, BLOCK..BLOCK + 1).unwrap(),
            [kept(BLOCK) + 1e6]
        );
    }

    #[test]
    fn rows_until_a_time_are_counted_across_blocks() {
        let spool = spool(2 * BLOCK + 5, 4000);
        for k in [0, 1, BLOCK - 1, BLOCK, BLOCK + 1, 2 * BLOCK, 2 * BLOCK + 4] {
            assert_eq!(spool.rows_until(0.5 * k as f64).unwrap(), (k, k + 1));
            assert_eq!(
                spool.rows_until(0.5 * k as f64 + 0.1).unwrap(),
                (k + 1, k + 1)
            );
        }
        assert_eq!(spool.rows_until(-1.0).unwrap(), (0, 0));
    }
}
