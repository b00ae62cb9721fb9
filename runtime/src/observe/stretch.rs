//! Rows of equations along a stretch of a log, handed on as soon as they are made: regressor,
//! decimation and what follows share the cache, and W is nowhere written.

use std::ops::Range;

use super::course::{Course, WINDOW};
use super::equations::equations_at;
use super::stream::{Sink, Stream, overlaps};
use super::{ModelKind, ObserveError};
use crate::model::IdentificationModel;
use crate::signal::REACH;

/// Samples that the regressor is evaluated on at once: its signals then stay in cache.
const CHUNK: usize = 384;

/// Rows that are handed on together, where the log is long enough.
const BATCH: usize = 64;

/// Hands the rows of some models on, in the order of time: the `believed` ones among `rows`.
///
/// # Errors
/// Those of [`Course::motion`].
pub(crate) fn stretch(
    course: &Course<'_>,
    model: &dyn IdentificationModel,
    kinds: &[ModelKind],
    rows: Range<usize>,
    believed: &[Range<usize>],
    sink: &mut Sink<'_>,
) -> Result<(), ObserveError> {
    // Inside, the row after the last row ahead is needed, and what derivatives look at.
    let margin = course.edge() + 2 + REACH.div_ceil(course.decimator.ratio());
    let inner = margin..course.rows().saturating_sub(margin);
    let part = |rows: Range<usize>, inside: bool, sink: &mut Sink<'_>| match rows.is_empty() {
        true => Ok(()),
        false if inside => inside_rows(course, model, kinds, rows, believed, sink),
        false => edge_rows(course, model, kinds, rows, believed, sink),
    };
    let (start, end) = (rows.start, rows.end);
    if inner.is_empty() {
        return part(rows, false, sink);
    }
    part(start..end.min(inner.start), false, sink)?;
    part(start.max(inner.start)..end.min(inner.end), true, sink)?;
    part(start.max(inner.end)..end, false, sink)
}

/// Rows that the edges of the log reach: as for a short log, from a motion with that edge.
fn edge_rows(
    course: &Course<'_>,
    model: &dyn IdentificationModel,
    kinds: &[ModelKind],
    rows: Range<usize>,
    believed: &[Range<usize>],
    sink: &mut Sink<'_>,
) -> Result<(), ObserveError> {
    let whole = course.samples();
    let far = course.decimator.memory();
    let start = course
        .sample(rows.start)
        .saturating_sub(far)
        .max(whole.start);
    let end = (course.sample(rows.end - 1) + 1)
        .saturating_add(far)
        .min(whole.end);
    let motion = course.motion(start..end)?;
    let kept: Vec<usize> = overlaps(&rows, believed)
        .flatten()
        .map(|row| course.sample(row) - start)
        .collect();
    let fail = ObserveError::filter(course.name(), "parallel filter");
    for &kind in kinds {
        let made = equations_at(model, kind, &motion, &course.decimator, &kept).map_err(&fail)?;
        for (joint, block) in made.blocks.iter().enumerate() {
            let columns = (0..block.columns.len()).map(|k| block.column(k));
            let all: Vec<&[f64]> = columns.chain(block.y.as_deref()).collect();
            sink(kind, joint, &all);
        }
    }
    Ok(())
}

/// Rows away from the edges, by running decimation.
fn inside_rows(
    course: &Course<'_>,
    model: &dyn IdentificationModel,
    kinds: &[ModelKind],
    rows: Range<usize>,
    believed: &[Range<usize>],
    sink: &mut Sink<'_>,
) -> Result<(), ObserveError> {
    let ratio = course.decimator.ratio();
    let edge = course.edge();
    let last = rows.end + edge;
    let per_window = (WINDOW / ratio).max(1);
    let per_chunk = (CHUNK / ratio).max(1);
    let mut stream = Stream::new(course, model, kinds, rows.start - edge);
    let mut at = rows.start - edge;
    while at < last {
        let window = at..(at + per_window).min(last);
        let samples = course.sample(at) - REACH..course.sample(window.end) + 1 + REACH;
        let (motion, first) = course.around(samples)?;
        while at < window.end {
            let next = (at + per_chunk).min(window.end);
            let from = first + (at - window.start) * ratio;
            stream.follow(&motion, from, next - at);
            at = next;
            // The last rows have just as many after them as they need.
            if at == last || stream.ready(edge) >= BATCH {
                let wanted = stream.ready(edge);
                stream.hand_on(wanted, &rows, believed, sink);
            }
        }
    }
    Ok(())
}
