//! The sampling rate that stamps show, and whether they keep to one.

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

/// The given rate, else a simple rate that explains every stamp, else the median step's.
pub(super) fn rate(stamps: &[f64], given: Option<f64>, warnings: &mut Vec<String>) -> f64 {
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
    let found = estimate(stamps, median);
    if !(2.0..=1e5).contains(&found) {
        warnings.push(format!(
            "The stamps say {} Hz; if they are not seconds, write t = {{ unit = \"ms\" }} (or us, \
             ns) under [columns] of the log companion.",
            shown(found)
        ));
    }
    found
}

/// A simple rate that explains every stamp, else a round rate near the median step's.
fn estimate(stamps: &[f64], median: f64) -> f64 {
    let ends = stamps.last().zip(stamps.first());
    let span = ends.map_or(0.0, |(last, first)| last - first);
    let mean = (stamps.len().saturating_sub(1)) as f64 / span;
    let whole_microseconds = 1e6 / (1e6 / mean).round();
    for rate in [round_rate(mean), mean.round(), whole_microseconds, mean] {
        if rate > 0.0 && fits(stamps, rate, false) {
            return rate;
        }
    }
    let near = round_rate(median);
    if (near / median - 1.0).abs() <= NEAR_ROUND {
        near
    } else if median >= 10.0 {
        median.round()
    } else {
        median
    }
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
