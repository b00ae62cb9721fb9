//! Decimation of signals that come chunk by chunk, in a memory that does not grow with the log.

use std::collections::VecDeque;

use pulp::Arch;

use super::modal::{Modes, PAIRS, State};

/// Sums over one pole pair of a signal are kept as one row of eight numbers, so that they fill
/// the registers of any machine; multiplications and additions are not fused, so that all machines
/// agree to the bit.
type Lanes = [f64; 2 * PAIRS];

/// The zero-phase low-pass of [`super::Decimator`] and its decimation, over many signals whose
/// samples come chunk by chunk: signals in, rows of kept samples out as soon as the samples after
/// them are known. Rows near where it began, or near where it ended, lack the samples beyond: they
/// are for [`super::Decimator`], which knows edges.
#[derive(Clone, Debug)]
pub struct Running {
    ratio: usize,
    signals: usize,
    table: Table,
    /// Per signal: \\( \sum_{m \ge 0} p^m x_{n-m} \\) at the last row.
    past: Vec<Lanes>,
    /// Rows on their way out: what the past gives, one value per signal.
    near: VecDeque<Vec<f64>>,
    /// Of each row but the last: the weighted sums of the samples up to the next row.
    ahead: VecDeque<Vec<Lanes>>,
    /// Buffers of rows that went out.
    spare: Vec<(Vec<f64>, Vec<Lanes>)>,
}

/// What the sums are weighted with.
#[derive(Clone, Debug)]
struct Table {
    /// \\( (p^{n-1-i} \pm p^i) / 2 \\) for the first half of the samples between two rows, whose
    /// other half mirrors them.
    even: Vec<Lanes>,
    odd: Vec<Lanes>,
    /// \\( p^{n_d} \\), by which a sum ages from row to row.
    aging: State,
    /// \\( p \\): the future begins one sample after a row.
    pole: State,
    /// Weights of the modes in the result, the imaginary parts with the sign of
    /// \\( \mathrm{Re}\,(w z) \\).
    weights: Lanes,
    direct: f64,
}

impl Running {
    /// Decimation by `ratio` of `signals` signals. Without `modes` there is no low-pass.
    pub(super) fn new(modes: Option<&Modes>, ratio: usize, signals: usize) -> Self {
        Running {
            ratio,
            signals,
            table: Table::new(modes, ratio),
            past: vec![[0.0; 2 * PAIRS]; signals],
            near: VecDeque::from([vec![0.0; signals]]),
            ahead: VecDeque::new(),
            spare: Vec::new(),
        }
    }

    /// Takes the samples of the next `rows` rows: of each signal (planar) those after the last row
    /// so far up to the last of the new rows, `rows * ratio`.
    pub fn take(&mut self, chunk: &[f64], rows: usize) {
        for _ in 0..rows {
            let (near, ahead) = self.spare.pop().unwrap_or_default();
            self.near.push_back(near);
            self.ahead.push_back(ahead);
        }
        Arch::new().dispatch(|| self.advance(chunk, rows));
    }

    #[inline(always)]
    fn advance(&mut self, chunk: &[f64], rows: usize) {
        let length = rows * self.ratio;
        let first = self.ahead.len() - rows;
        let news = self
            .near
            .range_mut(first + 1..)
            .zip(self.ahead.range_mut(first..));
        for (row, (near, ahead)) in news.enumerate() {
            near.resize(self.signals, 0.0);
            ahead.resize(self.signals, [0.0; 2 * PAIRS]);
            let samples = row * self.ratio..(row + 1) * self.ratio;
            let outputs = near.iter_mut().zip(ahead.iter_mut());
            for (signal, (near, ahead)) in outputs.enumerate() {
                let x = &chunk[signal * length..][samples.clone()];
                let (before, after) = self.table.sums(x);
                let past = &mut self.past[signal];
                *past = plus(before, rotated(&self.table.aging, past));
                *near = self.table.direct * x[self.ratio - 1] + weighted(&self.table.weights, past);
                *ahead = after;
            }
        }
    }

    /// Rows that are on their way and have at least `look_ahead` rows after them.
    pub fn ready(&self, look_ahead: usize) -> usize {
        self.ahead.len().saturating_sub(look_ahead)
    }

    /// Takes out the first `rows` rows, the very first of which (where it began) means nothing:
    /// signal by signal (planar), `rows` values each.
    pub fn give(&mut self, rows: usize, out: &mut Vec<f64>) {
        out.clear();
        out.resize(rows * self.signals, 0.0);
        Arch::new().dispatch(|| self.look_back(rows, out));
        for _ in 0..rows {
            self.spare
                .extend(self.near.pop_front().zip(self.ahead.pop_front()));
        }
    }

    #[inline(always)]
    fn look_back(&self, rows: usize, out: &mut [f64]) {
        let mut future = vec![[0.0; 2 * PAIRS]; self.signals];
        for (row, (near, ahead)) in self.near.iter().zip(&self.ahead).enumerate().rev() {
            for (signal, (future, ahead)) in future.iter_mut().zip(ahead).enumerate() {
                let aged = rotated(&self.table.aging, future);
                *future = plus(rotated(&self.table.pole, ahead), aged);
                if row < rows {
                    let from_future = weighted(&self.table.weights, future);
                    out[signal * rows + row] = near[signal] + from_future;
                }
            }
        }
    }
}

