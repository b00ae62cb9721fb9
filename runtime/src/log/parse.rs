//! A stretch of lines to columns of numbers: only the columns in use are read.
//!
//! A line whose fields are plain numbers is read in one pass over its bytes; any other line is
//! split into fields first. Nothing here knows the lines before or after the stretch, so that
//! stretches can be parsed in parallel: what may be wrong with a row is noted, and judged where
//! the rows are put together.

use std::ops::Range;

use super::columns::Layout;
use super::number;

/// How lines are to be read.
#[derive(Debug)]
pub(super) struct Parser {
    separator: u8,
    /// Fields of the header.
    fields: usize,
    /// Per field up to the last one in use: the channels that it feeds, with their factors.
    takers: Vec<Vec<(usize, f64)>>,
    channels: usize,
}

/// What is odd about a row.
#[derive(Debug, PartialEq)]
pub(super) enum Oddity {
    /// Too many or too few fields.
    Fields(usize),
    /// A field in use that is no number: its channel and its bytes in the stretch.
    NoNumber(usize, Range<usize>),
}

/// The rows of a stretch.
#[derive(Debug, Default)]
pub(super) struct Parsed {
    /// Column after column, each of `stride` values of which `rows` are in use.
    values: Vec<f64>,
    stride: usize,
    /// Data rows.
    pub rows: usize,
    /// Lines.
    pub lines: u64,
    /// Rows in front of which a line without data stands; ascending.
    blank: Vec<usize>,
    /// Odd rows; ascending.
    pub odd: Vec<(usize, Oddity)>,
}

impl Parsed {
    /// Rows that were never text: columns of equal length.
    #[cfg(feature = "parquet")]
    pub(super) fn of(columns: Vec<Vec<f64>>) -> Parsed {
        let rows = columns.iter().map(Vec::len).min().unwrap_or(0);
        let values = columns.iter().flat_map(|column| column.iter().take(rows));
        Parsed {
            values: values.copied().collect(),
            stride: rows,
            rows,
            lines: rows as u64,
            ..Parsed::default()
        }
    }

    /// The values of a channel, one per row.
    pub(super) fn column(&self, channel: usize) -> &[f64] {
        let start = channel * self.stride;
        let column = self.values.get(start..start + self.rows);
        column.unwrap_or_default()
    }

    /// The line of a row within the stretch, counted from 0.
    pub(super) fn line(&self, row: usize) -> u64 {
        (row + self.blank.partition_point(|&before| before <= row)) as u64
    }

    fn clear(&mut self, lines: usize, channels: usize) {
        self.stride = lines;
        // What an earlier stretch left behind is overwritten row by row.
        self.values.resize(lines * channels, f64::NAN);
        self.rows = 0;
        self.lines = lines as u64;
        self.blank.clear();
        self.odd.clear();
    }

    #[inline]
    fn set(&mut self, channel: usize, value: f64) {
        if let Some(place) = self.values.get_mut(channel * self.stride + self.rows) {
            *place = value;
        }
    }
}

impl Parser {
    pub(super) fn new(layout: &Layout, separator: u8, fields: usize) -> Parser {
        let last = layout.channels.iter().map(|channel| channel.index).max();
        let mut takers = vec![Vec::new(); last.map_or(0, |last| last + 1)];
        for (place, channel) in layout.channels.iter().enumerate() {
            if let Some(takers) = takers.get_mut(channel.index) {
                takers.push((place, channel.factor));
            }
        }
        Parser {
            separator,
            fields,
            takers,
            channels: layout.channels.len(),
        }
    }

    /// Reads the lines of `text` into `parsed`.
    pub(super) fn parse(&self, text: &[u8], parsed: &mut Parsed) {
        let ends = memchr::memchr_iter(b'\n', text).count();
        let unended = usize::from(!text.is_empty() && !text.ends_with(b"\n"));
        parsed.clear(ends + unended, self.channels);
        let mut at = 0;
        while let Some(line) = text.get(at..).filter(|line| !line.is_empty()) {
            let comment = matches!(line.first(), Some(b'#' | b'%'));
            if let Some(length) = self.plain(line, parsed).filter(|_| !comment) {
                parsed.rows += 1;
                at += length;
            } else {
                let length = memchr::memchr(b'\n', line).map_or(line.len(), |end| end + 1);
                self.any(line.get(..length).unwrap_or(line), at, parsed);
                at += length;
            }
        }
    }

