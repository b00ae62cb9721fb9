//! What is asked of evidence: which columns, and how the joints are weighted.

use super::{Evidence, EvidenceError};

/// How the equations of different joints are weighted.
#[derive(Clone, Debug, PartialEq)]
pub enum Weighting {
    /// Ordinary least squares.
    Equal,
    /// Weighted least squares: the equations of each joint are divided by the standard deviation
    /// of its residual under ordinary least squares, one pass. With a single joint this is
    /// ordinary least squares.
    Residual,
    /// The equations of each joint are divided by its error level, given: N m, N, or W for the
    /// power balance. Tests and resampling use the levels of one fit throughout.
    Given(Vec<f64>),
}

/// A least-squares problem on evidence.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// The columns to explain the measurements with, ascending, counted as in
    /// [`super::Layout`]; all others are taken to be zero.
    pub columns: Vec<usize>,
    /// Weights of the joints.
    pub weighting: Weighting,
}

impl Question {
    /// All np parameters of the model and no candidate.
    pub fn parameters(evidence: &Evidence, weighting: Weighting) -> Self {
        Question {
            columns: (0..evidence.layout().parameters).collect(),
            weighting,
        }
    }

    /// The same question without some columns.
    pub fn without(&self, columns: &[usize]) -> Self {
        let kept = self
            .columns
            .iter()
            .filter(|column| !columns.contains(column));
        Question {
            columns: kept.copied().collect(),
            weighting: self.weighting.clone(),
        }
    }

    /// The same question with some columns more, such as candidates.
    pub fn with(&self, columns: &[usize]) -> Self {
        let mut all: Vec<usize> = self.columns.iter().chain(columns).copied().collect();
        all.sort_unstable();
        all.dedup();
        Question {
            columns: all,
            weighting: self.weighting.clone(),
        }
    }

    /// Whether the evidence has what is asked for.
    pub(super) fn check(&self, evidence: &Evidence) -> Result<(), EvidenceError> {
        let columns = evidence.layout().columns();
        if let Some(&column) = self.columns.iter().find(|column| **column >= columns) {
            return Err(EvidenceError::NoSuchColumn { column, columns });
        }
        if let Weighting::Given(levels) = &self.weighting {
            let good = |joint: &usize| {
                levels
                    .get(*joint)
                    .is_some_and(|s| *s > 0.0 && s.is_finite())
            };
            if let Some(joint) = (0..evidence.layout().joints.len()).find(|joint| !good(joint)) {
                return Err(EvidenceError::Weights { joint: joint + 1 });
            }
        }
        Ok(())
    }
}
