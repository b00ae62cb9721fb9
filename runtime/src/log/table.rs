//! The rows of (a part of) a log, column by column: only the columns in use are parsed.

use std::io::BufRead;

use csv::ByteRecord;

use super::columns::Layout;
use super::error::{Found, Problem};
use super::lookup::Channel;
use super::source::Source;
use super::spec::{FIRST_ROW, Part};

/// Fewer rows than this hold no motion that could be filtered.
const FEWEST_ROWS: usize = 10;

/// The rows of a part; they are consecutive in the file.
#[derive(Debug, Default)]
pub(super) struct Table {
    /// Data row of the first value, counted from [`FIRST_ROW`].
    pub first_row: usize,
    /// One column per channel of the layout, in its units after the channel's factor.
    pub columns: Vec<Vec<f64>>,
}

impl Table {
    /// The time stamps, s.
    pub fn stamps(&self) -> &[f64] {
        self.columns.first().map_or(&[], Vec::as_slice)
    }

    /// Where sample `k` of the part stands: data row and stamp, for messages.
    pub fn at(&self, k: usize) -> String {
        let time = self.stamps().get(k).copied().unwrap_or(f64::NAN);
        format!("row {}, t = {time} s", self.first_row + k)
    }
}

/// A data row that is looked at.
#[derive(Clone, Copy)]
struct Place {
    row: usize,
    line: u64,
}

/// What the rows so far say about the rows to come.
#[derive(Default)]
struct Progress {
    /// Data rows seen.
    rows: usize,
    previous: Option<f64>,
    inside: bool,
    /// The last step back in time: where, from and to.
    step_back: Option<(Place, f64, f64)>,
    /// An incomplete row, fine if it is the last one.
    cut_off: Option<(Place, usize)>,
    extent: Option<(f64, f64)>,
}

/// Reads the rows of the part. Other rows only have their stamps looked at, and none at all when
/// the part is given by rows: so a damaged stretch can be cut away.
pub(super) fn read(
    mut source: Source,
    layout: &Layout,
    part: Part,
    warnings: &mut Vec<String>,
) -> Found<Table> {
    let columns = vec![Vec::new(); layout.channels.len()];
    let first_row = FIRST_ROW;
    let mut table = Table { first_row, columns };
    let mut progress = Progress::default();
    let mut record = ByteRecord::new();
    while next(&mut source.rows, &mut record, progress.rows)? {
        if is_blank(&record) {
            continue;
        }
        let row = FIRST_ROW + progress.rows;
        progress.rows += 1;
        if part.ends_before(row) {
            break;
        }
        if matches!(part, Part::Rows { .. }) && !part.contains(row, 0.0) {
            continue;
        }
        let line = record.position().map_or(0, csv::Position::line) + source.header_lines;
        let place = Place { row, line };
        if progress.complete(place, &record, source.header.len())? {
            let row = Row {
                record: &record,
                place,
                separator: source.separator,
            };
            row.take(&mut table, &mut progress, layout, part)?;
        }
    }
    progress.finish(&table, part, warnings)?;
    Ok(table)
}

fn next(
    rows: &mut csv::Reader<Box<dyn BufRead>>,
    record: &mut ByteRecord,
    rows_before: usize,
) -> Found<bool> {
    rows.read_byte_record(record)
        .map_err(|error| Problem::Damaged {
            rows: rows_before,
            reason: match error.into_kind() {
                csv::ErrorKind::Io(error) => format!("{error} (is the file truncated?)"),
                other => format!("{other:?}"),
            },
        })
}

/// One complete row.
struct Row<'a> {
    record: &'a ByteRecord,
    place: Place,
    separator: u8,
}

impl Row<'_> {
    /// Stamp, order and part of the row; its values if it belongs to the part.
    fn take(
        &self,
        table: &mut Table,
        progress: &mut Progress,
        layout: &Layout,
        part: Part,
    ) -> Found<()> {
        let Some(time) = layout.channels.first() else {
            return Ok(());
        };
        let time = self.value(time)?;
        if !progress.enters(self.place, time, part, table)? {
            return Ok(());
        }
        for (i, (channel, column)) in layout.channels.iter().zip(&mut table.columns).enumerate() {
            column.push(if i == 0 { time } else { self.value(channel)? });
        }
        Ok(())
    }

    fn value(&self, channel: &Channel) -> Found<f64> {
        let field = self.record.get(channel.index).unwrap_or_default();
        let value = number(field, self.separator).ok_or_else(|| Problem::BadNumber {
            row: self.place.row,
            line: self.place.line,
            column: channel.name.clone(),
            text: String::from_utf8_lossy(field).chars().take(40).collect(),
        })?;
        Ok(value * channel.factor)
    }
}

