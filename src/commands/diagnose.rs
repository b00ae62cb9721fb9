//! `idim diagnose`: which effect a robot's model lacks, and how much of the gap it closes.

use std::path::{Path, PathBuf};

use idim::catalogue::{Changes, Effects, Extension, entries};
use idim::codegen::Robot;
use idim::runtime::diagnose::{Log, Nominal, Options, Prediction, changes, diagnose};
use idim::runtime::identify::{Options as Identification, settle_units};
use idim::runtime::log::{self, LogSpec, ReadOptions};
use idim::runtime::model::IdentificationModel;
use idim::runtime::report::{Diagnosis, diagnosed, diagnosis_html};
use idim::runtime::simulate::SimulateError;
use idim::simulated::{self, Motions};

pub(super) mod write;

use super::predictions::Predictions;
use super::progress::Spinner;
use super::robot::Texts;
use super::simulate::parameters;
use super::{Failure, fits, output, robot};

/// Arguments of `idim diagnose`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Name of a built-in robot, or path of a .urdf, .toml or .par.
    #[arg(required_unless_present = "list")]
    robot: Option<String>,
    /// Logs to diagnose: LOG, LOG@5..7.5 (seconds) or LOG@#635..3510 (rows).
    #[arg(required_unless_present = "list", value_name = "LOG")]
    logs: Vec<String>,
    /// A log of another motion, to confirm and prove; may be given several times.
    #[arg(long, value_name = "LOG")]
    validate: Vec<String>,
    /// The parameters are known and stay as they are: ask what has changed. The JSON of `idim
    /// identify --json`, or a TOML with a [parameters] table.
    #[arg(long, value_name = "FILE")]
    nominal: Option<PathBuf>,
    /// Mass of the load that is at the tool, kg: sets the scale of the torques.
    #[arg(long, value_name = "KG", requires = "nominal", value_parser = mass)]
    load_mass: Option<f64>,
    /// Write the robot description with the effects found and the refitted parameters.
    #[arg(long, value_name = "FILE")]
    write: Option<PathBuf>,
    /// Folder for the torques predicted along each validation log, before and after.
    #[arg(long, value_name = "DIR", requires = "validate")]
    predictions: Option<PathBuf>,
    /// Cut-off of the prefilter of q, Hz.
    #[arg(long, value_name = "HZ")]
    fq: Option<f64>,
    /// Decimation ratio.
    #[arg(long, value_name = "N")]
    nd: Option<usize>,
    /// Log companion, instead of the .toml beside each log.
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Write a page with where the gap is, what was found, and the gap before and after; `-` for
    /// standard output.
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Write the result as JSON; `-` for standard output.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Print nothing but what was asked for as a file.
    #[arg(long)]
    quiet: bool,
    /// Print the catalogue: names, formulas, parameters, what they are confused with.
    #[arg(long, exclusive = true)]
    list: bool,
}

fn mass(text: &str) -> Result<f64, String> {
    let mass = text.parse::<f64>().ok();
    mass.filter(|mass| mass.is_finite() && *mass > 0.0)
        .ok_or_else(|| "a mass in kg, larger than zero".to_owned())
}

/// Diagnoses, reports.
///
/// # Errors
/// [`Failure`]: a robot or log that cannot be read, a diagnosis that is not possible, a file that
/// cannot be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Some(name) = arguments.robot.as_deref().filter(|_| !arguments.list) else {
        return output::print(&listing());
    };
    let spinner = Spinner::new(arguments.quiet);
    let (robot, model) = robot::both(name)?;
    let read = |names| read(model.as_ref(), names, arguments.map.as_deref(), &spinner);
    let (train, validate) = (read(&arguments.logs)?, read(&arguments.validate)?);
    let options = Options {
        fq_hz: arguments.fq,
        nd: arguments.nd,
        draw: arguments.html.is_some(),
    };
    let catalogue = Effects::new(&robot);
    let known = arguments.nominal.as_deref();
    let known =
        known.map(|path| known_values(path, model.as_ref(), &robot).map(|values| (path, values)));
    let logs = (train.as_slice(), validate.as_slice());
    let (mut diagnosis, predictions) = match known.transpose()? {
        Some((path, values)) => {
            let nominal = Nominal {
                source: &path.display().to_string(),
                values: &values,
                load_mass: arguments.load_mass,
            };
            let catalogue = Changes::new(&catalogue);
            changes(
                model.as_ref(),
                &catalogue,
                &nominal,
                logs,
                &options,
                &spinner,
            )?
        }
        None => diagnose(model.as_ref(), &catalogue, logs, &options, &spinner)?,
    };
    diagnosis.command = Some(output::command_line());
    let extension = catalogue
        .extension(&diagnosis)
        .map_err(write::not_extended)?;
    let motions = match arguments.simulates() {
        true => motions(
            model.as_ref(),
            &mut diagnosis,
            (&catalogue, &extension),
            (&validate, &spinner),
        ),
        false => Vec::new(),
    };
    if let Some(folder) = &arguments.predictions {
        predicted(folder, &validate, predictions, motions)?;
    }
    let mut text = diagnosed(&diagnosis);
    if let Some(path) = &arguments.write {
        write::write(path, &Texts::of(name)?, &diagnosis, &extension)?;
        text += &write::summary(path, &diagnosis, &extension);
    }
    spinner.finish();
    if let Some(path) = &arguments.html {
        output::text(path, &diagnosis_html(&diagnosis))?;
    }
    if let Some(path) = &arguments.json {
        output::json(path, &diagnosis)?;
    }
    let files = [&arguments.html, &arguments.json, &arguments.write];
    if arguments.quiet
        || files
            .iter()
            .any(|file| output::claims_stdout(file.as_deref()))
    {
        return Ok(());
    }
    output::print(&text)
}

