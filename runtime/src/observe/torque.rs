//! Torque, measured and predicted, as the equations see it, without the equations.

use super::equations::{pick, rows_believed};
use super::{Filtering, ModelKind, Motion, ObserveError, Treatment, contract};
use crate::model::{IdentificationModel, Output};
use crate::signal::{Decimator, SignalError};

/// Filtered, decimated torque of each joint along a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Torque {
    /// Sample of the motion that each row stands at.
    pub samples: Vec<usize>,
    /// Measured, N m or N, one series per joint.
    pub measured: Vec<Vec<f64>>,
    /// Predicted, \\( W X \\), one series per joint.
    pub predicted: Vec<Vec<f64>>,
}

/// Y and \\( W X \\) of each joint along a motion of [`Motion::trimmed`], for np parameters X.
/// The filters are linear, so it is \\( D X \\) that is low-passed, and W is never made. For the
/// power model, whose equation has no joints, \\( W \\) is that of the explicit model.
///
/// # Errors
/// [`ObserveError::NoTorque`]; those of [`super::observe`].
pub fn filtered_torque(
    model: &dyn IdentificationModel,
    kind: ModelKind,
    motion: &Motion,
    filtering: &Filtering,
    parameters: &[f64],
) -> Result<Torque, ObserveError> {
    let Some(tau) = &motion.tau else {
        return Err(ObserveError::NoTorque {
            log: motion.log.clone(),
        });
    };
    let fail = ObserveError::filter(&motion.log, "parallel filter");
    let decimator = filtering.decimator(motion.rate_hz).map_err(&fail)?;
    let kept = decimator.kept(motion.len);
    let rows = rows_believed(motion, filtering, &kept)?;
    let cut = |series: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        let joints = series.iter();
        joints.map(|joint| pick(joint, &rows)).collect()
    };
    let measured = decimator.values(tau.as_slice(), &kept).map_err(&fail)?;
    let mut predicted = vec![vec![0.0; kept.len()]; tau.len()];
    for term in terms(kind) {
        let along = contract(model, term.0, motion, parameters);
        let part = low_passed(&along, term.1, &decimator, &kept).map_err(&fail)?;
        for (sum, part) in predicted.iter_mut().flatten().zip(part.iter().flatten()) {
            *sum += part;
        }
    }
    Ok(Torque {
        samples: rows.iter().map(|&row| kept[row]).collect(),
        measured: cut(measured),
        predicted: cut(predicted),
    })
}

fn terms(kind: ModelKind) -> &'static [(Output, Treatment)] {
    match kind {
        ModelKind::Power => ModelKind::Explicit.terms(),
        ModelKind::Explicit | ModelKind::Implicit => kind.terms(),
    }
}

fn low_passed(
    series: &[Vec<f64>],
    treatment: Treatment,
    decimator: &Decimator,
    kept: &[usize],
) -> Result<Vec<Vec<f64>>, SignalError> {
    match treatment {
        Treatment::Value => decimator.values(series, kept),
        Treatment::Rate => decimator.rates(series, kept),
    }
}
