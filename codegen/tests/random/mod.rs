//! Robots drawn at random, and an inverse dynamics that knows nothing of the crate.

pub mod count;
pub mod draw;
pub mod dual;
pub mod newton_euler;
pub mod text;
pub mod vector;
