//! Robots in URDF.

use super::description::{Snap, UrdfTree};
use super::diagnostic::Diagnostic;

/// A robot as a URDF gives it.
pub(super) struct Robot {
    /// Its name.
    pub(super) name: String,
    /// Links and joints.
    pub(super) tree: UrdfTree,
    /// Angles taken as multiples of pi/2.
    pub(super) snaps: Vec<Snap>,
    /// What was noticed.
    pub(super) warnings: Vec<Diagnostic>,
}

/// Reads a URDF text.
pub(super) fn read(_text: &str, _file: &str) -> Result<Robot, Vec<Diagnostic>> {
    Err(Vec::new())
}
