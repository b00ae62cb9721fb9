//! How far and how fast the joints of a motion go: where effects may act, and the grids of their
//! shapes.

use std::ops::Range;

use idim_runtime::diagnose::{Hypothesis, Signals};

/// The reach of a motion.
#[derive(Clone, Debug)]
pub(super) struct Reach<'a> {
    /// The motion.
    pub signals: &'a Signals<'a>,
    /// Lowest and highest position of each joint, rad or m.
    pub range: Vec<(f64, f64)>,
    /// Top speed of each joint, rad/s or m/s.
    pub speed: Vec<f64>,
}

impl<'a> Reach<'a> {
    /// Looks along the signals once.
    pub fn new(signals: &'a Signals<'a>) -> Reach<'a> {
        let range = |q: &Vec<f64>| {
            let nothing = (f64::INFINITY, f64::NEG_INFINITY);
            q.iter()
                .fold(nothing, |(low, high), &q| (low.min(q), high.max(q)))
        };
        Reach {
            signals,
            range: signals.q.iter().map(range).collect(),
            speed: signals.qd.iter().map(|qd| largest(qd)).collect(),
        }
    }

    /// The joints that move more than their velocity is uncertain.
    pub fn moving(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.speed.len()).filter(|&joint| {
            let band = self.signals.dead_band.get(joint).copied().unwrap_or(0.0);
            self.speed[joint] > 2.0 * band
        })
    }

    /// Duration of the motion, s.
    pub fn duration(&self) -> f64 {
        self.signals.t.last().copied().unwrap_or(0.0)
    }

    /// A hypothesis without shape on each moving joint.
    pub fn each_joint(&self) -> Vec<Hypothesis> {
        self.moving().map(|joint| plain(vec![joint])).collect()
    }

    /// A hypothesis with one shape parameter, the same grid on each of some joints.
    pub fn each_of(
        &self,
        wanted: impl Fn(usize) -> bool,
        grid: impl Fn(usize) -> Vec<f64>,
    ) -> Vec<Hypothesis> {
        self.moving()
            .filter(|&joint| wanted(joint))
            .map(|joint| shaped(vec![joint], grid(joint)))
            .collect()
    }
}

/// Largest absolute value.
pub(super) fn largest(series: &[f64]) -> f64 {
    series.iter().fold(0.0, |all: f64, x| all.max(x.abs()))
}

/// The absolute value that all but one in a thousand stay below: the largest, but for what filters
/// ring at the ends of a log.
pub(super) fn top(series: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = series.iter().map(|x| x.abs()).collect();
    let beyond = sizes.len() / 1000;
    let place = sizes.len().checked_sub(1 + beyond);
    place.map_or(0.0, |place| {
        *sizes.select_nth_unstable_by(place, f64::total_cmp).1
    })
}

/// A hypothesis without shape.
pub(super) fn plain(joints: Vec<usize>) -> Hypothesis {
    Hypothesis {
        entry: 0,
        joints,
        grid: vec![vec![]],
        bounds: vec![],
        least: 0.0,
    }
}

/// A hypothesis with one shape parameter: its grid, ascending, and as bounds the ends of the grid.
pub(super) fn shaped(joints: Vec<usize>, grid: Vec<f64>) -> Hypothesis {
    let ends = |grid: &[f64]| -> Range<f64> {
        let low = grid.first().copied().unwrap_or(0.0);
        low..grid.last().copied().unwrap_or(low)
    };
    Hypothesis {
        entry: 0,
        joints,
        bounds: vec![ends(&grid)],
        grid: grid.into_iter().map(|value| vec![value]).collect(),
        least: 0.0,
    }
}

/// `count` values from low to high with equal ratios; one where there is no room.
pub(super) fn geometric(low: f64, high: f64, count: usize) -> Vec<f64> {
    if high <= low || count < 2 {
        return vec![low];
    }
    let ratio = (high / low).powf(1.0 / (count - 1) as f64);
    (0..count).map(|i| low * ratio.powi(i as i32)).collect()
}

/// The whole numbers from low to high.
pub(super) fn whole(low: u32, high: u32) -> Vec<f64> {
    (low..=high).map(f64::from).collect()
}
