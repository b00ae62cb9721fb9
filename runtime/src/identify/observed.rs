//! What is observed along one log, or along several together.

use super::{IdentifyError, Plan, Progress};
use crate::log::Recording;
use crate::model::IdentificationModel;
use crate::observe::{ModelKind, Motion, Observations, check_torque, observe};

/// The equations of all models that a plan needs, along one or several logs.
pub(super) struct Observed {
    /// Names of the logs.
    pub logs: Vec<String>,
    /// Joints that rest in all of the logs, counted from 0.
    pub resting: Vec<usize>,
    /// Equations of each model that is needed.
    observations: Vec<Observations>,
}

impl Observed {
    /// Filters a log and makes the equations.
    pub fn new(
        model: &dyn IdentificationModel,
        log: &Recording,
        plan: &Plan,
        progress: &dyn Progress,
    ) -> Result<Self, IdentifyError> {
        check_torque(log)?;
        progress.step(&format!("filtering {}", log.name));
        let motion = Motion::trimmed(log, model.joints().len(), &plan.filtering)?;
        let mut observations = Vec::new();
        for kind in plan.observed() {
            progress.step(&format!("{} model along {}", kind.name(), log.name));
            observations.push(observe(model, kind, &motion, &plan.filtering)?);
        }
        Ok(Observed {
            logs: vec![motion.log],
            resting: motion.resting,
            observations,
        })
    }

    /// The equations of several logs together, one log after the other.
    pub fn join(
        logs: impl Iterator<Item = Result<Self, IdentifyError>>,
    ) -> Result<Self, IdentifyError> {
        let mut together: Option<Observed> = None;
        for observed in logs {
            match &mut together {
                Some(together) => together.append(observed?),
                None => together = Some(observed?),
            }
        }
        together.ok_or(IdentifyError::NoLogs)
    }

    fn append(&mut self, other: Observed) {
        self.resting.retain(|joint| other.resting.contains(joint));
        for (all, more) in self.observations.iter_mut().zip(&other.observations) {
            all.append(more);
        }
        self.logs.extend(other.logs);
    }

    /// The equations of a model.
    pub fn of(&self, kind: ModelKind) -> Result<&Observations, IdentifyError> {
        self.observations
            .iter()
            .find(|o| o.model == kind)
            .ok_or(IdentifyError::NoLogs)
    }

    /// The equations in which torque is predicted with the parameters of a model: its own, or
    /// the explicit ones for the power model, which has none for a single joint.
    pub fn torque(&self, kind: ModelKind) -> Result<&Observations, IdentifyError> {
        match kind {
            ModelKind::Power => self.of(ModelKind::Explicit),
            ModelKind::Explicit | ModelKind::Implicit => self.of(kind),
        }
    }
}
