//! `idim identify --loaded`: what logged torques must be multiplied with, by a known load.

use std::path::Path;

use idim::runtime::identify::{KnownLoad, Options, gains};
use idim::runtime::log::Recording;
use idim::runtime::model::IdentificationModel;
use idim::runtime::observe::ModelKind;
use idim::runtime::report::{DriveGains, gains_terminal};

use super::Failure;
use super::output;
use super::progress::Spinner;

/// A known load on the last link, and the logs with it.
#[derive(Debug, clap::Args)]
pub struct Load {
    /// A log with a known load on the last link: the factors of the logged torques are identified
    /// from it and LOG without the load; may be given several times.
    #[arg(long, value_name = "LOG",
          conflicts_with_all = ["validate", "predictions", "html", "instruments", "payload"])]
    pub loaded: Vec<String>,
    /// Mass of that load, kg.
    #[arg(long, value_name = "KG", allow_negative_numbers = true)]
    load_mass: Option<f64>,
    /// Its centre of mass in the (modified Denavit-Hartenberg) frame of the last link, m.
    #[arg(long, value_name = "X,Y,Z", value_parser = centre, allow_hyphen_values = true,
          requires = "load_mass")]
    load_com: Option<[f64; 3]>,
}

fn centre(text: &str) -> Result<[f64; 3], String> {
    let parts = text.split(',').map(|part| part.trim().parse::<f64>().ok());
    parts
        .collect::<Option<Vec<_>>>()
        .and_then(|parts| parts.try_into().ok())
        .ok_or_else(|| "three numbers of m, such as 0,0.02,0.1".to_owned())
}

impl Load {
    /// The load, if there is one and everything asked for goes with it.
    ///
    /// # Errors
    /// [`Failure::Usage`].
    pub fn known(&self, options: &Options, links: usize) -> Result<Option<KnownLoad>, Failure> {
        let usage = |message: &str, help: &str| Failure::Usage {
            message: message.into(),
            help: help.into(),
        };
        match (self.loaded.is_empty(), self.load_mass) {
            (true, None) => Ok(None),
            (true, Some(_)) => Err(usage(
                "--load-mass without --loaded: there is no log with the load",
                "name the log with --loaded LOG",
            )),
            (false, None) => Err(usage(
                "--loaded without --load-mass: only a known mass sets the scale of the torques",
                "weigh the load and give --load-mass KG; an unknown load on a robot whose torques \
                 are right is --payload",
            )),
            (false, Some(_)) if options.models.iter().any(|m| *m != ModelKind::Explicit) => {
                Err(usage(
                    "--loaded identifies with the explicit model alone",
                    "leave --models out, or say --models explicit",
                ))
            }
            (false, Some(mass)) => Ok(Some(KnownLoad {
                link: links.saturating_sub(1),
                mass,
                com: self.load_com,
            })),
        }
    }
}

/// Identifies the gains and reports them.
///
/// # Errors
/// [`Failure::Identify`], [`Failure::Write`].
pub fn report(
    model: &dyn IdentificationModel,
    logs: (&[Recording], &[Recording]),
    (load, options): (&KnownLoad, &Options),
    (json, quiet): (Option<&Path>, bool),
    spinner: &Spinner,
) -> Result<(), Failure> {
    let found: DriveGains = gains(model, logs, load, options, spinner)?;
    spinner.finish();
    if let Some(path) = json {
        output::json(path, &found)?;
    }
    match quiet || output::claims_stdout(json) {
        true => Ok(()),
        false => output::print(&gains_terminal(&found)),
    }
}
