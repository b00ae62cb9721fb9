//! `idim generate`: the specialised code of a robot.

use std::path::PathBuf;

use clap::ValueEnum;
use idim::codegen::emit;

use super::{Failure, output, robot};

/// Languages that code can be emitted in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Language {
    /// A Rust module for use with `idim-runtime`.
    Rust,
}

/// Arguments of `idim generate`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Name of a built-in robot, or path of a .urdf or .toml.
    robot: String,
    /// Language of the code.
    #[arg(long, value_enum, default_value = "rust")]
    language: Language,
    /// File to write; standard output if absent.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Writes the code.
///
/// # Errors
/// [`Failure`] when the robot cannot be read or the file not be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let robot = robot::derived(&arguments.robot)?;
    let text = match arguments.language {
        Language::Rust => emit::rust(&robot).map_err(Failure::Defect)?,
    };
    match &arguments.output {
        Some(path) => output::write_whole(path, &text),
        None => output::print(&text),
    }
}
