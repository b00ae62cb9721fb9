//! Samples that cannot be believed: values that are no numbers, spikes, an encoder that stands
//! still while the joint moves, torque at its limit.
//!
//! Each is found and named with its rows. All but torque at its limit is bridged by a straight line,
//! so that filters have something finite to run over; what long bridges touch is left out of the
//! equations.

use std::ops::Range;

use super::clipped::clipped;
use crate::model::Joint;
use crate::signal::{all_finite, median, medians};

/// More than this fraction of bad values in one channel is no accident: the log is refused.
pub(super) const BEARABLE: f64 = 0.1;

/// A spike stands out of its neighbours by more than this fraction of the signal's range ...
const SPIKE_OF_RANGE: f64 = 0.5;

/// ... and by more than this many times what such deviations usually are.
const SPIKE_OF_SCATTER: f64 = 30.0;

/// ... and by more than this many times the smallest step: at rest, an encoder's last digit is all
/// the range there is.
const SPIKE_OF_RESOLUTION: f64 = 20.0;

/// An encoder is stuck when its value repeats for this many rows and more ...
const STUCK_ROWS: usize = 8;

/// ... and then jumps by more than this many times a fast step.
const STUCK_JUMP: f64 = 8.0;

/// What was found in one channel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Finding {
    /// `Joint 1 (`shoulder`): the position`.
    pub subject: String,
    pub what: What,
    /// Rows of the series, ascending and disjoint.
    pub ranges: Vec<Range<usize>>,
}

/// Why samples cannot be believed.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum What {
    NoNumber,
    Spike,
    Stuck,
    /// At these limits.
    Clipped(Vec<f64>),
}

impl Finding {
    /// Takes in what another part of the log says about the same channel.
    pub fn append(&mut self, more: Finding) {
        self.ranges.extend(more.ranges);
        if let (What::Clipped(levels), What::Clipped(more)) = (&mut self.what, more.what) {
            levels.extend(more);
            levels.sort_by(f64::total_cmp);
            levels.dedup();
        }
    }

    fn in_words(&self) -> (String, &'static str) {
        let bridged = "bridged by straight lines; equations near long bridges are left out";
        let what = match &self.what {
            What::NoNumber => "no number",
            What::Spike => "a spike",
            What::Stuck => "stuck",
            What::Clipped(levels) => {
                let levels: Vec<String> = levels.iter().map(f64::to_string).collect();
                let what = format!("clipped at {}", levels.join(" and "));
                return (what, "equations near them are left out");
            }
        };
        (what.to_owned(), bridged)
    }
}

type Search = fn(&[f64]) -> Vec<Range<usize>>;

/// What was found in all channels of a log, whether there are ranges to it or not: always the same
/// list for the same channels.
pub(super) struct Doubts<'a> {
    pub joints: &'a [Joint],
    pub findings: Vec<Finding>,
}

impl Doubts<'_> {
    /// Finds and bridges the bad samples of all positions.
    pub fn positions(&mut self, q: &mut [Vec<f64>]) {
        for (joint, series) in q.iter_mut().enumerate() {
            self.bridge((joint, "position"), series, (What::NoNumber, no_numbers));
            self.bridge((joint, "position"), series, (What::Spike, spikes));
            self.bridge((joint, "position"), series, (What::Stuck, stuck_runs));
        }
    }

    /// Finds and bridges the values of all velocities that are no numbers. The velocity of a joint
    /// at rest jumps whenever another one stops, so that a spike proves nothing.
    pub fn velocities(&mut self, qd: &mut [Vec<f64>]) {
        for (joint, series) in qd.iter_mut().enumerate() {
            self.bridge((joint, "velocity"), series, (What::NoNumber, no_numbers));
        }
    }

    /// Finds and bridges the bad samples of all torques, as the drives report them, and finds the
    /// rows in which they are at their limits while one of the joints moves that `moves_with`
    /// names.
    pub fn torques<'q>(
        &mut self,
        tau: &mut [Vec<f64>],
        moves_with: impl Fn(usize) -> Vec<&'q [f64]>,
    ) {
        for (joint, series) in tau.iter_mut().enumerate() {
            self.bridge((joint, "torque"), series, (What::NoNumber, no_numbers));
            self.bridge((joint, "torque"), series, (What::Spike, spikes));
            let ranges = clipped(series, &moves_with(joint));
            let mut levels: Vec<f64> = ranges.iter().map(|range| series[range.start]).collect();
            levels.sort_by(f64::total_cmp);
            levels.dedup();
            self.add((joint, "torque"), What::Clipped(levels), ranges);
        }
    }

    fn bridge(&mut self, channel: (usize, &str), series: &mut [f64], (what, find): (What, Search)) {
        let ranges = find(series);
        join(series, &ranges);
        self.add(channel, what, ranges);
    }

    fn add(&mut self, (joint, quantity): (usize, &str), what: What, ranges: Vec<Range<usize>>) {
        let name = self.joints.get(joint).map_or("", |joint| &joint.name);
        self.findings.push(Finding {
            subject: format!("Joint {} (`{name}`): the {quantity}", joint + 1),
            what,
            ranges,
        });
    }
}

