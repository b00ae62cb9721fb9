//! From a robot description to specialised identification models.
//!
//! The way of the data: text -> [`describe`] -> [`mechanism`] (links in modified
//! Denavit-Hartenberg frames) -> [`derive`] (the [`expr`] graph of D, P, R, h, dh) -> [`base`]
//! parameters -> [`emit`] (Rust), or the tape that interprets the same graph. [`robot::Robot`]
//! goes that way; [`Builder`] goes it in a build script.

pub mod base;
pub mod builder;
pub mod catalogue;
pub mod derive;
pub mod describe;
pub mod emit;
pub mod expr;
pub mod functions;
pub mod knowledge;
pub mod mechanism;
pub mod placement;
pub mod rewrite;
pub mod robot;
pub mod source;

pub use builder::{BuildError, Builder};
pub use robot::Robot;

/// Includes the generated module of a robot by its name; the build script made it with
/// [`Builder`]. The same as `idim_runtime::include_robot!`, for crates that have this one among their
/// dependencies too.
#[macro_export]
macro_rules! include_robot {
    ($name:literal) => {
        include!(concat!(env!("OUT_DIR"), "/idim/", $name, ".rs"));
    };
}
