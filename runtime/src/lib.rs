//! Identification of robot dynamics from measured logs.
//!
//! The way of the data: log -> [`log::Recording`] -> zero-phase filters ([`signal`]) ->
//! regressor, decimated in parallel ([`observe`]) -> least squares ([`estimate`]) -> report
//! ([`report`]), after M. Gautier, "A comparison of filtered models for dynamic identification of
//! robots" (1996). The crate is generic over a robot ([`model::IdentificationModel`]); it never
//! sees a description.

pub mod batch;
pub mod diagnose;
pub mod estimate;
pub mod evidence;
pub mod excite;
pub mod identify;
pub mod knowledge;
pub mod log;
pub mod model;
pub mod observe;
pub mod online;
pub mod physical;
pub mod report;
pub mod settings;
pub mod signal;
pub mod simulate;
pub mod whole;

pub use idim_lanes as lane;

/// Includes the generated module of a robot by its name; the build script made it with
/// `idim_codegen::Builder`.
///
/// ```ignore
/// mod arm {
///     #![allow(dead_code, missing_docs, clippy::all)]
///     idim_runtime::include_robot!("arm");
/// }
/// ```
#[macro_export]
macro_rules! include_robot {
    ($name:literal) => {
        include!(concat!(env!("OUT_DIR"), "/idim/", $name, ".rs"));
    };
}
