//! Columns against formulas, closed forms and robots that were described otherwise.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

mod arm;
mod bodies;
mod described;
mod formulas;
mod listing;
mod signals;
mod whole;
