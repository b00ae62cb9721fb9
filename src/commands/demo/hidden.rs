//! The hidden effect: simulated into logs, read from them, found, and written to a description.

use std::path::Path;

use idim::catalogue::Effects;
use idim::demo::hidden::{RUNS, Run};
use idim::robots;
use idim::runtime::diagnose::{Log, Options, diagnose};
use idim::runtime::log::{self, Companion, LogSpec, ReadOptions};
use idim::runtime::model::IdentificationModel;
use idim::runtime::report::Diagnosis;

use super::save_log;
use crate::commands::diagnose::{motions, write};
use crate::commands::progress::Spinner;
use crate::commands::robot::{self, Texts};
use crate::commands::{Failure, output};

/// Cut-off of the prefilter, Hz: the description's own is for the paper's slow log.
pub const CUT_OFF: f64 = 50.0;

/// The description with what was found.
pub const WRITTEN: &str = "scara_found.toml";

/// Simulates the logs into a folder and asks of them what the description lacks, as anybody would
/// who has nothing but the files.
///
/// # Errors
/// [`Failure`] when a file cannot be written; all else would be a defect.
pub fn find(folder: &Path, spinner: &Spinner) -> Result<Diagnosis, Failure> {
    let mut logs = Vec::new();
    for run in &RUNS {
        spinner.say(&format!("simulating {}", run.name));
        logs.push(simulated(folder, run)?);
    }
    let (train, validate) = logs.split_at(1);
    let robot = robot::derived(robots::scara::NAME)?;
    let catalogue = Effects::new(&robot);
    let options = Options {
        fq_hz: Some(CUT_OFF),
        draw: true,
        ..Options::default()
    };
    let model = robots::scara::Model;
    let (mut diagnosis, _) = diagnose(&model, &catalogue, (train, validate), &options, spinner)?;
    diagnosis.command = Some(command(folder));
    let extension = catalogue
        .extension(&diagnosis)
        .map_err(write::not_extended)?;
    let found = (&catalogue, &extension);
    motions(&model, &mut diagnosis, found, (validate, spinner));
    let texts = Texts::of(robots::scara::NAME)?;
    write::write(&folder.join(WRITTEN), &texts, &diagnosis, &extension)?;
    Ok(diagnosis)
}

/// The command line that does the same from the files.
pub fn command(folder: &Path) -> String {
    let folder = folder.display();
    format!(
        "idim diagnose scara {folder}/train.csv --validate {folder}/valid.csv --fq {CUT_OFF} \
         --write {folder}/{WRITTEN} --html page.html"
    )
}

/// Writes a log with its companion and reads it back.
fn simulated(folder: &Path, run: &Run) -> Result<Log, Failure> {
    let companion = folder.join(format!("{}.toml", run.name));
    output::text(&companion, &run.companion())?;
    let path = folder.join(format!("{}.csv", run.name));
    let log = run.simulate(&Companion::load(&companion)?);
    save_log(
        &path,
        &log.map_err(|error| Failure::Defect(error.to_string()))?,
    )?;
    let spec: LogSpec = path.display().to_string().parse()?;
    let model = robots::scara::Model;
    let options = ReadOptions {
        require_torque: true,
        companion: None,
    };
    let (recording, companion) =
        log::read(&spec, model.joints(), &model.settings().drives, &options)?;
    Ok(Log {
        recording,
        companion,
    })
}
