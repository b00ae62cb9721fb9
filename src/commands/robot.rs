//! `<ROBOT>`: the name of a built-in robot, or the path of a description.

use std::path::Path;

use idim::codegen::{Robot, builder};
use idim::interpreted::Interpreter;
use idim::robots;
use idim::runtime::model::IdentificationModel;

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

/// The model: generated code of a built-in robot, the interpreter for a path.
///
/// # Errors
/// [`Failure::UnknownRobot`], [`Failure::Description`].
pub fn model(argument: &str) -> Result<Box<dyn IdentificationModel>, Failure> {
    if let Some(robot) = built_in(argument) {
        return Ok(Box::new(robot.model));
    }
    Ok(Box::new(Interpreter::new(&derived(argument)?)))
}
