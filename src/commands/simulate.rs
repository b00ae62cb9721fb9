//! `idim simulate`: how a robot with given parameters moves.

pub(super) mod parameters;
mod show;

use std::path::{Path, PathBuf};

use idim::runtime::identify::{Options as Identification, settle_units};
use idim::runtime::log::{
    self, Companion, Controller, Feedforward, LogSpec, ReadOptions, Recording, Reference,
};
use idim::runtime::model::IdentificationModel;
use idim::runtime::simulate::{
    self, ClosedLoop, Grid, Method, Options, Simulation, Trajectory, rigid_only,
};

use super::progress::Spinner;
use super::{Failure, fits, output, robot};

/// Sampling rate of a trajectory that says none, Hz.
const RATE_HZ: f64 = 1000.0;

/// Most samples that a trajectory is simulated for.
const LONGEST: f64 = 1e8;

/// Arguments of `idim simulate`.
#[derive(Debug, clap::Args)]
#[command(group(clap::ArgGroup::new("motion").required(true).args(["trajectory", "like"])))]
pub struct Arguments {
    /// Name of a built-in robot, or path of a .urdf, .toml or .par.
    robot: String,
    /// Parameters: the JSON of `idim identify --json`, or a TOML with a [parameters] table.
    #[arg(long, value_name = "FILE")]
    parameters: PathBuf,
    /// TOML with the [reference] to follow and the [controller]; without one it is followed exactly.
    #[arg(long, value_name = "FILE")]
    trajectory: Option<PathBuf>,
    /// Log whose reference and controller (or else whose torque) drive the robot.
    #[arg(long, value_name = "LOG")]
    like: Option<String>,
    /// Companion of the log, if it is not the one beside it.
    #[arg(long, value_name = "FILE", requires = "like")]
    map: Option<PathBuf>,
    /// Write the simulated log (t, q1.., qd1.., tau1..) there instead of to standard output.
    #[arg(short, long, value_name = "LOG")]
    output: Option<PathBuf>,
    /// Samples per second of a trajectory; default: its rate_hz, or 1000.
    #[arg(long, value_name = "HZ", conflicts_with = "like")]
    rate: Option<f64>,
    /// Largest step of the integration, s; default 0.0005.
    #[arg(long, value_name = "S")]
    step: Option<f64>,
    /// Variable steps with this relative and absolute tolerance instead.
    #[arg(long, value_name = "X", conflicts_with = "step")]
    tolerance: Option<f64>,
    /// Print nothing but the log.
    #[arg(long)]
    quiet: bool,
}

/// A simulation with what it is compared to.
pub struct Run {
    result: Simulation,
    /// What drove the robot.
    driven: String,
    /// Whether nothing corrected it.
    open: bool,
    reference: Option<Vec<Vec<f64>>>,
    log: Option<Vec<Vec<f64>>>,
    /// What is odd about the log, and where it leaves its reference or its controller.
    warnings: Vec<String>,
    /// Whether it leaves one of them.
    misfit: bool,
}

impl Run {
    /// Motions on the same grid, with what the distance from them means.
    fn compared(&self) -> impl Iterator<Item = (&Vec<Vec<f64>>, &'static str)> {
        let reference = self.reference.iter().map(|q| (q, "rms error to reference"));
        reference.chain(self.log.iter().map(|q| (q, "rms distance from log")))
    }
}

/// Simulates, writes, reports.
///
/// # Errors
/// [`Failure`]: a robot, log or file of parameters that cannot be read, a simulation that is not
/// possible, a file that cannot be written.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let spinner = Spinner::new(arguments.quiet);
    let (derived, model) = robot::both(&arguments.robot)?;
    let values = parameters::read(&arguments.parameters, model.as_ref(), &derived)?;
    let described = parameters::rigid(&derived);
    let source = if described.is_some() {
        "the description"
    } else {
        "the given parameters"
    };
    let rigid = described.unwrap_or_else(|| rigid_only(model.as_ref(), &values));
    let setup = Setup {
        model: model.as_ref(),
        values,
        rigid,
        source,
        arguments,
    };
    spinner.say("simulating");
    let run = match (&arguments.like, &arguments.trajectory) {
        (Some(log), _) => setup.like(log)?,
        (None, Some(path)) => setup.trajectory(path)?,
        (None, None) => {
            return Err(Failure::Usage {
                message: "nothing to simulate".into(),
                help: "give --trajectory FILE or --like LOG".into(),
            });
        }
    };
    spinner.finish();
    show::save(&run.result, arguments.output.as_deref())?;
    if arguments.quiet {
        return Ok(());
    }
    let text = show::describe(model.as_ref(), &run);
    if arguments.output.is_none() {
        eprint!("{text}");
        return Ok(());
    }
    output::print(&text)
}

