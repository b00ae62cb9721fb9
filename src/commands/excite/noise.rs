//! The noise of the torque that is counted on.

use std::path::Path;

use idim::runtime::excite::{JointLimits, Noise};
use idim::runtime::model::IdentificationModel;
use serde_json::Value;

use super::limits::each;
use super::{Arguments, Failure};

/// Share of the effort limit that is assumed.
const SHARE: f64 = 0.01;

/// Assumed without an effort limit, N m or N.
const UNKNOWN: f64 = 1.0;

/// From numbers, from the residuals of an identification, or assumed.
///
/// # Errors
/// [`Failure::Usage`] for numbers that are none, [`Failure::Parameters`] for a file that cannot be
/// used.
pub(super) fn of(
    arguments: &Arguments,
    model: &dyn IdentificationModel,
    limits: &[JointLimits],
) -> Result<Noise, Failure> {
    let rate_hz = arguments.rate;
    let Some(given) = arguments.noise.as_deref() else {
        let assumed = |limits: &JointLimits| match limits.effort.is_finite() {
            true => SHARE * limits.effort,
            false => UNKNOWN,
        };
        return Ok(Noise {
            sigma: limits.iter().map(assumed).collect(),
            rate_hz,
        });
    };
    let numbers = given.split(',').map(|number| number.trim().parse::<f64>());
    match numbers.collect::<Result<Vec<f64>, _>>() {
        Ok(numbers) => Ok(Noise {
            sigma: each(model, "--noise", &numbers)?,
            rate_hz,
        }),
        Err(_) => identified(Path::new(given), model),
    }
}

/// Residuals of the explicit model: those of the rows that its decimation kept.
fn identified(path: &Path, model: &dyn IdentificationModel) -> Result<Noise, Failure> {
    let wrong = |message: String| Failure::Parameters {
        path: path.to_owned(),
        message,
    };
    let text = std::fs::read_to_string(path).map_err(|error| {
        wrong(format!(
            "{error}; --noise takes numbers or the JSON of `idim identify --json`"
        ))
    })?;
    let result: Value = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
    let read = || {
        let models = result["models"].as_array()?;
        let explicit = models.iter().find(|model| model["name"] == "explicit")?;
        let joints = explicit["fit"]["joints"].as_array()?;
        let sigma: Option<Vec<f64>> = joints.iter().map(|it| it["rmse"].as_f64()).collect();
        let nd = result["filter"]["nd"].as_f64()?;
        let rate_hz = result["rate_hz"].as_f64()? / nd;
        Some(Noise {
            sigma: sigma?,
            rate_hz,
        })
    };
    let noise = read().ok_or_else(|| {
        wrong("no explicit model in it: write it with `idim identify --json FILE`".into())
    })?;
    match noise.sigma.len() == model.joints().len() {
        true => Ok(noise),
        false => Err(wrong(format!(
            "it is for {} joints, the robot has {}",
            noise.sigma.len(),
            model.joints().len()
        ))),
    }
}
