//! A motion at a rate that still shows what drives and links do: a log that is sampled much faster
//! holds no more of it, and every hypothesis would be computed at every sample.

use std::ops::Range;

use crate::observe::{Filtering, Motion};
use crate::settings::Edges;
use crate::signal::{SignalError, ZeroPhase, butterworth};

/// The rate kept, Hz: twenty times the usual cut-off of the prefilter, and that of most controllers.
const ENOUGH_HZ: f64 = 1000.0;

/// The low-pass of the torque: its order, one pass, and its cut-off as a share of the rate kept.
const ORDER: usize = 4;
const SHARE: f64 = 0.4;

/// Which samples of a log a thinned motion has: every `ratio`-th from `first` on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Thin {
    pub ratio: usize,
    first: usize,
}

impl Thin {
    /// All samples.
    pub const NOT: Thin = Thin { ratio: 1, first: 0 };

    /// Down to a rate that is enough, so that the `kept` samples are among those that stay.
    pub fn to_enough(filtering: &Filtering, rate_hz: f64, kept: &[usize]) -> Thin {
        let enough = |ratio: &usize| {
            filtering.nd.is_multiple_of(*ratio) && rate_hz / *ratio as f64 >= ENOUGH_HZ
        };
        let ratio = (1..=filtering.nd).rev().find(enough).unwrap_or(1);
        Thin {
            ratio,
            first: kept.first().map_or(0, |first| first % ratio),
        }
    }

    /// The filters of what is left to do.
    pub fn filtering(self, filtering: &Filtering) -> Filtering {
        Filtering {
            nd: filtering.nd / self.ratio,
            ..filtering.clone()
        }
    }

    /// A prefiltered motion at the lower rate; its torque, which may hold more than the prefilter
    /// lets through, is low-passed before.
    pub fn motion(self, mut motion: Motion) -> Result<Motion, SignalError> {
        if self == Thin::NOT {
            return Ok(motion);
        }
        let samples = (self.first..motion.len).step_by(self.ratio);
        let pick = |series: &mut Vec<f64>| {
            *series = samples.clone().map(|sample| series[sample]).collect();
        };
        let states = [
            &mut motion.q,
            &mut motion.qd,
            &mut motion.qdd,
            &mut motion.slip,
        ];
        states.into_iter().flatten().for_each(pick);
        if let Some(tau) = &mut motion.tau {
            // Flat: a filter with ripple would change the torque's size against the columns'.
            let cut_off = SHARE * motion.rate_hz / self.ratio as f64;
            let low_pass = butterworth(ORDER, cut_off, motion.rate_hz)?;
            let low_pass = ZeroPhase::new(low_pass, ORDER, Edges::Scipy);
            *tau = low_pass.filter(tau)?;
            tau.iter_mut().for_each(pick);
        }
        motion.len = samples.len();
        motion.rate_hz /= self.ratio as f64;
        let within = |range: &Range<usize>| self.place(range.start)..self.place(range.end) + 1;
        let doubtful = motion.doubtful.iter().map(within);
        motion.doubtful = doubtful
            .map(|r| r.start..r.end.min(samples.len()))
            .collect();
        Ok(motion)
    }

    /// Seconds from the beginning of the log to a sample that stays.
    pub fn time(self, sample: usize, rate_hz: f64) -> f64 {
        sample as f64 / rate_hz + self.first as f64 * self.per_sample(rate_hz)
    }

    fn per_sample(self, rate_hz: f64) -> f64 {
        1.0 / (rate_hz * self.ratio as f64)
    }

    /// The last sample that stays up to one of the log.
    pub fn place(self, sample: usize) -> usize {
        sample.saturating_sub(self.first) / self.ratio
    }

    /// A series at all `len` samples of the log again, on straight lines between those that stayed.
    pub fn spread(self, series: Vec<f64>, len: usize) -> Vec<f64> {
        if self == Thin::NOT {
            return series;
        }
        let at = |sample: usize| {
            let place = self.place(sample).min(series.len().saturating_sub(2));
            let passed = sample as f64 - (self.first + place * self.ratio) as f64;
            let share = (passed / self.ratio as f64).clamp(0.0, 1.0);
            match series.get(place..place + 2) {
                Some(&[from, to]) => from + share * (to - from),
                _ => series.first().copied().unwrap_or(0.0),
            }
        };
        (0..len).map(at).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(rate_hz: f64, len: usize) -> Motion {
        let wave = |k: usize| (std::f64::consts::TAU * 3.0 * k as f64 / rate_hz).sin();
        let series = || vec![(0..len).map(wave).collect::<Vec<f64>>()];
        Motion {
            log: "log".into(),
            rate_hz,
            len,
            q: series(),
            qd: series(),
            qdd: series(),
            slip: Vec::new(),
            tau: Some(series()),
            doubtful: vec![103..111, len - 2..len],
            resting: Vec::new(),
        }
    }

    #[test]
    fn thinned_motion_is_the_motion_at_samples_that_hold_the_kept_ones() {
        let thin = Thin { ratio: 5, first: 3 };
        let full = motion(5000.0, 4000);
        let thinned = thin.motion(full.clone()).unwrap();
        assert_eq!(thinned.rate_hz, 1000.0);
        assert_eq!(thinned.len, 800);
        assert_eq!(thinned.doubtful, [20..22, 799..800]);
        let tau = &thinned.tau.as_ref().unwrap()[0];
        for (k, tau) in tau.iter().enumerate().take(780).skip(20) {
            let sample = 3 + 5 * k;
            assert_eq!(thinned.q[0][k], full.q[0][sample]);
            assert!((tau - full.q[0][sample]).abs() < 1e-9);
            assert!((thin.time(k, 1000.0) - sample as f64 / 5000.0).abs() < 1e-12);
        }
    }

    #[test]
    fn spread_series_goes_through_the_samples_that_stayed() {
        let thin = Thin { ratio: 4, first: 2 };
        let line = |sample: usize| 0.5 * sample as f64 - 3.0;
        let series: Vec<f64> = (2..41).step_by(4).map(line).collect();
        let spread = thin.spread(series, 41);
        for (sample, value) in spread.iter().enumerate().take(39).skip(2) {
            assert!((value - line(sample)).abs() < 1e-12);
        }
        assert_eq!(spread[0], line(2));
        assert_eq!(spread[40], line(38));
    }

    #[test]
    fn log_is_thinned_no_further_than_its_rows_allow() {
        let filtering = |nd| crate::observe::Filtering {
            fq_hz: 50.0,
            order: 4,
            nd,
            trim: 0,
            border: (0, 0),
            edges: Edges::Scipy,
            derivatives: crate::settings::Derivatives::Central,
            velocity: crate::settings::Velocity::Derived,
            prefilter_torque: false,
            chosen: Vec::new(),
        };
        let ratio = |nd, rate_hz| Thin::to_enough(&filtering(nd), rate_hz, &[300]).ratio;
        assert_eq!(ratio(100, 5000.0), 5);
        assert_eq!(ratio(20, 1000.0), 1);
        assert_eq!(ratio(20, 1999.0), 1);
        assert_eq!(ratio(40, 2000.0), 2);
        assert_eq!(ratio(7, 5000.0), 1);
    }
}
