//! From a robot description to specialised identification models.
//!
//! The way of the data: text -> [`describe`] -> mechanism (links in modified Denavit-Hartenberg
//! frames) -> expression graph of D, P, R, h, dh -> base parameters -> emitted Rust, or the
//! interpreter over the same graph.

pub mod catalogue;
pub mod describe;
pub mod expr;

pub mod derive;
pub mod mechanism;
pub mod base;
pub mod robot;
