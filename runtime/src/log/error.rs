//! What can be wrong with a log: what, where, and what to do.

use std::io;

use super::spec::SpecError;

/// Why a log could not be read, or written. Messages name the file.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// The name of the log is malformed.
    #[error(transparent)]
    Spec(#[from] SpecError),
    /// The log's content, or the file itself.
    #[error("{file}: {problem}")]
    Log {
        /// The log's path.
        file: String,
        /// What is wrong with it.
        problem: Problem,
    },
    /// The log's companion.
    #[error("{file}:{line}:{column}: {message}")]
    Companion {
        /// The companion's path.
        file: String,
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1, in characters.
        column: usize,
        /// What is wrong there, and what would be right.
        message: String,
    },
    /// The companion cannot be opened.
    #[error("{file}: the log companion cannot be read: {source}")]
    CompanionFile {
        /// The companion's path.
        file: String,
        /// Why.
        source: io::Error,
    },
    /// The companion does not fit the robot.
    #[error("{file}: {message}")]
    CompanionRobot {
        /// The companion's path.
        file: String,
        /// What does not fit.
        message: String,
    },
    /// A file cannot be written; nothing was left behind.
    #[error("{file}: cannot be written: {source}")]
    Write {
        /// The path that was to be written.
        file: String,
        /// Why.
        source: io::Error,
    },
    /// The series to be written do not belong together.
    #[error("{file}: column `{column}` has {found} rows, `{first}` has {expected}")]
    UnequalColumns {
        /// The path that was to be written.
        file: String,
        /// The column that differs.
        column: String,
        /// Its rows.
        found: usize,
        /// The first column.
        first: String,
        /// Its rows.
        expected: usize,
    },
}

