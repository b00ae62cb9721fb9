//! From stamps as they are to a uniform time grid: the rate, and whether samples may stay as they
//! are.

use super::error::{Found, Problem};
use super::resample;
use super::table::Table;

/// Stamps within this fraction of a step of the grid are on it.
const ON_GRID: f64 = 1e-3;

/// Irregular stamps are put on a round rate if their median step is this near to it: real clocks
/// and cycle times scatter by a few percent.
const NEAR_ROUND: f64 = 0.05;

/// Rates that people choose, up to powers of ten.
const ROUND: [f64; 12] = [1.0, 1.2, 1.25, 1.5, 2.0, 2.4, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0];

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
    /// `t[last] + 0.5 / rate` (NumPy: `arange(t[0], t[-1] + 0.5 / rate, 1 / rate)`).
    pub fn of(table: &Table, given: Option<f64>, warnings: &mut Vec<String>) -> Found<Grid> {
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
        report_irregular(&stamps, rate_hz, table, kept.as_deref(), warnings);
        Ok(Grid {
            rate_hz,
            start,
            len,
            kept,
            stamps: Some(stamps),
        })
    }

    /// A column of the table on the grid.
    pub fn apply(&self, column: Vec<f64>) -> Vec<f64> {
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
    }
}

/// Whether sample k was taken at `stamps[0] + k / rate`, up to a thousandth of a step or to what
/// the decimals of the stamps can tell.
///
/// Decimals coarser than half a step would hide lost samples; they count only when the rate was
/// `given` by the user.
pub(super) fn fits(stamps: &[f64], rate_hz: f64, given: bool) -> bool {
    let Some(&start) = stamps.first() else {
        return true;
    };
    let step = 1.0 / rate_hz;
    let quantum = quantum(stamps);
    let mut tolerance = ON_GRID * step;
    if given || quantum <= 0.5 * step {
        tolerance = tolerance.max(0.5 * quantum * (1.0 + 1e-6));
    }
    let (mut low, mut high) = (0.0_f64, 0.0_f64);
    for (k, &stamp) in stamps.iter().enumerate() {
        let deviation = stamp - start - k as f64 * step;
        if deviation.is_nan() {
            return false;
        }
        low = low.min(deviation);
        high = high.max(deviation);
    }
    high - low <= 2.0 * tolerance
}

/// The last decimal place that the stamps use, s; zero if they use more than nine.
fn quantum(stamps: &[f64]) -> f64 {
    let mut scale = 1.0;
    let mut decimals = 0;
    for &stamp in stamps {
        loop {
            let scaled = stamp * scale;
            let rounding = 1e-4 + 4.0 * f64::EPSILON * scaled.abs();
            if (scaled - scaled.round()).abs() <= rounding {
                break;
            }
            decimals += 1;
            scale *= 10.0;
            if decimals > 9 {
                return 0.0;
            }
        }
    }
    1.0 / scale
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
        "{count} rows carry the stamp of the row before ({} of them with other values) and are \
         left out; the first: {}.",
        differ.count(),
        table.at(first)
    ));
    Ok(Some(
        (0..rows)
            .filter(|k| repeats.binary_search(k).is_err())
            .collect(),
    ))
}

/// The given rate, else a simple rate that explains every stamp, else the median step's.
fn rate(stamps: &[f64], given: Option<f64>, warnings: &mut Vec<String>) -> f64 {
    let median = 1.0 / median_step(stamps);
    if let Some(given) = given {
        if (median / given - 1.0).abs() > NEAR_ROUND {
            warnings.push(format!(
                "The log companion says {given} Hz, the stamps say about {} Hz; {given} Hz is used.",
                shown(median)
            ));
        }
        return given;
    }
    let span = stamps
        .last()
        .zip(stamps.first())
        .map_or(0.0, |(last, first)| last - first);
    let mean = (stamps.len().saturating_sub(1)) as f64 / span;
    let simple = [
        round_rate(mean),
        mean.round(),
        1e6 / (1e6 / mean).round(),
        mean,
    ];
    let exact = simple
        .into_iter()
        .find(|&rate| rate > 0.0 && fits(stamps, rate, false));
    let found = exact.unwrap_or_else(|| {
        let near = round_rate(median);
        let whole = if median >= 10.0 {
            median.round()
        } else {
            median
        };
        if (near / median - 1.0).abs() <= NEAR_ROUND {
            near
        } else {
            whole
        }
    });
    if !(2.0..=1e5).contains(&found) {
        warnings.push(format!(
            "The stamps say {} Hz; if they are not seconds, write t = {{ unit = \"ms\" }} (or us, \
             ns) under [columns] of the log companion.",
            shown(found)
        ));
    }
    found
}

fn median_step(stamps: &[f64]) -> f64 {
    let mut steps: Vec<f64> = stamps.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() {
        return f64::NAN;
    }
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The round rate nearest to this one.
fn round_rate(rate: f64) -> f64 {
    let decade = 10.0_f64.powf(rate.log10().floor());
    let candidates = ROUND
        .iter()
        .map(|mantissa| mantissa * decade)
        .chain([10.0 * decade]);
    candidates
        .min_by(|a, b| (a - rate).abs().total_cmp(&(b - rate).abs()))
        .unwrap_or(rate)
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
    let irregular = steps
        .iter()
        .filter(|&&step| (step - 1.0).abs() > 0.1)
        .count();
    let longest = steps.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    let Some((place, step)) = longest else { return };
    let ms = |steps: f64| shown(steps * 1e3 / rate_hz);
    warnings.push(format!(
        "The stamps are irregular: {irregular} of {} steps differ from {} ms by more than 10 %, the \
         longest is {} ms (after {}); samples were interpolated linearly onto {} Hz.",
        steps.len(),
        ms(1.0),
        ms(*step),
        at(place),
        shown(rate_hz),
    ));
    let gaps: Vec<usize> = (0..steps.len()).filter(|&k| steps[k] > GAP).collect();
    if gaps.is_empty() {
        return;
    }
    let list = gaps
        .iter()
        .take(LISTED)
        .map(|&k| format!("{} ms after {}", ms(steps[k]), at(k)));
    let more = if gaps.len() > LISTED { ", ..." } else { "" };
    let list: Vec<String> = list.collect();
    warnings.push(format!(
        "{} gaps longer than {GAP} steps are bridged by straight lines: {}{more}.",
        gaps.len(),
        list.join("; ")
    ));
}

/// A number for a message: six digits are enough.
fn shown(value: f64) -> String {
    let digits = (5.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}
