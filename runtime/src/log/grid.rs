//! From stamps as they are to a uniform time grid: the rate, and whether samples may stay as they
//! are.

use std::ops::Range;

use super::error::{Found, Problem};
use super::rate::{fits, rate, shown};
use super::resample;
use super::spec::Part;
use super::stamps::{Ends, Kept, Stamps, each_step};
use super::table::at;

/// More repeated stamps than this fraction are no accident.
const REPEATED: f64 = 0.05;

/// Steps longer than so many of the grid's are gaps.
const GAP: f64 = 5.0;

/// A grid with more samples per row than this comes from a mistake, not from a log.
const SAMPLES_PER_ROW: f64 = 50.0;

/// The stamps of the rows of a log, and what else is asked about those rows.
pub(super) struct Stamped<'a> {
    pub stamps: &'a dyn Stamps,
    /// Data row of the first stamp.
    pub first_row: usize,
    /// How many of these rows differ from the row before in any column.
    pub differ: &'a dyn Fn(&[usize]) -> usize,
}

/// A uniform time grid, and how the rows of a log get onto it.
#[derive(Debug)]
pub(super) struct Grid {
    /// Hz.
    pub rate_hz: f64,
    /// Time of the first sample, s.
    pub start: f64,
    /// Samples.
    pub len: usize,
    /// The rows that do not count, because they repeat a stamp; ascending.
    pub dropped: Vec<usize>,
    /// Samples must be interpolated; otherwise the rows that count are the samples.
    pub interpolated: bool,
}

impl Grid {
    /// The grid for these stamps, at the given rate or at the one the stamps show.
    ///
    /// Uniform stamps keep their samples; others get the grid `t[0] + k / rate` up to
    /// `t[last] + 0.5 / rate` (NumPy: `arange(t[0], t[-1] + 0.5 / rate, 1 / rate)`), and not
    /// beyond the end of the part.
    pub fn of(
        rows: &Stamped<'_>,
        part: Part,
        given: Option<f64>,
        warnings: &mut Vec<String>,
    ) -> Found<Grid> {
        let all = rows.stamps.ends();
        let uniform = |rate_hz, len, dropped| Grid {
            rate_hz,
            start: all.first,
            len,
            dropped,
            interpolated: false,
        };
        if let Some(rate_hz) = given
            && fits(rows.stamps, rate_hz, true)?
        {
            return Ok(uniform(rate_hz, all.len, Vec::new()));
        }
        let dropped = repeats(rows, warnings)?;
        let stamps = Kept::new(rows.stamps, &dropped);
        let (rate_hz, fits) = rate(&stamps, given, warnings)?;
        if fits {
            let len = stamps.ends().len;
            return Ok(uniform(rate_hz, len, dropped));
        }
        let len = cut(part, rate_hz, all.first, length(stamps.ends(), rate_hz)?);
        report_irregular(&stamps, rate_hz, rows.first_row, &dropped, warnings)?;
        Ok(Grid {
            rate_hz,
            start: all.first,
            len,
            dropped,
            interpolated: true,
        })
    }

    /// The samples of the grid that the given rows (ascending ranges) enter.
    pub fn samples(
        &self,
        stamp: impl Fn(usize) -> Option<f64>,
        rows: &[Range<usize>],
    ) -> Vec<Range<usize>> {
        let place =
            |row: usize| stamp(row).map_or(self.len as f64, |t| (t - self.start) * self.rate_hz);
        let mut samples: Vec<Range<usize>> = Vec::new();
        for range in rows {
            // One row further on either side: interpolation reaches to the neighbours.
            let from = place(range.start.saturating_sub(1)).floor().max(0.0) as usize;
            let to = (place(range.end).ceil() + 1.0).max(0.0) as usize;
            let to = to.min(self.len);
            match samples.last_mut() {
                Some(last) if from <= last.end => last.end = last.end.max(to),
                _ if from < to => samples.push(from..to),
                _ => {}
            }
        }
        samples
    }

    /// Columns with the given stamps on the grid.
    pub fn apply(&self, stamps: &[f64], columns: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        let kept = self.interpolated.then(|| self.keep(0, stamps.to_vec()));
        let column = |column: Vec<f64>| {
            let column = self.keep(0, column);
            match &kept {
                Some(kept) => {
                    resample::onto_grid(kept, &column, self.start, self.rate_hz, 0..self.len)
                }
                None => column,
            }
        };
        columns.into_iter().map(column).collect()
    }

    /// The values of the rows that count, of a column that begins at row `first`.
    pub fn keep(&self, first: usize, mut values: Vec<f64>) -> Vec<f64> {
        if !self.dropped.is_empty() {
            let mut row = first;
            values.retain(|_| {
                row += 1;
                self.dropped.binary_search(&(row - 1)).is_err()
            });
        }
        values
    }