impl Progress {
    /// Whether the row has as many fields as the header; one that has fewer may end the file.
    fn complete(&mut self, place: Place, record: &ByteRecord, expected: usize) -> Found<bool> {
        let error = |Place { row, line }, found| Problem::FieldCount {
            row,
            line,
            found,
            expected,
        };
        if let Some((place, found)) = self.cut_off {
            return Err(error(place, found));
        }
        let found = record.len();
        if found > expected && !record.iter().skip(expected).all(<[u8]>::is_empty) {
            return Err(error(place, found));
        }
        if found < expected {
            self.cut_off = Some((place, found));
        }
        Ok(found >= expected)
    }

    /// Whether the row belongs to the part; within the part, time must not go back.
    fn enters(&mut self, place: Place, time: f64, part: Part, table: &mut Table) -> Found<bool> {
        if let Some(before) = self.previous.filter(|&before| time < before) {
            self.step_back = Some((place, before, time));
        }
        let was_inside = self.inside;
        self.inside = part.contains(place.row, time) || (time.is_nan() && was_inside);
        let begun = !table.stamps().is_empty();
        if self.inside && begun {
            // A second entrance means that time went back on the way, too.
            if let Some((at, before, time)) = self.step_back
                && (!was_inside || at.row == place.row)
            {
                return Err(Problem::DecreasingTime {
                    row: at.row,
                    line: at.line,
                    before,
                    time,
                });
            }
        }
        if self.inside && !begun {
            table.first_row = place.row;
        }
        if time.is_finite() {
            self.previous = Some(time);
            let (low, high) = self.extent.unwrap_or((time, time));
            self.extent = Some((low.min(time), high.max(time)));
        }
        Ok(self.inside)
    }

    fn finish(&self, table: &Table, part: Part, warnings: &mut Vec<String>) -> Found<()> {
        if let Some((Place { row, line }, found)) = self.cut_off {
            warnings.push(format!(
                "Row {row} (line {line}), the last one, holds only {found} fields; it is left out."
            ));
        }
        if let Some((Place { row, line }, before, time)) = self.step_back {
            warnings.push(format!(
                "Outside this part, time goes back from {before} s to {time} s at row {row} \
                 (line {line})."
            ));
        }
        let rows = table.stamps().len();
        if rows >= FEWEST_ROWS {
            return Ok(());
        }
        let times = self.extent.map_or_else(String::new, |(low, high)| {
            format!(", t from {low} to {high} s")
        });
        let extent = match part {
            Part::Whole => format!("the log has {} rows{times}", self.rows),
            _ => format!("of the part {part}, {} rows were read{times}", self.rows),
        };
        Err(Problem::TooFewRows {
            rows,
            needed: FEWEST_ROWS,
            extent,
        })
    }
}

fn is_blank(record: &ByteRecord) -> bool {
    record.get(0).is_none_or(blank) && record.iter().all(blank)
}

fn blank(field: &[u8]) -> bool {
    field.trim_ascii().is_empty()
}

/// The number in a field; an empty field is NaN. A decimal comma is understood where the comma
/// does not separate fields.
fn number(field: &[u8], separator: u8) -> Option<f64> {
    let text = std::str::from_utf8(field).ok()?;
    if let Ok(value) = text.parse() {
        return Some(value);
    }
    let text = text.trim();
    if text.is_empty() {
        return Some(f64::NAN);
    }
    let plain = text.parse().ok();
    if separator == b',' {
        plain
    } else {
        plain.or_else(|| text.replace(',', ".").parse().ok())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn number_in_any_spelling_of_a_logger_is_read() {
        assert_eq!(number(b"-1.5e-3", b','), Some(-1.5e-3));
        assert_eq!(number(b"  2 ", b','), Some(2.0));
        assert_eq!(number(b"0,25", b';'), Some(0.25));
        assert_eq!(number(b"0,25", b','), None);
        assert!(number(b"", b',').is_some_and(f64::is_nan));
        assert!(number(b"NaN", b',').is_some_and(f64::is_nan));
        assert_eq!(number(b"\xff", b','), None);
        assert_eq!(number(b"1.2.3", b';'), None);
    }
}
