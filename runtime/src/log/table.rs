//! The rows of (a part of) a log, put together in the order of the file.
//!
//! Text is read, parsed and put together at the same time: while one batch of stretches is parsed
//! in parallel, the batch before it is put together and the next one is read.

use std::io::{self, BufRead};
use std::ops::Range;

use rayon::iter::{IndexedParallelIterator, IntoParallelRefMutIterator, ParallelIterator};

use super::columns::Layout;
use super::error::{Found, Problem};
use super::lines::{Lines, Stretch};
use super::parse::{Oddity, Parsed, Parser, unquoted};
use super::source::{Content, Source};
use super::spec::{FIRST_ROW, Part};

/// Fewer rows than this hold no motion that could be filtered.
const FEWEST_ROWS: usize = 10;

/// More stretches than this in flight would only cost memory.
const MOST_STRETCHES: usize = 96;

/// Where rows go to.
pub(super) trait Sink: Send {
    /// Takes rows that follow those before, all channels of the layout.
    fn append(&mut self, rows: &Parsed, range: Range<usize>) -> Found<()>;
}

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
}

/// A data row and its stamp, for messages.
pub(super) fn at(row: usize, time: f64) -> String {
    format!("row {row}, t = {time} s")
}

impl Sink for Table {
    fn append(&mut self, rows: &Parsed, range: Range<usize>) -> Found<()> {
        for (channel, column) in self.columns.iter_mut().enumerate() {
            column.extend_from_slice(rows.column(channel).get(range.clone()).unwrap_or_default());
        }
        Ok(())
    }
}

/// Reads the rows of the part into memory.
pub(super) fn read(
    source: Source,
    layout: &Layout,
    part: Part,
    warnings: &mut Vec<String>,
) -> Found<Table> {
    let mut table = Table {
        first_row: FIRST_ROW,
        columns: vec![Vec::new(); layout.channels.len()],
    };
    table.first_row = read_into(source, layout, part, &mut table, warnings)?;
    Ok(table)
}

/// Reads the rows of the part; the data row of the first one. What is wrong with other rows does
/// not count: so a damaged stretch can be cut away.
pub(super) fn read_into(
    source: Source,
    layout: &Layout,
    part: Part,
    sink: &mut dyn Sink,
    warnings: &mut Vec<String>,
) -> Found<usize> {
    let mut progress = Progress::new(&source, layout, part);
    match source.content {
        Content::Text(text) => {
            let parser = Parser::new(layout, text.separator, source.header.len());
            // On the threads that parse: another one would have to be woken for every batch.
            rayon::scope(|_| read_text(text.lines, &parser, &mut progress, sink))?;
        }
        #[cfg(feature = "parquet")]
        Content::Parquet(content) => content.read(layout, |rows| {
            progress.merge(&[], rows, sink)?;
            Ok(!progress.ended)
        })?,
    }
    progress.finish(warnings)?;
    Ok(progress.first_row)
}

fn read_text(
    text: Box<dyn BufRead + Send>,
    parser: &Parser,
    progress: &mut Progress,
    sink: &mut dyn Sink,
) -> Found<()> {
    let mut lines = Lines::new(text);
    let (mut done, mut parsing, mut reading) = (Batch::new(), Batch::new(), Batch::new());
    loop {
        let (merged, ()) = rayon::join(
            || {
                done.merge(progress, sink)?;
                reading.fill(&mut lines);
                Ok(())
            },
            || parsing.parse(parser),
        );
        merged?;
        if progress.ended || (parsing.is_empty() && reading.is_empty()) {
            return Ok(());
        }
        std::mem::swap(&mut done, &mut parsing);
        std::mem::swap(&mut parsing, &mut reading);
    }
}

/// Stretches that are read, parsed and put together at one go.
struct Batch {
    stretches: Vec<(Stretch, Parsed)>,
    used: usize,
    /// Why reading ended behind the last stretch.
    error: Option<io::Error>,
}

