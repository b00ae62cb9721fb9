//! From stamps as they are to a uniform time grid: the rate, and whether samples may stay as they
//! are.

use std::ops::Range;

use super::error::{Found, Problem};
use super::rate::{fits, rate, shown};
use super::resample;
use super::spec::Part;
use super::table::Table;

/// More repeated stamps than this fraction are no accident.
const REPEATED: f64 = 0.05;

/// Steps longer than so many of the grid's are gaps.
const GAP: f64 = 5.0;

/// A grid with more samples per row than this comes from a mistake, not from a log.
const SAMPLES_PER_ROW: f64 = 50.0;

/// A uniform time grid, and how the rows of a log get onto it.
#[derive(Debug)]
pub(super) struct Grid {
    /// Hz.
    pub rate_hz: f64,
    /// Time of the first sample, s.
    pub start: f64,
    /// Samples.
    pub len: usize,
    /// The rows that count, if some repeat a stamp.
    kept: Option<Vec<usize>>,
    /// Their stamps, if samples must be interpolated.
    stamps: Option<Vec<f64>>,
}

impl Grid {
    /// The grid for the table's stamps, at the given rate or at the one the stamps show.
    ///
    /// Uniform stamps keep their samples; others get the grid `t[0] + k / rate` up to
    /// `t[last] + 0.5 / rate` (NumPy: `arange(t[0], t[-1] + 0.5 / rate, 1 / rate)`), and not
    /// beyond the end of the part.
    pub fn of(
        table: &Table,
        part: Part,
        given: Option<f64>,
        warnings: &mut Vec<String>,
    ) -> Found<Grid> {
        let all = table.stamps();
        let start = all.first().copied().unwrap_or(0.0);
        if let Some(rate_hz) = given.filter(|&rate| fits(all, rate, true)) {
            return Ok(Grid {
                rate_hz,
                start,
                len: all.len(),
                kept: None,
                stamps: None,
            });
        }
        let kept = without_repeats(table, warnings)?;
        let stamps: Vec<f64> = match &kept {
            Some(kept) => gather(all, kept),
            None => all.to_vec(),
        };
        let rate_hz = rate(&stamps, given, warnings);
        if fits(&stamps, rate_hz, false) {
            return Ok(Grid {
                rate_hz,
                start,
                len: stamps.len(),
                kept,
                stamps: None,
            });
        }
        let len = length(&stamps, rate_hz)?;
        let len = cut(part, rate_hz, start, len);
        report_irregular(&stamps, rate_hz, table, kept.as_deref(), warnings);
        Ok(Grid {
            rate_hz,
            start,
            len,
            kept,
            stamps: Some(stamps),
        })
    }

    /// The samples of the grid that the given rows (ascending ranges) enter.
    pub fn samples(&self, stamps: &[f64], rows: &[Range<usize>]) -> Vec<Range<usize>> {
        let place = |row: usize| {
            stamps
                .get(row)
                .map_or(self.len as f64, |t| (t - self.start) * self.rate_hz)
        };
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

    /// Columns of the table on the grid.
    pub fn apply(&self, columns: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        let column = |column: Vec<f64>| {
            let column = match &self.kept {
                Some(kept) => gather(&column, kept),
                None => column,
            };
            match &self.stamps {
                Some(stamps) => {
                    resample::onto_grid(stamps, &column, self.start, self.rate_hz, self.len)
                }
                None => column,
            }
        };
        columns.into_iter().map(column).collect()
    }
}

fn gather(values: &[f64], kept: &[usize]) -> Vec<f64> {
    kept.iter()
        .filter_map(|&k| values.get(k).copied())
        .collect()
}

/// The rows that carry a stamp of their own, if some do not: of equal stamps the first row stays.
fn without_repeats(table: &Table, warnings: &mut Vec<String>) -> Found<Option<Vec<usize>>> {
    let stamps = table.stamps();
    let repeats: Vec<usize> = (1..stamps.len())
        .filter(|&k| stamps[k] == stamps[k - 1])
        .collect();
    let Some(&first) = repeats.first() else {
        return Ok(None);
    };
    let (count, rows) = (repeats.len(), stamps.len());
    if count as f64 > REPEATED * rows as f64 {
        let row = table.first_row + first;
        return Err(Problem::RepeatedStamps {
            count,
            rows,
            row,
            time: stamps[first],
        });
    }
    let differ = repeats
        .iter()
        .filter(|&&k| table.columns.iter().any(|c| c.get(k) != c.get(k - 1)));
    warnings.push(format!(
        "Rows that carry the stamp of the row before are left out: {count}, of which {} have other \
         values; the first is {}.",
        differ.count(),
        table.at(first)
    ));
    Ok(Some(
        (0..rows)
            .filter(|k| repeats.binary_search(k).is_err())
            .collect(),
    ))
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
fn length(stamps: &[f64], rate_hz: f64) -> Found<usize> {
    let (Some(first), Some(last)) = (stamps.first(), stamps.last()) else {
        return Ok(0);
    };
    let samples = ((last + 0.5 / rate_hz - first) / (1.0 / rate_hz)).ceil();
    let rows = stamps.len();
    if samples <= SAMPLES_PER_ROW * rows as f64 {
        return Ok(samples as usize);
    }
    Err(Problem::TooLong {
        rate_hz,
        seconds: last - first,
        samples,
        rows,
    })
}

/// Says how irregular the stamps are, and where the longest gaps lie.
fn report_irregular(
    stamps: &[f64],
    rate_hz: f64,
    table: &Table,
    kept: Option<&[usize]>,
    warnings: &mut Vec<String>,
) {
    const LISTED: usize = 5;
    let at = |k: usize| table.at(kept.and_then(|kept| kept.get(k).copied()).unwrap_or(k));
    let steps: Vec<f64> = stamps
        .windows(2)
        .map(|pair| (pair[1] - pair[0]) * rate_hz)
        .collect();
    let irregular = steps.iter().filter(|step| (*step - 1.0).abs() > 0.1);
    let longest = steps.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    let Some((place, step)) = longest else { return };
    let ms = |steps: f64| shown(steps * 1e3 / rate_hz);
    warnings.push(format!(
        "The stamps are irregular: {} of {} steps differ from {} ms by more than 10 %, the \
         longest is {} ms (after {}); samples were interpolated linearly onto {} Hz.",
        irregular.count(),
        steps.len(),
        ms(1.0),
        ms(*step),
        at(place),
        shown(rate_hz),
    ));
    let gaps: Vec<String> = (steps.iter().enumerate())
        .filter(|(_, step)| **step > GAP)
        .map(|(k, step)| format!("{} ms after {}", ms(*step), at(k)))
        .collect();
    if !gaps.is_empty() {
        warnings.push(format!(
            "Gaps longer than {GAP} steps are bridged by straight lines ({}): {}{}.",
            gaps.len(),
            gaps[..gaps.len().min(LISTED)].join("; "),
            if gaps.len() > LISTED { "; ..." } else { "" },
        ));
    }
}
