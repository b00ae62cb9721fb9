//! What the user may choose, and how it becomes a plan.

use super::{IdentifyError, choice, excited};
use crate::log::Samples;
use crate::model::IdentificationModel;
use crate::observe::{Filtering, ModelKind, check};
use crate::settings::{Derivatives, Edges, Freedom, Velocity, Weights};

/// Choices of the user. Each that is `None` is taken from the robot's settings
/// ([`IdentificationModel::settings`]), and failing that from the data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Models to identify; empty for all three.
    pub models: Vec<ModelKind>,
    /// Cut-off of the prefilter of q, Hz.
    pub fq_hz: Option<f64>,
    /// Order of the Butterworth prefilter.
    pub order: Option<usize>,
    /// Decimation ratio n_d.
    pub nd: Option<usize>,
    /// What is cut off at either end; its unit follows from the edge rule.
    pub trim: Option<usize>,
    /// Samples cut off at the start and at the end before decimation.
    pub border: Option<(usize, usize)>,
    /// Edge rule.
    pub edges: Option<Edges>,
    /// How signals are differentiated.
    pub derivatives: Option<Derivatives>,
    /// Source of the velocity.
    pub velocity: Option<Velocity>,
    /// Whether the torque passes the prefilter too.
    pub prefilter_torque: Option<bool>,
    /// Weights of the equations.
    pub weights: Option<Weights>,
    /// What to do with the tolerances of the description.
    pub prior: PriorUse,
}

/// What to do with prior knowledge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PriorUse {
    /// An estimate with it beside the classical one, where the description has tolerances.
    #[default]
    Use,
    /// Only the classical estimate.
    Ignore,
}

/// An identification with every choice made.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Models to identify, each once, in the order of the paper.
    pub models: Vec<ModelKind>,
    /// Filters.
    pub filtering: Filtering,
    /// Weights of the equations.
    pub weights: Weights,
    /// What the residual's degrees of freedom are counted against.
    pub degrees_of_freedom: Freedom,
}

impl Options {
    /// Makes every choice: the option, else the robot's setting, else a default or what
    /// [`Plan`]'s rules make of the logs.
    ///
    /// # Errors
    /// [`IdentifyError::NoLogs`]; [`IdentifyError::Rate`]; [`IdentifyError::Observe`] if a log does
    /// not fit the robot; [`IdentifyError::NothingMoves`] for logs without
    /// motion.
    pub fn resolve<L: Samples>(
        &self,
        model: &dyn IdentificationModel,
        train: &[L],
    ) -> Result<Plan, IdentifyError> {
        let logs: Vec<&dyn Samples> = train.iter().map(|log| log as &dyn Samples).collect();
        excited::check(&choice::looks(&logs)?)?;
        self.resolve_at_rest(model, train)
    }

    /// The same for logs in which nothing needs to move.
    pub(crate) fn resolve_at_rest<L: Samples>(
        &self,
        model: &dyn IdentificationModel,
        train: &[L],
    ) -> Result<Plan, IdentifyError> {
        let set = model.settings();
        // Edges of Matlab or SciPy are asked for where their numbers are to be reproduced.
        let derivatives = self.derivatives.unwrap_or(match self.edges.or(set.edges) {
            Some(_) => Derivatives::Central,
            None => Derivatives::Eighth,
        });
        let edges = self.edges.or(set.edges).unwrap_or(Edges::Scipy);
        let order = self.order.or(set.order).unwrap_or(choice::ORDER);
        let (fq_hz, nd) = (self.fq_hz.or(set.fq_hz), self.nd.or(set.nd));
        // The robot's trim is in the unit of its own edge rule.
        let own_trim = set
            .trim
            .filter(|_| edges == set.edges.unwrap_or(Edges::Scipy));
        let trim = self.trim.or(own_trim);
        let train: Vec<&dyn Samples> = train.iter().map(|log| log as &dyn Samples).collect();
        let looks = choice::looks(&train)?;
        for look in &looks {
            check(look, model.joints().len())?;
        }
        let (np, given) = (model.columns().len(), (fq_hz, nd, trim));
        let by = (edges, derivatives);
        let chosen = choice::from_logs(&train, &looks, np, by, given)?;
        let filtering = Filtering {
            fq_hz: chosen.fq_hz,
            order,
            nd: chosen.nd,
            trim: chosen.trim,
            border: self.border.or(set.border).unwrap_or((0, 0)),
            edges,
            derivatives,
            velocity: self.velocity.or(set.velocity).unwrap_or(Velocity::Derived),
            prefilter_torque: self
                .prefilter_torque
                .or(set.prefilter_torque)
                .unwrap_or(false),
            chosen: chosen.names,
        };
        let weights = self.weights.or(set.weights).unwrap_or(Weights::Joint);
        Ok(Plan {
            models: self.kinds(),
            filtering,
            weights,
            degrees_of_freedom: set.degrees_of_freedom.unwrap_or_default(),
        })
    }

    fn kinds(&self) -> Vec<ModelKind> {
        let asked = |kind: &ModelKind| self.models.is_empty() || self.models.contains(kind);
        ModelKind::ALL.into_iter().filter(asked).collect()
    }
}

impl Plan {
    /// The models whose equations are needed: those asked for, and the explicit one to predict
    /// torque with the parameters of the power model.
    pub(super) fn observed(&self) -> Vec<ModelKind> {
        let needed = |kind: &ModelKind| {
            self.models.contains(kind)
                || (*kind == ModelKind::Explicit && self.models.contains(&ModelKind::Power))
        };
        ModelKind::ALL.into_iter().filter(needed).collect()
    }
}
