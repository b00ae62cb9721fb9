//! A robot's joints with other columns than its own parameters.

use crate::model::{Column, ColumnKind, IdentificationModel, Joint, Output, Pattern, States};
use crate::settings::Settings;

/// What evidence needs to know of equations that are not the robot's own: the joints they belong
/// to, and the names of their columns. It evaluates nothing.
pub(super) struct OtherColumns<'a> {
    robot: &'a dyn IdentificationModel,
    columns: Vec<Column>,
    nothing: Pattern,
}

impl<'a> OtherColumns<'a> {
    pub fn new(robot: &'a dyn IdentificationModel, columns: Vec<Column>) -> Self {
        OtherColumns {
            robot,
            columns,
            nothing: Pattern {
                entries: (&[]).into(),
                signals: 0,
            },
        }
    }
}

/// A column with nothing behind its name.
pub(super) fn column(
    (name, unit): (&str, &str),
    (joint, kind): (usize, ColumnKind),
    meaning: &'static str,
) -> Column {
    Column {
        name: name.to_owned().into(),
        unit: unit.to_owned().into(),
        joint,
        kind,
        meaning: meaning.into(),
        relation: name.to_owned().into(),
    }
}

impl IdentificationModel for OtherColumns<'_> {
    fn name(&self) -> &str {
        self.robot.name()
    }
    fn joints(&self) -> &[Joint] {
        self.robot.joints()
    }
    fn columns(&self) -> &[Column] {
        &self.columns
    }
    fn pattern(&self, _output: Output) -> &Pattern {
        &self.nothing
    }
    fn settings(&self) -> &Settings {
        self.robot.settings()
    }
    fn evaluate(&self, _output: Output, _states: &States<'_>, _signals: &mut [f64]) {}
}