    /// Reads a line of plain numbers, as many as the header has names; its length with the line
    /// feed. `None`: the line is to be looked at more closely.
    #[inline]
    fn plain(&self, line: &[u8], parsed: &mut Parsed) -> Option<usize> {
        let comma = self.separator != b',';
        let mut at = 0;
        let mut field = 0;
        for takers in &self.takers {
            field += 1;
            if takers.is_empty() {
                at += memchr::memchr3(self.separator, b'\n', b'"', line.get(at..)?)?;
            } else {
                at += spaces(line.get(at..)?);
                let (value, length) = number::leading(line.get(at..)?, comma)?;
                for &(channel, factor) in takers {
                    parsed.set(channel, value * factor);
                }
                at += length;
                at += spaces(line.get(at..)?);
            }
            if field < self.fields {
                if *line.get(at)? != self.separator {
                    return None;
                }
                at += 1;
            }
        }
        while field < self.fields {
            field += 1;
            at += memchr::memchr3(self.separator, b'\n', b'"', line.get(at..)?)?;
            if field < self.fields {
                if *line.get(at)? != self.separator {
                    return None;
                }
                at += 1;
            }
        }
        match line.get(at)? {
            b'\n' => Some(at + 1),
            b'\r' if line.get(at + 1) == Some(&b'\n') => Some(at + 2),
            _ => None,
        }
    }

    /// Reads a line of any kind, `start` bytes into the stretch.
    fn any(&self, line: &[u8], start: usize, parsed: &mut Parsed) {
        let content = line.trim_ascii();
        let fields: Vec<Range<usize>> = Fields::of(line, self.separator).collect();
        let text = |field: &Range<usize>| unquoted(line.get(field.clone()).unwrap_or_default());
        let is_blank = |field: &Range<usize>| text(field).0.is_empty();
        if matches!(content.first(), Some(b'#' | b'%')) || fields.iter().all(is_blank) {
            parsed.blank.push(parsed.rows);
            return;
        }
        let beyond = fields.get(self.fields..).unwrap_or_default();
        let fits = fields.len() >= self.fields && beyond.iter().all(is_blank);
        if !fits {
            parsed.odd.push((parsed.rows, Oddity::Fields(fields.len())));
        }
        for (takers, field) in self.takers.iter().zip(&fields) {
            let (number_text, quoted) = text(field);
            // Between quotes, a comma separates nothing.
            let value = number::field(number_text, quoted || self.separator != b',');
            for &(channel, factor) in takers {
                parsed.set(channel, value.unwrap_or(f64::NAN) * factor);
                if fits && value.is_none() {
                    let bytes = start + field.start..start + field.end;
                    let oddity = Oddity::NoNumber(channel, bytes);
                    parsed.odd.push((parsed.rows, oddity));
                }
            }
        }
        parsed.rows += 1;
    }
}

#[inline]
fn spaces(text: &[u8]) -> usize {
    text.iter().take_while(|&&byte| byte == b' ').count()
}

/// A field without blanks and quotes around it, and whether it had quotes.
pub(super) fn unquoted(field: &[u8]) -> (&[u8], bool) {
    let field = field.trim_ascii();
    let inner = field
        .strip_prefix(b"\"")
        .and_then(|f| f.strip_suffix(b"\""));
    inner.map_or((field, false), |inner| (inner.trim_ascii(), true))
}

/// The fields of a line, as ranges of its bytes; separators between quotes do not count.
pub(super) struct Fields<'a> {
    line: &'a [u8],
    separator: u8,
    next: Option<usize>,
}

impl<'a> Fields<'a> {
    pub(super) fn of(line: &'a [u8], separator: u8) -> Fields<'a> {
        let line = line.strip_suffix(b"\n").unwrap_or(line);
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        Fields {
            line,
            separator,
            next: Some(0),
        }
    }
}

impl Iterator for Fields<'_> {
    type Item = Range<usize>;

    fn next(&mut self) -> Option<Range<usize>> {
        let start = self.next?;
        let rest = self.line.get(start..)?;
        let mut quoted = false;
        let end = rest.iter().position(|&byte| {
            quoted ^= byte == b'"';
            byte == self.separator && !quoted
        });
        self.next = end.map(|end| start + end + 1);
        Some(start..end.map_or(self.line.len(), |end| start + end))
    }
}
