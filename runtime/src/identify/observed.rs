//! What is observed along one log, or along several together.

use super::streamed::streamed;
use super::{IdentifyError, Plan, Progress};
use crate::evidence::{Cut, Evidence, EvidenceError};
use crate::log::Samples;
use crate::model::IdentificationModel;
use crate::observe::{Course, ModelKind, Motion, Observations, check, check_torque, observe};
use crate::settings::Weights;

/// Equations with more entries than this are not kept: the evidence answers without them, and
/// nothing that would look at single rows again is worth their memory (16 MB).
const KEPT: usize = 2_000_000;

/// Nor are logs with more samples of all joints than this taken into memory, however few rows are
/// left of them: their motion takes six times as many numbers (48 MB).
const KEPT_SAMPLES: usize = 1_000_000;

/// Equations with more entries than this are not kept for the sake of weights either (400 MB).
const KEPT_FOR_WEIGHTS: usize = 50_000_000;

/// What all models that a plan needs make of one or several logs.
pub(super) struct Observed {
    /// Names of the logs.
    pub logs: Vec<String>,
    /// Joints that rest in all of the logs, counted from 0.
    pub resting: Vec<usize>,
    /// Each model that is needed.
    models: Vec<Gathered>,
}

/// What one model makes of logs.
pub(super) struct Gathered {
    pub kind: ModelKind,
    /// The equations reduced to factors.
    pub evidence: Evidence,
    /// The equations themselves, if they are few or rows are to be weighted one by one.
    pub rows: Option<Observations>,
}

impl Observed {
    /// Filters a log and makes the equations.
    pub fn new(
        model: &dyn IdentificationModel,
        log: &dyn Samples,
        plan: &Plan,
        progress: &dyn Progress,
    ) -> Result<Self, IdentifyError> {
        let equations = log.len() / plan.filtering.nd.max(1) * model.joints().len();
        let entries = equations.saturating_mul(model.columns().len());
        let samples = log.len().saturating_mul(model.joints().len());
        let few = entries <= KEPT && samples <= KEPT_SAMPLES;
        match plan.weights {
            Weights::Robust if entries > KEPT_FOR_WEIGHTS => Err(IdentifyError::TooLongForRobust {
                log: log.name().to_owned(),
                samples: log.len(),
            }),
            Weights::Robust => Observed::kept(model, log, plan, progress),
            _ if few => Observed::kept(model, log, plan, progress),
            _ => Observed::streamed(model, log, plan, progress),
        }
    }

    /// From a log that fits in memory, its equations kept.
    pub fn kept(
        model: &dyn IdentificationModel,
        log: &dyn Samples,
        plan: &Plan,
        progress: &dyn Progress,
    ) -> Result<Self, IdentifyError> {
        let recording = log.window(0..log.len())?;
        check(&recording, model.joints().len())?;
        check_torque(&recording)?;
        progress.step(&format!("filtering {}", log.name()));
        let motion = Motion::trimmed(&recording, model, &plan.filtering)?;
        let mut models = Vec::new();
        for kind in plan.observed() {
            progress.step(&format!("{} model along {}", kind.name(), log.name()));
            let rows = observe(model, kind, &motion, &plan.filtering)?;
            let evidence = Evidence::from_observations(model, &rows, &[], Cut::default());
            models.push(Gathered {
                kind,
                evidence: evidence.map_err(IdentifyError::evidence(kind))?,
                rows: Some(rows),
            });
        }
        Ok(Observed {
            logs: vec![motion.log],
            resting: motion.resting,
            models,
        })
    }

    /// From a log of any length, reduced to evidence on the way.
    fn streamed(
        model: &dyn IdentificationModel,
        log: &dyn Samples,
        plan: &Plan,
        progress: &dyn Progress,
    ) -> Result<Self, IdentifyError> {
        progress.step(&format!("looking through {}", log.name()));
        let course = Course::new(log, model, &plan.filtering)?;
        progress.step(&format!("reducing {} to evidence", log.name()));
        let gathered = |(kind, evidence)| Gathered {
            kind,
            evidence,
            rows: None,
        };
        let evidence = streamed(model, &course, &plan.observed(), Cut::default())?;
        Ok(Observed {
            logs: vec![log.name().to_owned()],
            resting: course.resting(),
            models: plan
                .observed()
                .into_iter()
                .zip(evidence)
                .map(gathered)
                .collect(),
        })
    }

    /// What several logs say together, one log after the other.
    pub fn join(
        logs: impl Iterator<Item = Result<Self, IdentifyError>>,
    ) -> Result<Self, IdentifyError> {
        let mut together: Option<Observed> = None;
        for observed in logs {
            match &mut together {
                Some(together) => together.append(observed?)?,
                None => together = Some(observed?),
            }
        }
        together.ok_or(IdentifyError::NoLogs)
    }

    fn append(&mut self, other: Observed) -> Result<(), IdentifyError> {
        self.resting.retain(|joint| other.resting.contains(joint));
        for (all, more) in self.models.iter_mut().zip(&other.models) {
            all.append(more)
                .map_err(IdentifyError::evidence(more.kind))?;
        }
        self.logs.extend(other.logs);
        Ok(())
    }

    /// What a model makes of the logs.
    pub fn of(&self, kind: ModelKind) -> Result<&Gathered, IdentifyError> {
        self.models
            .iter()
            .find(|m| m.kind == kind)
            .ok_or(IdentifyError::NoLogs)
    }

    /// The equations of a model; there are none unless all logs' were kept.
    pub fn rows(&self, kind: ModelKind) -> Result<&Observations, IdentifyError> {
        self.of(kind)?.rows.as_ref().ok_or(IdentifyError::NoLogs)
    }

    /// The model in which torque is predicted with the parameters of a model: its own, or the
    /// explicit one for the power model, which has none for a single joint.
    pub fn torque(&self, kind: ModelKind) -> Result<&Gathered, IdentifyError> {
        match kind {
            ModelKind::Power => self.of(ModelKind::Explicit),
            ModelKind::Explicit | ModelKind::Implicit => self.of(kind),
        }
    }
}

impl Gathered {
    /// Adds what another log says. Rows are kept only if both have kept them.
    fn append(&mut self, more: &Gathered) -> Result<(), EvidenceError> {
        self.evidence.merge(&more.evidence)?;
        self.rows = match (self.rows.take(), &more.rows) {
            (Some(mut rows), Some(more)) => {
                rows.append(more);
                Some(rows)
            }
            _ => None,
        };
        Ok(())
    }
}
