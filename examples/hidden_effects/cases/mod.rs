//! Robots with hidden effects: drawn, simulated, diagnosed, scored.

pub mod answer;
pub mod draw;
pub mod files;
pub mod hidden;
pub mod logs;
pub mod machine;
mod motion;
mod oracle;
mod outside;
pub mod propose;
pub mod random;
pub mod robots;
pub mod score;
pub mod table;
