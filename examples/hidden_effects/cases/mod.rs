//! Robots with hidden effects: drawn, simulated, diagnosed, scored.

pub mod answer;
pub mod draw;
pub mod files;
mod hidden;
mod logs;
mod machine;
mod motion;
mod oracle;
mod outside;
mod propose;
mod random;
mod robots;
pub mod score;
pub mod table;

pub use machine::Failure;