/// What every simulation needs.
struct Setup<'a> {
    model: &'a dyn IdentificationModel,
    values: Vec<f64>,
    /// Of the controller's feedforward.
    rigid: Vec<f64>,
    /// Where they come from.
    source: &'static str,
    arguments: &'a Arguments,
}

impl Setup<'_> {
    fn options(&self, companion: &Companion) -> Options {
        let default = Options::default();
        let step = self.arguments.step.map(|step_s| Method::Fixed { step_s });
        let tolerance = self.arguments.tolerance;
        let variable = tolerance.map(|x| Method::Adaptive {
            relative: x,
            absolute: x,
        });
        Options {
            method: variable.or(step).unwrap_or(default.method),
            encoder_resolution: companion.encoder_resolution,
            ..default
        }
    }

    /// Along a log: its reference and controller, or its torque.
    fn like(&self, name: &str) -> Result<Run, Failure> {
        let spec: LogSpec = name.parse()?;
        let options = ReadOptions {
            require_torque: false,
            companion: self.arguments.map.clone(),
        };
        let drives = &self.model.settings().drives;
        let (mut recording, companion) = log::read(&spec, self.model.joints(), drives, &options)?;
        settle_units(
            self.model,
            &mut recording,
            &companion,
            &Identification::default(),
        );
        let off = [
            fits::reference(self.model, &recording, &companion)?,
            fits::controller(self.model, &self.rigid, &recording, &companion)?,
        ];
        let misfit = off.iter().any(Option::is_some);
        recording.warnings.extend(off.into_iter().flatten());
        let parameters = (self.values.as_slice(), self.rigid.as_slice());
        let log = (&recording, &companion);
        let result = simulate::like(self.model, parameters, log, &self.options(&companion))?;
        let grid = Grid::of(&recording);
        let open = companion.controller.is_none() || companion.reference.is_none();
        let reference = match &companion.reference {
            Some(reference) if !open => Some(Trajectory::of(reference, &grid)?.q),
            _ => None,
        };
        let driven = match &companion.controller {
            Some(controller) if !open => {
                let with = self.feedforward(controller);
                format!("closed loop{with}, reference and controller of {name}")
            }
            _ => format!("open loop under the torque of {name}"),
        };
        let Recording { q, warnings, .. } = recording;
        Ok(Run {
            result,
            driven,
            open,
            reference,
            log: Some(q),
            warnings,
            misfit,
        })
    }

    /// Along a reference, with its controller or exactly.
    fn trajectory(&self, path: &Path) -> Result<Run, Failure> {
        let companion = Companion::load(path)?;
        let Some(reference) = &companion.reference else {
            return Err(Failure::Usage {
                message: format!("{} has no [reference]", path.display()),
                help: "a trajectory file has the [reference] table of a log companion".into(),
            });
        };
        let grid = self.grid(&companion, reference)?;
        let (result, driven) = match &companion.controller {
            Some(controller) => {
                let plan = ClosedLoop {
                    reference,
                    controller,
                    rigid: &self.rigid,
                    grid,
                    start: None,
                };
                let options = self.options(&companion);
                let result = simulate::closed_loop(self.model, &self.values, &plan, &options)?;
                let with = self.feedforward(controller);
                (
                    result,
                    format!("closed loop{with}, reference of {}", path.display()),
                )
            }
            None => {
                let result = simulate::ideal(self.model, &self.values, reference, &grid)?;
                (
                    result,
                    format!("reference of {} followed exactly", path.display()),
                )
            }
        };
        let reference = Trajectory::of(reference, &grid)?.q;
        Ok(Run {
            result,
            driven,
            open: false,
            reference: Some(reference),
            log: None,
            warnings: Vec::new(),
            misfit: false,
        })
    }

    /// What the controller adds, in words.
    fn feedforward(&self, controller: &Controller) -> String {
        let kind = match controller.feedforward {
            Feedforward::None => return String::new(),
            Feedforward::Gravity => "gravity",
            Feedforward::Rigid => "rigid",
        };
        format!(" with {kind} feedforward from {}", self.source)
    }

    fn grid(&self, companion: &Companion, reference: &Reference) -> Result<Grid, Failure> {
        let rate_hz = self.arguments.rate.or(companion.rate_hz).unwrap_or(RATE_HZ);
        let samples = match (reference, reference.seconds()) {
            (Reference::Sampled { q }, _) => q.first().map_or(0, Vec::len).saturating_sub(1) as f64,
            (_, seconds) => seconds.unwrap_or(0.0) * rate_hz,
        };
        if !(samples.is_finite() && (0.0..LONGEST).contains(&samples)) {
            return Err(Failure::Usage {
                message: format!("{samples} samples cannot be simulated at {rate_hz} Hz"),
                help: "give a positive --rate and a reference of reasonable length".into(),
            });
        }
        Ok(Grid {
            rate_hz,
            start: 0.0,
            len: samples.round() as usize + 1,
        })
    }
}
