//! Logs that repeat themselves, and the pure error that this shows: what differs between periods
//! is noise, for a model error repeats.

use std::ops::Range;

use super::track::Track;

/// Difference between a motion and itself a period later, as a share of its variance, below which
/// it counts as the same motion.
const SAME: f64 = 1e-3;

/// Shortest period looked for, s.
const SHORTEST: f64 = 0.5;

/// Share of a period over which the ends of a log come to count, and what they count for at least.
const TAPER: f64 = 0.1;
const FAINT: f64 = 1e-3;

/// Rows that repeat with a period.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Repeats {
    pub segment: Range<usize>,
    /// Rows of a period.
    pub period: usize,
}

/// Finds the period of a log in its motion; rows `segment` of all are this log's.
pub(super) fn find(track: &Track, segment: Range<usize>) -> Option<Repeats> {
    let q: Vec<Vec<f64>> = track.motion.q.iter().map(|q| track.at_rows(q)).collect();
    let rows = track.rows();
    let variance = |q: &Vec<f64>| {
        let mean = q.iter().sum::<f64>() / rows as f64;
        q.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / rows as f64
    };
    let moving: Vec<(&Vec<f64>, f64)> = q
        .iter()
        .map(|q| (q, variance(q)))
        .filter(|(_, v)| *v > 1e-10)
        .collect();
    let apart = |lag: usize, stride: usize| {
        let of_joint = |(q, variance): &(&Vec<f64>, f64)| {
            let pairs = (0..rows - lag).step_by(stride);
            let count = pairs.len().max(1) as f64;
            pairs.map(|t| (q[t + lag] - q[t]).powi(2)).sum::<f64>() / (count * variance)
        };
        moving.iter().map(of_joint).fold(0.0, f64::max)
    };
    let shortest = ((SHORTEST / track.step()) as usize).max(10);
    if moving.is_empty() || rows < 2 * shortest {
        return None;
    }
    // Two periods must be there, but for what the filters' edges took.
    let longest = rows / 2 + rows / 16;
    let stride = (rows / 500).max(1);
    let near = (shortest..longest).find(|&lag| apart(lag, stride) < 10.0 * SAME)?;
    let around = near..(near + near / 10 + 3).min(longest);
    let (period, distance) =
        around
            .map(|lag| (lag, apart(lag, 1)))
            .fold((near, f64::INFINITY), |best, next| {
                if next.1 < best.1 { next } else { best }
            });
    (distance < SAME).then_some(Repeats { segment, period })
}

/// The motion of a log that repeats itself as its other periods show it: for every sample the mean
/// of those that lie whole periods away. Its noise is not that of the sample. The ends of the log
/// count less, so that the mean does not jump where another set of periods takes over.
pub(super) fn elsewhere(track: &Track) -> Option<Vec<Vec<f64>>> {
    let q = &track.source.recording.q;
    let period = own_noise(track)?;
    let len = q.first()?.len();
    let weight = |k: usize| {
        let edge = (k.min(len - 1 - k) as f64 / (TAPER * period as f64)).min(1.0);
        edge * edge * (3.0 - 2.0 * edge) + FAINT
    };
    let at = |q: &Vec<f64>, k: usize| {
        let same = (k % period..len)
            .step_by(period)
            .filter(|other| *other != k);
        let (sum, weights) = same.fold((0.0, 0.0), |(sum, weights), other| {
            (sum + weight(other) * q[other], weights + weight(other))
        });
        sum / weights
    };
    Some(
        q.iter()
            .map(|q| (0..len).map(|k| at(q, k)).collect())
            .collect(),
    )
}

