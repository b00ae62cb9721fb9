//! From a robot to the text of its specialised code.
//!
//! No dynamics here. What is computed, in which order and under which names is decided once for
//! all languages: [`function`] walks the graph, [`statement`] writes expressions, [`naming`] gives
//! names, [`signature`] says what the functions take and return. A [`Language`] says how it spells
//! what is left; with its tables it is one file ([`c`], [`python`]), or a folder for Rust, which
//! also carries the runtime's trait. The same robot always gives the same bytes.

pub mod angles;
pub mod c;
pub mod function;
pub mod language;
pub mod naming;
pub mod par;
mod parts;
pub mod python;
pub mod rust;
pub mod signals;
pub mod signature;
pub mod statement;
pub mod summary;
mod text;
pub mod urdf;

pub use c::{c, c_in_one};
pub use language::Language;
pub use par::{ParError, par};
pub use python::python;
pub use rust::index::index;
pub use rust::rust;

/// A file of emitted code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Name without a folder, such as `scara.h`.
    pub name: String,
    /// The text.
    pub text: String,
}
