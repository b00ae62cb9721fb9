//! Logs too long for memory: parsed once, kept on disk as numbers, given out window by window.
//!
//! [`read_long`] follows the path of [`read`](super::read()): columns and units -> rows of the part,
//! into a [`Spool`] -> uniform time grid -> joint side of the drives and doubtful samples, segment by
//! segment -> checks. Everything is done to each row as it is done in memory; what is judged by a
//! signal's usual size is judged within segments of half a minute and more.

mod place;
mod segments;
mod spool;
mod spooling;
#[cfg(test)]
mod tests;
mod window;

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::ops::Range;

use super::columns::Layout;
use super::companion::Companion;
use super::error::{Found, LogError};
use super::grid::{Grid, Stamped};
use super::read::{self, Opened, ReadOptions};
use super::spec::LogSpec;
use crate::model::Joint;
use crate::settings::Drives;
use spool::Spool;

/// Text that holds more than this is read as a long log: its numbers, with what is computed from
/// them, would take several times as much memory. Bytes.
const LONG: u64 = 24 << 20;

/// Digits of measurements compress to no less than this fraction.
const GZIP: u64 = 4;

/// A log that stays on disk: parsed once, given out window by window.
///
/// A temporary file without a name holds its numbers (8 bytes each); it goes with this value, or
/// with the process.
#[derive(Debug)]
pub struct LongLog {
    /// How the user named it, such as `log.csv.gz@5..7.5`.
    pub name: String,
    /// File stem for outputs: `log` for `dir/log.csv.gz@5..7.5`.
    pub stem: String,
    /// Sampling rate of the uniform grid, Hz.
    pub rate_hz: f64,
    /// Time of the first sample of the grid, s.
    pub start: f64,
    /// Number of samples on the grid.
    pub len: usize,
    /// Rows of (this part of) the file.
    pub rows: usize,
    /// Smallest and largest position of each joint, rad or m.
    pub range: Vec<(f64, f64)>,
    /// Samples of the grid that cannot be believed, ascending and disjoint.
    pub doubtful: Vec<Range<usize>>,
    /// What was noticed while reading, each a full sentence that says where.
    pub warnings: Vec<String>,
    spool: Spool,
    grid: Grid,
    /// Columns of the spool.
    q: Range<usize>,
    qd: Option<Range<usize>>,
    tau: Option<Range<usize>>,
}

/// Whether a log is too long to be held in memory, by the size of its file; one that cannot be
/// opened is not.
pub fn is_long(spec: &LogSpec) -> bool {
    text_size(spec).is_some_and(|size| size > LONG)
}

/// An estimate of how much text the file holds, bytes.
fn text_size(spec: &LogSpec) -> Option<u64> {
    let mut file = File::open(&spec.path).ok()?;
    let size = file.metadata().ok().filter(|data| data.is_file())?.len();
    let mut magic = [0; 4];
    if file.read_exact(&mut magic).is_err() {
        return Some(size);
    }
    #[cfg(feature = "parquet")]
    if magic == *b"PAR1" {
        return super::parquet::text_size(file);
    }
    if !magic.starts_with(&[0x1f, 0x8b]) {
        return Some(size);
    }
    // The last four bytes say how much the last member holds, modulo 2^32.
    let mut last = [0; 4];
    file.seek(SeekFrom::End(-4)).ok()?;
    file.read_exact(&mut last).ok()?;
    Some(u64::from(u32::from_le_bytes(last)).max(GZIP * size))
}

/// Reads a log, or a part of it, as [`read`](super::read()) does, but keeps its samples on disk.
///
/// A `q1_ref..` in the log is not kept.
///
/// # Errors
/// Those of [`read`](super::read()), and [`Problem::Spool`](super::Problem::Spool) if the numbers do
/// not fit into the directory for temporary files.
pub fn read_long(
    spec: &LogSpec,
    joints: &[Joint],
    drives: &Drives,
    options: &ReadOptions,
) -> Result<(LongLog, Companion), LogError> {
    let opened = read::open(spec, joints, drives, options)?;
    let robot = Robot { joints, drives };
    load(spec, robot, options, opened).map_err(|problem| LogError::Log {
        file: spec.path.display().to_string(),
        problem,
    })
}

/// What is known of the robot.
#[derive(Clone, Copy)]
struct Robot<'a> {
    joints: &'a [Joint],
    drives: &'a Drives,
}

fn load(
    spec: &LogSpec,
    robot: Robot<'_>,
    options: &ReadOptions,
    opened: Opened,
) -> Found<(LongLog, Companion)> {
    let Opened {
        source,
        companion,
        mut layout,
        mut warnings,
    } = opened;
    without_reference(&mut layout, &companion, &mut warnings);
    let rows = spooling::rows(source, &layout, spec.part, &mut warnings)?;
    rows.check_stamps(&layout)?;
    let stamped = Stamped {
        stamps: &rows.spool,
        first_row: rows.first_row,
        differ: &|_| rows.repeats_that_differ,
    };
    let grid = Grid::of(&stamped, spec.part, companion.rate_hz, &mut warnings)?;
    rows.check_finite(&mut layout, options, &mut warnings)?;
    let resolution = companion.encoder_resolution;
    let settled = segments::settle(&rows, &layout, robot, resolution, &mut warnings)?;
    let doubtful = grid.samples(
        |row| rows.spool.read(0, row..row + 1).ok()?.first().copied(),
        &settled.doubtful,
    );
    let log = LongLog {
        name: spec.name.clone(),
        stem: spec.stem(),
        rate_hz: grid.rate_hz,
        start: grid.start,
        len: grid.len,
        rows: rows.spool.rows,
        range: settled.range,
        doubtful,
        warnings,
        grid,
        q: layout.q.channels,
        qd: layout.qd.map(|group| group.channels),
        tau: layout.tau.map(|group| group.channels),
        spool: rows.spool,
    };
    Ok((log, companion))
}

/// Leaves the commanded positions out.
fn without_reference(layout: &mut Layout, companion: &Companion, warnings: &mut Vec<String>) {
    let Some(q_ref) = layout.q_ref.take() else {
        return;
    };
    layout.channels.drain(q_ref.channels);
    if companion.reference.is_none() {
        warnings.push(
            "The commanded positions are not kept, the log is too long; read a part of it to \
             follow them: LOG@FROM..TO."
                .into(),
        );
    }
}