    /// The row that holds the `k`-th value that counts.
    pub fn row(&self, k: usize) -> usize {
        row_of(k, &self.dropped)
    }
}

/// Where the `k`-th of the rows that are not dropped stands among all.
fn row_of(k: usize, dropped: &[usize]) -> usize {
    let (mut low, mut high) = (0, dropped.len());
    while low < high {
        let middle = (low + high) / 2;
        match dropped.get(middle) {
            Some(&row) if row - middle <= k => low = middle + 1,
            _ => high = middle,
        }
    }
    k + low
}

/// The rows that carry the stamp of the row before.
fn repeats(rows: &Stamped<'_>, warnings: &mut Vec<String>) -> Found<Vec<usize>> {
    let len = rows.stamps.ends().len;
    let bearable = REPEATED * len as f64;
    let (mut count, mut first, mut repeats) = (0, None, Vec::new());
    each_step(rows.stamps, &mut |k, time, step| {
        if step == 0.0 {
            count += 1;
            first = first.or(Some((k + 1, time)));
            if count as f64 <= bearable {
                repeats.push(k + 1);
            }
        }
    })?;
    let Some((first, time)) = first else {
        return Ok(repeats);
    };
    let row = rows.first_row + first;
    if count as f64 > bearable {
        return Err(Problem::RepeatedStamps {
            count,
            rows: len,
            row,
            time,
        });
    }
    warnings.push(format!(
        "Rows that carry the stamp of the row before are left out: {count}, of which {} have other \
         values; the first is {}.",
        (rows.differ)(&repeats),
        at(row, time)
    ));
    Ok(repeats)
}

/// Length of the grid inside the part: the half step that the grid may reach beyond the last row
/// must not reach beyond the part.
fn cut(part: Part, rate_hz: f64, start: f64, len: usize) -> usize {
    /// A grid point this near to the end, in steps, lies on it and is no part of it.
    const TIE: f64 = 1e-6;
    match part {
        Part::Seconds { to: Some(to), .. } => {
            len.min(((to - start) * rate_hz - TIE).ceil().max(0.0) as usize)
        }
        _ => len,
    }
}

/// `len(numpy.arange(first, last + 0.5 / rate, 1 / rate))`, if it is a sensible number.
fn length(Ends { first, last, len }: Ends, rate_hz: f64) -> Found<usize> {
    let samples = ((last + 0.5 / rate_hz - first) / (1.0 / rate_hz)).ceil();
    if samples <= SAMPLES_PER_ROW * len as f64 {
        return Ok(samples as usize);
    }
    Err(Problem::TooLong {
        rate_hz,
        seconds: last - first,
        samples,
        rows: len,
    })
}

/// Says how irregular the stamps are, and where the longest gaps lie.
fn report_irregular(
    stamps: &dyn Stamps,
    rate_hz: f64,
    first_row: usize,
    dropped: &[usize],
    warnings: &mut Vec<String>,
) -> Found<()> {
    const LISTED: usize = 5;
    let ms = |steps: f64| shown(steps * 1e3 / rate_hz);
    let place = |k: usize, time: f64| at(first_row + row_of(k, dropped), time);
    let mut irregular = 0;
    let mut longest: Option<(f64, usize, f64)> = None;
    let (mut gaps, mut listed) = (0, Vec::new());
    each_step(stamps, &mut |k, time, step| {
        let steps = step * rate_hz;
        irregular += usize::from((steps - 1.0).abs() > 0.1);
        if longest.is_none_or(|(so_far, ..)| steps >= so_far) {
            longest = Some((steps, k, time));
        }
        if steps > GAP {
            gaps += 1;
            if gaps <= LISTED {
                listed.push(format!("{} ms after {}", ms(steps), place(k, time)));
            }
        }
    })?;
    let Some((steps, k, time)) = longest else {
        return Ok(());
    };
    warnings.push(format!(
        "The stamps are irregular: {irregular} of {} steps differ from {} ms by more than 10 %, the \
         longest is {} ms (after {}); samples were interpolated linearly onto {} Hz.",
        stamps.ends().len - 1,
        ms(1.0),
        ms(steps),
        place(k, time),
        shown(rate_hz),
    ));
    if gaps > 0 {
        warnings.push(format!(
            "Gaps longer than {GAP} steps are bridged by straight lines ({gaps}): {}{}.",
            listed.join("; "),
            if gaps > LISTED { "; ..." } else { "" },
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn row_of_a_value_counts_the_dropped_rows_before_it() {
        let dropped = [2, 3, 7];
        let kept: Vec<usize> = (0..10).filter(|row| !dropped.contains(row)).collect();
        for (k, row) in kept.iter().enumerate() {
            assert_eq!(row_of(k, &dropped), *row);
        }
    }
}
