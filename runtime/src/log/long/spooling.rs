//! The rows of the part, from text to the spool.

use std::ops::Range;

use super::super::columns::{Group, Layout};
use super::super::error::Found;
use super::super::parse::Parsed;
use super::super::read::{NotFinite, ReadOptions};
use super::super::source::Source;
use super::super::spec::Part;
use super::super::table::{self, Sink};
use super::spool::{Spool, Spooler};

/// The rows of the part as the file has them, one column per channel of the layout.
pub(super) struct Rows {
    pub spool: Spool,
    /// Data row of the first one.
    pub first_row: usize,
    /// Rows that carry the stamp of the row before, with other values.
    pub repeats_that_differ: usize,
    bad: Vec<NotFinite>,
}

/// Reads all rows of the part into a spool.
pub(super) fn rows(
    source: Source,
    layout: &Layout,
    part: Part,
    warnings: &mut Vec<String>,
) -> Found<Rows> {
    let channels = layout.channels.len();
    let mut sink = Spooling {
        spooler: Spooler::new(channels)?,
        bad: vec![NotFinite::default(); channels],
        last: vec![f64::NAN; channels],
        repeats_that_differ: 0,
    };
    let first_row = table::read_into(source, layout, part, &mut sink, warnings)?;
    let mut bad = sink.bad;
    bad.iter_mut().for_each(|bad| bad.begin_at(first_row));
    Ok(Rows {
        spool: sink.spooler.finish()?,
        first_row,
        repeats_that_differ: sink.repeats_that_differ,
        bad,
    })
}

struct Spooling {
    spooler: Spooler,
    bad: Vec<NotFinite>,
    /// The row before.
    last: Vec<f64>,
    repeats_that_differ: usize,
}

impl Sink for Spooling {
    fn append(&mut self, rows: &Parsed, range: Range<usize>) -> Found<()> {
        for (channel, bad) in self.bad.iter_mut().enumerate() {
            let values = rows.column(channel).get(range.clone()).unwrap_or_default();
            bad.count(self.spooler.rows(), values);
        }
        self.count_repeats(rows, range.clone());
        self.spooler.append(range, |channel| rows.column(channel))
    }
}

impl Spooling {
    fn count_repeats(&mut self, rows: &Parsed, range: Range<usize>) {
        let stamps = rows.column(0);
        for k in range.clone() {
            let before = if k == range.start {
                self.last.first()
            } else {
                stamps.get(k - 1)
            };
            if before != stamps.get(k) {
                continue;
            }
            let differs = (0..self.last.len()).any(|channel| {
                let column = rows.column(channel);
                let before = if k == range.start {
                    self.last.get(channel)
                } else {
                    column.get(k - 1)
                };
                before != column.get(k)
            });
            self.repeats_that_differ += usize::from(differs);
        }
        for (channel, last) in self.last.iter_mut().enumerate() {
            let values = rows.column(channel).get(range.clone()).unwrap_or_default();
            *last = values.last().copied().unwrap_or(*last);
        }
    }
}

impl Rows {
    /// Whether every stamp is a number.
    pub fn check_stamps(&self, layout: &Layout) -> Found<()> {
        self.check(layout, 0..1)
    }

    /// Whether motion and torque are numbers, up to a few; optional columns that are not are left
    /// out of the layout.
    pub fn check_finite(
        &self,
        layout: &mut Layout,
        options: &ReadOptions,
        warnings: &mut Vec<String>,
    ) -> Found<()> {
        self.check(layout, layout.q.channels.clone())?;
        if let (Some(tau), true) = (&layout.tau, options.require_torque) {
            self.check(layout, tau.channels.clone())?;
        }
        let (qd, tau) = (layout.qd.take(), layout.tau.take());
        let mut usable = |group: Option<Group>| {
            let group = group?;
            let finite = self.check(layout, group.channels.clone());
            let unused = |why| warnings.push(format!("These columns are not used: {why}."));
            finite.map_err(unused).ok()?;
            Some(group)
        };
        let (qd, tau) = (usable(qd), usable(tau));
        (layout.qd, layout.tau) = (qd, tau);
        Ok(())
    }

    fn check(&self, layout: &Layout, group: Range<usize>) -> Found<()> {
        for place in group {
            if let (Some(bad), Some(channel)) = (self.bad.get(place), layout.channels.get(place)) {
                bad.bearable(place, self.spool.rows, channel)?;
            }
        }
        Ok(())
    }
}
