//! A log, or a part of one, as everything after this module sees it.

use std::ops::Range;

/// Joint motion and torque on a uniform time grid, SI units, in the order of the model's joints.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// How the user named it, such as `log.csv.gz@5..7.5`.
    pub name: String,
    /// File stem for outputs: `log` for `dir/log.csv.gz@5..7.5`.
    pub stem: String,
    /// Sampling rate of the uniform grid, Hz.
    pub rate_hz: f64,
    /// Time of the first sample of the grid, s.
    pub start: f64,
    /// Number of samples on the grid.
    pub len: usize,
    /// Joint positions, one series of `len` samples per joint, rad or m.
    pub q: Vec<Vec<f64>>,
    /// Measured joint velocities, if the log has them, rad/s or m/s.
    pub qd: Option<Vec<Vec<f64>>>,
    /// Joint torques, if the log has them, N m or N.
    pub tau: Option<Vec<Vec<f64>>>,
    /// Samples of the grid that cannot be believed, ascending and disjoint: they were bridged by
    /// straight lines, and what they touch is left out of the equations.
    pub doubtful: Vec<Range<usize>>,
    /// The time stamps of the rows of (this part of) the file, s, as they stand there.
    pub stamps: Vec<f64>,
    /// What was noticed while reading, each a full sentence that says where.
    pub warnings: Vec<String>,
}
