//! Tables of names: `[lengths]`, `[parameters]` and `[scaled]`.

use super::super::code;
use super::super::description::{Quantity, ScaledParameter};
use super::super::expression;
use super::super::findings::{Findings, finding};
use super::super::identifier::is_word;
use super::table::{Value, in_text_order, wrong_type};
use super::value;
use toml::de::DeValue;

/// Most named lengths: every one is looked at for every name in an expression.
const MAX_LENGTHS: usize = 1000;

/// Reads `[lengths]`; a length may be an expression over the ones before it.
pub(super) fn lengths(value: Value<'_>, to: &mut Findings) -> Vec<(String, f64)> {
    let mut lengths = Vec::new();
    for (name, offset, value) in entries(value, "[lengths]", to) {
        if lengths.len() >= MAX_LENGTHS {
            let message = format!("more than {MAX_LENGTHS} lengths");
            to.error(offset, finding(code::NUMBER_RANGE, message));
            break;
        }
        if expression::RESERVED.contains(&name) {
            let message = format!("`{name}` cannot name a length: it has a meaning already");
            to.error(offset, finding(code::NAME_INVALID, message));
        } else if checked_word(name, offset, "length", to) {
            let what = format!("length `{name}`");
            if let Some(found) = value::quantity(value, &what, &lengths, to) {
                lengths.push((name.to_owned(), found.value));
            }
        }
    }
    lengths
}

/// Reads `[parameters]`.
pub(super) fn parameters(value: Value<'_>, to: &mut Findings) -> Vec<(String, f64)> {
    let mut parameters = Vec::new();
    for (name, offset, value) in entries(value, "[parameters]", to) {
        if checked_word(name, offset, "parameter", to)
            && let Some(number) = value::number(value, &format!("parameter `{name}`"), to)
        {
            parameters.push((name.to_owned(), number));
        }
    }
    parameters
}

/// Reads `[scaled]`: `LMX2 = "L*MX2"`.
pub(super) fn scaled(
    value: Value<'_>,
    lengths: &[(String, f64)],
    to: &mut Findings,
) -> Vec<ScaledParameter> {
    let mut all = Vec::new();
    for (name, offset, value) in entries(value, "[scaled]", to) {
        let what = format!("scaled parameter `{name}`");
        if !checked_word(name, offset, "scaled parameter", to) {
            continue;
        }
        let Some(text) = value::text(value, &what, to) else {
            continue;
        };
        let start = value.span().start;
        match product(text, lengths) {
            Ok((factor, parameter)) => all.push(ScaledParameter {
                name: name.to_owned(),
                factor,
                parameter,
                span: to.span(offset),
            }),
            Err(why) => {
                let help = "write a factor, `*`, and one parameter: \"L*MX2\"";
                to.error(
                    start,
                    finding(code::SCALED, format!("{what}: {why}")).help(help),
                );
            }
        }
    }
    all
}

/// `FACTOR*PARAMETER`: everything before the last `*` is the factor.
fn product(text: &str, lengths: &[(String, f64)]) -> Result<(Quantity, String), String> {
    let Some((factor, parameter)) = text.rsplit_once('*') else {
        return Err(format!("`{text}` is not a product"));
    };
    let (factor, parameter) = (factor.trim(), parameter.trim());
    if !is_word(parameter) {
        return Err(format!("`{parameter}` is not the name of a parameter"));
    }
    if lengths.iter().any(|(name, _)| name == parameter) {
        return Err(format!("`{parameter}` is a length: put the parameter last"));
    }
    let value = expression::evaluate(factor, lengths).map_err(|mistake| mistake.message)?;
    if value == 0.0 || !value.is_finite() {
        return Err(format!("the factor `{factor}` is {value}"));
    }
    Ok((
        Quantity {
            value,
            text: factor.to_owned(),
        },
        parameter.to_owned(),
    ))
}

fn checked_word(name: &str, offset: usize, what: &str, to: &mut Findings) -> bool {
    let fits = is_word(name);
    if !fits {
        let message = format!("`{name}` cannot name a {what}");
        let help = "a name is a letter, then letters, digits and `_`";
        to.error(offset, finding(code::NAME_INVALID, message).help(help));
    }
    fits
}

fn entries<'t>(
    value: Value<'t>,
    what: &str,
    to: &mut Findings,
) -> Vec<(&'t str, usize, Value<'t>)> {
    match value.get_ref() {
        DeValue::Table(table) => in_text_order(table),
        other => {
            wrong_type(value, what, "a table", other, to);
            Vec::new()
        }
    }
}
