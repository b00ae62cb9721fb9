//! What any motion within limits can determine.

use faer::Mat;

use super::criterion::Criterion;
use super::error::ExciteError;
use super::random::Random;
use super::regressor::Regressor;
use super::result::Undetermined;
use super::space::Path;
use super::{Task, matrix};
use crate::estimate::identifiability;

/// Random states, more than a model has parameters of a joint.
const STATES: usize = 400;

/// The rank of W over unconnected random states within the limits: no motion has a higher one.
pub(super) struct Within {
    /// Columns of the model that take part: a largest independent set, ascending.
    pub independent: Vec<usize>,
    /// Whether a column is determined by itself.
    pub determined: Vec<bool>,
    /// Columns that are not, in groups with the number of known combinations.
    groups: Vec<(Vec<usize>, usize)>,
}

impl Within {
    pub fn new(task: &Task<'_>) -> Result<Within, ExciteError> {
        let np = task.model.columns().len();
        let all: Vec<usize> = (0..np).collect();
        let regressor = Regressor::new(task.model, &all, vec![1.0; task.limits.len()]);
        let w: Mat<f64> = matrix(&regressor, &states(task));
        let nothing = || ExciteError::NothingDetermined {
            robot: task.model.name().to_owned(),
        };
        let found = identifiability(&w, np).map_err(|_| nothing())?;
        if found.independent.is_empty() {
            return Err(nothing());
        }
        let determined = all.iter().map(|column| found.determines(*column));
        let unseen = found.unseen.iter().map(|column| (vec![*column], 0));
        let dependent = found.dependent.iter();
        let dependent = dependent.map(|group| (group.columns.clone(), group.combinations));
        Ok(Within {
            determined: determined.collect(),
            groups: unseen.chain(dependent).collect(),
            independent: found.independent,
        })
    }

    /// The columns of [`Criterion::Separate`] among the independent ones.
    ///
    /// # Errors
    /// [`ExciteError::Inseparable`].
    pub fn separate(
        &self,
        task: &Task<'_>,
        criterion: &Criterion,
    ) -> Result<Vec<usize>, ExciteError> {
        let Criterion::Separate { columns } = criterion else {
            return Ok(Vec::new());
        };
        let place = |column: &usize| {
            let place = self.independent.iter().position(|kept| kept == column);
            let alone = self.determined.get(*column).copied().unwrap_or(false);
            place
                .filter(|_| alone)
                .ok_or_else(|| ExciteError::Inseparable {
                    name: name(task, *column),
                })
        };
        columns.iter().map(place).collect()
    }

    /// Parameters of contacts that yield before they slide, whose states the search does not run
    /// along a motion: nothing is said of them.
    pub fn not_judged(&self, task: &Task<'_>) -> Vec<String> {
        let unseen = self.groups.iter().filter(|group| self.yields(task, group));
        let columns = unseen.flat_map(|(columns, _)| columns);
        columns.map(|column| name(task, *column)).collect()
    }

    /// Whether a group is an unseen column of such a contact.
    fn yields(&self, task: &Task<'_>, (columns, known): &(Vec<usize>, usize)) -> bool {
        let mut contacts = task.model.presliding().iter();
        let joint = |column: &usize| task.model.columns().get(*column).map(|it| it.joint);
        let joint = columns.first().and_then(joint);
        *known == 0 && contacts.any(|contact| Some(contact.joint + 1) == joint)
    }

    pub fn undetermined(&self, task: &Task<'_>) -> Vec<Undetermined> {
        let group = |(columns, known): &(Vec<usize>, usize)| Undetermined {
            names: columns.iter().map(|column| name(task, *column)).collect(),
            known: *known,
        };
        let groups = self.groups.iter();
        let groups = groups.filter(|group| !self.yields(task, group));
        groups.map(group).collect()
    }
}

fn name(task: &Task<'_>, column: usize) -> String {
    let columns = task.model.columns();
    columns
        .get(column)
        .map_or_else(String::new, |column| column.name.to_string())
}

/// Positions, velocities and accelerations anywhere within the limits.
fn states(task: &Task<'_>) -> Path {
    let mut random = Random::new(1, 0);
    let mut draw = |middle: fn(&super::JointLimits) -> (f64, f64)| -> Vec<f64> {
        let values = task.limits.iter().flat_map(|limits| {
            let (middle, size) = middle(limits);
            let value = || middle + size * random.symmetric();
            std::iter::repeat_with(value)
                .take(STATES)
                .collect::<Vec<f64>>()
        });
        values.collect()
    };
    Path {
        len: STATES,
        q: draw(|limits| (limits.middle(), 0.5 * (limits.upper - limits.lower))),
        qd: draw(|limits| (0.0, limits.velocity)),
        qdd: draw(|limits| (0.0, limits.acceleration)),
    }
}
