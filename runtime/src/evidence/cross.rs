//! Leave-blocks-out cross-validation.

use super::{Evidence, EvidenceError, Question};

/// How well each part of the logs is predicted by the rest of them.
#[derive(Clone, Debug, PartialEq)]
pub struct CrossValidation {
    /// The parts, in the order of time.
    pub folds: Vec<HeldOut>,
    /// Root mean square of the prediction errors of each joint over all parts: N m, N or W.
    pub joint_rms: Vec<f64>,
}

/// A part of the logs, predicted by the rest of them.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldOut {
    /// By column: the estimate without this part.
    pub solution: Vec<f64>,
    /// Rank of the rest; smaller than that of the whole if only this part excites a parameter,
    /// and then its prediction means little.
    pub rank: usize,
    /// Sum of the squared prediction errors of each joint, unweighted.
    pub joint_squares: Vec<f64>,
    /// Number of equations of each joint.
    pub joint_rows: Vec<usize>,
}

impl Evidence {
    /// k-fold cross-validation over time blocks: each of `folds` parts, made of neighbouring
    /// blocks so that correlated errors stay together, is predicted by an estimate from all the
    /// others. Weights are estimated anew each time, so nothing of the part is known before.
    ///
    /// # Errors
    /// [`EvidenceError::TooFewBlocks`] for fewer blocks than folds or fewer than 2 folds; those of
    /// [`Evidence::fit`].
    pub fn cross_validate(
        &self,
        question: &Question,
        folds: usize,
    ) -> Result<CrossValidation, EvidenceError> {
        let needs = folds.max(2);
        if self.blocks() < needs {
            let (purpose, blocks) = ("cross-validation", self.blocks());
            return Err(EvidenceError::TooFewBlocks {
                purpose,
                needs,
                blocks,
            });
        }
        let parts = self.coarsened(needs);
        let held = (0..needs).map(|part| parts.hold_out(question, part));
        let folds = held.collect::<Result<Vec<_>, _>>()?;
        let joint_rms = (0..self.layout.joints.len())
            .map(|joint| rms(&folds, joint))
            .collect();
        Ok(CrossValidation { folds, joint_rms })
    }

    /// Predicts block `part` from all others.
    fn hold_out(&self, question: &Question, part: usize) -> Result<HeldOut, EvidenceError> {
        let others: Vec<usize> = (0..self.blocks()).filter(|block| *block != part).collect();
        let fit = self.select(&others)?.fit(question)?;
        let held = self.select(&[part])?;
        Ok(HeldOut {
            rank: fit.rank,
            joint_squares: held.residual_squares(&fit.solution).concat(),
            joint_rows: held.joint_rows(),
            solution: fit.solution,
        })
    }
}

fn rms(folds: &[HeldOut], joint: usize) -> f64 {
    let square: f64 = folds.iter().map(|fold| fold.joint_squares[joint]).sum();
    let rows: usize = folds.iter().map(|fold| fold.joint_rows[joint]).sum();
    (square / rows.max(1) as f64).sqrt()
}
