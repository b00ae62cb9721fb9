//! The study behind table 1 of Gautier 1996: how far the filters alone falsify parameters, on logs
//! without noise of the demo's robot.

use idim_codegen::builder::BuildError;
use idim_runtime::identify::{IdentifyError, Options, identify};
use idim_runtime::knowledge::Knowledge;
use idim_runtime::log::Recording;
use idim_runtime::model::{
    Column, IdentificationModel, Joint, Output, Pattern, Presliding, States,
};
use idim_runtime::observe::ModelKind;
use idim_runtime::report::Identification;
use idim_runtime::settings::Settings;

use crate::demo;
use crate::robots;

/// Why the study cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The built-in robot.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// An identification.
    #[error(transparent)]
    Identify(#[from] IdentifyError),
}

/// The SCARA without settings of its own: filters are chosen from the data.
#[derive(Debug, Default)]
pub struct Unset {
    settings: Settings,
}

impl IdentificationModel for Unset {
    fn name(&self) -> &str {
        robots::scara::Model.name()
    }
    fn joints(&self) -> &[Joint] {
        robots::scara::Model.joints()
    }
    fn columns(&self) -> &[Column] {
        robots::scara::Model.columns()
    }
    fn pattern(&self, output: Output) -> &Pattern {
        robots::scara::Model.pattern(output)
    }
    fn settings(&self) -> &Settings {
        &self.settings
    }
    fn knowledge(&self) -> &Knowledge {
        robots::scara::Model.knowledge()
    }
    fn presliding(&self) -> &[Presliding] {
        robots::scara::Model.presliding()
    }
    fn evaluate(&self, output: Output, states: &States<'_>, signals: &mut [f64]) {
        robots::scara::Model.evaluate(output, states, signals);
    }
}

/// Largest relative error of any parameter, percent, by the explicit, implicit and power model.
pub type Errors = [f64; 3];

/// The errors on a log, with the paper's filters (`own` false) or with those that are chosen from
/// the data.
///
/// # Errors
/// [`IdentifyError`].
pub fn errors(log: &Recording, truth: &[f64], own: bool) -> Result<Errors, IdentifyError> {
    let (paper, unset) = (robots::scara::Model, Unset::default());
    let model: &dyn IdentificationModel = if own { &unset } else { &paper };
    let logs = std::slice::from_ref(log);
    let found = identify(model, logs, &[], &Options::default(), &())?;
    Ok(ModelKind::ALL.map(|kind| largest(&found, kind, truth)))
}

/// The errors on the random moves of a seed.
///
/// # Errors
/// [`StudyError`].
pub fn errors_of(seed: u128, own: bool) -> Result<Errors, StudyError> {
    let experiment = demo::experiment_of(seed)?;
    Ok(errors(&experiment.recording, &experiment.truth, own)?)
}

fn largest(found: &Identification, kind: ModelKind, truth: &[f64]) -> f64 {
    let Some(model) = found.model(kind) else {
        return f64::NAN;
    };
    let pairs = model.parameters.iter().zip(truth);
    let error = pairs.map(|(p, x)| {
        p.value
            .map_or(f64::INFINITY, |value| (value / x - 1.0).abs())
    });
    100.0 * error.fold(0.0, f64::max)
}
