//! `idim excite`: a motion along which the parameters of a robot can be told apart.

mod limits;
mod noise;
mod separate;
mod write;

use std::path::PathBuf;

use clap::ValueEnum;
use idim::runtime::excite::{
    Criterion, Excitation, Family, Search, Settings, Start, Task, excite, stages,
};
use idim::runtime::model::IdentificationModel;
use idim::runtime::report::excitation_terminal;
use indicatif::{ProgressBar, ProgressStyle};

use super::simulate::parameters;
use super::{Failure, output, robot};

/// Sampling rate of the log that is counted on, Hz.
const RATE_HZ: f64 = 1000.0;

/// Families of motions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Truncated Fourier series.
    Fourier,
    /// Polynomials of degree five between points.
    ViaPoints,
}

/// How a motion begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Begin {
    /// At rest at its centre, and ends there.
    Rest,
    /// Moving (Fourier series only).
    Moving,
}

/// What is minimised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Measure {
    /// Condition number of W, SI units.
    Condition,
    /// Condition number of W with columns of unit norm.
    Scaled,
    /// Volume in which the parameters will be known to lie (D-optimal).
    Determinant,
}

/// Arguments of `idim excite`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Name of a built-in robot, or path of a .urdf, .toml or .par.
    robot: String,
    /// Write the motion there: a TOML with the [reference] that `idim simulate --trajectory` reads.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Write the motion as samples: t, q1_ref.., qd1_ref.., qdd1_ref...
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Family of the motion.
    #[arg(long, value_enum, default_value = "fourier")]
    family: Kind,
    /// Harmonics of a Fourier series.
    #[arg(long, value_name = "N", default_value_t = 5, conflicts_with = "points")]
    harmonics: usize,
    /// Points of a motion through points, between its start and its end; default 6.
    #[arg(long, value_name = "N")]
    points: Option<usize>,
    /// How the motion begins and ends.
    #[arg(long, value_enum, default_value = "rest")]
    start: Begin,
    /// One period, s.
    #[arg(long, value_name = "S", default_value_t = 10.0)]
    period: f64,
    /// How often it is repeated.
    #[arg(long, value_name = "N", default_value_t = 1)]
    periods: usize,
    /// What is minimised.
    #[arg(long, value_enum, default_value = "condition")]
    criterion: Measure,
    /// Tell these effects apart instead: names of the catalogue at joints (stribeck@2,
    /// drive_gain@elbow), of the whole robot (base_tilt), or of parameters (FV2), separated by commas.
    #[arg(
        long,
        value_name = "WHAT",
        value_delimiter = ',',
        conflicts_with = "criterion"
    )]
    separate: Vec<String>,
    #[command(flatten)]
    limits: limits::Given,
    /// Present parameters: the JSON of `idim identify --json`, or a TOML with a [parameters] table.
    /// Efforts are limited with them, and relative standard deviations are told.
    #[arg(long, value_name = "FILE")]
    parameters: Option<PathBuf>,
    /// Standard deviation of the torque's noise: one number, one for each joint, or the JSON of
    /// `idim identify --json`; default: 1 % of the effort limit, or else 1.
    #[arg(long, value_name = "N.m|FILE")]
    noise: Option<String>,
    /// Samples per second of the log to come, and of --csv, Hz.
    #[arg(long, value_name = "HZ", default_value_t = RATE_HZ)]
    rate: f64,
    /// Say how many periods this relative standard deviation takes, %.
    #[arg(long, value_name = "PCT", requires = "parameters")]
    wanted_pct: Option<f64>,
    /// Seed of the search: equal seeds give equal motions.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Starts of the search.
    #[arg(long, value_name = "N", default_value_t = 8)]
    starts: usize,
    /// Most steps downhill from each start.
    #[arg(long, value_name = "N", default_value_t = 150)]
    steps: usize,
    /// Write the result as JSON; `-` for standard output.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Print nothing but what was asked for as a file.
    #[arg(long)]
    quiet: bool,
}

