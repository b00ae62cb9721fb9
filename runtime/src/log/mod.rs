//! From files as people have them to [`Recording`]s: checked, uniform in time, SI units.

pub mod recording;

pub use recording::Recording;