impl Table {
    fn new(modes: Option<&Modes>, ratio: usize) -> Self {
        let half = ratio.div_ceil(2);
        let Some(modes) = modes else {
            return Table {
                even: vec![[0.0; 2 * PAIRS]; half],
                odd: vec![[0.0; 2 * PAIRS]; half],
                aging: State::default(),
                pole: State::default(),
                weights: [0.0; 2 * PAIRS],
                direct: 1.0,
            };
        };
        let pair = |i: usize, sign: f64| -> Lanes {
            let (later, sooner) = (modes.powers(ratio - 1 - i), modes.powers(i));
            std::array::from_fn(|lane| {
                let (part, k) = (lane / PAIRS, lane % PAIRS);
                0.5 * (later[part][k] + sign * sooner[part][k])
            })
        };
        let weights = std::array::from_fn(|lane| match lane / PAIRS {
            0 => modes.weights[lane].re,
            _ => -modes.weights[lane - PAIRS].im,
        });
        Table {
            even: (0..half).map(|i| pair(i, 1.0)).collect(),
            odd: (0..half).map(|i| pair(i, -1.0)).collect(),
            aging: modes.powers(ratio),
            pole: modes.powers(1),
            weights,
            direct: modes.direct,
        }
    }

    /// \\( \sum_i p^{n-1-i} x_i \\) and \\( \sum_i p^i x_i \\).
    #[expect(
        clippy::needless_range_loop,
        reason = "the index names a lane of several arrays"
    )]
    #[inline(always)]
    fn sums(&self, x: &[f64]) -> (Lanes, Lanes) {
        let (mut even, mut odd) = ([0.0; 2 * PAIRS], [0.0; 2 * PAIRS]);
        let half = x.len() / 2;
        let pairs = x[..half].iter().zip(x.iter().rev());
        for ((a, b), (e, o)) in pairs.zip(self.even.iter().zip(&self.odd)) {
            let (sum, difference) = (a + b, a - b);
            for lane in 0..2 * PAIRS {
                even[lane] += e[lane] * sum;
                odd[lane] += o[lane] * difference;
            }
        }
        if x.len() % 2 == 1 {
            for lane in 0..2 * PAIRS {
                even[lane] += self.even[half][lane] * x[half];
            }
        }
        let minus = std::array::from_fn(|lane| even[lane] - odd[lane]);
        (plus(even, odd), minus)
    }
}

/// The products of complex numbers with those of `state`.
#[inline(always)]
fn rotated(by: &State, state: &Lanes) -> Lanes {
    let mut product = [0.0; 2 * PAIRS];
    for k in 0..PAIRS {
        let (re, im) = (state[k], state[k + PAIRS]);
        product[k] = by[0][k] * re - by[1][k] * im;
        product[k + PAIRS] = by[0][k] * im + by[1][k] * re;
    }
    product
}

#[inline(always)]
fn plus(a: Lanes, b: Lanes) -> Lanes {
    std::array::from_fn(|lane| a[lane] + b[lane])
}

/// Sum of the products, in a fixed order that leaves lanes independent as long as possible.
#[inline(always)]
fn weighted(weights: &Lanes, state: &Lanes) -> f64 {
    let products: Lanes = std::array::from_fn(|lane| weights[lane] * state[lane]);
    let half: [f64; PAIRS] = std::array::from_fn(|k| products[k] + products[k + PAIRS]);
    (half[0] + half[2]) + (half[1] + half[3])
}

#[cfg(test)]
mod tests {
    use super::super::Decimator;
    use crate::settings::Edges;

    const LEN: usize = 24_000;

    fn signals() -> Vec<Vec<f64>> {
        let wave = |s: usize, i: usize| {
            let noise = ((i * 7919 + s * 104_729) % 1009) as f64 / 1009.0;
            3.0 + (0.002 * (s + 1) as f64 * i as f64).sin() + 0.2 * noise
        };
        (0..3)
            .map(|s| (0..LEN).map(|i| wave(s, i)).collect())
            .collect()
    }

    /// All rows of a running decimation, fed in chunks of `rows` rows, first row meaningless.
    fn running(decimator: &Decimator, signals: &[Vec<f64>], rows: usize) -> Vec<Vec<f64>> {
        let (kept, ratio) = (decimator.kept(LEN), decimator.ratio());
        let mut running = decimator.running(signals.len());
        let mut all = vec![Vec::new(); signals.len()];
        let (mut at, mut out) = (0, Vec::new());
        let mut give = |running: &mut super::Running, rows: usize| {
            running.give(rows, &mut out);
            for (all, part) in all.iter_mut().zip(out.chunks(rows.max(1))) {
                all.extend(part);
            }
        };
        while kept[at] + rows * ratio < LEN {
            let samples = kept[at] + 1..kept[at] + rows * ratio + 1;
            let chunk: Vec<f64> = signals
                .iter()
                .flat_map(|s| s[samples.clone()].to_vec())
                .collect();
            running.take(&chunk, rows);
            at += rows;
            let ready = running.ready(decimator.look_ahead());
            give(&mut running, ready);
        }
        let rest = running.ready(0);
        give(&mut running, rest);
        all
    }

    #[test]
    fn running_decimation_is_that_of_the_whole_log_away_from_its_edges() {
        let signals = signals();
        for (ratio, edges, chunk) in [
            (10, Edges::Scipy, 40),
            (7, Edges::Matlab, 11),
            (1, Edges::Scipy, 300),
        ] {
            let decimator = Decimator::new(ratio, 1000.0, edges).unwrap();
            let kept = decimator.kept(LEN);
            let whole = decimator.values(signals.as_slice(), &kept).unwrap();
            let parts = running(&decimator, &signals, chunk);
            let far = decimator.look_ahead() + 1;
            for (whole, part) in whole.iter().zip(&parts) {
                assert!(part.len() > 2 * far + 100, "{} rows", part.len());
                for row in far..part.len() - far {
                    let error = (whole[row] - part[row]).abs() / 3.0;
                    assert!(error < 2e-13, "1 in {ratio}, row {row}: {error:e}");
                }
            }
        }
    }
}
