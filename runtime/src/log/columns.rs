//! Which columns of a log hold time, motion and torque of which joint.

use std::ops::Range;

use super::error::{Found, LogError, Problem};
use super::lookup::{Channel, Lookup};
use super::naming::{CURRENT, Family, Q, Q_REF, QD, QM, TAU, TIME, VOLTAGE};
use super::unit::Quantity;
use crate::settings::Drives;

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
