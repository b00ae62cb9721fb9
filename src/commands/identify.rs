//! `idim identify`: parameters from measured logs, by the three models side by side.

mod logs;

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use idim::runtime::identify::{Options, PriorUse, identify, instruments, payload, predict, series};
use idim::runtime::log::{Companion, Log, Recording};
use idim::runtime::model::IdentificationModel;
use idim::runtime::observe::ModelKind;
use idim::runtime::report::{Identification, ModelResult, Role, html, payload_terminal, terminal};
use idim::runtime::settings::{Derivatives, Edges, Velocity, Weights};

use super::predictions::Predictions;
use super::progress::Spinner;
use super::simulate::parameters;
use super::{Failure, gains, output, robot};
use logs::{Reading, all_held, beginnings, recordings, settle};

/// Arguments of `idim identify`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Name of a built-in robot, or path of a .urdf, .toml or .par.
    robot: String,
    /// Logs to identify from: LOG, LOG@5..7.5 (seconds) or LOG@#635..3510 (rows).
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<String>,
    /// A log to validate on; may be given several times.
    #[arg(long, value_name = "LOG")]
    validate: Vec<String>,
    /// Folder for the torques predicted along each validation log.
    #[arg(long, value_name = "DIR")]
    predictions: Option<PathBuf>,
    #[command(flatten)]
    choices: Choices,
    /// Instrumental variables beside least squares: unbiased where W is noisy. `simulated` takes
    /// them from closed-loop simulation, with reference and controller of the log's companion.
    #[arg(long, value_enum)]
    instruments: Option<Instruments>,
    /// Identify a load on the last link instead, relative to the known robot of --nominal or of the
    /// description; LINK (from 1) for another link.
    #[arg(long, value_name = "LINK", num_args = 0..=1, default_missing_value = "0",
          conflicts_with_all = ["validate", "predictions", "html", "instruments"])]
    payload: Option<usize>,
    /// Parameters of the robot without load: the JSON of `idim identify --json`, or a TOML with a
    /// [parameters] table.
    #[arg(long, value_name = "FILE", requires = "payload")]
    nominal: Option<PathBuf>,
    #[command(flatten)]
    known: gains::Load,
    /// Log companion, instead of the .toml beside each log.
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Write the result as JSON; `-` for standard output.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the result as one self-contained page; the JSON then holds the curves it draws, too.
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Print nothing but what was asked for as a file.
    #[arg(long)]
    quiet: bool,
}

/// Filters, weights and models; what is not given comes from the robot or from the data.
#[derive(Debug, Default, clap::Args)]
pub struct Choices {
    /// Models to identify.
    #[arg(long, value_enum, value_delimiter = ',')]
    models: Vec<Model>,
    /// Cut-off of the prefilter of q, Hz.
    #[arg(long, value_name = "HZ")]
    fq: Option<f64>,
    /// Decimation ratio.
    #[arg(long, value_name = "N")]
    nd: Option<usize>,
    /// Order of the prefilter.
    #[arg(long, value_name = "N")]
    order: Option<usize>,
    /// Cut off at either end: samples before decimation (scipy edges), or decimated rows (matlab).
    #[arg(long, value_name = "N")]
    trim: Option<usize>,
    /// Samples cut off at the start and at the end before decimation, whatever the edges.
    #[arg(long, value_name = "START,END", value_parser = border)]
    border: Option<(usize, usize)>,
    /// Edge rule of the filters.
    #[arg(long, value_enum)]
    edges: Option<EdgeRule>,
    /// Differences of two neighbours (central), or of eighth order with a zero velocity where it is
    /// uncertain (eighth): the default where no edge rule is given.
    #[arg(long, value_enum)]
    derivatives: Option<Differences>,
    /// Weights of the equations.
    #[arg(long, value_enum)]
    weights: Option<Weighting>,
    /// Joint velocity: differences of q, or the log's own.
    #[arg(long, value_enum)]
    velocity: Option<Source>,
    /// Pass the torque through the prefilter too.
    #[arg(long)]
    prefilter_torque: bool,
    /// Tolerances of the description ([prior]): an estimate with them beside the classical one.
    #[arg(long, value_enum, default_value = "use")]
    prior: Prior,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Model {
    Explicit,
    Implicit,
    Power,
}

#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum Prior {
    #[default]
    Use,
    Ignore,
}

