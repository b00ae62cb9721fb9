//! The logs of `idim identify`: read beside the derivation of the model, settled with it, held or
//! long.

use std::path::Path;

use idim::runtime::identify::{Options, settle_units};
use idim::runtime::log::{Companion, Log, LogSpec, ReadOptions, Recording};
use idim::runtime::model::{IdentificationModel, Joint};
use idim::runtime::settings::Drives;

use super::super::progress::Spinner;
use super::super::{Failure, fits, robot};

/// How logs are read.
pub struct Reading<'a> {
    joints: Vec<Joint>,
    drives: Drives,
    options: ReadOptions,
    spinner: &'a Spinner,
}

impl<'a> Reading<'a> {
    /// Of this robot, with a companion other than the one beside each log.
    pub fn new(robot: &robot::Opened, map: Option<&Path>, spinner: &'a Spinner) -> Self {
        Reading {
            joints: robot.joints.clone(),
            drives: robot.drives.clone(),
            options: ReadOptions {
                require_torque: true,
                companion: map.map(Path::to_owned),
            },
            spinner,
        }
    }

    /// Reads logs.
    ///
    /// # Errors
    /// [`Failure::Log`].
    pub fn read(&self, names: &[String]) -> Result<Vec<(Log, Companion)>, Failure> {
        let read = |name: &String| {
            self.spinner.say(&format!("reading {name}"));
            let spec: LogSpec = name.parse()?;
            Ok(Log::read(&spec, &self.joints, &self.drives, &self.options)?)
        };
        names.iter().map(read).collect()
    }
}

/// Settles what only the model can tell of the logs that are held in memory: units, and whether
/// references fit.
pub fn settle(
    model: &dyn IdentificationModel,
    logs: &mut [(Log, Companion)],
    options: &Options,
) -> Result<(), Failure> {
    for (log, companion) in logs {
        if let Log::Held(recording) = log {
            settle_units(model, recording, companion, options);
            let off = fits::reference(model, recording, companion)?;
            recording.warnings.extend(off);
        }
    }
    Ok(())
}

/// What a page can show of logs: the beginning of long ones.
pub fn beginnings(logs: &[Log]) -> Result<Vec<Recording>, Failure> {
    const SHOWN: usize = 100_000;
    logs.iter().map(|log| Ok(log.beginning(SHOWN)?)).collect()
}

/// The recordings of logs that are held in memory.
pub fn all_held(logs: &[Log]) -> Result<Vec<Recording>, Failure> {
    logs.iter().map(held).collect()
}

pub fn recordings(logs: &[(Log, Companion)]) -> Result<Vec<Recording>, Failure> {
    logs.iter().map(|(log, _)| held(log)).collect()
}

fn held(log: &Log) -> Result<Recording, Failure> {
    match log {
        Log::Held(recording) => Ok(recording.clone()),
        Log::Long(long) => Err(Failure::Usage {
            message: format!(
                "{} has {} samples: too many to hold at once, as this needs",
                long.name, long.len
            ),
            help: "name parts of it, such as LOG@0..60".into(),
        }),
    }
}
