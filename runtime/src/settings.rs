//! A robot's own defaults for identification, and what the torque channels of its logs mean.
//!
//! They come from the `[identify]` and `[drives]` tables of a description, by way of the generated
//! module or the interpreter; the command line and the log override them.

use std::borrow::Cow;

use serde::Serialize;

/// What happens at the edges of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Edges {
    /// `filtfilt` extends by 3 x order samples; `decimate` keeps the samples
    /// `nbeg = r - (r*ceil(n/r) - n)`, counted from 1; `trim` counts rows after decimation.
    Matlab,
    /// `sosfiltfilt` extends by 3 x (2 x sections + 1 - zero coefficients) samples; every r-th
    /// sample is kept from the first; `trim` counts samples before decimation.
    Scipy,
}

/// How equations of different joints are weighted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Weights {
    /// Ordinary least squares.
    None,
    /// Weighted least squares: each joint's rows divided by its residual's standard deviation.
    Joint,
    /// Iteratively reweighted against glitches (Huber).
    Robust,
}

/// Degrees of freedom of the residual of r equations, in the variance that sigma is taken from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Freedom {
    /// r - np: unbiased (Gautier 1996, section 7.3).
    #[default]
    Parameters,
    /// r - 1, about the residual's mean: the standard deviation that Matlab's `std` gives, in
    /// which the reference results of EMPS are published.
    Mean,
}

/// Where the joint velocity comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Velocity {
    /// Central differences of the filtered position.
    Derived,
    /// The log's own velocity, low-passed like the position.
    Measured,
}

/// How signals are differentiated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Derivatives {
    /// Central differences of the two neighbours (Gautier 1996, section 6.2): their gain falls as
    /// \\( \sin(\omega T) / \omega T \\).
    #[default]
    Central,
    /// Central differences of eighth order (Fornberg 1988), right to 1e-3 up to 0.3 of the half
    /// rate, where central ones miss 14 %. Below what they and the sensor's noise leave uncertain, a velocity counts as zero.
    Eighth,
}

/// A robot's own defaults; `None` leaves the choice to the runtime.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Settings {
    /// Cut-off of the prefilter of q, Hz.
    pub fq_hz: Option<f64>,
    /// Order of the Butterworth prefilter.
    pub order: Option<usize>,
    /// Decimation ratio n_d.
    pub nd: Option<usize>,
    /// What is cut off at either end; its unit follows from [`Edges`].
    pub trim: Option<usize>,
    /// Samples cut off at the start and at the end before decimation, whatever the edges.
    pub border: Option<(usize, usize)>,
    /// Edge rule.
    pub edges: Option<Edges>,
    /// Weights of the joints.
    pub weights: Option<Weights>,
    /// Source of the velocity.
    pub velocity: Option<Velocity>,
    /// Whether the torque passes the prefilter too (Gautier 1996, section 7.2).
    pub prefilter_torque: Option<bool>,
    /// What the residual's degrees of freedom are counted against.
    pub degrees_of_freedom: Option<Freedom>,
    /// What the log's torque channels mean.
    pub drives: Drives,
}

/// Drive chains: from logged units to joint torques (Gautier 1996, eq. 13).
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Drives {
    /// N m (or N) per logged unit, one per drive; empty: no gains known.
    pub gains: Cow<'static, [f64]>,
    /// Coupling matrix C, n x n, row-major; empty: identity.
    /// \\( q_{motor} = C q \\), \\( \tau = C^T \tau_{motor} \\).
    pub coupling: Cow<'static, [f64]>,
}