/// Searches, writes, reports.
///
/// # Errors
/// [`Failure`]: a robot or file that cannot be read, limits that no motion keeps to, effects that are
/// not known or cannot be told apart, a file that cannot be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (mut robot, mut model) = robot::both(&arguments.robot)?;
    let parameters = arguments.parameters.as_deref();
    let given = parameters.map(|path| parameters::read(path, model.as_ref(), &robot));
    let mut values = given.transpose()?;
    let mut criterion = arguments.criterion();
    if !arguments.separate.is_empty() {
        let extended = separate::extended(&robot, values.as_deref(), &arguments.separate)?;
        values = extended.values;
        criterion = Criterion::Separate {
            columns: extended.columns,
        };
        (robot, model) = (extended.robot, Box::new(extended.model));
    }
    let (limits, assumed) = arguments.limits.settle(model.as_ref(), &robot)?;
    let center = arguments.limits.center(model.as_ref())?;
    let noise = noise::of(arguments, model.as_ref(), &limits)?;
    let settings = arguments.settings(criterion, noise);
    let task = Task {
        model: model.as_ref(),
        limits: &limits,
        center: center.as_deref(),
        parameters: values.as_deref(),
    };
    let bar = bar(arguments.quiet, stages(&settings));
    let found = excite(&task, &settings, &|| bar.inc(1));
    bar.finish_and_clear();
    let mut found = found?;
    found.warnings.splice(0..0, assumed);
    save(arguments, model.as_ref(), &found)
}

/// Shown on standard error while it is a terminal.
fn bar(quiet: bool, stages: usize) -> ProgressBar {
    let bar = match quiet {
        true => ProgressBar::hidden(),
        false => ProgressBar::new(stages as u64),
    };
    match ProgressStyle::with_template("searching {bar:40} {pos}/{len} {eta}") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Writes what was asked for, whole, and tells the rest.
fn save(
    arguments: &Arguments,
    model: &dyn IdentificationModel,
    found: &Excitation,
) -> Result<(), Failure> {
    if let Some(path) = &arguments.output {
        output::write_whole(path, &write::trajectory(found, &output::command_line()))?;
    }
    if let Some(path) = &arguments.csv {
        write::samples(path, found, arguments.rate)?;
    }
    if let Some(path) = &arguments.json {
        output::json(path, found)?;
    }
    if arguments.quiet || output::claims_stdout(arguments.json.as_deref()) {
        return Ok(());
    }
    let mut text = excitation_terminal(found);
    let files = [
        (&arguments.output, "the motion"),
        (&arguments.csv, "its samples"),
    ];
    for (path, what) in files {
        if let Some(path) = path {
            text.push_str(&format!("written: {}, {what}\n", path.display()));
        }
    }
    if let Some(path) = &arguments.output {
        text.push_str(&format!(
            "try it: idim simulate {} --trajectory {} --parameters FILE\n",
            model.name(),
            path.display()
        ));
    }
    output::print(&text)
}

impl Arguments {
    fn criterion(&self) -> Criterion {
        match self.criterion {
            Measure::Condition => Criterion::Condition,
            Measure::Scaled => Criterion::Scaled,
            Measure::Determinant => Criterion::Determinant,
        }
    }

    fn settings(&self, criterion: Criterion, noise: idim::runtime::excite::Noise) -> Settings {
        let Arguments {
            seed,
            starts,
            steps,
            ..
        } = *self;
        Settings {
            family: match self.family {
                Kind::Fourier => Family::Fourier {
                    harmonics: self.harmonics,
                },
                Kind::ViaPoints => Family::ViaPoints {
                    points: self.points.unwrap_or(6),
                },
            },
            start: match self.start {
                Begin::Rest => Start::Rest,
                Begin::Moving => Start::Moving,
            },
            criterion,
            period_s: self.period,
            periods: self.periods,
            search: Search {
                seed,
                starts,
                steps,
            },
            noise,
            wanted_pct: self.wanted_pct,
        }
    }
}