/// Where instruments come from.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Instruments {
    Simulated,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum EdgeRule {
    Matlab,
    Scipy,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Differences {
    Central,
    Eighth,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Weighting {
    None,
    Joint,
    Robust,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Source {
    Derived,
    Measured,
}

fn border(text: &str) -> Result<(usize, usize), String> {
    let parse = |part: &str| part.trim().parse::<usize>().ok();
    text.split_once(',')
        .and_then(|(start, end)| Some((parse(start)?, parse(end)?)))
        .ok_or_else(|| "two numbers of samples, such as 49,0".to_owned())
}

impl Choices {
    fn options(&self) -> Options {
        let kind = |model: &Model| match model {
            Model::Explicit => ModelKind::Explicit,
            Model::Implicit => ModelKind::Implicit,
            Model::Power => ModelKind::Power,
        };
        Options {
            models: self.models.iter().map(kind).collect(),
            fq_hz: self.fq,
            order: self.order,
            nd: self.nd,
            trim: self.trim,
            border: self.border,
            edges: self.edges.map(|edges| match edges {
                EdgeRule::Matlab => Edges::Matlab,
                EdgeRule::Scipy => Edges::Scipy,
            }),
            derivatives: self.derivatives.map(|by| match by {
                Differences::Central => Derivatives::Central,
                Differences::Eighth => Derivatives::Eighth,
            }),
            weights: self.weights.map(|weights| match weights {
                Weighting::None => Weights::None,
                Weighting::Joint => Weights::Joint,
                Weighting::Robust => Weights::Robust,
            }),
            velocity: self.velocity.map(|source| match source {
                Source::Derived => Velocity::Derived,
                Source::Measured => Velocity::Measured,
            }),
            prefilter_torque: self.prefilter_torque.then_some(true),
            prior: match self.prior {
                Prior::Use => PriorUse::Use,
                Prior::Ignore => PriorUse::Ignore,
            },
        }
    }
}

/// Identifies, validates, reports.
///
/// # Errors
/// [`Failure`]: a robot or log that cannot be read, an identification that is not possible, a
/// file that cannot be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.predictions.is_some() && arguments.validate.is_empty() {
        return Err(Failure::Usage {
            message: "--predictions without --validate: there is no log to predict".into(),
            help: "name the log with --validate LOG".into(),
        });
    }
    let spinner = Spinner::new(arguments.quiet);
    let robot = robot::open(&arguments.robot)?;
    let options = arguments.choices.options();
    let known = arguments.known.known(&options, robot.joints.len())?;
    let reading = Reading::new(&robot, arguments.map.as_deref(), &spinner);
    // Side by side on the threads that parse: a further one would only be in their way.
    let (train, model) = rayon::join(|| reading.read(&arguments.logs), || robot.model());
    let (model, mut train) = (model?, train?);
    settle(model.as_ref(), &mut train, &options)?;
    let read = |names| {
        let mut logs = reading.read(names)?;
        settle(model.as_ref(), &mut logs, &options)?;
        Ok::<_, Failure>(logs)
    };
    if let Some(known) = known {
        let (unloaded, loaded) = (
            recordings(&train)?,
            recordings(&read(&arguments.known.loaded)?)?,
        );
        let files = (arguments.json.as_deref(), arguments.quiet);
        let logs = (unloaded.as_slice(), loaded.as_slice());
        return gains::report(model.as_ref(), logs, (&known, &options), files, &spinner);
    }
    if let Some(link) = arguments.payload {
        return load(model.as_ref(), link, &train, arguments, &spinner);
    }
    let validate = read(&arguments.validate)?.into_iter();
    let validate: Vec<Log> = validate.map(|(log, _)| log).collect();
    let (train, companions): (Vec<Log>, Vec<Companion>) = train.into_iter().unzip();
    let mut result = identify(model.as_ref(), &train, &validate, &options, &spinner)?;
    if let Some(Instruments::Simulated) = arguments.instruments {
        let logs: Vec<_> = all_held(&train)?.into_iter().zip(companions).collect();
        instruments(
            model.as_ref(),
            &logs,
            &all_held(&validate)?,
            &mut result,
            &spinner,
        )?;
    }
    result.command = Some(output::command_line());
    if let Some(folder) = &arguments.predictions {
        predictions(model.as_ref(), &all_held(&validate)?, &result, folder)?;
    }
    if arguments.html.is_some() {
        spinner.say("drawing");
        let (train, validate) = (beginnings(&train)?, beginnings(&validate)?);
        draw(model.as_ref(), &train, &validate, &mut result)?;
    }
    spinner.finish();
    if let Some(path) = &arguments.html {
        output::text(path, &html(&result))?;
    }
    if let Some(path) = &arguments.json {
        output::json(path, &result)?;
    }
    let files = [arguments.json.as_deref(), arguments.html.as_deref()];
    if arguments.quiet || files.into_iter().any(output::claims_stdout) {
        return Ok(());
    }
    output::print(&terminal(&result))
}

/// Identifies a load and reports it.
fn load(
    model: &dyn IdentificationModel,
    link: usize,
    logs: &[(Log, Companion)],
    arguments: &Arguments,
    spinner: &Spinner,
) -> Result<(), Failure> {
    let link = link.checked_sub(1).unwrap_or(model.joints().len() - 1);
    let nominal = match &arguments.nominal {
        Some(path) => parameters::read(path, model, &robot::derived(&arguments.robot)?)?,
        None => described(model)?,
    };
    let logs = recordings(logs)?;
    let options = arguments.choices.options();
    let found = payload(model, &logs, (&nominal, link), &options, spinner)?;
    spinner.finish();
    if let Some(path) = &arguments.json {
        output::json(path, &found)?;
    }
    if arguments.quiet || output::claims_stdout(arguments.json.as_deref()) {
        return Ok(());
    }
    output::print(&payload_terminal(&found))
}

/// All parameters by the description, if it has them all.
fn described(model: &dyn IdentificationModel) -> Result<Vec<f64>, Failure> {
    let known = model.knowledge();
    let columns = model.columns().iter().enumerate();
    let missing: Vec<&str> = columns
        .filter(|(k, _)| known.value(*k).is_none())
        .map(|(_, column)| column.name.as_ref())
        .collect();
    if missing.is_empty() {
        let values = (0..model.columns().len()).filter_map(|k| known.value(k));
        return Ok(values.collect());
    }
    Err(Failure::Usage {
        message: format!(
            "--payload needs the robot without load, and the description says nothing of {}",
            missing.join(", ")
        ),
        help: "identify the robot without load first, with --json FILE, and give --nominal FILE"
            .into(),
    })
}

/// Adds to a result what its page draws of each log.
///
/// # Errors
/// [`Failure::Identify`].
pub fn draw(
    model: &dyn IdentificationModel,
    train: &[Recording],
    validate: &[Recording],
    result: &mut Identification,
) -> Result<(), Failure> {
    let training = train.iter().map(|log| (log, Role::Training));
    let held_out = validate.iter().map(|log| (log, Role::Validation));
    for (log, role) in training.chain(held_out) {
        let drawn = series(model, log, role, result)?;
        result.series.push(drawn);
    }
    Ok(())
}

/// `LOGSTEM_MODEL.csv.gz` for each validation log and model: t, tau1.. on the rows of the log.
fn predictions(
    model: &dyn IdentificationModel,
    logs: &[Recording],
    result: &Identification,
    folder: &Path,
) -> Result<(), Failure> {
    let mut files = Predictions::new(folder)?;
    for recording in logs {
        let along = |found: &ModelResult| {
            let (x, kind) = (found.solution(), found.name);
            Ok((
                kind.name(),
                vec![("tau", predict(model, recording, &x, &result.filter, kind)?)],
            ))
        };
        let torques: Vec<_> = result
            .models
            .iter()
            .map(along)
            .collect::<Result<_, Failure>>()?;
        files.write(recording, torques)?;
    }
    Ok(())
}
