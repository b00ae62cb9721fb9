//! From chunks of states to lanes and back: the driver of emitted models.

use wide::f64x4;

use crate::lane::Lane;
use crate::model::States;

/// Samples side by side in one call of an emitted function.
pub type Block = f64x4;

/// Lanes in a [`Block`].
const WIDTH: usize = 4;

/// Takes the values of one block of samples to their places in the signals.
#[derive(Debug)]
pub struct Sink<'a> {
    signals: &'a mut [f64],
    stride: usize,
    start: usize,
    count: usize,
}

impl Sink<'_> {
    /// Stores the entries at `places`, (row, column), as signals 0, 1, ...
    #[inline]
    pub fn store<const C: usize>(&mut self, rows: &[[Block; C]], places: &[(usize, usize)]) {
        for (signal, &(row, column)) in places.iter().enumerate() {
            let values = rows[row][column].to_array();
            let at = signal * self.stride + self.start;
            self.signals[at..at + self.count].copy_from_slice(&values[..self.count]);
        }
    }
}

/// Calls `evaluate` on each block of samples of a chunk of states of N joints.
///
/// `signals` is as in [`crate::model::IdentificationModel::evaluate`]. The last block is filled up
/// with its own last sample, so that no lane ever computes on undefined numbers.
pub fn run<const N: usize>(
    states: &States<'_>,
    signals: &mut [f64],
    mut evaluate: impl FnMut([Block; N], [Block; N], [Block; N], &mut Sink<'_>),
) {
    run_with_slip(states, signals, |q, qd, qdd, _, sink| {
        evaluate(q, qd, qdd, sink);
    });
}

/// [`run`] for joints with a presliding state, which comes after the acceleration.
pub fn run_with_slip<const N: usize>(
    states: &States<'_>,
    signals: &mut [f64],
    mut evaluate: impl FnMut([Block; N], [Block; N], [Block; N], [Block; N], &mut Sink<'_>),
) {
    let mut start = 0;
    while start < states.len {
        let count = WIDTH.min(states.len - start);
        let load = |series: &[f64]| -> [Block; N] {
            std::array::from_fn(|joint| {
                let values = &series[joint * states.len..][start..start + count];
                let last = values[count - 1];
                let mut lanes = [last; WIDTH];
                lanes[..count].copy_from_slice(values);
                Block::from(lanes)
            })
        };
        let (q, qd, qdd) = (load(states.q), load(states.qd), load(states.qdd));
        let slip = match states.slip.is_empty() {
            true => qd.map(Lane::sign),
            false => load(states.slip),
        };
        let mut sink = Sink {
            signals,
            stride: states.len,
            start,
            count,
        };
        evaluate(q, qd, qdd, slip, &mut sink);
        start += count;
    }
}

const _: () = {
    const fn is_lane<T: Lane>() {}
    is_lane::<Block>();
};