/// The period of a log, in samples, each of which has a noise of its own. Where most samples are
/// exactly those of a period before, the encoder rounds them alike, and its error repeats as well.
pub(super) fn own_noise(track: &Track) -> Option<usize> {
    let period = samples(track, find(track, 0..track.rows())?.period);
    let apart = |q: &Vec<f64>| {
        let pairs = q.iter().zip(q.get(period..).unwrap_or_default());
        let count = pairs.len();
        2 * pairs.filter(|(a, b)| a != b).count() > count
    };
    let mut moving = track
        .source
        .recording
        .q
        .iter()
        .filter(|q| q.iter().any(|x| *x != q[0]));
    moving.all(apart).then_some(period)
}

/// A period in samples, about one in rows: the one after which the motion is most nearly the same.
fn samples(track: &Track, rows: usize) -> usize {
    let q = &track.source.recording.q;
    let len = q.first().map_or(0, Vec::len);
    let ratio = (track.step() * track.source.recording.rate_hz)
        .round()
        .max(1.0) as usize;
    let apart = |lag: usize| -> f64 {
        let of_joint = |q: &Vec<f64>| -> f64 {
            (0..len.saturating_sub(lag))
                .step_by(7)
                .map(|t| (q[t + lag] - q[t]).powi(2))
                .sum()
        };
        let count = len.saturating_sub(lag).max(1) as f64;
        q.iter().map(of_joint).sum::<f64>() / count
    };
    let around = (rows - 1) * ratio..=(rows + 1) * ratio;
    let best = around
        .map(|lag| (lag, apart(lag)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    best.map_or(rows * ratio, |(lag, _)| lag)
}

/// Rows with the mean over periods taken away and what that costs given back, and the means
/// themselves; rows that have no other of their phase are left out by a weight of zero.
pub(super) struct PureError {
    pub rows: Vec<f64>,
    pub weights: Vec<f64>,
    /// Sum of squares of the period means, over all rows, and its degrees of freedom.
    pub repeated: (f64, f64),
    /// Sum of squares of the deviations, and its degrees of freedom.
    pub between: (f64, f64),
}

/// Splits rows with weights into what repeats and what does not.
pub(super) fn pure_error(rows: &[f64], weights: &[f64], repeats: &[Repeats]) -> PureError {
    let mut error = PureError {
        rows: vec![0.0; rows.len()],
        weights: vec![0.0; rows.len()],
        repeated: (0.0, 0.0),
        between: (0.0, 0.0),
    };
    for Repeats { segment, period } in repeats {
        for phase in segment.start..(segment.start + period).min(segment.end) {
            let same = (phase..segment.end)
                .step_by(*period)
                .filter(|&t| weights[t] >= 1.0);
            let same: Vec<usize> = same.collect();
            let count = same.len() as f64;
            if same.len() < 2 {
                continue;
            }
            let mean = same.iter().map(|&t| rows[t]).sum::<f64>() / count;
            error.repeated.0 += count * mean * mean;
            error.repeated.1 += 1.0;
            error.between.1 += count - 1.0;
            for t in same {
                error.between.0 += (rows[t] - mean).powi(2);
                error.rows[t] = (rows[t] - mean) * (count / (count - 1.0)).sqrt();
                error.weights[t] = 1.0;
            }
        }
    }
    error
}

/// Lack of fit of whitened residuals: \\( z = (F - 1) / \sqrt{2/d_1 + 2/d_2} \\) with the variance
/// of what repeats against that between periods; `decided` is how many parameters the rows decide.
pub(super) fn lack_of_fit(error: &PureError, decided: f64) -> Lack {
    let above = (error.repeated.1 - decided).max(1.0);
    let below = error.between.1.max(1.0);
    let ratio = (error.repeated.0 / above) / (error.between.0 / below).max(f64::MIN_POSITIVE);
    Lack::new(ratio, above, below)
}

/// How much of a joint's residual is no noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lack {
    /// Standard deviations.
    pub z: f64,
    /// Variance of the residual over that of the noise, less one.
    pub excess: f64,
}

impl Lack {
    pub fn new(ratio: f64, above: f64, below: f64) -> Lack {
        let excess = ratio - 1.0;
        let z = excess / (2.0 / above + 2.0 / below).sqrt();
        Lack { z, excess }
    }
}
