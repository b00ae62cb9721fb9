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
mod extent;
mod modal;
mod planar;
#[cfg(test)]
mod reference;
mod running;
mod sums;
mod whiteness;
mod zero_phase;

pub use bandwidth::bandwidth;
pub use cascade::{Cascade, Section};
pub use decimate::Decimator;
pub use design::{butterworth, chebyshev1};
pub(crate) use difference::{EIGHTH, REACH, uncertainty};
pub use difference::{central_difference, derivative};
pub(crate) use extent::{all_finite, extent, median, medians};
pub use planar::{BLOCK, LANES, Planar, Signals};
pub use running::Running;
pub(crate) use whiteness::{autocorrelation, density};
pub use zero_phase::ZeroPhase;

/// Why a filter cannot be designed or applied.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SignalError {
    /// A cut-off that is not below half the sampling rate, or too low for the arithmetic.
    #[error(
        "cut-off {cutoff_hz} Hz is not between {lowest_hz} Hz and {nyquist_hz} Hz, \
         half the sampling rate"
    )]
    CutOff {
        /// What was asked for, Hz.
        cutoff_hz: f64,
        /// Lowest cut-off that double precision can realise at this rate, Hz.
        lowest_hz: f64,
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
    /// A decimation ratio of zero or beyond reason.
    #[error("the decimation ratio {ratio} is not between 1 and {largest}")]
    Ratio {
        /// What was asked for.
        ratio: usize,
        /// The largest ratio that is still accurate.
        largest: usize,
    },
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
