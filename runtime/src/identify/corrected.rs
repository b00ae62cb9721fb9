//! Standard deviations that hold although filtered residuals are correlated in time.

use rayon::prelude::*;

use crate::evidence::{Evidence, Question, Weighting};
use crate::model::IdentificationModel;
use crate::settings::Weights;

/// The normal quantile that users multiply a standard deviation with for 95 %.
const NORMAL: f64 = 1.96;

/// By parameter: a standard deviation from the evidence of time blocks, which takes neither
/// neighbouring rows nor the joints at one instant for independent ([`Evidence::corrected`]). It
/// is scaled so that estimate +- 1.96 sigma is the 95 % interval of Student's t with the degrees
/// of freedom that the blocks leave.
///
/// `None` where the log is too short to tell, or where rows were reweighted one by one.
pub(super) fn corrected(
    model: &dyn IdentificationModel,
    evidence: &Evidence,
    weights: Weights,
) -> Vec<Option<f64>> {
    let silent = || vec![None; model.columns().len()];
    let weighting = match weights {
        Weights::None => Weighting::Equal,
        Weights::Joint => Weighting::Residual,
        Weights::Robust => return silent(),
    };
    let covariance = evidence
        .fit(&Question::parameters(evidence, weighting))
        .and_then(|fit| evidence.corrected(&fit));
    match covariance {
        Ok(covariance) => (0..model.columns().len())
            .into_par_iter()
            .map(|column| {
                covariance
                    .half_width(column, 0.95)
                    .map(|half| half / NORMAL)
            })
            .collect(),
        Err(_) => silent(),
    }
}
