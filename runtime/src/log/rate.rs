//! The sampling rate that stamps show, and whether they keep to one.

use super::error::Found;
use super::order;
use super::stamps::{Ends, Stamps, each_step};
use crate::signal::{all_finite, extent};

/// Stamps within this fraction of a step of the grid are on it.
const ON_GRID: f64 = 1e-3;

/// Irregular stamps are put on a round rate if their median step is this near to it: real clocks
/// and cycle times scatter by a few percent.
const NEAR_ROUND: f64 = 0.05;

/// Rates that people choose, up to powers of ten.
const ROUND: [f64; 12] = [1.0, 1.2, 1.25, 1.5, 2.0, 2.4, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0];

/// Whether sample k was taken at `stamps[0] + k / rate`, up to a thousandth of a step or to what
/// the decimals of the stamps can tell.
///
/// Decimals coarser than half a step would hide lost samples; they count only when the rate was
/// `given` by the user.
pub(super) fn fits(stamps: &dyn Stamps, rate_hz: f64, given: bool) -> Found<bool> {
    fit(stamps, quantum(stamps)?, rate_hz, given)
}

fn fit(stamps: &dyn Stamps, quantum: f64, rate_hz: f64, given: bool) -> Found<bool> {
    Ok(spread(stamps, rate_hz)? <= spread_allowed(quantum, rate_hz, given))
}

/// How far apart the deviations of stamps on a grid may be, s.
fn spread_allowed(quantum: f64, rate_hz: f64, given: bool) -> f64 {
    let step = 1.0 / rate_hz;
    let tolerance = ON_GRID * step;
    match given || quantum <= 0.5 * step {
        true => 2.0 * tolerance.max(0.5 * quantum * (1.0 + 1e-6)),
        false => 2.0 * tolerance,
    }
}

/// How far apart the deviations of the stamps from a grid are, s; infinite where a stamp is no
/// number.
fn spread(stamps: &dyn Stamps, rate_hz: f64) -> Found<f64> {
    let step = 1.0 / rate_hz;
    let Ends { first, .. } = stamps.ends();
    let (mut low, mut high, mut k) = (0.0_f64, 0.0_f64, 0.0);
    let mut numbers = true;
    let mut deviations = Vec::new();
    stamps.each(&mut |stamps| {
        deviations.clear();
        deviations.extend(stamps.iter().map(|stamp| {
            k += 1.0;
            stamp - first - (k - 1.0) * step
        }));
        numbers &= all_finite(&deviations);
        let (lowest, highest) = extent(&deviations);
        (low, high) = (low.min(lowest), high.max(highest));
    })?;
    Ok(if numbers { high - low } else { f64::INFINITY })
}

/// Numbers near this one, \( 1.5 \cdot 2^{52} \), are whole.
const WHOLE: f64 = 6_755_399_441_055_744.0;

/// The last decimal place that the stamps use, s; zero if they use more than nine.
fn quantum(stamps: &dyn Stamps) -> Found<f64> {
    let mut scale = 1.0;
    let mut decimals = 0;
    stamps.each(&mut |stamps| {
        for &stamp in stamps {
            while decimals <= 9 {
                let scaled = stamp * scale;
                let rounding = 1e-4 + 4.0 * f64::EPSILON * scaled.abs();
                // The sum has no digits behind the point; where it has lost more, so had the stamp.
                let whole = (scaled + WHOLE) - WHOLE;
                if (scaled - whole).abs() <= rounding {
                    break;
                }
                decimals += 1;
                scale *= 10.0;
            }
        }
    })?;
    Ok(if decimals > 9 { 0.0 } else { 1.0 / scale })
}

/// The given rate, else a simple rate that explains every stamp, else the median step's; and
/// whether it fits every stamp.
pub(super) fn rate(
    stamps: &dyn Stamps,
    given: Option<f64>,
    warnings: &mut Vec<String>,
) -> Found<(f64, bool)> {
    if let Some(given) = given {
        let median = 1.0 / median_step(stamps)?;
        if (median / given - 1.0).abs() > NEAR_ROUND {
            warnings.push(format!(
                "The log companion says {given} Hz, the stamps say about {} Hz; {given} Hz is used.",
                shown(median)
            ));
        }
        return Ok((given, fits(stamps, given, false)?));
    }
    let (found, fits) = estimate(stamps)?;
    if !(2.0..=1e5).contains(&found) {
        warnings.push(format!(
            "The stamps say {} Hz; if they are not seconds, write t = {{ unit = \"ms\" }} (or us, \
             ns) under [columns] of the log companion.",
            shown(found)
        ));
    }
    Ok((found, fits))
}

/// A simple rate that explains every stamp, else a round rate near the median step's.
fn estimate(stamps: &dyn Stamps) -> Found<(f64, bool)> {
    let Ends { first, last, len } = stamps.ends();
    let mean = (len.saturating_sub(1)) as f64 / (last - first);
    let whole_microseconds = 1e6 / (1e6 / mean).round();
    let likeliest = round_rate(mean);
    let (quantum, first_spread) = rayon::join(|| quantum(stamps), || spread(stamps, likeliest));
    let (quantum, first_spread) = (quantum?, first_spread?);
    if likeliest > 0.0 && first_spread <= spread_allowed(quantum, likeliest, false) {
        return Ok((likeliest, true));
    }
    for rate in [mean.round(), whole_microseconds, mean] {
        if rate > 0.0 && fit(stamps, quantum, rate, false)? {
            return Ok((rate, true));
        }
    }
    let median = 1.0 / median_step(stamps)?;
    let near = round_rate(median);
    let rate = if (near / median - 1.0).abs() <= NEAR_ROUND {
        near
    } else if median >= 10.0 {
        median.round()
    } else {
        median
    };
    Ok((rate, fit(stamps, quantum, rate, false)?))
}

fn median_step(stamps: &dyn Stamps) -> Found<f64> {
    let steps = stamps.ends().len.saturating_sub(1);
    if steps == 0 {
        return Ok(f64::NAN);
    }
    order::select(steps / 2, |see| {
        each_step(stamps, &mut |_, _, step| see(step))
    })
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

/// A number for a message: six digits are enough.
pub(super) fn shown(value: f64) -> String {
    let digits = (5.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}
