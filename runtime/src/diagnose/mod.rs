//! From a gap between model and measurement to a named effect.

mod catalogue;

pub use catalogue::{Catalogue, ColumnsAlong, Entry, EntryKind, Hypothesis, Signals, TorqueColumn};
