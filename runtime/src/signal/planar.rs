//! Many signals of equal length, and how a filter reads them: a few at a time, side by side.

use std::ops::Range;

use pulp::Simd;
use wide::f64x2;

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

    /// The samples `range` of a signal, in the pieces that they are stored in; nothing of a signal
    /// that there is not.
    fn pieces(&self, signal: usize, range: Range<usize>) -> impl Iterator<Item = &[f64]>;

    /// Writes `signal` into one lane of `out`, which has as many places as there are samples.
    fn copy_to_lane(&self, signal: usize, lane: usize, out: &mut [[f64; LANES]]) {
        let mut places = out.iter_mut();
        for piece in self.pieces(signal, 0..self.samples()) {
            for (value, place) in piece.iter().zip(places.by_ref()) {
                place[lane] = *value;
            }
        }
    }
}

impl Signals for [Vec<f64>] {
    fn count(&self) -> usize {
        self.len()
    }

    fn samples(&self) -> usize {
        self.iter().map(Vec::len).min().unwrap_or(0)
    }

    fn pieces(&self, signal: usize, range: Range<usize>) -> impl Iterator<Item = &[f64]> {
        self.get(signal).and_then(|s| s.get(range)).into_iter()
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

    fn pieces(&self, signal: usize, range: Range<usize>) -> impl Iterator<Item = &[f64]> {
        let numbered = self.blocks.iter().enumerate();
        numbered.filter_map(move |(number, block)| {
            let length = block.len() / self.count.max(1);
            let at = |sample: usize| sample.saturating_sub(number * BLOCK).min(length);
            let own = signal * length;
            block.get(own + at(range.start)..own + at(range.end))
        })
    }
}

/// A stretch of signals.
#[derive(Clone, Debug)]
pub(super) struct Stretch<'a, S: ?Sized> {
    pub signals: &'a S,
    pub range: Range<usize>,
}

impl<S: Signals + ?Sized> Signals for Stretch<'_, S> {
    fn count(&self) -> usize {
        self.signals.count()
    }

    fn samples(&self) -> usize {
        self.range.len()
    }

    fn pieces(&self, signal: usize, range: Range<usize>) -> impl Iterator<Item = &[f64]> {
        let start = self.range.start;
        let range = start + range.start..start + range.end;
        self.signals.pieces(signal, range)
    }
}

/// From signal after signal (planar, `length` samples each) to sample after sample, a register of
/// signals side by side; lanes without a signal keep what they hold.
#[inline(always)]
pub(super) fn side_by_side<S: Simd>(signals: &[f64], length: usize, samples: &mut [f64]) {
    let lanes = S::F64_LANES;
    let full = signals.len() == lanes * length;
    let done = match lanes {
        8 if full => turned::<8>(signals, length, samples),
        4 if full => turned::<4>(signals, length, samples),
        _ => 0,
    };
    for (lane, signal) in signals.chunks_exact(length).enumerate() {
        let places = samples[done * lanes..].iter_mut().skip(lane).step_by(lanes);
        places
            .zip(&signal[done..])
            .for_each(|(place, x)| *place = *x);
    }
}

/// The same for `N` signals, two samples of two of them at a time, so that neighbours are written
/// together; returns for how many samples.
#[inline(always)]
fn turned<const N: usize>(signals: &[f64], length: usize, samples: &mut [f64]) -> usize {
    let half = length / 2;
    let twos: [&[[f64; 2]]; N] = std::array::from_fn(|lane| {
        let signal = &signals[lane * length..][..length];
        &signal.as_chunks().0[..half]
    });
    let rows = &mut samples.as_chunks_mut::<N>().0.as_chunks_mut().0[..half];
    for (k, [first, second]) in rows.iter_mut().enumerate() {
        for lane in (0..N).step_by(2) {
            let square = [twos[lane][k], twos[lane + 1][k]].map(f64x2::from);
            let [a, b] = f64x2::transpose(square).map(f64x2::to_array);
            first[lane..lane + 2].copy_from_slice(&a);
            second[lane..lane + 2].copy_from_slice(&b);
        }
    }
    2 * half
}
