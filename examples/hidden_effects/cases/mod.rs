//! Robots with hidden effects: drawn, simulated, diagnosed, scored.

pub mod answer;
mod build;
mod columns;
pub mod draw;
pub mod files;
pub mod hidden;
pub mod host;
pub mod kinds;
pub mod logs;
pub mod machine;
mod motion;
mod oracle;
mod outside;
pub mod propose;
pub mod random;
pub mod robots;
mod scene;
pub mod score;
mod stage;
pub mod table;
pub mod truth;
