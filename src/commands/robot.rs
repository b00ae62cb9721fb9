//! `<ROBOT>`: the name of a built-in robot, or the path of a description.

use std::path::{Path, PathBuf};

use idim::codegen::mechanism::Mechanism;
use idim::codegen::{Robot, builder};
use idim::interpreted::{self, Interpreter};
use idim::robots;
use idim::runtime::model::{IdentificationModel, Joint};
use idim::runtime::settings::Drives;

use super::Failure;

/// A built-in robot by its name, if it is one.
fn built_in(name: &str) -> Option<&'static robots::Robot> {
    robots::ALL.iter().find(|robot| robot.name == name)
}

fn unknown(name: &str) -> Failure {
    let known = robots::ALL.iter().map(|robot| robot.name).collect();
    Failure::UnknownRobot {
        name: name.to_owned(),
        known,
    }
}

/// Whether the argument means a file rather than a built-in robot.
fn is_path(argument: &str) -> bool {
    let path = Path::new(argument);
    path.extension().is_some() || path.components().count() > 1 || path.is_file()
}

/// The derived robot: graph, mechanism, base parameters.
///
/// # Errors
/// [`Failure::UnknownRobot`], [`Failure::Description`].
pub fn derived(argument: &str) -> Result<Robot, Failure> {
    if let Some(robot) = built_in(argument) {
        return Ok(builder::read_texts(robot.texts)?);
    }
    if !is_path(argument) {
        return Err(unknown(argument));
    }
    Ok(builder::read(Path::new(argument))?.robot)
}

/// The derived robot and its model.
///
/// # Errors
/// [`Failure::UnknownRobot`], [`Failure::Description`].
pub fn both(argument: &str) -> Result<(Robot, Box<dyn IdentificationModel>), Failure> {
    let robot = derived(argument)?;
    let model: Box<dyn IdentificationModel> = match built_in(argument) {
        Some(robot) => Box::new(robot.model),
        None => Box::new(Interpreter::new(&robot)),
    };
    Ok((robot, model))
}

/// A robot of which is known what the reading of its logs needs; deriving its model takes longer
/// and can go on beside it.
pub struct Opened {
    /// The driven joints.
    pub joints: Vec<Joint>,
    /// What leads from the drives to them.
    pub drives: Drives,
    source: Source,
}

enum Source {
    BuiltIn(&'static robots::Robot),
    File(Box<builder::Described>),
}

/// Reads `<ROBOT>` and derives nothing yet.
///
/// # Errors
/// [`Failure::UnknownRobot`], [`Failure::Description`].
pub fn open(argument: &str) -> Result<Opened, Failure> {
    if let Some(robot) = built_in(argument) {
        return Ok(Opened {
            joints: robot.model.joints().to_vec(),
            drives: robot.model.settings().drives.clone(),
            source: Source::BuiltIn(robot),
        });
    }
    if !is_path(argument) {
        return Err(unknown(argument));
    }
    let described = builder::open(Path::new(argument))?;
    Ok(Opened {
        joints: interpreted::joints(&Mechanism::new(&described.description)),
        drives: interpreted::drives(&described.description),
        source: Source::File(Box::new(described)),
    })
}

impl Opened {
    /// The model: generated code of a built-in robot, the interpreter for a path.
    ///
    /// # Errors
    /// [`Failure::Description`].
    pub fn model(self) -> Result<Box<dyn IdentificationModel>, Failure> {
        match self.source {
            Source::BuiltIn(robot) => Ok(Box::new(robot.model)),
            Source::File(described) => Ok(Box::new(Interpreter::new(&described.derive()?.robot))),
        }
    }
}

/// A description as it is written: its text, and that of the URDF that it names.
pub struct Texts {
    /// By file name, the description first.
    all: Vec<(String, String)>,
    /// Where the description lies; none for a built-in robot.
    pub folder: Option<PathBuf>,
}

impl Texts {
    /// The texts of `<ROBOT>`.
    ///
    /// # Errors
    /// [`Failure::UnknownRobot`], [`Failure::Description`].
    pub fn of(argument: &str) -> Result<Texts, Failure> {
        if let Some(robot) = built_in(argument) {
            let own = |(file, text): &(&str, &str)| ((*file).to_owned(), (*text).to_owned());
            return Ok(Texts {
                all: robot.texts.iter().map(own).collect(),
                folder: None,
            });
        }
        if !is_path(argument) {
            return Err(unknown(argument));
        }
        let path = Path::new(argument);
        Ok(Texts {
            all: builder::read(path)?.texts,
            folder: Some(path.parent().unwrap_or(Path::new("")).to_owned()),
        })
    }

    /// File name and text of the description.
    pub fn description(&self) -> (&str, &str) {
        let first = self.all.first();
        first.map_or(("", ""), |(file, text)| (file, text))
    }

    /// Whether the description is SYMORO's.
    pub fn is_par(&self) -> bool {
        let extension = Path::new(self.description().0).extension();
        extension.is_some_and(|extension| extension.eq_ignore_ascii_case("par"))
    }

    /// Whether the description is a TOML, rather than a bare URDF.
    pub fn is_toml(&self) -> bool {
        !self
            .description()
            .1
            .trim_start_matches('\u{feff}')
            .trim_start()
            .starts_with('<')
    }

    /// Path and text of the URDF, if there is one.
    pub fn urdf(&self) -> Option<&(String, String)> {
        match self.is_toml() {
            true => self.all.get(1),
            false => self.all.first(),
        }
    }
}
