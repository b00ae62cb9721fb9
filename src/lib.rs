//! Inverse dynamic identification models: from a robot's description and a measured log to its
//! base dynamic parameters, with the explicit, the implicit and the power model side by side.
//!
//! This crate is the facade: [`robots`] holds the generated built-in robots, [`interpreted`] runs
//! any other description without a rebuild, and both go through [`runtime`]. The generator is
//! [`codegen`].

pub use idim_codegen as codegen;
pub use idim_runtime as runtime;

pub mod catalogue;
pub mod demo;
pub mod exported;
pub mod interpreted;
pub mod simulated;
pub mod study;

/// The robots of `robots/`, generated when this crate was built.
#[allow(clippy::all, clippy::approx_constant)]
pub mod robots {
    include!(concat!(env!("OUT_DIR"), "/idim/index.rs"));
}
