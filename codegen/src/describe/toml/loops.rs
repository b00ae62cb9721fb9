//! `[[loop]]`: where branches of the tree meet.

use super::super::code;
use super::super::description::{LoopSpec, MdhRow, Motion};
use super::super::findings::{Findings, finding};
use super::rows::RowReader;
use super::table::{Table, Value};
use super::value;

/// Kinds of the joint that is cut.
const KINDS: [(&str, Motion); 2] = [("revolute", Motion::Revolute), ("fixed", Motion::Fixed)];

/// Reads `[[loop]]` behind the rows, and goes on after a bad one.
pub(super) fn read(
    table: &mut Table<'_>,
    rows: &[MdhRow],
    lengths: &[(String, f64)],
    to: &mut Findings,
) -> Vec<LoopSpec> {
    let values = table.get("loop");
    let values = values.and_then(|value| value::list(value, "`loop` (written [[loop]])", to));
    let values = values.unwrap_or_default().into_iter().enumerate();
    values
        .filter_map(|(index, value)| one(index, value, rows.len(), lengths, to))
        .collect()
}

fn one(
    index: usize,
    value: Value<'_>,
    rows: usize,
    lengths: &[(String, f64)],
    to: &mut Findings,
) -> Option<LoopSpec> {
    let mut table = Table::from_value(value, &format!("loop {}", index + 1), to)?;
    let name = table.get("name");
    let name = name.and_then(|value| value::text(value, &table.path("name"), to));
    let name = name.map_or_else(|| (index + 1).to_string(), str::to_owned);
    let motion = table.get("kind");
    let motion = motion.and_then(|value| value::word(value, &table.path("kind"), &KINDS, to));
    let flipped = table.get("flipped");
    let flipped = flipped.and_then(|value| value::flag(value, &table.path("flipped"), to));
    let mut frame = |key, motion| {
        let value = table.need(key, to)?;
        let what = format!("`{key}` of loop `{name}`");
        let mut reader = RowReader {
            table: Table::from_value(value, &what, to)?,
            lengths,
            // The angles of a loop are as exact as they are written.
            snaps: &mut vec![],
        };
        let frame = reader.frame(rows, motion, to);
        reader.table.finish(to);
        Some(frame)
    };
    let cut = frame("cut", motion.unwrap_or(Motion::Revolute));
    let meets = frame("meets", Motion::Fixed);
    let span = to.span(table.offset);
    table.finish(to);
    let (cut, meets) = (cut?, meets?);
    if cut.ant == meets.ant {
        let message = format!("both sides of loop `{name}` hang on row {}", cut.ant);
        let help = "a loop closes between two branches of the tree";
        to.error_at(span, finding(code::CLOSED_LOOP, message).help(help));
    }
    Some(LoopSpec {
        name,
        cut,
        meets,
        flipped: flipped.unwrap_or(false),
        span,
    })
}
