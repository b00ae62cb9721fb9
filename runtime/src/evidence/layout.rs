//! What the columns of evidence stand for: two pieces merge only if this is equal.

use super::checksum::Checksum;
use super::{Candidate, EvidenceError};
use crate::model::IdentificationModel;
use crate::observe::{ModelKind, Observations};

/// The columns of evidence: np parameters of the model, then the candidates, counted together
/// from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Name of the robot.
    pub robot: String,
    /// Which of the three models.
    pub model: ModelKind,
    /// Names of the columns: np parameters, then the candidates.
    pub names: Vec<String>,
    /// Number np of parameters of the model.
    pub parameters: usize,
    /// The columns that each joint can see, ascending; a single entry for the power model.
    pub joints: Vec<Vec<usize>>,
    /// Of the parameters' names, units and regrouping relations, as text and in numbers: robots of
    /// the same name and other dimensions differ in it.
    pub fingerprint: u64,
}

impl Layout {
    /// The columns of `observations` of a robot, with `candidates` beside them.
    ///
    /// # Errors
    /// [`EvidenceError::NoSuchColumn`] if the equations have columns that the model has not,
    /// [`EvidenceError::Shape`] if a candidate acts on a joint that has no equations.
    pub fn new(
        model: &dyn IdentificationModel,
        observations: &Observations,
        candidates: &[Candidate<'_>],
    ) -> Result<Self, EvidenceError> {
        let parameters = model.columns().len();
        let names = model.columns().iter().map(|column| column.name.to_string());
        let mut joints: Vec<_> = observations
            .blocks
            .iter()
            .map(|b| b.columns.clone())
            .collect();
        let columns = parameters;
        match joints.iter().flatten().find(|column| **column >= columns) {
            Some(&column) => return Err(EvidenceError::NoSuchColumn { column, columns }),
            None => add(&mut joints, candidates, parameters)?,
        }
        Ok(Layout {
            robot: model.name().to_owned(),
            model: observations.model,
            names: names
                .chain(candidates.iter().map(|c| c.name.clone()))
                .collect(),
            parameters,
            joints,
            fingerprint: fingerprint(model),
        })
    }

    /// Number of columns: parameters and candidates.
    pub fn columns(&self) -> usize {
        self.names.len()
    }

    /// Width of joint `j`'s factor: its columns and the measurements.
    pub(super) fn width(&self, joint: usize) -> usize {
        self.joints
            .get(joint)
            .map_or(1, |columns| columns.len() + 1)
    }

    /// Where the columns of joint `joint` and the measurements stand among `columns`, with the
    /// measurements last.
    pub(super) fn places(&self, joint: usize, columns: &[usize]) -> Vec<Option<usize>> {
        let place = |column: &usize| columns.iter().position(|c| c == column);
        let seen = self.joints.get(joint).map_or(&[][..], Vec::as_slice);
        seen.iter()
            .map(place)
            .chain([Some(columns.len())])
            .collect()
    }

    /// Says what two layouts differ in.
    pub(super) fn check_same(&self, other: &Layout) -> Result<(), EvidenceError> {
        let differ =
            |what, left: String, right: String| Err(EvidenceError::Different { what, left, right });
        if self.robot != other.robot {
            return differ("robot", self.robot.clone(), other.robot.clone());
        }
        if self.model != other.model {
            let name = |layout: &Layout| layout.model.name().to_owned();
            return differ("model", name(self), name(other));
        }
        if self.names != other.names || self.parameters != other.parameters {
            return differ("columns", self.names.join(" "), other.names.join(" "));
        }
        if self.joints != other.joints || self.fingerprint != other.fingerprint {
            let print = |layout: &Layout| format!("#{:016x}", layout.fingerprint);
            return differ("description", print(self), print(other));
        }
        Ok(())
    }
}

/// Lets joints see the candidates that act on them.
fn add(
    joints: &mut [Vec<usize>],
    candidates: &[Candidate<'_>],
    parameters: usize,
) -> Result<(), EvidenceError> {
    let expected = joints.len();
    for (k, candidate) in candidates.iter().enumerate() {
        for (joint, _) in &candidate.signals {
            let found = joint + 1;
            let what = "joint of a candidate";
            let seen = joints.get_mut(*joint).ok_or(EvidenceError::Shape {
                what,
                found,
                expected,
            })?;
            seen.push(parameters + k);
        }
    }
    joints.iter_mut().for_each(|seen| seen.dedup());
    Ok(())
}

fn fingerprint(model: &dyn IdentificationModel) -> u64 {
    let mut sum = Checksum::default();
    for column in model.columns() {
        for text in [&column.name, &column.unit, &column.relation] {
            sum.add(text.as_bytes());
            sum.add(&[0]);
        }
    }
    // Relations speak of lengths by name: what these are is in the factors.
    for term in &*model.knowledge().terms {
        sum.add(&term.factor.to_le_bytes());
    }
    sum.value()
}