/// What is wrong with a log. Rows are data rows, counted from 0; lines are lines of the file.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// The file does not exist or may not be read.
    #[error("cannot be opened: {0}")]
    Open(#[source] io::Error),
    /// A directory instead of a file.
    #[error("is a directory, not a log")]
    Directory,
    /// A format that this reader does not know.
    #[error("{0} is not read yet; convert it to CSV (or .csv.gz) with columns t, q1.., tau1..")]
    Format(&'static str),
    /// A format whose reader was not built in.
    #[error(
        "{format} needs a build with the feature `{feature}` (cargo install idim --features \
         {feature}); or convert it to CSV (or .csv.gz) with columns t, q1.., tau1.."
    )]
    NotBuiltIn {
        /// The format.
        format: &'static str,
        /// The cargo feature.
        feature: &'static str,
    },
    /// A column of something else than numbers.
    #[error("column `{column}` holds {holds}, not numbers")]
    NoNumbers {
        /// Its name.
        column: String,
        /// What it holds, as the format calls it.
        holds: String,
    },
    /// Reading failed on the way, as in a truncated gzip file.
    #[error("cannot be read beyond row {rows}: {reason}")]
    Damaged {
        /// Data rows read before.
        rows: usize,
        /// Why.
        reason: String,
    },
    /// A long log's numbers cannot be kept on disk.
    #[error(
        "its numbers cannot be kept in a temporary file: {0}; free space in the directory for \
         temporary files, or name another one (TMPDIR, on Windows TEMP)"
    )]
    Spool(#[source] io::Error),
    /// No content at all.
    #[error("is empty; expected a header line such as `t,q1,tau1` and one line per sample")]
    Empty,
    /// Not a text file.
    #[error("is not a text file ({0}); expected CSV, plain or gzip")]
    NotText(&'static str),
    /// The first line holds numbers.
    #[error(
        "the first line holds numbers, not column names (`{0}`); add a header such as `t,q1,tau1`"
    )]
    NoHeader(String),
    /// A column that must be there is not.
    #[error("no column for {what}: expected {expected}; found {found}{hint}")]
    MissingColumn {
        /// What it should hold.
        what: String,
        /// The names looked for.
        expected: String,
        /// The header.
        found: String,
        /// The nearest name, or nothing.
        hint: String,
    },
    /// A unit in the header that does not fit.
    #[error("column `{column}`: {message}; or state the unit under [columns] of the log companion")]
    HeaderUnit {
        /// Name in the header.
        column: String,
        /// What is wrong with the unit, and which would do.
        message: String,
    },
    /// A row with another number of fields than the header.
    #[error("row {row} (line {line}) has {found} fields, the header has {expected}")]
    FieldCount {
        /// Data row.
        row: usize,
        /// Line of the file.
        line: u64,
        /// Its fields.
        found: usize,
        /// The header's fields.
        expected: usize,
    },
    /// A field that is no number.
    #[error("row {row} (line {line}), column `{column}`: `{text}` is not a number")]
    BadNumber {
        /// Data row.
        row: usize,
        /// Line of the file.
        line: u64,
        /// Name in the header.
        column: String,
        /// The field.
        text: String,
    },
    /// Missing or infinite values where none may be.
    #[error(
        "column `{column}`: values missing, NaN or infinite: {count} (row {rows}); \
         cut them away with a part of the log, such as LOG@#FROM..TO"
    )]
    NotFinite {
        /// Name in the header.
        column: String,
        /// How many.
        count: usize,
        /// The first of them.
        rows: String,
    },
    /// Time goes backwards.
    #[error(
        "time goes back from {before} s to {time} s at row {row} (line {line}); use the rows \
         before or after it: LOG@#FROM..TO"
    )]
    DecreasingTime {
        /// Data row.
        row: usize,
        /// Line of the file.
        line: u64,
        /// The stamp before, s.
        before: f64,
        /// The stamp, s.
        time: f64,
    },
    /// Stamps too coarse to tell the rows apart.
    #[error(
        "{count} of {rows} rows carry the stamp of the row before (first: row {row}, t = {time} s); \
         the stamps are too coarse: give rate_hz in the log companion"
    )]
    RepeatedStamps {
        /// How many rows.
        count: usize,
        /// Of how many.
        rows: usize,
        /// The first, a data row.
        row: usize,
        /// Its stamp, s.
        time: f64,
    },
    /// The part of the log holds too little.
    #[error("{rows} rows are too few (at least {needed}); {extent}")]
    TooFewRows {
        /// Rows in the part.
        rows: usize,
        /// Rows that are needed.
        needed: usize,
        /// What the log holds.
        extent: String,
    },
    /// The grid would be far larger than the log.
    #[error(
        "at {rate_hz} Hz the log's {seconds} s make {samples:.0} samples for {rows} rows; \
         cut the log into parts around its gaps, or check the stamps' unit and rate_hz"
    )]
    TooLong {
        /// Rate of the grid, Hz.
        rate_hz: f64,
        /// Duration of the part, s.
        seconds: f64,
        /// Samples of the grid.
        samples: f64,
        /// Rows of the part.
        rows: usize,
    },
    /// Currents or voltages without gains.
    #[error(
        "torque is logged as `{column}`.., but the robot has no drive gains; \
         write [drives] gains = [...] (N.m per unit) in its description"
    )]
    NoGains {
        /// The first channel.
        column: String,
    },
    /// Gains or coupling that do not fit the robot.
    #[error("[drives] {what} has {found} entries, {joints} joints need {expected}")]
    DrivesShape {
        /// `gains` or `coupling`.
        what: &'static str,
        /// Entries given.
        found: usize,
        /// Entries needed.
        expected: usize,
        /// Joints of the robot.
        joints: usize,
    },
    /// A coupling matrix without an inverse.
    #[error("[drives] coupling is singular: motor positions do not determine the joints")]
    SingularCoupling,
}

/// The result of looking into a log; the file is named where the problem leaves this module.
pub(super) type Found<T> = Result<T, Problem>;
