//! The parameters of `--parameters FILE` with the metric of their log.

use std::path::Path;

use idim::codegen::Robot;
use idim::exported::Identified;
use idim::runtime::model::IdentificationModel;
use serde_json::Value;

use super::super::Failure;
use super::super::simulate::parameters;

/// Standard deviation of values that come without one, as a share of each, and at least, as a share
/// of the largest of its unit.
const SHARE: f64 = 0.01;
const LEAST: f64 = 1e-3;

/// Values, what is known of their errors, and their metric.
pub(super) struct Found {
    pub sigma: Vec<Option<f64>>,
    pub identified: Identified,
}

/// Reads values and their metric; those of a TOML count as known to a hundredth.
///
/// # Errors
/// Those of [`parameters::read`].
pub(super) fn read(
    path: &Path,
    model: &dyn IdentificationModel,
    robot: &Robot,
) -> Result<Found, Failure> {
    let values = parameters::read(path, model, robot)?;
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let json: Value = serde_json::from_str(&text).unwrap_or(Value::Null);
    let models = json["models"].as_array().map_or(&[][..], Vec::as_slice);
    let explicit = models.iter().find(|model| model["name"] == "explicit");
    let Some(explicit) = explicit.or(models.first()) else {
        let sigma: Vec<Option<f64>> = assumed(&values, robot).into_iter().map(Some).collect();
        return Ok(Found {
            identified: Identified::new(values, (&sigma, &sigma), &[]),
            sigma,
        });
    };
    let parameters = explicit["parameters"]
        .as_array()
        .map_or(&[][..], Vec::as_slice);
    let each = |key: &str| -> Vec<Option<f64>> {
        let columns = model.columns().iter();
        let of = |name: &str| parameters.iter().find(|p| p["name"] == name)?[key].as_f64();
        columns.map(|column| of(&column.name)).collect()
    };
    let (plain, corrected) = (each("sigma"), each("sigma_corrected"));
    let pairs = corrected.iter().zip(&plain);
    Ok(Found {
        sigma: pairs
            .map(|(corrected, plain)| corrected.or(*plain))
            .collect(),
        identified: Identified::new(values, (&plain, &corrected), &lower(&explicit["precision"])),
    })
}

/// The rows of a triangle.
fn lower(json: &Value) -> Vec<Vec<f64>> {
    let numbers = |row: &Value| row.as_array()?.iter().map(Value::as_f64).collect();
    let rows = json.as_array().map_or(&[][..], Vec::as_slice).iter();
    rows.map(numbers).collect::<Option<_>>().unwrap_or_default()
}

/// Standard deviations of values that are only stated.
fn assumed(values: &[f64], robot: &Robot) -> Vec<f64> {
    let parameters = &robot.base.parameters;
    let largest = |unit: &str| {
        let same = parameters
            .iter()
            .zip(values)
            .filter(|(p, _)| p.unit == unit);
        same.fold(0.0_f64, |top, (_, value)| top.max(value.abs()))
    };
    let each = parameters.iter().zip(values);
    each.map(|(parameter, value)| {
        let least = LEAST * largest(&parameter.unit);
        (SHARE * value.abs())
            .max(least)
            .max(f64::MIN_POSITIVE.sqrt())
    })
    .collect()
}
