//! Parameter values by name, and in the order of a model's columns.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::error::SimulateError;
use crate::model::{ColumnKind, IdentificationModel};

#[derive(Deserialize)]
struct Raw {
    parameters: BTreeMap<String, toml::Spanned<Number>>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Number {
    Float(f64),
    Integer(i64),
}

/// The `[parameters]` table of a TOML text; other tables are not looked at, so that a robot's
/// description can be read too.
///
/// # Errors
/// Line and column of the mistake, both counted from 1, with what is wrong: malformed TOML, no such
/// table, a value that is not a finite number.
pub fn named_values(text: &str) -> Result<BTreeMap<String, f64>, String> {
    let raw: Raw = toml::from_str(text).map_err(|error| {
        let place = error
            .span()
            .map_or_else(String::new, |span| position(text, span.start));
        format!("{place}{}", error.message().trim())
    })?;
    let mut values = BTreeMap::new();
    for (name, number) in raw.parameters {
        let start = number.span().start;
        let value = match number.into_inner() {
            Number::Float(value) => value,
            Number::Integer(value) => value as f64,
        };
        if !value.is_finite() {
            let place = position(text, start);
            return Err(format!(
                "{place}the parameter {name} is {value}: it must be finite"
            ));
        }
        values.insert(name, value);
    }
    Ok(values)
}

/// `line:column: ` of a byte.
fn position(text: &str, byte: usize) -> String {
    let before = text.get(..byte).unwrap_or(text);
    let line = before.rfind('\n').map_or(before, |at| &before[at + 1..]);
    format!(
        "{}:{}: ",
        before.matches('\n').count() + 1,
        line.chars().count() + 1
    )
}

/// The np values of a model's columns, in their order, SI; names that it does not have are left.
///
/// # Errors
/// [`SimulateError::Missing`] with the names of all columns without a value.
pub fn in_order(
    model: &dyn IdentificationModel,
    values: &BTreeMap<String, f64>,
) -> Result<Vec<f64>, SimulateError> {
    let names = model.columns().iter().map(|column| column.name.as_ref());
    let (mut found, mut missing) = (Vec::new(), Vec::new());
    for name in names {
        match values.get(name) {
            Some(value) => found.push(*value),
            None => missing.push(name.to_owned()),
        }
    }
    if missing.is_empty() {
        return Ok(found);
    }
    Err(SimulateError::Missing {
        robot: model.name().to_owned(),
        names: missing,
    })
}

/// Parameters of a controller's feedforward: the rigid bodies as they are described, or, where the
/// description has none, those of the given parameters.
pub fn feedforward_of(model: &dyn IdentificationModel, parameters: &[f64]) -> Vec<f64> {
    let described = &model.knowledge().rigid;
    match described.is_empty() {
        true => rigid_only(model, parameters),
        false => described.to_vec(),
    }
}

/// Parameters of the rigid bodies alone: those of friction, rotors and other effects are zero. A
/// rotor inertia that is regrouped with an inertia stays in it.
pub fn rigid_only(model: &dyn IdentificationModel, parameters: &[f64]) -> Vec<f64> {
    let columns = model.columns().iter().zip(parameters);
    let rigid = |kind| kind == ColumnKind::Inertial;
    columns
        .map(|(column, value)| if rigid(column.kind) { *value } else { 0.0 })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_of_a_description_are_read_by_name() {
        let text = "name = 'arm'\n[[joint]]\nname = 'a'\n[parameters]\nZZ1 = 3\nFS1 = 0.5 # N m\n";
        let values = named_values(text).unwrap();
        assert_eq!(
            values,
            [("FS1".to_owned(), 0.5), ("ZZ1".to_owned(), 3.0)].into()
        );
    }

    #[test]
    fn mistakes_are_placed() {
        for (text, message) in [
            ("name = 'arm'\n", "missing field `parameters`"),
            ("[parameters]\nZZ1 = nan\n", "2:7: the parameter ZZ1 is NaN"),
            ("[parameters]\nZZ1 = 'a'\n", "2:7: "),
            ("[parameters\n", "1:12: "),
        ] {
            let found = named_values(text).unwrap_err();
            assert!(found.contains(message), "{found}");
        }
    }
}
