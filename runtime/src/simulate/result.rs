//! What a simulation gives.

use super::options::Grid;
use crate::log::Recording;

/// Motion and torque on a uniform grid: one series per joint, one value per sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// The grid.
    pub grid: Grid,
    /// Positions, rad or m.
    pub q: Vec<Vec<f64>>,
    /// Velocities, rad/s or m/s.
    pub qd: Vec<Vec<f64>>,
    /// Torques, N m or N; of a controller, that which begins at the sample.
    pub tau: Vec<Vec<f64>>,
}

impl Simulation {
    pub(super) fn new(grid: &Grid, joints: usize) -> Simulation {
        let series = || vec![Vec::with_capacity(grid.len); joints];
        Simulation {
            grid: *grid,
            q: series(),
            qd: series(),
            tau: series(),
        }
    }

    pub(super) fn push(&mut self, q: &[f64], qd: &[f64], tau: &[f64]) {
        let parts = [(&mut self.q, q), (&mut self.qd, qd), (&mut self.tau, tau)];
        for (series, values) in parts {
            series
                .iter_mut()
                .zip(values)
                .for_each(|(series, value)| series.push(*value));
        }
    }

    /// The simulation as a log, to be identified from or compared with one.
    pub fn into_recording(self, name: &str) -> Recording {
        let Grid {
            rate_hz,
            start,
            len,
        } = self.grid;
        Recording {
            doubtful: vec![],
            name: name.to_owned(),
            stem: name.to_owned(),
            rate_hz,
            start,
            len,
            q: self.q,
            qd: Some(self.qd),
            tau: Some(self.tau),
            stamps: (0..len).map(|k| self.grid.time(k)).collect(),
            warnings: Vec::new(),
        }
    }
}
