//! Parallel decimation: one low-pass for all signals, then one sample in n_d.

use std::ops::Range;

use rayon::prelude::*;

use super::SignalError;
use super::design::chebyshev1;
use super::difference::differentiate;
use super::modal::Modes;
use super::planar::{LANES, Signals, Stretch};
use super::running::Running;
use super::zero_phase::ZeroPhase;
use crate::settings::{Derivatives, Edges};

/// Order of the low-pass, as in Matlab's and SciPy's `decimate`.
const ORDER: usize = 8;

/// Pass-band ripple, dB, as in Matlab's and SciPy's `decimate`.
const RIPPLE_DB: f64 = 0.05;

/// Cut-off of the low-pass relative to the half rate after decimation, as in both.
const CUT_OFF: f64 = 0.8;

/// Beyond this ratio the low-pass loses its accuracy, and no log is long enough.
const LARGEST_RATIO: usize = 10_001;

/// Signals so many times as long as the low-pass remembers have enough samples that no edge reaches.
const LONG: usize = 6;

/// Rows that [`Running`] takes at once, of few signals: their samples stay in cache.
const ROWS: usize = 16;

/// The operator `fpd` of Gautier 1996, section 6.2: a zero-phase Chebyshev I low-pass of order 8
/// with 0.05 dB ripple, cut-off \\( \omega_{fp} = 0.8 (\omega_c / 2) / n_d \\), at the full rate,
/// then one sample in `n_d`. A ratio of 1 leaves signals unchanged.
#[derive(Clone, Debug)]
pub struct Decimator {
    filter: Option<ZeroPhase>,
    modes: Option<Modes>,
    ratio: usize,
    edges: Edges,
    rate_hz: f64,
    derivatives: Derivatives,
}

impl Decimator {
    /// Decimation by `ratio` of signals sampled at `rate_hz`.
    ///
    /// # Errors
    /// [`SignalError::Ratio`] if the ratio is zero or beyond reason.
    pub fn new(ratio: usize, rate_hz: f64, edges: Edges) -> Result<Self, SignalError> {
        let cascade = match ratio {
            1 => None,
            0 | LARGEST_RATIO.. => {
                return Err(SignalError::Ratio {
                    ratio,
                    largest: LARGEST_RATIO - 1,
                });
            }
            _ => Some(chebyshev1(ORDER, RIPPLE_DB, CUT_OFF / ratio as f64, 2.0)?),
        };
        Ok(Decimator {
            modes: cascade.as_ref().and_then(Modes::of),
            filter: cascade.map(|cascade| ZeroPhase::new(cascade, ORDER, edges)),
            ratio,
            edges,
            rate_hz,
            derivatives: Derivatives::Central,
        })
    }

    /// The same with another way to differentiate.
    pub fn differentiating(self, derivatives: Derivatives) -> Self {
        Decimator {
            derivatives,
            ..self
        }
    }

    /// How signals are differentiated.
    pub fn derivatives(&self) -> Derivatives {
        self.derivatives
    }

    /// Cut-off of the low-pass, Hz.
    pub fn cutoff_hz(&self) -> f64 {
        CUT_OFF * self.rate_hz / (2.0 * self.ratio as f64)
    }

    /// Which samples of a signal of `samples` samples are kept.
    pub fn kept(&self, samples: usize) -> Vec<usize> {
        let first = match self.edges {
            Edges::Scipy => 0,
            // nbeg = r - (r*ceil(n/r) - n), counted from 1, keeps the last sample.
            Edges::Matlab => samples.saturating_sub(1) % self.ratio,
        };
        (first..samples).step_by(self.ratio).collect()
    }

    /// Samples away from an edge after which the low-pass has forgotten it, to rounding.
    pub fn memory(&self) -> usize {
        self.filter.as_ref().map_or(1, ZeroPhase::memory)
    }

    /// Decimation ratio.
    pub fn ratio(&self) -> usize {
        self.ratio
    }

    /// Rows away from an edge after which the low-pass has forgotten it, to rounding.
    pub fn look_ahead(&self) -> usize {
        self.memory().div_ceil(self.ratio) + 1
    }

