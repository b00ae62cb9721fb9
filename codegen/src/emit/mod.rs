//! From a robot to the text of its specialised Rust module.
//!
//! No dynamics here: the module reads the graph, names and orders what it finds, and lets
//! `prettyplease` set the type. The same robot always gives the same bytes.

pub mod comment;
pub mod function;
pub mod index;
pub mod module;
pub mod naming;
pub mod state;
pub mod statement;
pub mod tables;

pub use index::index;
pub use module::rust;
