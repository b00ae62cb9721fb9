//! The parameters of `--parameters FILE` with the metric of their log.

use std::path::Path;

use idim::codegen::Robot;
use idim::runtime::model::IdentificationModel;
use serde_json::Value;

use super::super::Failure;
use super::super::simulate::parameters;

/// Standard deviation of values that come without one, as a share of each, and at least, as a share
/// of the largest of its unit.
const SHARE: f64 = 0.01;
const LEAST: f64 = 1e-3;

/// np values, what is known of their errors, and the inverse covariance, np x np.
pub(super) struct Found {
    pub values: Vec<f64>,
    pub sigma: Vec<Option<f64>>,
    pub precision: Vec<f64>,
}

/// Reads values and precision. Standard deviations that respect the autocorrelation of residuals
/// stretch the metric; values of a TOML count as known to a hundredth.
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
            precision: alone(&sigma),
            sigma,
            values,
        });
    };
    let by_name = |name: &str, key: &str| {
        let parameters = explicit["parameters"].as_array()?;
        let parameter = parameters.iter().find(|p| p["name"] == name)?;
        parameter[key].as_f64()
    };
    let columns = model.columns().iter();
    let each = |key: &'static str| -> Vec<Option<f64>> {
        let columns = columns.clone();
        columns.map(|column| by_name(&column.name, key)).collect()
    };
    let (plain, corrected) = (each("sigma"), each("sigma_corrected"));
    let sigma: Vec<Option<f64>> = corrected
        .iter()
        .zip(&plain)
        .map(|(corrected, plain)| corrected.or(*plain))
        .collect();
    let precision = match lower(&explicit["precision"], values.len()) {
        Some(lower) => stretched(&lower, &plain, &sigma),
        None => alone(&sigma),
    };
    Ok(Found {
        values,
        sigma,
        precision,
    })
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

/// Independent errors; nothing is known of what has no standard deviation.
fn alone(sigma: &[Option<f64>]) -> Vec<f64> {
    let np = sigma.len();
    let mut precision = vec![0.0; np * np];
    for (k, sigma) in sigma.iter().enumerate() {
        precision[k * np + k] = sigma.filter(|s| *s > 0.0).map_or(0.0, |s| s.powi(-2));
    }
    precision
}

/// The lower triangle of a JSON as a full matrix, if it is one of np rows.
fn lower(json: &Value, np: usize) -> Option<Vec<f64>> {
    let rows = json.as_array().filter(|rows| rows.len() == np)?;
    let mut full = vec![0.0; np * np];
    for (i, row) in rows.iter().enumerate() {
        for (k, value) in row
            .as_array()
            .filter(|row| row.len() == i + 1)?
            .iter()
            .enumerate()
        {
            let value = value.as_f64()?;
            full[i * np + k] = value;
            full[k * np + i] = value;
        }
    }
    Some(full)
}

/// The metric in which each parameter has its corrected standard deviation.
fn stretched(full: &[f64], plain: &[Option<f64>], sigma: &[Option<f64>]) -> Vec<f64> {
    let np = plain.len();
    let pairs = plain.iter().zip(sigma);
    let shrink: Vec<f64> = pairs
        .map(|pair| match pair {
            (Some(plain), Some(sigma)) if *sigma > 0.0 => plain / sigma,
            _ => 1.0,
        })
        .collect();
    let entry = |at: usize| full[at] * shrink[at / np] * shrink[at % np];
    (0..np * np).map(entry).collect()
}
