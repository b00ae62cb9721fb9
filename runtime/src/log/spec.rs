//! Which log, and which part of it: `log.csv.gz@5..7.5`, `log.csv@#635..3510`.
//!
//! Pure text: no file is touched here.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// The first data row of a log (the line after the header) is row 0, in parts and in messages: a
/// part `@#a..b` holds the rows that the slice `[a:b]` holds in NumPy and pandas.
pub const FIRST_ROW: usize = 0;

/// How far a stamp may lie from a limit of a part and still count as equal to it, s: stamps that
/// went through a unit or a clock carry rounding errors.
const TIE: f64 = 1e-9;

/// Extensions that a log's stem and its companion's name do without, outermost first.
const EXTENSIONS: [&str; 6] = ["gz", "csv", "tsv", "txt", "parquet", "mcap"];

/// A part of a log: the first limit is included, the last one excluded; `None` is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// The whole log.
    Whole,
    /// `@5..7.5`: the rows with `from <= t < to`, s.
    Seconds {
        /// First time that belongs to the part, s.
        from: Option<f64>,
        /// First time that no longer belongs to it, s.
        to: Option<f64>,
    },
    /// `@#635..3510`: data rows, counted from [`FIRST_ROW`].
    Rows {
        /// First row that belongs to the part.
        from: Option<usize>,
        /// First row that no longer belongs to it.
        to: Option<usize>,
    },
}

impl Part {
    /// Whether the data row `row`, stamped `t` (s), belongs to the part.
    pub fn contains(&self, row: usize, t: f64) -> bool {
        match *self {
            Part::Whole => true,
            Part::Seconds { from, to } => {
                from.is_none_or(|from| t >= from - TIE) && to.is_none_or(|to| t < to - TIE)
            }
            Part::Rows { from, to } => {
                from.is_none_or(|from| row >= from) && to.is_none_or(|to| row < to)
            }
        }
    }

    /// Whether no row from `row` on can belong to the part, whatever its stamp.
    pub fn ends_before(&self, row: usize) -> bool {
        matches!(*self, Part::Rows { to: Some(to), .. } if row >= to)
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fn limits<T: fmt::Display>(
            f: &mut fmt::Formatter<'_>,
            from: Option<T>,
            to: Option<T>,
        ) -> fmt::Result {
            from.map_or(Ok(()), |from| write!(f, "{from}"))?;
            f.write_str("..")?;
            to.map_or(Ok(()), |to| write!(f, "{to}"))
        }
        match *self {
            Part::Whole => Ok(()),
            Part::Seconds { from, to } => {
                f.write_str("@")?;
                limits(f, from, to)
            }
            Part::Rows { from, to } => {
                f.write_str("@#")?;
                limits(f, from, to)
            }
        }
    }
}

/// A log as the user names it: a path and, after `@`, a part of it.
#[derive(Clone, Debug, PartialEq)]
pub struct LogSpec {
    /// The file.
    pub path: PathBuf,
    /// The part of it.
    pub part: Part,
    /// The text it was parsed from.
    pub name: String,
}

/// Why the text after `@` names no part of a log.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpecError {
    /// Nothing before the `@`.
    #[error("`{text}`: no file is named; write LOG, LOG@5..7.5 (seconds) or LOG@#635..3510 (rows)")]
    NoPath {
        /// What was given.
        text: String,
    },
    /// No `..`, or both ends open.
    #[error(
        "`{text}`: `{part}` names no part of a log; write @5..7.5 (seconds) or @#635..3510 (rows), \
         one of the two ends may be left open"
    )]
    NotAPart {
        /// What was given.
        text: String,
        /// What stands after the `@`.
        part: String,
    },
    /// A limit that is no number.
    #[error("`{text}`: `{limit}` is not {expected}")]
    BadLimit {
        /// What was given.
        text: String,
        /// The limit.
        limit: String,
        /// What it should be.
        expected: &'static str,
    },
    /// The part holds nothing: its end is not after its start.
    #[error("`{text}`: the part ends at {to}, which is not after its start {from}")]
    Backwards {
        /// What was given.
        text: String,
        /// First limit.
        from: String,
        /// Last limit.
        to: String,
    },
}

