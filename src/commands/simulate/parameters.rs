//! `--parameters FILE`: the result of an identification, or a table of values.

use std::collections::BTreeMap;
use std::path::Path;

use idim::codegen::Robot;
use idim::codegen::base::BaseParameter;
use idim::codegen::derive::ParameterKind;
use idim::codegen::mechanism::inertia::NAMES;
use idim::runtime::model::IdentificationModel;
use idim::runtime::simulate::{SimulateError, in_order, named_values};
use serde_json::Value;

use super::Failure;

/// Values by name.
type Values = BTreeMap<String, f64>;

/// The np parameters of a robot from a file.
///
/// JSON is that of `idim identify --json`: the explicit model's values, or those of the only model
/// there is. TOML has a `[parameters]` table with base or standard parameters; inertial values that
/// it does not name are those of the description.
///
/// # Errors
/// [`Failure::Parameters`] for a file that cannot be used, [`Failure::Simulate`] naming the
/// parameters without a value.
pub fn read(
    path: &Path,
    model: &dyn IdentificationModel,
    robot: &Robot,
) -> Result<Vec<f64>, Failure> {
    let wrong = |message: String| Failure::Parameters {
        path: path.to_owned(),
        message,
    };
    let text = std::fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
    if path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("json"))
    {
        return Ok(in_order(model, &identified(&text).map_err(wrong)?)?);
    }
    let given = named_values(&text).map_err(wrong)?;
    let described = described(robot);
    let mut missing = Vec::new();
    let mut values = Vec::new();
    for parameter in &robot.base.parameters {
        match value(parameter, &given, &described) {
            Ok(value) => values.push(value),
            Err(name) => missing.push(name),
        }
    }
    if missing.is_empty() {
        return Ok(values);
    }
    let robot = model.name().to_owned();
    Err(SimulateError::Missing {
        robot,
        names: missing,
    }
    .into())
}

/// The rigid-body parameters of the description, without friction and rotor inertia; `None` if it
/// describes no inertia.
pub fn rigid(robot: &Robot) -> Option<Vec<f64>> {
    let described = described(robot);
    if described.is_empty() {
        return None;
    }
    let term = |(factor, name): &(f64, String)| factor * described.get(name).unwrap_or(&0.0);
    let sum = |parameter: &BaseParameter| parameter.relation.iter().map(term).sum();
    Some(robot.base.parameters.iter().map(sum).collect())
}

/// A base parameter by its own name or from the standard ones, or a name that has no value.
fn value(parameter: &BaseParameter, given: &Values, described: &Values) -> Result<f64, String> {
    if let Some(value) = given.get(&parameter.name) {
        return Ok(*value);
    }
    let mut sum = 0.0;
    for (factor, name) in &parameter.relation {
        let value = given.get(name).or_else(|| described.get(name));
        sum += factor * value.ok_or_else(|| missing(parameter, name))?;
    }
    Ok(sum)
}

/// The name to ask for: of a group of inertial values, the group's.
fn missing(parameter: &BaseParameter, standard: &str) -> String {
    match parameter.kind {
        ParameterKind::Inertial(_) => format!("{} (for {standard})", parameter.name),
        _ => parameter.name.clone(),
    }
}

/// Standard inertial parameters of all links of a URDF, by name; empty without any inertia.
fn described(robot: &Robot) -> Values {
    let joints = &robot.mechanism.joints;
    let any = joints
        .iter()
        .flat_map(|joint| &joint.bodies)
        .any(|body| body.inertial.is_some());
    if !any {
        return Values::new();
    }
    let mut values = Values::new();
    for (index, joint) in joints.iter().enumerate() {
        for (name, value) in NAMES.iter().zip(joint.carried().values()) {
            values.insert(format!("{name}{}", index + 1), value);
        }
    }
    values
}

/// Parameters of the explicit model of an identification, or of its only model.
fn identified(text: &str) -> Result<Values, String> {
    let result: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
    let models = result["models"].as_array().map_or(&[][..], Vec::as_slice);
    let explicit = models.iter().find(|model| model["name"] == "explicit");
    let only = models.first().filter(|_| models.len() == 1);
    let Some(model) = explicit.or(only) else {
        return Err("no explicit model in it: write it with `idim identify --json FILE`".into());
    };
    let parameters = model["parameters"]
        .as_array()
        .map_or(&[][..], Vec::as_slice);
    let value = |parameter: &Value| {
        let name = parameter["name"].as_str()?.to_owned();
        // `value` is null where the log does not determine it; `solution` always predicts.
        let value = parameter["solution"]
            .as_f64()
            .or_else(|| parameter["value"].as_f64())?;
        Some((name, value))
    };
    Ok(parameters.iter().filter_map(value).collect())
}