    /// The same filter and decimation for `signals` signals whose samples come chunk by chunk.
    pub fn running(&self, signals: usize) -> Running {
        Running::new(self.modes.as_ref(), self.ratio, signals)
    }

    /// The low-passed signals at the samples `kept`.
    ///
    /// # Errors
    /// [`SignalError::TooShort`].
    pub fn values<S: Signals + ?Sized>(
        &self,
        signals: &S,
        kept: &[usize],
    ) -> Result<Vec<Vec<f64>>, SignalError> {
        match self.far(signals.samples(), kept) {
            Some(far) => self.beyond_edges(signals, kept, far),
            None => self.read(signals, kept, |_| (), |_| ()),
        }
    }

    /// The rows that no edge of long signals reaches, of those at the samples `kept`.
    fn far(&self, samples: usize, kept: &[usize]) -> Option<Range<usize>> {
        let memory = self.memory();
        let regular = kept.windows(2).all(|pair| pair[1] == pair[0] + self.ratio);
        if self.modes.is_none() || !regular || samples < LONG * memory {
            return None;
        }
        let row = |sample: usize| kept.partition_point(|kept| *kept < sample);
        let far = row(memory.max(self.ratio))..row(samples - memory);
        (!far.is_empty()).then_some(far)
    }

    /// [`Decimator::values`] of long signals: the rows `far` from all edges by the modes of the
    /// low-pass, those near an edge by the low-pass along the samples that it remembers.
    fn beyond_edges<S: Signals + ?Sized>(
        &self,
        signals: &S,
        kept: &[usize],
        far: Range<usize>,
    ) -> Result<Vec<Vec<f64>>, SignalError> {
        let (samples, memory) = (signals.samples(), self.memory());
        let near = |rows: Range<usize>, range: Range<usize>| {
            let local: Vec<usize> = kept[rows].iter().map(|k| k - range.start).collect();
            self.read(&Stretch { signals, range }, &local, |_| (), |_| ())
        };
        let (first, last) = (kept[far.start], kept[far.end - 1]);
        let mut rows = near(0..far.start, 0..first + memory)?;
        let inner = self.inner(signals, kept[far.start], far.len());
        let after = near(far.end..kept.len(), last - memory..samples)?;
        for (row, (inner, after)) in rows.iter_mut().zip(inner.into_iter().zip(after)) {
            row.extend(inner);
            row.extend(after);
        }
        Ok(rows)
    }

    /// `rows` rows from the sample `first` on, by what the low-pass remembers away from all edges.
    fn inner<S: Signals + ?Sized>(&self, signals: &S, first: usize, rows: usize) -> Vec<Vec<f64>> {
        let samples_after = signals.samples() - 1 - first;
        let reach = self.memory().div_ceil(self.ratio);
        let before = reach.min(first / self.ratio);
        let all = (before + rows - 1 + reach).min(before + samples_after / self.ratio);
        let start = first - before * self.ratio + 1;
        let of_group = |group: usize| -> Vec<Vec<f64>> {
            let numbers = group * LANES..signals.count().min((group + 1) * LANES);
            let mut running = self.running(numbers.len());
            let mut chunk = Vec::with_capacity(LANES * ROWS * self.ratio);
            for taken in (0..all).step_by(ROWS) {
                let more = ROWS.min(all - taken);
                let from = start + taken * self.ratio;
                chunk.clear();
                for number in numbers.clone() {
                    let pieces = signals.pieces(number, from..from + more * self.ratio);
                    pieces.for_each(|piece| chunk.extend_from_slice(piece));
                }
                running.take(&chunk, more);
            }
            let mut out = Vec::new();
            running.give(all, &mut out);
            // The row at which all begins never comes out.
            let wanted = before - 1..before - 1 + rows;
            let signals = out.chunks_exact(all);
            signals.map(|rows| rows[wanted.clone()].to_vec()).collect()
        };
        let groups = 0..signals.count().div_ceil(LANES);
        groups.into_par_iter().flat_map_iter(of_group).collect()
    }