impl LogSpec {
    /// The file's name without directory and extensions: `log` for `dir/log.csv.gz@5..7.5`.
    pub fn stem(&self) -> String {
        stem(&self.path)
    }

    /// Where the log's companion lies if it has one: beside it, extensions replaced by `.toml`.
    pub fn companion_path(&self) -> PathBuf {
        self.path.with_file_name(format!("{}.toml", self.stem()))
    }
}

impl From<PathBuf> for LogSpec {
    fn from(path: PathBuf) -> Self {
        let name = path.display().to_string();
        LogSpec {
            path,
            part: Part::Whole,
            name,
        }
    }
}

impl FromStr for LogSpec {
    type Err = SpecError;

    /// Parses `PATH`, `PATH@from..to` (seconds) or `PATH@#from..to` (rows).
    ///
    /// An `@` inside the path is not taken for a part: what follows it then holds a path separator
    /// or ends like a file.
    ///
    /// # Errors
    /// [`SpecError`]: no path, no part after the `@`, a limit that is no number, a part that ends
    /// before it starts.
    fn from_str(text: &str) -> Result<Self, SpecError> {
        let (path, part) = match text.rsplit_once('@') {
            Some((path, part)) if !looks_like_path(part) => (path, parse_part(text, part)?),
            _ => (text, Part::Whole),
        };
        if path.is_empty() {
            return Err(SpecError::NoPath {
                text: text.to_owned(),
            });
        }
        Ok(LogSpec {
            path: PathBuf::from(path),
            part,
            name: text.to_owned(),
        })
    }
}

impl fmt::Display for LogSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}

fn stem(path: &Path) -> String {
    let mut name = path
        .file_name()
        .map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    for extension in EXTENSIONS {
        if let Some((rest, last)) = name.rsplit_once('.')
            && last.eq_ignore_ascii_case(extension)
            && !rest.is_empty()
        {
            name.truncate(rest.len());
        }
    }
    name
}

fn looks_like_path(text: &str) -> bool {
    let extension = text.rsplit_once('.').map_or("", |(_, extension)| extension);
    text.contains(['/', '\\']) || EXTENSIONS.iter().any(|e| extension.eq_ignore_ascii_case(e))
}

fn parse_part(text: &str, part: &str) -> Result<Part, SpecError> {
    let (rows, limits) = match part.strip_prefix('#') {
        Some(limits) => (true, limits),
        None => (false, part),
    };
    let (from, to) = match limits.split_once("..") {
        Some((from, to)) if !(from.is_empty() && to.is_empty()) => (from.trim(), to.trim()),
        _ => {
            return Err(SpecError::NotAPart {
                text: text.to_owned(),
                part: part.to_owned(),
            });
        }
    };
    let (part, backwards) = if rows {
        let (from, to) = (limit(text, from, row)?, limit(text, to, row)?);
        (
            Part::Rows { from, to },
            from.zip(to).is_some_and(|(from, to)| to <= from),
        )
    } else {
        let (from, to) = (limit(text, from, seconds)?, limit(text, to, seconds)?);
        (
            Part::Seconds { from, to },
            from.zip(to).is_some_and(|(from, to)| to <= from),
        )
    };
    if backwards {
        return Err(SpecError::Backwards {
            text: text.to_owned(),
            from: from.to_owned(),
            to: to.to_owned(),
        });
    }
    Ok(part)
}

/// A limit as `parse` reads it; an empty one is open.
fn limit<T>(
    text: &str,
    limit: &str,
    parse: fn(&str) -> Result<T, &'static str>,
) -> Result<Option<T>, SpecError> {
    if limit.is_empty() {
        return Ok(None);
    }
    parse(limit)
        .map(Some)
        .map_err(|expected| SpecError::BadLimit {
            text: text.to_owned(),
            limit: limit.to_owned(),
            expected,
        })
}

fn seconds(limit: &str) -> Result<f64, &'static str> {
    let value = limit.parse::<f64>().ok().filter(|value| value.is_finite());
    value.ok_or("a time in seconds, such as 7.5 (rows are written with #: @#635..3510)")
}

fn row(limit: &str) -> Result<usize, &'static str> {
    let value = limit.parse::<usize>().ok();
    value.ok_or("a row number (data rows are counted from 0)")
}