/// The values of `--nominal`, all of them.
fn known_values(
    path: &Path,
    model: &dyn IdentificationModel,
    robot: &Robot,
) -> Result<Vec<f64>, Failure> {
    let missing = match parameters::read(path, model, robot) {
        Err(Failure::Simulate(SimulateError::Missing { names, .. })) => names,
        other => return other,
    };
    let (name, all) = (model.name(), model.columns().len());
    // What most of is missing was made for something else.
    let message = match 2 * missing.len() > all {
        true => format!(
            "these are not the parameters of {name}: {} of its {all} have no value; give what \
             `idim identify {name} LOG --json FILE` writes",
            missing.len()
        ),
        false => format!(
            "no value for {} of {name}, and --nominal keeps every parameter as it is: add {} to \
             [parameters], or identify them",
            missing.join(", "),
            if missing.len() == 1 { "it" } else { "them" }
        ),
    };
    Err(Failure::Parameters {
        path: path.to_owned(),
        message,
    })
}

/// The catalogue as text.
fn listing() -> String {
    let names = |pairs: &[(&str, &str)]| -> String {
        let pair = |(name, unit): &(&str, &str)| match unit.is_empty() {
            true => (*name).to_owned(),
            false => format!("{name} ({unit})"),
        };
        pairs.iter().map(pair).collect::<Vec<_>>().join(", ")
    };
    let mut text = String::new();
    for entry in entries() {
        text.push_str(&format!(
            "{}: {}\n  torque: {}\n",
            entry.name, entry.meaning, entry.formula
        ));
        let mut line = |what: &str, of: String| {
            if !of.is_empty() {
                text.push_str(&format!("  {what}: {of}\n"));
            }
        };
        line("parameters", names(entry.parameters));
        line("shape", names(entry.shape));
        line("often taken for", entry.confused_with.join(", "));
        line("to tell", entry.experiment.to_owned());
    }
    text
}

fn read(
    model: &dyn IdentificationModel,
    names: &[String],
    map: Option<&Path>,
    spinner: &Spinner,
) -> Result<Vec<Log>, Failure> {
    let options = ReadOptions {
        require_torque: true,
        companion: map.map(Path::to_owned),
    };
    let read = |name: &String| {
        spinner.say(&format!("reading {name}"));
        let spec: LogSpec = name.parse()?;
        let drives = &model.settings().drives;
        let (mut recording, companion) = log::read(&spec, model.joints(), drives, &options)?;
        settle_units(
            model,
            &mut recording,
            &companion,
            &Identification::default(),
        );
        let off = fits::reference(model, &recording, &companion)?;
        recording.warnings.extend(off);
        Ok(Log {
            recording,
            companion,
        })
    };
    names.iter().map(read).collect()
}

impl Arguments {
    /// Whether motions are simulated: for those who want a file, since it takes longer than all
    /// the rest.
    fn simulates(&self) -> bool {
        self.json.is_some() || self.html.is_some() || self.predictions.is_some()
    }
}

/// Simulates the motion of each validation log that has a reference and a controller, and notes
/// the gap on the last of them.
pub(super) fn motions(
    model: &dyn IdentificationModel,
    diagnosis: &mut Diagnosis,
    (catalogue, extension): (&Effects, &Extension),
    (logs, spinner): (&[Log], &Spinner),
) -> Vec<Option<Motions>> {
    let mut all = Vec::new();
    for log in logs {
        spinner.say(&format!("simulating {}", log.recording.name));
        let found = simulated::motions(model, diagnosis, (catalogue, extension), log);
        let found = found.unwrap_or_else(|why| {
            diagnosis.warnings.push(why.to_string());
            None
        });
        if let Some(motions) = &found {
            diagnosis.gap.simulation = Some(simulated::gap(log, motions));
            if let Some(pictures) = &mut diagnosis.pictures {
                pictures.motion = simulated::curves(model, log, motions);
            }
        }
        all.push(found);
    }
    let simulated = all.iter().flatten().next();
    let left_out = simulated.map(|motions: &Motions| motions.left_out.clone());
    diagnosis.warnings.extend(left_out.unwrap_or_default());
    all
}

/// `LOGSTEM_before.csv.gz` and `LOGSTEM_after.csv.gz` of each validation log: t, tau1.. on its
/// rows, and q1.. where its motion was simulated.
fn predicted(
    folder: &Path,
    logs: &[Log],
    predictions: Vec<Prediction>,
    motions: Vec<Option<Motions>>,
) -> Result<(), Failure> {
    let mut files = Predictions::new(folder)?;
    for ((log, Prediction { before, after }), motions) in logs.iter().zip(predictions).zip(motions)
    {
        let mut columns = [vec![("tau", before)], vec![("tau", after)]];
        if let Some(Motions { before, after, .. }) = motions {
            columns[0].push(("q", before));
            columns[1].push(("q", after));
        }
        files.write(&log.recording, ["before", "after"].into_iter().zip(columns))?;
    }
    Ok(())
}
