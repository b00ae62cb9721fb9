//! Torque predicted from a logged motion.

use super::IdentifyError;
use crate::log::Recording;
use crate::model::{IdentificationModel, Output};
use crate::observe::{Filtering, ModelKind, Motion, contract};
use crate::signal::central_difference;

/// Torque of each joint, N m or N, predicted from the logged motion at every sample of the
/// recording's grid, before any low-pass.
///
/// \\( D X \\) for the explicit model, \\( \frac{d}{dt}(P X) + R X \\) for the implicit one; the
/// parameters of the power model are used in \\( D X \\), since its own equation is a sum over
/// joints. The recording's torque is not read.
///
/// # Errors
/// [`IdentifyError::Parameters`]; [`IdentifyError::Observe`] if the recording does not fit the
/// robot or is too short for the prefilter.
pub fn predict(
    model: &dyn IdentificationModel,
    recording: &Recording,
    parameters: &[f64],
    filtering: &Filtering,
    kind: ModelKind,
) -> Result<Vec<Vec<f64>>, IdentifyError> {
    let (has, needs) = (parameters.len(), model.columns().len());
    if has != needs {
        return Err(IdentifyError::Parameters {
            robot: model.name().to_owned(),
            has,
            needs,
        });
    }
    let motion = Motion::full(recording, model, filtering)?;
    let product = |output| contract(model, output, &motion, parameters);
    Ok(match kind {
        ModelKind::Explicit | ModelKind::Power => product(Output::Explicit),
        ModelKind::Implicit => {
            let momentum = product(Output::Momentum);
            let rates = momentum
                .iter()
                .map(|p| central_difference(p, motion.rate_hz));
            let sum = |(rate, rest): (Vec<f64>, Vec<f64>)| {
                rate.iter()
                    .zip(&rest)
                    .map(|(rate, rest)| rate + rest)
                    .collect()
            };
            rates.zip(product(Output::Rest)).map(sum).collect()
        }
    })
}
