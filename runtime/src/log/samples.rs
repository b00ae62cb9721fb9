//! Where samples come from: a recording in memory, or a log that stays on disk.

use std::ops::Range;

use super::{LogError, Recording};

/// The samples of a log on a uniform time grid, given out window by window, so that what works on
/// them needs no more memory for a long log than for a short one.
pub trait Samples: Sync {
    /// How the user named the log.
    fn name(&self) -> &str;

    /// Sampling rate, Hz.
    fn rate_hz(&self) -> f64;

    /// Number of samples.
    fn len(&self) -> usize;

    /// Whether there are no samples.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Samples that cannot be believed; see [`Recording::doubtful`].
    fn doubtful(&self) -> &[Range<usize>];

    /// Smallest and largest position of each joint, if known without a look at the samples.
    fn ranges(&self) -> Option<&[(f64, f64)]> {
        None
    }

    /// What was noticed while reading.
    fn warnings(&self) -> &[String];

    /// The samples `range` as a recording of their own, with the name of the whole; samples beyond
    /// the end are left out.
    ///
    /// # Errors
    /// [`LogError`] if they cannot be read from where they are kept.
    fn window(&self, range: Range<usize>) -> Result<Recording, LogError>;
}

impl Samples for Recording {
    fn name(&self) -> &str {
        &self.name
    }

    fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    fn len(&self) -> usize {
        self.len
    }

    fn doubtful(&self) -> &[Range<usize>] {
        &self.doubtful
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn window(&self, range: Range<usize>) -> Result<Recording, LogError> {
        let range = range.start.min(self.len)..range.end.min(self.len);
        let cut = |series: &Vec<f64>| series[range.clone()].to_vec();
        let all = |series: &Vec<Vec<f64>>| series.iter().map(cut).collect();
        Ok(Recording {
            name: self.name.clone(),
            stem: self.stem.clone(),
            rate_hz: self.rate_hz,
            start: self.start + range.start as f64 / self.rate_hz,
            len: range.len(),
            q: all(&self.q),
            qd: self.qd.as_ref().map(all),
            tau: self.tau.as_ref().map(all),
            doubtful: within(&self.doubtful, &range),
            stamps: Vec::new(),
            warnings: Vec::new(),
        })
    }
}

/// The parts of ascending disjoint `ranges` inside `window`, counted from its start.
pub(crate) fn within(ranges: &[Range<usize>], window: &Range<usize>) -> Vec<Range<usize>> {
    let first = ranges.partition_point(|range| range.end <= window.start);
    let inside = ranges[first..]
        .iter()
        .take_while(|range| range.start < window.end);
    let shifted = |i: usize| i.clamp(window.start, window.end) - window.start;
    inside
        .map(|range| shifted(range.start)..shifted(range.end))
        .collect()
}