    /// The low-passed derivatives of the signals at the samples `kept`, per second; the
    /// difference is taken at the full rate.
    ///
    /// Difference and low-pass commute (Gautier 1996, eq. 19), except near an edge, where the
    /// signal is extended. With [`Edges::Matlab`] the low-pass comes first, as in the paper, and
    /// the rows near the edge are to be trimmed. With [`Edges::Scipy`], where nothing is trimmed
    /// after the low-pass, the difference comes first: then a derivative is extended in the way
    /// torque is, and the equations hold up to the last row.
    ///
    /// # Errors
    /// [`SignalError::TooShort`].
    pub fn rates<S: Signals + ?Sized>(
        &self,
        signals: &S,
        kept: &[usize],
    ) -> Result<Vec<Vec<f64>>, SignalError> {
        let difference =
            |group: &mut [[f64; LANES]]| differentiate(group, self.rate_hz, self.derivatives);
        match self.edges {
            Edges::Matlab => self.read(signals, kept, from_zero, difference),
            Edges::Scipy => self.read(signals, kept, difference, |_| ()),
        }
    }

    /// Passes groups of signals through `before`, the low-pass and `after`, and keeps samples.
    fn read<S: Signals + ?Sized>(
        &self,
        signals: &S,
        kept: &[usize],
        before: impl Fn(&mut [[f64; LANES]]) + Sync,
        after: impl Fn(&mut [[f64; LANES]]) + Sync,
    ) -> Result<Vec<Vec<f64>>, SignalError> {
        let read = |group: &mut [[f64; LANES]], width: usize| {
            after(group);
            let lane = |lane| kept.iter().map(|i| group[*i][lane]).collect();
            (0..width).map(lane).collect()
        };
        match &self.filter {
            Some(filter) => filter.groups(signals, before, read),
            None => Ok(unfiltered(signals, before, read)),
        }
    }
}

/// Lets every signal start at zero, so that the derivative of a constant is zero and not the
/// rounding of the low-pass times the sampling rate.
fn from_zero(group: &mut [[f64; LANES]]) {
    let first = group.first().copied().unwrap_or([0.0; LANES]);
    for sample in group {
        *sample = std::array::from_fn(|lane| sample[lane] - first[lane]);
    }
}