/// The rows that any finding touches, ascending and disjoint; each finding becomes a sentence.
pub(super) fn report(
    first_row: usize,
    findings: Vec<Finding>,
    warnings: &mut Vec<String>,
) -> Vec<Range<usize>> {
    let mut rows = Vec::new();
    for finding in findings {
        if !finding.ranges.is_empty() {
            warnings.push(sentence(first_row, &finding));
            rows.extend(finding.ranges);
        }
    }
    united(rows)
}

fn sentence(first_row: usize, finding: &Finding) -> String {
    const LISTED: usize = 3;
    let count: usize = finding.ranges.iter().map(Range::len).sum();
    let places: Vec<String> = finding
        .ranges
        .iter()
        .take(LISTED)
        .map(|range| match range.len() {
            1 => (first_row + range.start).to_string(),
            _ => format!(
                "{} to {}",
                first_row + range.start,
                first_row + range.end - 1
            ),
        })
        .collect();
    let more = if finding.ranges.len() > LISTED {
        ", ..."
    } else {
        ""
    };
    let (what, done) = finding.in_words();
    format!(
        "{} is {what} in {count} row{} ({}{more}); {done}.",
        finding.subject,
        if count == 1 { "" } else { "s" },
        places.join(", "),
    )
}

/// Runs of values that are not finite.
fn no_numbers(series: &[f64]) -> Vec<Range<usize>> {
    if all_finite(series) {
        return Vec::new();
    }
    united(
        (0..series.len())
            .filter(|&i| !series[i].is_finite())
            .map(|i| i..i + 1)
            .collect(),
    )
}

/// Samples far out of the median of five (at an end, of the five that there are): a step of dry friction or of a fast move is not, since
/// at least three of the five lie on its side.
fn spikes(series: &[f64]) -> Vec<Range<usize>> {
    if series.len() < 5 {
        return Vec::new();
    }
    let found = medians(series);
    let far = SPIKE_OF_RANGE * (found.high - found.low);
    let smooth = |i: usize| median(&series[i.clamp(2, series.len() - 3) - 2..][..5]);
    let apart = |i: usize| (series[i] - smooth(i)).abs();
    let at_ends = [0, 1, series.len() - 2, series.len() - 1].map(apart);
    // Most signals need no closer look.
    if at_ends.iter().all(|rest| *rest <= far) && found.farthest <= far {
        return Vec::new();
    }
    let rest: Vec<f64> = (0..series.len()).map(apart).collect();
    // The mean of the usual deviations, not their median: in a clean signal most are zero.
    let usual = quantile(&rest, 0.99).max(f64::MIN_POSITIVE);
    let limit = far
        .max(SPIKE_OF_SCATTER * usual)
        .max(SPIKE_OF_RESOLUTION * resolution(series));
    united(
        (0..series.len())
            .filter(|&i| rest[i] > limit)
            .map(|i| i..i + 1)
            .collect(),
    )
}

/// The smallest step between neighbours that differ; zero if none do: a sensor's resolution.
pub(crate) fn resolution(series: &[f64]) -> f64 {
    let steps = series.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let smallest = steps
        .filter(|&step| step > 0.0)
        .fold(f64::INFINITY, f64::min);
    if smallest.is_finite() { smallest } else { 0.0 }
}