impl Batch {
    fn new() -> Batch {
        let stretches = (8 * rayon::current_num_threads()).min(MOST_STRETCHES);
        Batch {
            stretches: (0..stretches).map(|_| Default::default()).collect(),
            used: 0,
            error: None,
        }
    }

    fn is_empty(&self) -> bool {
        self.used == 0 && self.error.is_none()
    }

    fn fill(&mut self, lines: &mut Lines) {
        self.used = 0;
        for (stretch, _) in &mut self.stretches {
            self.error = lines.fill(stretch).err();
            if stretch.text().is_empty() {
                break;
            }
            self.used += 1;
            if self.error.is_some() {
                break;
            }
        }
    }

    fn parse(&mut self, parser: &Parser) {
        let used = self.stretches.get_mut(..self.used).unwrap_or_default();
        // One by one: threads that take several at a time wait for each other at the end.
        used.par_iter_mut()
            .with_max_len(1)
            .for_each(|(stretch, parsed)| parser.parse(stretch.text(), parsed));
    }

    fn merge(&mut self, progress: &mut Progress, sink: &mut dyn Sink) -> Found<()> {
        for (stretch, parsed) in self.stretches.iter().take(self.used) {
            if progress.ended {
                return Ok(());
            }
            progress.merge(stretch.text(), parsed, sink)?;
        }
        match self.error.take() {
            Some(error) if !progress.ended => Err(Problem::Damaged {
                rows: progress.rows,
                reason: format!("{error} (is the file truncated?)"),
            }),
            _ => Ok(()),
        }
    }
}

/// A data row that is looked at.
#[derive(Clone, Copy)]
struct Place {
    row: usize,
    line: u64,
}

/// What the rows so far say about the rows to come.
struct Progress {
    part: Part,
    /// The channels' names.
    names: Vec<String>,
    /// Fields of the header.
    expected: usize,
    /// Line of the file that comes next, counted from 1.
    line: u64,
    /// Data rows seen.
    rows: usize,
    /// Rows of the part, and the data row of the first.
    taken: usize,
    first_row: usize,
    previous: Option<f64>,
    inside: bool,
    /// No row to come can belong to the part.
    ended: bool,
    /// The last step back in time: where, from and to.
    step_back: Option<(Place, f64, f64)>,
    /// An incomplete row, fine if it is the last one.
    cut_off: Option<(Place, usize)>,
    extent: Option<(f64, f64)>,
}

impl Progress {
    fn new(source: &Source, layout: &Layout, part: Part) -> Progress {
        Progress {
            part,
            names: layout.channels.iter().map(|c| c.name.clone()).collect(),
            expected: source.header.len(),
            line: source.first_line,
            rows: 0,
            taken: 0,
            first_row: FIRST_ROW,
            previous: None,
            inside: false,
            ended: false,
            step_back: None,
            cut_off: None,
            extent: None,
        }
    }

    /// Goes through the rows of a stretch and hands those of the part on.
    fn merge(&mut self, text: &[u8], parsed: &Parsed, sink: &mut dyn Sink) -> Found<()> {
        if self.calm(parsed) {
            return self.pass(parsed, sink);
        }
        let mut odd = parsed.odd.as_slice();
        let mut run = 0..0;
        for (k, &time) in parsed.column(0).iter().enumerate() {
            let (here, later) = odd.split_at(odd.partition_point(|(row, _)| *row <= k));
            odd = later;
            let row = FIRST_ROW + self.rows;
            if self.part.ends_before(row) {
                self.ended = true;
                break;
            }
            self.rows += 1;
            if matches!(self.part, Part::Rows { .. }) && !self.part.contains(row, 0.0) {
                continue;
            }
            let line = self.line + parsed.line(k);
            let place = Place { row, line };
            if !self.complete(place, here)? {
                continue;
            }
            self.check_numbers(place, here, text, 0..1)?;
            if !self.enters(place, time)? {
                continue;
            }
            self.check_numbers(place, here, text, 1..usize::MAX)?;
            if run.end != k {
                sink.append(parsed, run)?;
                run = k..k;
            }
            run.end = k + 1;
        }
        self.line += parsed.lines;
        sink.append(parsed, run)
    }

