//! Forward and backward filtering: no phase shift, edges extended oddly.

use rayon::prelude::*;

use super::SignalError;
use super::cascade::Cascade;
use super::planar::{LANES, Signals};
use crate::settings::Edges;

/// A filter run forward, then backward, over a signal extended oddly about its two ends, each
/// pass starting in the steady state (Matlab's `filtfilt`, SciPy's `sosfiltfilt`).
#[derive(Clone, Debug, PartialEq)]
pub struct ZeroPhase {
    cascade: Cascade,
    /// Samples added at either end.
    extension: usize,
}

impl ZeroPhase {
    /// Zero-phase filter of a cascade of the given order, with the extension that `edges` asks
    /// for: three times the order (Matlab), or
    /// `3 * (2 * sections + 1 - min(zero b2, zero a2))` (SciPy).
    pub fn new(cascade: Cascade, order: usize, edges: Edges) -> Self {
        let sections = cascade.sections();
        let extension = match edges {
            Edges::Matlab => 3 * order,
            Edges::Scipy => {
                let zero_b2 = sections.iter().filter(|s| s.b[2] == 0.0).count();
                let zero_a2 = sections.iter().filter(|s| s.a[1] == 0.0).count();
                3 * (2 * sections.len() + 1 - zero_b2.min(zero_a2))
            }
        };
        ZeroPhase { cascade, extension }
    }

    /// Samples that the odd extension adds at either end.
    pub fn extension(&self) -> usize {
        self.extension
    }

    /// Fewest samples that can be filtered.
    pub fn fewest_samples(&self) -> usize {
        self.extension + 1
    }

    /// Samples away from an edge after which the filter has forgotten it, to rounding.
    pub fn memory(&self) -> usize {
        self.cascade.memory()
    }

    /// Filters every signal over its whole length.
    ///
    /// # Errors
    /// [`SignalError::TooShort`] if there are fewer than [`Self::fewest_samples`].
    pub fn filter(&self, series: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, SignalError> {
        let read = |group: &mut [[f64; LANES]], width: usize| {
            (0..width)
                .map(|lane| group.iter().map(|sample| sample[lane]).collect())
                .collect()
        };
        self.groups(series, |_| (), read)
    }

    /// Filters all signals, [`LANES`] side by side. Each group passes through `prepare` before
    /// the filter and goes to `read` after it, with the number of lanes in use; what `read`
    /// returns for the groups is chained in their order.
    ///
    /// # Errors
    /// [`SignalError::TooShort`] if there are fewer than [`Self::fewest_samples`].
    pub fn groups<S, T, P, R>(
        &self,
        signals: &S,
        prepare: P,
        read: R,
    ) -> Result<Vec<T>, SignalError>
    where
        S: Signals + ?Sized,
        T: Send,
        P: Fn(&mut [[f64; LANES]]) + Sync,
        R: Fn(&mut [[f64; LANES]], usize) -> Vec<T> + Sync,
    {
        let has = signals.samples();
        if has < self.fewest_samples() && signals.count() > 0 {
            return Err(SignalError::TooShort {
                needs: self.fewest_samples(),
                has,
            });
        }
        let inner = self.extension..self.extension + has;
        let groups: Vec<Vec<T>> = (0..signals.count().div_ceil(LANES))
            .into_par_iter()
            .map_init(Vec::new, |samples, group| {
                let first = group * LANES;
                let width = LANES.min(signals.count() - first);
                samples.resize(has + 2 * self.extension, [0.0; LANES]);
                for lane in 0..width {
                    signals.copy_to_lane(first + lane, lane, &mut samples[inner.clone()]);
                }
                prepare(&mut samples[inner.clone()]);
                self.run(samples);
                read(&mut samples[inner.clone()], width)
            })
            .collect();
        Ok(groups.into_iter().flatten().collect())
    }

    /// Both passes over `samples`, whose ends are still to be filled with the extension.
    fn run(&self, samples: &mut [[f64; LANES]]) {
        extend_oddly(samples, self.extension);
        self.cascade.forward(samples);
        self.cascade.backward(samples);
    }
}

/// Fills `extension` places at either end by point reflection about the first and last sample.
fn extend_oddly(samples: &mut [[f64; LANES]], extension: usize) {
    let first = extension;
    let last = samples.len() - 1 - extension;
    let reflect = |centre: [f64; LANES], x: [f64; LANES]| {
        std::array::from_fn(|lane| 2.0 * centre[lane] - x[lane])
    };
    for k in 1..=extension {
        samples[first - k] = reflect(samples[first], samples[first + k]);
        samples[last + k] = reflect(samples[last], samples[last - k]);
    }
}

#[cfg(test)]
mod tests {
    use super::super::reference::*;
    use super::super::{butterworth, chebyshev1};
    use super::*;

