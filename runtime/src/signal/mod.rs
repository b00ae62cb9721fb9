//! Zero-phase filters, differences and decimation of uniformly sampled signals.
//!
//! The tools of Gautier 1996, section 6: a zero-phase Butterworth prefilter, central differences,
//! and the decimation that low-passes many signals in parallel. Numbers agree with SciPy's
//! `butter`, `cheby1`, `sosfiltfilt` and Matlab's `filtfilt`, `decimate`. Nothing here knows what
//! a signal stands for; frequencies are in Hz, rates in samples per second.

mod bandwidth;
mod cascade;
mod decimate;
mod design;
mod difference;
mod planar;
#[cfg(test)]
mod reference;
mod zero_phase;

pub use bandwidth::bandwidth;
pub use cascade::{Cascade, Section};
pub use decimate::Decimator;
pub use design::{butterworth, chebyshev1};
pub use difference::central_difference;
pub use planar::{BLOCK, LANES, Planar, Signals};
pub use zero_phase::ZeroPhase;

/// Why a filter cannot be designed or applied.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SignalError {
    /// A cut-off outside the open interval from 0 to half the sampling rate.
    #[error(
        "cut-off {cutoff_hz} Hz is not between 0 and {nyquist_hz} Hz, half the sampling rate; \
         choose a lower cut-off"
    )]
    CutOff {
        /// What was asked for, Hz.
        cutoff_hz: f64,
        /// Half the sampling rate, Hz.
        nyquist_hz: f64,
    },
    /// A filter order that makes no sense.
    #[error("filter order {order} is not between 1 and {max}; 4 is usual")]
    Order {
        /// What was asked for.
        order: usize,
        /// The largest order that is still accurate.
        max: usize,
    },
    /// A decimation ratio of zero.
    #[error("the decimation ratio must be at least 1")]
    Ratio,
    /// Too few samples for the extension at the edges of a zero-phase filter.
    #[error(
        "zero-phase filtering needs at least {needs} samples and has {has}; \
         use a longer log, trim less or lower the filter order"
    )]
    TooShort {
        /// Fewest samples that can be filtered.
        needs: usize,
        /// Samples there are.
        has: usize,
    },
}
