//! From files as people have them to [`Recording`]s: checked, uniform in time, SI units.
//!
//! [`read`] follows one path: open ([`LogSpec`], gzip, encoding, separator) -> columns and units,
//! with the help of the [`Companion`] -> rows of the part -> joint side of the drives -> doubtful
//! samples -> checks -> uniform time grid. [`read_long`] does the same to a log too long for
//! memory. [`write()`] and [`onto_stamps`] lead back from results to files.
//!
//! This module owns every file format of measured data; filters and models begin at [`Recording`].

mod any;
mod checks;
mod clipped;
pub mod closed_loop;
mod columns;
pub mod companion;
mod doubt;
mod drives;
pub mod error;
mod grid;
mod lines;
mod long;
mod lookup;
mod naming;
mod number;
mod order;
#[cfg(feature = "parquet")]
mod parquet;
mod parse;
mod rate;
mod read;
pub mod recording;
mod reference;
mod resample;
mod samples;
mod source;
pub mod spec;
mod speed;
mod stamps;
mod table;
mod unit;
mod utf16;
mod write;

#[cfg(test)]
mod tests;

pub use any::Log;
pub use closed_loop::{Controller, Feedforward, Fourier, Law, Reference, Start, ViaPoints};
pub use companion::{ColumnSource, Companion};
pub(crate) use doubt::resolution;
pub use error::{LogError, Problem};
pub use long::{LongLog, is_long, read_long};
pub use read::{ReadOptions, read};
pub use recording::Recording;
pub use resample::onto_stamps;
pub use samples::Samples;
pub(crate) use samples::within;
pub use spec::{LogSpec, Part, SpecError};
pub use write::write;
