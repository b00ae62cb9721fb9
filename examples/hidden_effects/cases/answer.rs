//! What the diagnosis says of a case. It is given the folder of the case and nothing else.

use std::path::Path;
use std::time::Instant;

use idim::catalogue::Effects;
use idim::codegen::builder::read;
use idim::interpreted::Interpreter;
use idim::runtime::diagnose::{Log, Options, diagnose};
use idim::runtime::log::{self, LogSpec, Part, ReadOptions};
use idim::runtime::model::IdentificationModel;
use idim::runtime::report::{FoundEffect, Verdict};
use idim::simulated::{gap, motions};

use super::machine::Failure;
use super::oracle::rmse;

/// What was said.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The verdict.
    pub verdict: Verdict,
    /// The effects named, in order.
    pub effects: Vec<Said>,
    /// RMSE of the torque on validation with what was found, 20 Hz, by joint.
    pub rmse_after: Vec<f64>,
    /// Closed-loop position error on validation, before and after, by joint; if it was simulated.
    pub position: Option<[Vec<f64>; 2]>,
    /// Time that reading and diagnosing took, s.
    pub seconds: f64,
}

/// An effect that was named.
#[derive(Clone, Debug)]
pub struct Said {
    /// Its name.
    pub effect: String,
    /// Its joints, from 1.
    pub joints: Vec<usize>,
    /// Names of what the log does not tell it from.
    pub same: Vec<String>,
}

/// Diagnoses the case in a folder.
pub fn answer(folder: &Path) -> Result<Answer, Failure> {
    let begun = Instant::now();
    let robot = read(&folder.join("robot.toml"))?.robot;
    let model = Interpreter::new(&robot);
    let logs = [
        log_of(folder, "train", &model)?,
        log_of(folder, "valid", &model)?,
    ];
    let catalogue = Effects::new(&robot);
    let (train, valid) = logs.split_at(1);
    let options = Options::default();
    let (found, predictions) = diagnose(&model, &catalogue, (train, valid), &options, &())?;
    let seconds = begun.elapsed().as_secs_f64();
    let measured = valid[0]
        .recording
        .tau
        .as_ref()
        .ok_or("a log without torque")?;
    let after = &predictions.first().ok_or("no prediction")?.after;
    let extension = catalogue.extension(&found)?;
    let motions = motions(&model, &found, (&catalogue, &extension), &valid[0])?;
    let simulation = motions.map(|motions| gap(&valid[0], &motions));
    Ok(Answer {
        verdict: found.verdict,
        effects: found.effects.iter().map(said).collect(),
        rmse_after: rmse(measured, after)?,
        position: simulation.map(|gap| [gap.before.rms.clone(), gap.after.rms.clone()]),
        seconds,
    })
}

fn said(effect: &FoundEffect) -> Said {
    let same = effect.alternatives.iter().filter(|other| !other.separable);
    Said {
        effect: effect.effect.clone(),
        joints: effect.joints.clone(),
        same: same.map(|other| other.effect.clone()).collect(),
    }
}

fn log_of(folder: &Path, name: &str, model: &dyn IdentificationModel) -> Result<Log, Failure> {
    let spec = LogSpec {
        path: folder.join(format!("{name}.csv.gz")),
        part: Part::Whole,
        name: format!("{name}.csv.gz"),
    };
    let options = ReadOptions {
        require_torque: true,
        companion: None,
    };
    let drives = &model.settings().drives;
    let (recording, companion) = log::read(&spec, model.joints(), drives, &options)?;
    Ok(Log {
        recording,
        companion,
    })
}
