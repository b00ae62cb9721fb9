//! `idim generate`: the specialised code of a robot.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use idim::codegen::Robot;
use idim::codegen::emit::{self, File};
use idim::codegen::functions::Group;

use super::{Failure, output, robot};

/// Languages that code can be emitted in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Language {
    /// A Rust module for use with `idim-runtime`: NAME.rs.
    Rust,
    /// C99 that needs `math.h` only: NAME.h and NAME.c.
    C,
    /// A Python module that needs numpy only: NAME.py.
    Python,
    /// The description for SYMORO: NAME.par.
    Par,
}

/// Functions beside the identification models.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Functions {
    /// Inverse dynamics, mass matrix and gravity of given base parameters.
    Dynamics,
    /// Pose and Jacobian of every tip.
    Kinematics,
}

/// Arguments of `idim generate`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Name of a built-in robot, or path of a .urdf, .toml or .par.
    robot: String,
    /// Language of the code.
    #[arg(long, value_enum, default_value = "rust")]
    language: Language,
    /// Further functions, beside the identification models.
    #[arg(long, value_enum, value_delimiter = ',')]
    with: Vec<Functions>,
    /// File to write, or folder to write into; standard output if absent.
    #[arg(short, long, value_name = "FILE|DIR")]
    output: Option<PathBuf>,
}

/// Writes the code.
///
/// # Errors
/// [`Failure`] when the robot cannot be read or the code not be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let groups = arguments.with.iter().map(|functions| match functions {
        Functions::Dynamics => Group::Dynamics,
        Functions::Kinematics => Group::Kinematics,
    });
    let groups: Vec<Group> = groups.collect();
    let robot = robot::derived(&arguments.robot)?.with(&groups);
    match &arguments.output {
        Some(path) => write(path, files(&robot, arguments.language)?),
        None => output::print(&text(&robot, arguments.language)?),
    }
}

fn files(robot: &Robot, language: Language) -> Result<Vec<File>, Failure> {
    Ok(match language {
        Language::Rust => vec![File {
            name: format!("{}.rs", robot.mechanism.name),
            text: emit::rust(robot).map_err(Failure::Defect)?,
        }],
        Language::C => emit::c(robot).into(),
        Language::Python => vec![emit::python(robot)],
        Language::Par => vec![emit::par(robot)?],
    })
}

/// The code as one text that stands alone.
fn text(robot: &Robot, language: Language) -> Result<String, Failure> {
    match language {
        Language::C => Ok(emit::c_in_one(robot)),
        _ => Ok(files(robot, language)?
            .into_iter()
            .map(|file| file.text)
            .collect()),
    }
}

/// Several files go into a folder, which is made if it is not there; one file also goes where a
/// file is named.
fn write(path: &Path, files: Vec<File>) -> Result<(), Failure> {
    let named = path.to_string_lossy().ends_with(std::path::is_separator);
    let folder = path.is_dir() || named;
    match files.as_slice() {
        [file] if !folder => output::write_whole(path, &file.text),
        _ if path.is_file() => Err(Failure::Usage {
            message: format!(
                "{}: the code is {} files, and this is one",
                path.display(),
                files.len()
            ),
            help: "name a folder after -o".into(),
        }),
        _ => {
            std::fs::create_dir_all(path).map_err(|source| Failure::Write {
                path: path.to_owned(),
                source,
            })?;
            let texts = files
                .into_iter()
                .map(|file| (path.join(file.name), file.text));
            output::write_all_whole(&texts.collect::<Vec<_>>())
        }
    }
}
