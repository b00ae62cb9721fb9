//! The filters of an identification, every choice made.

use serde::Serialize;

use crate::settings::{Derivatives, Edges, Velocity};
use crate::signal::{Decimator, SignalError, ZeroPhase, butterworth};

/// The filters of an identification (Gautier 1996, section 6), every choice made.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Filtering {
    /// Cut-off of the zero-phase Butterworth prefilter of q, Hz.
    pub fq_hz: f64,
    /// Order of the prefilter, one pass.
    pub order: usize,
    /// Decimation ratio n_d.
    pub nd: usize,
    /// What is cut off at either end, to forget the edges of the filters: samples before the
    /// parallel filter ([`Edges::Scipy`]) or decimated rows after it ([`Edges::Matlab`]).
    pub trim: usize,
    /// Samples cut off at the start and at the end before the parallel filter.
    pub border: (usize, usize),
    /// Edge rule of the filters and of the decimation.
    pub edges: Edges,
    /// How q, momentum and energy are differentiated.
    pub derivatives: Derivatives,
    /// Source of the velocity.
    pub velocity: Velocity,
    /// Whether the torque passes the prefilter too.
    pub prefilter_torque: bool,
    /// The names of those of the above that were chosen from the data.
    pub chosen: Vec<&'static str>,
}

impl Filtering {
    /// The prefilter for signals sampled at `rate_hz`.
    pub(super) fn prefilter(&self, rate_hz: f64) -> Result<ZeroPhase, SignalError> {
        let cascade = butterworth(self.order, self.fq_hz, rate_hz)?;
        Ok(ZeroPhase::new(cascade, self.order, self.edges))
    }

    /// The parallel filter and decimation for signals sampled at `rate_hz`.
    pub(crate) fn decimator(&self, rate_hz: f64) -> Result<Decimator, SignalError> {
        let decimator = Decimator::new(self.nd, rate_hz, self.edges)?;
        Ok(decimator.differentiating(self.derivatives))
    }

    /// Samples cut off at the start and at the end before the parallel filter.
    pub(crate) fn cut_before(&self) -> (usize, usize) {
        let trim = match self.edges {
            Edges::Scipy => self.trim,
            Edges::Matlab => 0,
        };
        (
            self.border.0.saturating_add(trim),
            self.border.1.saturating_add(trim),
        )
    }

    /// Samples on either side of a kept one that the filters gather into it, but for traces: four
    /// decimated rows of the parallel filter and a period of the prefilter's cut-off.
    pub(crate) fn reach(&self, rate_hz: f64) -> usize {
        self.nd
            .saturating_mul(4)
            .saturating_add((rate_hz / self.fq_hz) as usize)
    }

    /// Bridges over this many samples are too short to be seen behind the prefilter: a tenth of
    /// the period of its cut-off.
    pub(super) fn bridgeable(&self, rate_hz: f64) -> usize {
        (0.1 * rate_hz / self.fq_hz) as usize + 3
    }

    /// Velocity that the noise of a position sensor makes behind the prefilter, per unit of the
    /// standard deviation of what the prefilter takes away: white noise between its cut-off and half
    /// the rate has the same density below, \\( 2 \pi \sqrt{f_{fq}^3 / 3 / (f_c / 2 - f_{fq})} \\).
    pub(super) fn noise_speed(&self, rate_hz: f64) -> f64 {
        let above = (0.5 * rate_hz - self.fq_hz).max(f64::MIN_POSITIVE);
        std::f64::consts::TAU * (self.fq_hz.powi(3) / 3.0 / above).sqrt()
    }

    /// Whether velocities become zero where they are uncertain; not where the settings ask for plain
    /// differences or measured velocities.
    pub(super) fn rests(&self) -> bool {
        self.velocity == Velocity::Derived && self.derivatives != Derivatives::Central
    }

    /// Decimated rows cut off at either end after the parallel filter.
    pub(super) fn cut_after(&self) -> usize {
        match self.edges {
            Edges::Scipy => 0,
            Edges::Matlab => self.trim,
        }
    }
}
