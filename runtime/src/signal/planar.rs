//! Many signals of equal length, and how a filter reads them: a few at a time, side by side.

/// Signals that a filter treats at once.
pub const LANES: usize = 8;

/// Samples that a [`Planar`] keeps together.
pub const BLOCK: usize = 256;

/// Signals of equal length that can be laid side by side.
pub trait Signals: Sync {
    /// Number of signals.
    fn count(&self) -> usize;

    /// Samples of each signal.
    fn samples(&self) -> usize;

    /// Writes `signal` into one lane of `out`, which has as many places as there are samples.
    fn copy_to_lane(&self, signal: usize, lane: usize, out: &mut [[f64; LANES]]);
}

impl Signals for [Vec<f64>] {
    fn count(&self) -> usize {
        self.len()
    }

    fn samples(&self) -> usize {
        self.iter().map(Vec::len).min().unwrap_or(0)
    }

    fn copy_to_lane(&self, signal: usize, lane: usize, out: &mut [[f64; LANES]]) {
        let Some(series) = self.get(signal) else {
            return;
        };
        for (place, value) in out.iter_mut().zip(series) {
            place[lane] = *value;
        }
    }
}

/// Signals computed block by block: within a block of `m` samples, `signal` at sample `i` of the
/// block is `block[signal * m + i]`. All blocks but the last have [`BLOCK`] samples.
#[derive(Clone, Debug)]
pub struct Planar {
    /// Number of signals.
    pub count: usize,
    /// Samples of each signal.
    pub samples: usize,
    /// The blocks, in the order of time.
    pub blocks: Vec<Vec<f64>>,
}

impl Signals for Planar {
    fn count(&self) -> usize {
        self.count
    }

    fn samples(&self) -> usize {
        self.samples
    }

    fn copy_to_lane(&self, signal: usize, lane: usize, out: &mut [[f64; LANES]]) {
        for (block, places) in self.blocks.iter().zip(out.chunks_mut(BLOCK)) {
            let length = places.len();
            for (place, value) in places.iter_mut().zip(block.iter().skip(signal * length)) {
                place[lane] = *value;
            }
        }
    }
}
