//! Looking a column up: first in the companion, then in the header; and what to say if it is in
//! neither.

use super::companion::Companion;
use super::error::{LogError, Problem};
use super::naming::{self, Family};
use super::unit::{self, Quantity};
use crate::model::{Joint, JointKind};
use crate::settings::Drives;

/// One column in use.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Channel {
    /// Place in the header.
    pub index: usize,
    /// Name in the header.
    pub name: String,
    /// From the field to SI (or to the drive's unit).
    pub factor: f64,
}

/// A header, its companion and the robot's joints: where names are looked up.
#[derive(Clone, Copy)]
pub(super) struct Lookup<'a> {
    pub file: &'a str,
    pub header: &'a [String],
    pub companion: &'a Companion,
    pub joints: &'a [Joint],
    pub drives: &'a Drives,
    pub require_torque: bool,
}

impl Lookup<'_> {
    pub(super) fn log(&self, problem: Problem) -> LogError {
        LogError::Log {
            file: self.file.to_owned(),
            problem,
        }
    }

    /// The first of the names that the companion maps or the header holds.
    pub(super) fn find(
        &self,
        names: &[String],
        quantity: Quantity,
        joint: Option<(&Joint, bool)>,
    ) -> Result<Option<Channel>, LogError> {
        for name in names {
            let Some(source) = self.companion.columns.get(name) else {
                continue;
            };
            let error = |message| self.companion.column_error(name, message);
            let from = source.from.as_deref().unwrap_or(name);
            let index = self.place(from).ok_or_else(|| {
                error(format!(
                    "`{from}` (for {name}) is not in the log; found {}",
                    self.found()
                ))
            })?;
            let unit = match &source.unit {
                Some(unit) => unit_factor(unit, quantity, joint).map_err(error)?,
                None => self.header_unit(index, quantity, joint)?,
            };
            let factor = unit * source.gain.unwrap_or(1.0);
            return Ok(Some(Channel {
                index,
                name: from.to_owned(),
                factor,
            }));
        }
        let found = names.iter().find_map(|name| self.place(name));
        let channel = |index| {
            Ok(Channel {
                index,
                name: self.header.get(index).cloned().unwrap_or_default(),
                factor: self.header_unit(index, quantity, joint)?,
            })
        };
        found.map(channel).transpose()
    }

    /// Where a name stands in the header, with its unit or without; capitals count only if nothing
    /// else matches.
    fn place(&self, name: &str) -> Option<usize> {
        let exact = self.header.iter().position(|column| column == name);
        let bare = |same: fn(&str, &str) -> bool| {
            let mut columns = self.header.iter();
            columns.position(|column| same(unit::split(column).0, name))
        };
        exact
            .or_else(|| bare(|a, b| a == b))
            .or_else(|| bare(str::eq_ignore_ascii_case))
    }

    /// The factor of the unit that stands in the header, such as `q1 [deg]`; 1 if none does.
    fn header_unit(
        &self,
        index: usize,
        quantity: Quantity,
        joint: Option<(&Joint, bool)>,
    ) -> Result<f64, LogError> {
        let column = self.header.get(index).map_or("", String::as_str);
        let Some(unit) = unit::split(column).1 else {
            return Ok(1.0);
        };
        unit_factor(&unit, quantity, joint).map_err(|message| {
            self.log(Problem::HeaderUnit {
                column: column.to_owned(),
                message,
            })
        })
    }

    pub(super) fn check_companion_keys(&self) -> Result<(), LogError> {
        let canonical = naming::canonical(self.joints);
        for key in self.companion.columns.keys() {
            if !canonical.contains(key) {
                let n = self.joints.len();
                let message = format!(
                    "`{key}` is no column that is read; expected t, q1..q{n}, qd1.., tau1.., \
                     i1.., u1.., qm1.. or q1_ref.., or the same with joint names (q_NAME)"
                );
                return Err(self.companion.column_error(key, message));
            }
        }
        Ok(())
    }

    pub(super) fn missing_joint(&self, family: &Family, joint: usize) -> Problem {
        let what = match family.quantity {
            Quantity::Torque | Quantity::Drive => "torque",
            Quantity::Velocity => "velocity",
            _ if family.suffix.is_empty() => "position",
            _ => "commanded position",
        };
        let name = self
            .joints
            .get(joint)
            .map_or("", |joint| joint.name.as_ref());
        let names = family.names(joint, self.joints);
        self.missing(
            format!("the {what} of joint {} (`{name}`)", joint + 1),
            &names,
        )
    }

    pub(super) fn missing(&self, what: String, names: &[String]) -> Problem {
        let expected: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        Problem::MissingColumn {
            what,
            expected: expected.join(" or "),
            found: self.found(),
            hint: self.hint(names),
        }
    }

    fn found(&self) -> String {
        const SHOWN: usize = 40;
        let names: Vec<&str> = self.header.iter().take(SHOWN).map(String::as_str).collect();
        let more = if self.header.len() > SHOWN {
            ", ..."
        } else {
            ""
        };
        format!("{}{more}", names.join(", "))
    }

    /// The unused name of the header that is nearest to one of these, if it is near at all.
    fn hint(&self, names: &[String]) -> String {
        let canonical = naming::canonical(self.joints);
        let unused = self
            .header
            .iter()
            .filter(|column| !canonical.contains(column));
        let nearest = unused
            .flat_map(|column| {
                names
                    .iter()
                    .map(move |name| (naming::distance(column, name), column, name))
            })
            .filter(|(distance, _, name)| *distance <= 1.max(name.chars().count() / 3))
            .min_by_key(|(distance, ..)| *distance);
        match (nearest, names.first()) {
            (Some((_, column, _)), Some(name)) => format!(
                "; did you mean `{column}`? Write {name} = {{ from = \"{column}\" }} under \
                 [columns] of the log companion"
            ),
            _ => String::new(),
        }
    }
}

/// The unit's factor, if it suits the quantity and, at the joint, the joint's kind.
fn unit_factor(
    unit: &str,
    quantity: Quantity,
    joint: Option<(&Joint, bool)>,
) -> Result<f64, String> {
    let factor = unit::factor(unit, quantity)?;
    if let (Some((joint, false)), Some(angular)) = (joint, unit::is_angular(unit))
        && angular != (joint.kind == JointKind::Revolute)
    {
        let kind = if angular { "prismatic" } else { "revolute" };
        return Err(format!(
            "unit `{unit}` does not fit `{}`, a {kind} joint",
            joint.name
        ));
    }
    Ok(factor)
}
