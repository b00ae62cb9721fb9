//! A reference motion on a grid, with its derivatives.

use std::f64::consts::TAU;

use super::error::SimulateError;
use super::options::Grid;
use super::via_points;
use crate::log::{Fourier, Reference};
use crate::signal::central_difference;

/// Positions, velocities, accelerations: one series per joint, one value per sample, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Positions, rad or m.
    pub q: Vec<Vec<f64>>,
    /// Velocities, rad/s or m/s.
    pub qd: Vec<Vec<f64>>,
    /// Accelerations, rad/s^2 or m/s^2.
    pub qdd: Vec<Vec<f64>>,
}

impl Trajectory {
    /// Evaluates a reference: a Fourier series or a motion through points with its exact
    /// derivatives at the times of the grid, a sampled reference with central differences (its first sample is that of the grid).
    ///
    /// # Errors
    /// [`SimulateError::NotPositive`] or [`SimulateError::Empty`] for a grid that is none,
    /// [`SimulateError::Length`] if a sampled reference has not one value per sample.
    pub fn of(reference: &Reference, grid: &Grid) -> Result<Trajectory, SimulateError> {
        grid.check()?;
        match reference {
            Reference::Fourier(fourier) => Ok(Trajectory::fourier(fourier, grid)),
            Reference::ViaPoints(points) => Ok(via_points::along(points, grid)),
            Reference::Sampled { q } => Trajectory::sampled(q, grid),
        }
    }

    fn fourier(fourier: &Fourier, grid: &Grid) -> Trajectory {
        let joints = fourier.center.len();
        let series = || vec![Vec::with_capacity(grid.len); joints];
        let mut trajectory = Trajectory {
            q: series(),
            qd: series(),
            qdd: series(),
        };
        // Whatever a row has not is zero.
        let at = |rows: &[Vec<f64>], joint: usize, h: usize| {
            rows.get(joint)
                .and_then(|row| row.get(h))
                .copied()
                .unwrap_or(0.0)
        };
        let longest = fourier
            .sin
            .iter()
            .chain(&fourier.cos)
            .map(Vec::len)
            .max()
            .unwrap_or(0);
        for (joint, center) in fourier.center.iter().enumerate() {
            for sample in 0..grid.len {
                let phase = TAU * fourier.f0_hz * grid.time(sample);
                let [mut q, mut qd, mut qdd] = [*center, 0.0, 0.0];
                for h in 0..longest {
                    let (sin, cos) = (at(&fourier.sin, joint, h), at(&fourier.cos, joint, h));
                    let harmonic = (h + 1) as f64;
                    let w = harmonic * TAU * fourier.f0_hz;
                    let (s, c) = (harmonic * phase).sin_cos();
                    q += sin * s + cos * c;
                    qd += w * (sin * c - cos * s);
                    qdd -= w * w * (sin * s + cos * c);
                }
                trajectory.q[joint].push(q);
                trajectory.qd[joint].push(qd);
                trajectory.qdd[joint].push(qdd);
            }
        }
        trajectory
    }

    fn sampled(q: &[Vec<f64>], grid: &Grid) -> Result<Trajectory, SimulateError> {
        check_series("reference", q, grid.len)?;
        let rates = |series: &[Vec<f64>]| -> Vec<Vec<f64>> {
            series
                .iter()
                .map(|joint| central_difference(joint, grid.rate_hz))
                .collect()
        };
        let qd = rates(q);
        Ok(Trajectory {
            q: q.to_vec(),
            qdd: rates(&qd),
            qd,
        })
    }
}

/// Whether every series has `needs` samples.
pub(super) fn check_series(
    what: &'static str,
    series: &[Vec<f64>],
    needs: usize,
) -> Result<(), SimulateError> {
    match series.iter().position(|values| values.len() != needs) {
        None => Ok(()),
        Some(place) => {
            let (joint, has) = (place + 1, series[place].len());
            Err(SimulateError::Length {
                what,
                joint,
                has,
                needs,
            })
        }
    }
}
