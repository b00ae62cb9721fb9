//! Samples of a long log as a recording of their own.

use std::ops::Range;

use super::super::error::{Found, LogError};
use super::super::recording::Recording;
use super::super::resample;
use super::super::samples::{Samples, within};
use super::LongLog;

impl LongLog {
    /// Whether the log has torques.
    pub fn has_torque(&self) -> bool {
        self.tau.is_some()
    }

    /// Whether the log has measured velocities.
    pub fn has_velocity(&self) -> bool {
        self.qd.is_some()
    }

    /// The samples `range` of the grid, cut at its end, as a [`Recording`]: what the same samples
    /// are in the recording of the whole log.
    ///
    /// Its stamps are those of the rows from its first sample to the first sample behind it: the
    /// stamps of windows that follow each other are those of the log. It has no warnings; they are
    /// the log's. Several threads may ask at once.
    ///
    /// # Errors
    /// [`LogError::Log`] with [`Problem::Spool`](crate::log::Problem::Spool) if the temporary file
    /// cannot be read.
    pub fn window(&self, range: Range<usize>) -> Result<Recording, LogError> {
        let end = range.end.min(self.len);
        let range = range.start.min(end)..end;
        self.cut(range).map_err(|problem| LogError::Log {
            file: self.name.clone(),
            problem,
        })
    }

    fn cut(&self, range: Range<usize>) -> Found<Recording> {
        let rows = self.rows_under(&range)?;
        let group = |columns: &Range<usize>| self.group(columns.clone(), &rows, &range);
        Ok(Recording {
            name: self.name.clone(),
            stem: self.stem.clone(),
            rate_hz: self.rate_hz,
            start: self.time(range.start),
            len: range.len(),
            q: group(&self.q)?,
            qd: self.qd.as_ref().map(group).transpose()?,
            tau: self.tau.as_ref().map(group).transpose()?,
            doubtful: within(&self.doubtful, &range),
            stamps: self
                .spool
                .read(0, self.row_of(range.start)?..self.row_of(range.end)?)?,
            warnings: Vec::new(),
        })
    }

    fn time(&self, sample: usize) -> f64 {
        self.start + sample as f64 / self.rate_hz
    }

    /// The rows that the samples are made of.
    fn rows_under(&self, range: &Range<usize>) -> Found<Range<usize>> {
        if range.is_empty() {
            return Ok(0..0);
        }
        let last = range.end - 1;
        if !self.grid.interpolated {
            return Ok(self.grid.row(range.start)..self.grid.row(last) + 1);
        }
        let (_, until_first) = self.spool.rows_until(self.time(range.start))?;
        let (_, until_last) = self.spool.rows_until(self.time(last))?;
        let mut from = until_first.saturating_sub(1);
        while from > 0 && self.grid.dropped.binary_search(&from).is_ok() {
            from -= 1;
        }
        Ok(from..(until_last + 1).min(self.rows))
    }

    /// The first row that belongs to a sample and not to those before.
    fn row_of(&self, sample: usize) -> Found<usize> {
        match sample {
            0 => Ok(0),
            end if end >= self.len => Ok(self.rows),
            _ if !self.grid.interpolated => Ok(self.grid.row(sample)),
            _ => Ok(self.spool.rows_until(self.time(sample))?.0),
        }
    }

    /// Columns of the spool on the samples of the grid.
    fn group(
        &self,
        columns: Range<usize>,
        rows: &Range<usize>,
        range: &Range<usize>,
    ) -> Found<Vec<Vec<f64>>> {
        let kept = |column| {
            let values = self.spool.read(column, rows.clone())?;
            Ok(self.grid.keep(rows.start, values))
        };
        if !self.grid.interpolated {
            return columns.map(kept).collect();
        }
        let stamps = kept(0)?;
        let on_grid = |values: Vec<f64>| {
            resample::onto_grid(&stamps, &values, self.start, self.rate_hz, range.clone())
        };
        columns.map(|column| Ok(on_grid(kept(column)?))).collect()
    }
}

impl Samples for LongLog {
    fn name(&self) -> &str {
        &self.name
    }

    fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    fn len(&self) -> usize {
        self.len
    }

    fn doubtful(&self) -> &[Range<usize>] {
        &self.doubtful
    }

    fn ranges(&self) -> Option<&[(f64, f64)]> {
        Some(&self.range)
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn window(&self, range: Range<usize>) -> Result<Recording, LogError> {
        LongLog::window(self, range)
    }
}
