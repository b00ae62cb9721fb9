//! From the text of a robot description to a checked [`Description`].
//!
//! Reading collects [`Diagnostic`]s and goes on; [`check`] decides. URDF and modified
//! Denavit-Hartenberg tables end in the same type; nothing after this module reads text.

pub mod description;
pub mod diagnostic;

pub use description::*;
pub use diagnostic::{Diagnostic, Severity, Span};
