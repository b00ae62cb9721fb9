//! Which columns of a log hold time, motion and torque of which joint.

use std::ops::Range;

use super::companion::Companion;
use super::error::{Found, LogError, Problem};
use super::naming::{self, CURRENT, Family, Q, Q_REF, QD, QM, TAU, TIME, VOLTAGE};
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

/// One value per joint, on the joint's or on the motor's side of the drive.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Group {
    /// Places in [`Layout::channels`], one per joint.
    pub channels: Range<usize>,
    /// Motor side: drive gains and coupling still apply.
    pub motor: bool,
}

/// The columns of a log that are read; all others are skipped.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layout {
    /// The columns in use; time first.
    pub channels: Vec<Channel>,
    /// Positions.
    pub q: Group,
    /// Velocities.
    pub qd: Option<Group>,
    /// Torques, or what the drives report.
    pub tau: Option<Group>,
    /// Commanded positions.
    pub q_ref: Option<Group>,
}

/// A header, its companion and the robot's joints: where names are looked up.
pub(super) struct Lookup<'a> {
    pub file: &'a str,
    pub header: &'a [String],
    pub companion: &'a Companion,
    pub joints: &'a [Joint],
    pub drives: &'a Drives,
    pub require_torque: bool,
}

impl Lookup<'_> {
    /// Finds every column that is read; what is ignored is said in `warnings`.
    pub(super) fn layout(&self, warnings: &mut Vec<String>) -> Result<Layout, LogError> {
        self.check_companion_keys()?;
        let time = TIME.map(String::from);
        let mut channels = match self.find(&time, Quantity::Time, None)? {
            Some(time) => vec![time],
            None => return Err(self.log(self.missing("the time stamps".into(), &time))),
        };
        let q = match self.group(&Q, &mut channels)? {
            Some(q) => q,
            None => match self.group(&QM, &mut channels)? {
                Some(qm) => qm,
                None => return Err(self.log(self.missing_joint(&Q, 0))),
            },
        };
        let qd = self.optional(&QD, &mut channels, warnings)?;
        let tau = self.torque(&mut channels, warnings)?;
        let q_ref = self.optional(&Q_REF, &mut channels, warnings)?;
        self.warn_of_repeated_names(&channels, warnings);
        Ok(Layout {
            channels,
            q,
            qd,
            tau,
            q_ref,
        })
    }

    fn log(&self, problem: Problem) -> LogError {
        LogError::Log {
            file: self.file.to_owned(),
            problem,
        }
    }

    /// Torque at the joint, else currents, else voltages.
    fn torque(
        &self,
        channels: &mut Vec<Channel>,
        warnings: &mut Vec<String>,
    ) -> Result<Option<Group>, LogError> {
        for family in [&TAU, &CURRENT, &VOLTAGE] {
            let group = if self.require_torque {
                self.group(family, channels)?
            } else {
                self.optional(family, channels, warnings)?
            };
            let Some(group) = group else { continue };
            if group.motor && self.drives.gains.is_empty() {
                let column = channels.get(group.channels.start).map(|c| c.name.clone());
                let problem = Problem::NoGains {
                    column: column.unwrap_or_default(),
                };
                if self.require_torque {
                    return Err(self.log(problem));
                }
                warnings.push(format!("{problem}; the log is read without torque."));
                channels.truncate(group.channels.start);
                return Ok(None);
            }
            return Ok(Some(group));
        }
        if self.require_torque {
            return Err(self.log(self.missing_joint(&TAU, 0)));
        }
        Ok(None)
    }

    /// The columns of all joints, or none; some but not all is an error.
    fn group(
        &self,
        family: &Family,
        channels: &mut Vec<Channel>,
    ) -> Result<Option<Group>, LogError> {
        let start = channels.len();
        let mut missing = None;
        for (j, joint) in self.joints.iter().enumerate() {
            let names = family.names(j, self.joints);
            match self.find(&names, family.quantity, Some((joint, family.motor)))? {
                Some(channel) => channels.push(channel),
                None => missing = missing.or(Some(j)),
            }
        }
        let found = channels.len() > start;
        match missing {
            None => Ok(Some(Group {
                channels: start..channels.len(),
                motor: family.motor,
            })),
            Some(j) if found => {
                channels.truncate(start);
                Err(self.log(self.missing_joint(family, j)))
            }
            Some(_) => Ok(None),
        }
    }

    /// The same, but an incomplete group is only noted.
    fn optional(
        &self,
        family: &Family,
        channels: &mut Vec<Channel>,
        warnings: &mut Vec<String>,
    ) -> Result<Option<Group>, LogError> {
        match self.group(family, channels) {
            Err(LogError::Log {
                problem: problem @ Problem::MissingColumn { .. },
                ..
            }) => {
                let (prefix, suffix) = (family.prefix, family.suffix);
                warnings.push(format!("{prefix}1{suffix}.. are not used: {problem}."));
                Ok(None)
            }
            other => other,
        }
    }

    /// The first of the names that the companion maps or the header holds.
    fn find(
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
                None => 1.0,
            };
            let factor = unit * source.gain.unwrap_or(1.0);
            return Ok(Some(Channel {
                index,
                name: from.to_owned(),
                factor,
            }));
        }
        Ok(names.iter().find_map(|name| {
            let index = self.place(name)?;
            Some(Channel {
                index,
                name: self.header.get(index)?.clone(),
                factor: 1.0,
            })
        }))
    }

    /// Where a name stands in the header; capitals count only if nothing else matches.
    fn place(&self, name: &str) -> Option<usize> {
        let exact = self.header.iter().position(|column| column == name);
        exact.or_else(|| {
            self.header
                .iter()
                .position(|column| column.eq_ignore_ascii_case(name))
        })
    }

    fn check_companion_keys(&self) -> Result<(), LogError> {
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

    fn warn_of_repeated_names(&self, channels: &[Channel], warnings: &mut Vec<String>) {
        for channel in channels {
            let count = self
                .header
                .iter()
                .filter(|name| **name == channel.name)
                .count();
            if count > 1 {
                let name = &channel.name;
                warnings.push(format!(
                    "Column `{name}` occurs {count} times; the first is used."
                ));
            }
        }
    }

    fn missing_joint(&self, family: &Family, joint: usize) -> Problem {
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

    fn missing(&self, what: String, names: &[String]) -> Problem {
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

/// Checks the drives against the number of joints.
pub(super) fn check_drives(drives: &Drives, joints: usize) -> Found<()> {
    let shapes = [
        ("gains", drives.gains.len(), joints),
        ("coupling", drives.coupling.len(), joints * joints),
    ];
    for (what, found, expected) in shapes {
        if found != 0 && found != expected {
            return Err(Problem::DrivesShape {
                what,
                found,
                expected,
                joints,
            });
        }
    }
    Ok(())
}
