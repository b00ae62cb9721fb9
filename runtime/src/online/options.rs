//! How a stream filters, every choice made and checked.

use super::OnlineError;
use crate::observe::ModelKind;
use crate::settings::Velocity;

/// Filters of a stream; see the module's page for what they do.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Samples per second, Hz.
    pub rate_hz: f64,
    /// Which equations: of the joints (explicit, implicit) or of the power.
    pub model: ModelKind,
    /// Cut-off of the Butterworth prefilter of q, one of its two passes, Hz.
    pub fq_hz: f64,
    /// Order of the prefilter, one pass.
    pub order: usize,
    /// Cut-off of the parallel low-pass of all columns and of the torque, Hz.
    pub fp_hz: f64,
    /// One instant in `nd` becomes equations.
    pub nd: usize,
    /// Whether velocities come from the positions or are pushed.
    pub velocity: Velocity,
    /// A joint is at rest while its positions stay this close together, rad or m, over the whole
    /// window of the prefilter: more than the sensor's noise. 0: never at rest.
    pub rest_band: f64,
}

impl Options {
    /// The usual choices at a sampling rate: the explicit model, 40 equations per second and joint
    /// at 1 kHz, prefilter 40 Hz, parallel filter 16 Hz (both in proportion to the rate).
    pub fn at(rate_hz: f64) -> Options {
        const ND: usize = 25;
        Options {
            rate_hz,
            model: ModelKind::Explicit,
            fq_hz: rate_hz / 25.0,
            order: 4,
            fp_hz: 0.8 * rate_hz / (2.0 * ND as f64),
            nd: ND,
            velocity: Velocity::Derived,
            rest_band: 1e-5,
        }
    }

    /// # Errors
    /// [`OnlineError::Rate`], [`OnlineError::Ratio`], [`OnlineError::Band`].
    pub(super) fn check(&self) -> Result<(), OnlineError> {
        let rate_hz = self.rate_hz;
        if !(rate_hz > 0.0 && rate_hz.is_finite()) {
            return Err(OnlineError::Rate { rate_hz });
        }
        if self.nd == 0 {
            return Err(OnlineError::Ratio);
        }
        match self.rest_band {
            band if band >= 0.0 => Ok(()),
            band => Err(OnlineError::Band { band }),
        }
    }
}