    /// Whether no row needs a closer look: the whole log is wanted, and time goes forward.
    fn calm(&self, parsed: &Parsed) -> bool {
        let times = parsed.column(0);
        let begins = times.first().is_some_and(|&first| {
            first.is_finite() && self.previous.is_none_or(|previous| previous <= first)
        });
        let forward = || times.windows(2).all(|pair| pair[0] <= pair[1]);
        let ends = times.last().is_some_and(|last| last.is_finite());
        let alike = parsed.odd.is_empty() && self.cut_off.is_none() && self.step_back.is_none();
        self.part == Part::Whole && alike && begins && ends && forward()
    }

    /// Hands all rows on.
    fn pass(&mut self, parsed: &Parsed, sink: &mut dyn Sink) -> Found<()> {
        let times = parsed.column(0);
        if let (Some(&first), Some(&last)) = (times.first(), times.last()) {
            let (low, high) = self.extent.unwrap_or((first, last));
            self.extent = Some((low.min(first), high.max(last)));
            self.previous = Some(last);
        }
        self.inside = true;
        self.rows += times.len();
        self.taken += times.len();
        self.line += parsed.lines;
        sink.append(parsed, 0..times.len())
    }

    /// Whether the row has as many fields as the header; one that has fewer may end the file.
    fn complete(&mut self, place: Place, odd: &[(usize, Oddity)]) -> Found<bool> {
        let expected = self.expected;
        let error = |Place { row, line }, found| Problem::FieldCount {
            row,
            line,
            found,
            expected,
        };
        if let Some((place, found)) = self.cut_off {
            return Err(error(place, found));
        }
        match odd.first() {
            Some(&(_, Oddity::Fields(found))) if found > expected => Err(error(place, found)),
            Some(&(_, Oddity::Fields(found))) => {
                self.cut_off = Some((place, found));
                Ok(false)
            }
            _ => Ok(true),
        }
    }

    /// Whether the fields of these channels are numbers.
    fn check_numbers(
        &self,
        Place { row, line }: Place,
        odd: &[(usize, Oddity)],
        text: &[u8],
        channels: Range<usize>,
    ) -> Found<()> {
        for (_, oddity) in odd {
            if let Oddity::NoNumber(channel, bytes) = oddity
                && channels.contains(channel)
            {
                let (field, _) = unquoted(text.get(bytes.clone()).unwrap_or_default());
                let column = self.names.get(*channel).cloned();
                return Err(Problem::BadNumber {
                    row,
                    line,
                    column: column.unwrap_or_default(),
                    text: String::from_utf8_lossy(field).chars().take(40).collect(),
                });
            }
        }
        Ok(())
    }

    /// Whether the row belongs to the part; within the part, time must not go back.
    fn enters(&mut self, place: Place, time: f64) -> Found<bool> {
        if let Some(before) = self.previous.filter(|&before| time < before) {
            self.step_back = Some((place, before, time));
        }
        let was_inside = self.inside;
        self.inside = self.part.contains(place.row, time) || (time.is_nan() && was_inside);
        if self.inside && self.taken > 0 {
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
        if self.inside {
            if self.taken == 0 {
                self.first_row = place.row;
            }
            self.taken += 1;
        }
        if time.is_finite() {
            self.previous = Some(time);
            let (low, high) = self.extent.unwrap_or((time, time));
            self.extent = Some((low.min(time), high.max(time)));
        }
        Ok(self.inside)
    }

    fn finish(&self, warnings: &mut Vec<String>) -> Found<()> {
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
        if self.taken >= FEWEST_ROWS {
            return Ok(());
        }
        let times = self.extent.map_or_else(String::new, |(low, high)| {
            format!(", t from {low} to {high} s")
        });
        let extent = match self.part {
            Part::Whole => format!("the log has {} rows{times}", self.rows),
            part => format!("of the part {part}, {} rows were read{times}", self.rows),
        };
        Err(Problem::TooFewRows {
            rows: self.taken,
            needed: FEWEST_ROWS,
            extent,
        })
    }
}