    fn wave() -> Vec<f64> {
        (0..90)
            .map(|i| (0.1 * f64::from(i)).sin() + 0.3 * f64::from((i * 7919) % 101) / 101.0)
            .collect()
    }

    fn assert_every_sixth(filter: &ZeroPhase, expected: &[f64]) {
        let filtered = filter.filter(&[wave()]).unwrap();
        for (own, scipy) in filtered[0].iter().step_by(6).zip(expected) {
            assert!((own - scipy).abs() < 1e-12, "{own} against {scipy}");
        }
    }

    #[test]
    fn butterworth_agrees_with_filtfilt() {
        let cascade = butterworth(4, 0.2, 2.0).unwrap();
        let matlab = ZeroPhase::new(cascade.clone(), 4, Edges::Matlab);
        assert_eq!(matlab.extension(), 12);
        assert_every_sixth(&matlab, &BUTTERWORTH_12);
        let scipy = ZeroPhase::new(cascade, 4, Edges::Scipy);
        assert_eq!(scipy.extension(), 15);
        assert_every_sixth(&scipy, &BUTTERWORTH_15);
    }

    #[test]
    fn chebyshev_agrees_with_filtfilt() {
        let cascade = chebyshev1(8, 0.05, 0.08, 2.0).unwrap();
        let matlab = ZeroPhase::new(cascade.clone(), 8, Edges::Matlab);
        assert_eq!(matlab.extension(), 24);
        assert_every_sixth(&matlab, &CHEBYSHEV_24);
        let scipy = ZeroPhase::new(cascade, 8, Edges::Scipy);
        assert_eq!(scipy.extension(), 27);
        assert_every_sixth(&scipy, &CHEBYSHEV_27);
    }

    #[test]
    fn a_straight_line_passes_unchanged() {
        // Odd extension continues a straight line, and a low-pass has no phase at zero frequency.
        let line: Vec<f64> = (0..300).map(|i| 2.0 - 0.01 * f64::from(i)).collect();
        for order in 1..=8 {
            let cascade = butterworth(order, 20.0, 100.0).unwrap();
            let filter = ZeroPhase::new(cascade, order, Edges::Scipy);
            let filtered = filter.filter(std::slice::from_ref(&line)).unwrap();
            let middle = 100..200;
            for (x, y) in filtered[0][middle.clone()].iter().zip(&line[middle]) {
                assert!((x - y).abs() < 1e-9, "order {order}: {x} against {y}");
            }
        }
    }

    #[test]
    fn many_signals_are_filtered_like_each_alone() {
        let series: Vec<Vec<f64>> = (0..19)
            .map(|s| (0..80).map(|i| (f64::from(i * s) * 0.03).cos()).collect())
            .collect();
        let filter = ZeroPhase::new(butterworth(4, 8.0, 100.0).unwrap(), 4, Edges::Matlab);
        let together = filter.filter(&series).unwrap();
        assert_eq!(together.len(), series.len());
        for (one, filtered) in series.iter().zip(&together) {
            assert_eq!(
                &filter.filter(std::slice::from_ref(one)).unwrap()[0],
                filtered
            );
        }
    }

    #[test]
    fn too_short_a_signal_is_an_error() {
        let filter = ZeroPhase::new(butterworth(4, 8.0, 100.0).unwrap(), 4, Edges::Matlab);
        assert!(filter.filter(&[vec![1.0; 13]]).is_ok());
        let error = filter.filter(&[vec![1.0; 12]]).unwrap_err();
        assert_eq!(error, SignalError::TooShort { needs: 13, has: 12 });
    }
}
