//! Linear interpolation: from stamps to the uniform grid, and back.

use std::ops::Range;

use super::rate;
use super::recording::Recording;

/// The series known at increasing `stamps`, at `start + k / rate_hz` for all `k` of `range`; held before
/// the first and after the last stamp, as NumPy's `interp` does.
pub(super) fn onto_grid(
    stamps: &[f64],
    series: &[f64],
    start: f64,
    rate_hz: f64,
    range: Range<usize>,
) -> Vec<f64> {
    let mut j = 0;
    let at = |k: usize| {
        let t = start + k as f64 / rate_hz;
        while stamps.get(j + 1).is_some_and(|&next| next <= t) {
            j += 1;
        }
        let (Some(&t0), Some(&y0)) = (stamps.get(j), series.get(j)) else {
            return f64::NAN;
        };
        match (stamps.get(j + 1), series.get(j + 1)) {
            (Some(&t1), Some(&y1)) if t > t0 => (y1 - y0) / (t1 - t0) * (t - t0) + y0,
            _ => y0,
        }
    };
    range.map(at).collect()
}

/// A series on the recording's uniform grid, at the stamps of the rows of the log: one value per
/// row of the (part of the) log.
///
/// `series` has `recording.len` values, in any unit. Where the grid is the stamps, the values are
/// returned as they are; otherwise they are interpolated linearly, and held beyond either end. A
/// series of another length is understood to begin with the grid; an empty one gives NaN.
pub fn onto_stamps(recording: &Recording, series: &[f64]) -> Vec<f64> {
    let stamps = &recording.stamps;
    let uniform = rate::fits(&stamps.as_slice(), recording.rate_hz, true);
    if stamps.len() == series.len() && uniform.unwrap_or(false) {
        return series.to_vec();
    }
    let last = series.len().saturating_sub(1);
    let at = |&stamp: &f64| {
        let place = ((stamp - recording.start) * recording.rate_hz).clamp(0.0, last as f64);
        let i = place.floor() as usize;
        let y0 = series.get(i).copied().unwrap_or(f64::NAN);
        let y1 = series.get(i + 1).copied().unwrap_or(y0);
        y0 + (y1 - y0) * (place - i as f64)
    };
    stamps.iter().map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recording(stamps: Vec<f64>, rate_hz: f64, len: usize) -> Recording {
        Recording {
            doubtful: vec![],
            name: String::new(),
            stem: String::new(),
            rate_hz,
            start: stamps[0],
            len,
            q: vec![],
            qd: None,
            tau: None,
            stamps,
            warnings: vec![],
        }
    }

    #[test]
    fn series_on_a_grid_passes_through_its_stamps_and_is_held_beyond() {
        let found = onto_grid(&[1.0, 1.5, 2.5], &[10.0, 20.0, 0.0], 0.5, 2.0, 0..6);
        assert_eq!(found, [10.0, 10.0, 20.0, 10.0, 0.0, 0.0]);
    }

    #[test]
    fn series_back_at_the_stamps_is_the_line_it_came_from() {
        let stamps: Vec<f64> = (0..50)
            .map(|k| f64::from(k) * 0.01 + 0.004 * (k % 3) as f64)
            .collect();
        let recording = recording(stamps.clone(), 100.0, 51);
        let series: Vec<f64> = (0..51).map(|k| 3.0 - f64::from(k) * 0.02).collect();
        for (found, t) in onto_stamps(&recording, &series).iter().zip(&stamps) {
            assert!((found - (3.0 - 2.0 * t)).abs() < 1e-12);
        }
    }

    #[test]
    fn series_on_stamps_that_are_the_grid_is_returned_bit_for_bit() {
        let recording = recording((0..40).map(|k| f64::from(k) / 1000.0).collect(), 1000.0, 40);
        let series: Vec<f64> = (0..40).map(|k| f64::from(k).sin()).collect();
        assert_eq!(onto_stamps(&recording, &series), series);
    }

    #[test]
    fn series_that_is_empty_gives_nan_and_no_panic() {
        let recording = recording(vec![0.0, 0.1], 10.0, 2);
        assert!(
            onto_stamps(&recording, &[])
                .iter()
                .all(|value| value.is_nan())
        );
    }
}