/// Hands all signals to `read` as they are after `prepare`.
fn unfiltered<S: Signals + ?Sized, T>(
    signals: &S,
    prepare: impl Fn(&mut [[f64; LANES]]),
    read: impl Fn(&mut [[f64; LANES]], usize) -> Vec<T>,
) -> Vec<T> {
    let mut group = vec![[0.0; LANES]; signals.samples()];
    let mut all = Vec::with_capacity(signals.count());
    for first in (0..signals.count()).step_by(LANES) {
        let width = LANES.min(signals.count() - first);
        for lane in 0..width {
            signals.copy_to_lane(first + lane, lane, &mut group);
        }
        prepare(&mut group);
        all.extend(read(&mut group, width));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::super::central_difference;
    use super::*;

    #[test]
    fn kept_samples_follow_matlab_or_scipy() {
        let matlab = Decimator::new(10, 100.0, Edges::Matlab).unwrap();
        assert_eq!(matlab.kept(4200).first(), Some(&9));
        assert_eq!(matlab.kept(4200).len(), 420);
        // EMPS: 24 792 samples, nbeg = 2.
        assert_eq!(matlab.kept(24_792).first(), Some(&1));
        assert_eq!(matlab.kept(24_792).len(), 2480);
        assert_eq!(matlab.kept(1), [0]);
        assert!(matlab.kept(0).is_empty());
        let scipy = Decimator::new(10, 100.0, Edges::Scipy).unwrap();
        assert_eq!(scipy.kept(4200).first(), Some(&0));
        assert_eq!(scipy.kept(4201).len(), 421);
    }

    #[test]
    fn a_ratio_of_one_changes_nothing() {
        let series = vec![vec![1.0, -2.0, 3.5]; 11];
        let decimator = Decimator::new(1, 100.0, Edges::Scipy).unwrap();
        assert_eq!(
            decimator.values(series.as_slice(), &[0, 1, 2]).unwrap(),
            series
        );
        let rates = decimator.rates(series.as_slice(), &[0, 1, 2]).unwrap();
        assert_eq!(rates[10], central_difference(&series[10], 100.0));
    }

    #[test]
    fn slow_signals_pass_and_fast_ones_do_not() {
        let wave = |hz: f64| -> Vec<f64> {
            (0..3000)
                .map(|i| (std::f64::consts::TAU * hz * f64::from(i) / 1000.0).sin())
                .collect()
        };
        let decimator = Decimator::new(10, 1000.0, Edges::Scipy).unwrap();
        assert_eq!(decimator.cutoff_hz(), 40.0);
        let kept = decimator.kept(3000);
        let waves = [wave(5.0), wave(80.0)];
        let rows = decimator.values(waves.as_slice(), &kept).unwrap();
        let middle = 50..250;
        for (row, i) in middle.clone().zip(kept.into_iter().skip(middle.start)) {
            assert!((rows[0][row] - wave(5.0)[i]).abs() < 0.012);
            assert!(rows[1][row].abs() < 1e-4);
        }
    }

    #[test]
    fn long_signals_are_decimated_like_short_ones() {
        let wave = |s: usize| -> Vec<f64> {
            let noise = |i: usize| ((i * 7919 + s * 104_729) % 1009) as f64 / 1009.0;
            (0..30_011)
                .map(|i| (1e-3 * (i * (s + 1)) as f64).sin() + noise(i))
                .collect()
        };
        let series: Vec<Vec<f64>> = (0..11).map(wave).collect();
        for (ratio, edges) in [(10, Edges::Scipy), (7, Edges::Matlab)] {
            let decimator = Decimator::new(ratio, 1000.0, edges).unwrap();
            let all = decimator.kept(series[0].len());
            for kept in [&all[..], &all[90..all.len() - 333]] {
                assert!(decimator.far(series[0].len(), kept).is_some());
                let rows = decimator.values(series.as_slice(), kept).unwrap();
                let whole = decimator.read(series.as_slice(), kept, |_| (), |_| ());
                for (rows, whole) in rows.iter().zip(whole.unwrap()) {
                    assert_eq!(rows.len(), whole.len());
                    let mut pairs = rows.iter().zip(&whole);
                    assert!(pairs.all(|(a, b)| (a - b).abs() < 1e-12));
                }
            }
        }
    }

    #[test]
    fn differentiation_and_low_pass_commute_away_from_the_edges() {
        let wave: Vec<f64> = (0..6000).map(|i| (0.02 * f64::from(i)).sin()).collect();
        let decimator = Decimator::new(8, 100.0, Edges::Matlab).unwrap();
        let kept = decimator.kept(wave.len());
        let rates = decimator.rates(std::slice::from_ref(&wave), &kept).unwrap();
        let slope = [central_difference(&wave, 100.0)];
        let values = decimator.values(slope.as_slice(), &kept).unwrap();
        for row in 250..500 {
            assert!((rates[0][row] - values[0][row]).abs() < 1e-9);
        }
    }

    #[test]
    fn a_constant_has_no_derivative() {
        let constant = [vec![0.123456789; 3000]];
        for edges in [Edges::Matlab, Edges::Scipy] {
            let decimator = Decimator::new(7, 5000.0, edges).unwrap();
            let rates = decimator
                .rates(constant.as_slice(), &decimator.kept(3000))
                .unwrap();
            assert!(rates[0].iter().all(|rate| *rate == 0.0));
        }
    }

    #[test]
    fn ratios_beyond_reason_are_errors() {
        for ratio in [0, 10_001, usize::MAX] {
            let error = Decimator::new(ratio, 100.0, Edges::Matlab).unwrap_err();
            assert_eq!(
                error,
                SignalError::Ratio {
                    ratio,
                    largest: 10_000
                }
            );
        }
    }
}
