//! A robot together with where it came from.

use std::path::PathBuf;

use crate::robot::Robot;

/// A robot with the texts that it was read from.
#[derive(Clone, Debug)]
pub struct Source {
    /// File name of the description, without its folder.
    pub file: String,
    /// All texts by file name: the description first, then what it names.
    pub texts: Vec<(String, String)>,
    /// All files, for the build system to watch.
    pub paths: Vec<PathBuf>,
    /// The robot.
    pub robot: Robot,
}
