//! What a simulation can be told, and the grid and state that it works on.

use super::error::SimulateError;
use crate::log::Recording;

/// How the equations of motion are integrated between two samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Runge-Kutta of order 4; every sample interval is cut into equal steps of at most `step_s`.
    Fixed {
        /// Largest step, s.
        step_s: f64,
    },
    /// Dormand-Prince 5(4): steps as long as the error estimate allows, ending on every sample.
    /// A step is accepted when the error of no state is above `absolute + relative * |state|`.
    Adaptive {
        /// Relative tolerance per step.
        relative: f64,
        /// Absolute tolerance per step: rad, m, rad/s, m/s.
        absolute: f64,
    },
}

/// Options of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The integrator.
    pub method: Method,
    /// Resolution of the encoders that the controller reads, rad or m; `None`: exact.
    pub encoder_resolution: Option<f64>,
    /// Distance from the reference, rad or m, beyond which a closed loop is said to diverge.
    pub tracking_limit: f64,
}

impl Default for Options {
    /// Fixed steps of at most 0.5 ms (energy of a double pendulum in free fall within 1e-10 over
    /// 10 s), exact encoders, 3 rad or m from the reference at most.
    fn default() -> Self {
        Options {
            method: Method::Fixed { step_s: 5e-4 },
            encoder_resolution: None,
            tracking_limit: 3.0,
        }
    }
}

impl Options {
    /// Whether all numbers can be used.
    pub(super) fn check(&self) -> Result<(), SimulateError> {
        match self.method {
            Method::Fixed { step_s } => positive("the step", step_s)?,
            Method::Adaptive { relative, absolute } => {
                positive("the relative tolerance", relative)?;
                positive("the absolute tolerance", absolute)?;
            }
        }
        if let Some(step) = self.encoder_resolution {
            positive("the encoder resolution", step)?;
        }
        positive("the tracking limit", self.tracking_limit)
    }
}

/// Uniform samples in time: `start + k / rate_hz`, k = 0 .. len - 1. Controllers run on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Samples per second, Hz.
    pub rate_hz: f64,
    /// Time of the first sample, s.
    pub start: f64,
    /// Number of samples.
    pub len: usize,
}

impl Grid {
    /// The grid of a recording.
    pub fn of(recording: &Recording) -> Grid {
        let Recording {
            rate_hz,
            start,
            len,
            ..
        } = *recording;
        Grid {
            rate_hz,
            start,
            len,
        }
    }

    /// Time of sample `k`, s.
    pub fn time(&self, k: usize) -> f64 {
        self.start + k as f64 / self.rate_hz
    }

    pub(super) fn check(&self) -> Result<(), SimulateError> {
        positive("the sampling rate", self.rate_hz)?;
        if self.len == 0 {
            Err(SimulateError::Empty)
        } else {
            Ok(())
        }
    }
}

/// Positions and velocities of all joints.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Positions, rad or m.
    pub q: Vec<f64>,
    /// Velocities, rad/s or m/s.
    pub qd: Vec<f64>,
}

fn positive(what: &'static str, value: f64) -> Result<(), SimulateError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(SimulateError::NotPositive { what, value })
    }
}