/// Runs of one value that end in a jump: the joint moved on while the encoder did not.
fn stuck_runs(series: &[f64]) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut start = 0;
    for i in 1..=series.len() {
        if i < series.len() && series[i] == series[start] {
            continue;
        }
        let next = series.get(i);
        let jump = next.map_or(0.0, |next| (next - series[start]).abs());
        if i - start >= STUCK_ROWS && jump > 0.0 {
            runs.push((start + 1..i, jump));
        }
        start = i;
    }
    if runs.is_empty() {
        return Vec::new();
    }
    let steps: Vec<f64> = series
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .collect();
    let fast = quantile(&steps, 0.95);
    runs.retain(|(_, jump)| fast > 0.0 && *jump > STUCK_JUMP * fast);
    runs.into_iter().map(|(run, _)| run).collect()
}

/// Replaces the values of each range by the straight line between its neighbours; at an end of the
/// series, by the one neighbour there is.
fn join(series: &mut [f64], ranges: &[Range<usize>]) {
    for range in ranges {
        let before = range.start.checked_sub(1).map(|i| series[i]);
        let after = series.get(range.end).copied();
        let (from, to) = match (before, after) {
            (Some(before), Some(after)) => (before, after),
            (Some(one), None) | (None, Some(one)) => (one, one),
            (None, None) => return,
        };
        let steps = (range.len() + 1) as f64;
        for (k, value) in series[range.clone()].iter_mut().enumerate() {
            *value = from + (to - from) * (k + 1) as f64 / steps;
        }
    }
}

/// Ascending disjoint ranges over the same places.
pub(super) fn united(mut ranges: Vec<Range<usize>>) -> Vec<Range<usize>> {
    ranges.sort_by_key(|range| range.start);
    let mut all: Vec<Range<usize>> = Vec::new();
    for range in ranges {
        match all.last_mut() {
            Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
            _ => all.push(range),
        }
    }
    all
}

pub(super) fn quantile(values: &[f64], fraction: f64) -> f64 {
    let mut sorted = values.to_vec();
    let place = ((sorted.len().saturating_sub(1)) as f64 * fraction) as usize;
    if sorted.is_empty() {
        return 0.0;
    }
    *sorted.select_nth_unstable_by(place, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(rows: usize) -> Vec<f64> {
        (0..rows).map(|i| (0.01 * i as f64).sin()).collect()
    }

    #[test]
    fn spikes_are_found_and_steps_of_friction_are_not() {
        let mut torque: Vec<f64> = motion(2000)
            .iter()
            .map(|x| 0.1 * x + 5.0 * x.signum())
            .collect();
        assert_eq!(spikes(&torque), []);
        torque[700] *= 100.0;
        torque[1500] = -400.0;
        assert_eq!(spikes(&torque), [700..701, 1500..1501]);
    }

    #[test]
    fn last_digit_of_a_resting_encoder_is_no_spike() {
        let mut q = vec![0.2; 500];
        q[100] += 1e-4;
        q[300] -= 2e-4;
        assert_eq!(spikes(&q), []);
    }

    #[test]
    fn encoder_that_is_stuck_is_found_and_one_that_rests_is_not() {
        let mut q = motion(2000);
        let held = q[300];
        q[300..500].fill(held);
        assert_eq!(stuck_runs(&q), vec![301..500]);
        // At rest and then smoothly on its way again.
        let mut resting = vec![0.0; 400];
        resting.extend((0..600).map(|i| 1.0 - (0.01 * f64::from(i)).cos()));
        assert_eq!(stuck_runs(&resting), []);
    }

    #[test]
    fn bridge_of_a_straight_line_is_that_line() {
        let line: Vec<f64> = (0..50).map(|i| 3.0 - 0.5 * f64::from(i)).collect();
        let mut broken = line.clone();
        broken[10] = f64::NAN;
        broken[20..25].fill(f64::INFINITY);
        let ranges = no_numbers(&broken);
        assert_eq!(ranges, vec![10..11, 20..25]);
        join(&mut broken, &ranges);
        for (a, b) in broken.iter().zip(&line) {
            assert!((a - b).abs() < 1e-13);
        }
    }
}
