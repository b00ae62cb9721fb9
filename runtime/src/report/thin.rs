//! Fewer points that look the same.

use std::ops::Range;

/// Which samples to draw of signals that share one time axis: at most about `points` of them,
/// among them the first, the last, and the extremes of every signal in each stretch of time, so
/// that no peak disappears. Ascending.
pub(crate) fn thinned(signals: &[&[f64]], points: usize) -> Vec<usize> {
    let len = signals.iter().map(|signal| signal.len()).min().unwrap_or(0);
    if len <= points {
        return (0..len).collect();
    }
    let stretches = (points / (2 * signals.len().max(1))).max(1);
    let mut keep = vec![0, len - 1];
    for k in 0..stretches {
        let stretch = k * len / stretches..(k + 1) * len / stretches;
        keep.extend(
            signals
                .iter()
                .flat_map(|signal| extremes(signal, stretch.clone())),
        );
    }
    keep.sort_unstable();
    keep.dedup();
    keep
}

/// Where a signal is lowest and highest within a range.
fn extremes(signal: &[f64], range: Range<usize>) -> impl Iterator<Item = usize> {
    let by_value = |a: &usize, b: &usize| signal[*a].total_cmp(&signal[*b]);
    let low = range.clone().min_by(by_value);
    low.into_iter().chain(range.max_by(by_value))
}

#[cfg(test)]
mod tests {
    use super::thinned;

    #[test]
    fn short_signals_stay_whole() {
        assert_eq!(thinned(&[&[1.0, 2.0, 3.0]], 3), [0, 1, 2]);
        assert!(thinned(&[], 10).is_empty());
    }

    #[test]
    fn every_peak_of_every_signal_stays() {
        let wave: Vec<f64> = (0..10_000).map(|i| (f64::from(i) * 0.01).sin()).collect();
        let mut spike = vec![0.0; 10_000];
        spike[4321] = 9.0;
        spike[7777] = -9.0;
        let keep = thinned(&[&wave, &spike], 400);
        assert!(keep.len() <= 402, "{}", keep.len());
        assert!(keep.windows(2).all(|pair| pair[0] < pair[1]));
        for sample in [0, 4321, 7777, 9999] {
            assert!(keep.contains(&sample), "{sample}");
        }
    }
}
