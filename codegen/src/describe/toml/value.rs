//! Values of TOML as numbers, words and lists; what is wrong goes to the findings.

use super::super::code;
use super::super::description::Quantity;
use super::super::expression::evaluate;
use super::super::findings::{Findings, finding};
use super::super::suggest;
use super::table::{Value, wrong_type};
use toml::de::{DeInteger, DeValue};

/// A finite number, or an expression over named lengths.
pub(super) fn quantity(
    value: Value<'_>,
    what: &str,
    lengths: &[(String, f64)],
    to: &mut Findings,
) -> Option<Quantity> {
    let (number, text) = match value.get_ref() {
        DeValue::String(text) => (
            evaluated(value, text, what, lengths, to)?,
            text.trim().to_owned(),
        ),
        DeValue::Integer(digits) => (real(digits), digits.to_string()),
        DeValue::Float(digits) => (
            digits.as_str().parse().unwrap_or(f64::NAN),
            digits.as_str().to_owned(),
        ),
        other => {
            wrong_type(value, what, "a number or an expression", other, to);
            return None;
        }
    };
    if !number.is_finite() {
        let message = format!("{what} is {text}, which is no finite number");
        to.error(
            value.span().start,
            finding(code::NUMBER_NOT_FINITE, message),
        );
        return None;
    }
    Some(Quantity {
        value: number,
        text,
    })
}

fn evaluated(
    value: Value<'_>,
    text: &str,
    what: &str,
    lengths: &[(String, f64)],
    to: &mut Findings,
) -> Option<f64> {
    match evaluate(text, lengths) {
        Ok(number) => Some(number),
        Err(mistake) => {
            // Exact for a plain quoted string; an escape inside shifts it by a few columns.
            let offset = value.span().start + 1 + mistake.offset;
            let message = format!("{what}: {}", mistake.message);
            to.error(
                offset,
                finding(code::EXPRESSION, message).help(mistake.help),
            );
            None
        }
    }
}

/// A finite number.
pub(super) fn number(value: Value<'_>, what: &str, to: &mut Findings) -> Option<f64> {
    match value.get_ref() {
        // `pi/2` is a number, but lengths have their place in the geometry only.
        DeValue::String(text) if evaluate(text, &[]).is_err() => {
            let message = format!("{what} must be a number, not `{text}`");
            to.error(value.span().start, finding(code::VALUE_TYPE, message));
            None
        }
        _ => quantity(value, what, &[], to).map(|found| found.value),
    }
}

/// A number within a closed range.
pub(super) fn number_within(
    value: Value<'_>,
    what: &str,
    (low, high): (f64, f64),
    to: &mut Findings,
) -> Option<f64> {
    let found = number(value, what, to)?;
    if (low..=high).contains(&found) {
        return Some(found);
    }
    let wanted = if high < f64::MAX {
        format!("between {low} and {high}")
    } else if low == f64::MIN_POSITIVE {
        "positive".to_owned()
    } else {
        format!("{low} or more")
    };
    let message = format!("{what} must be {wanted}, not {found}");
    to.error(value.span().start, finding(code::NUMBER_RANGE, message));
    None
}

/// A whole number within a closed range.
pub(super) fn count_within(
    value: Value<'_>,
    what: &str,
    (low, high): (usize, usize),
    to: &mut Findings,
) -> Option<usize> {
    let DeValue::Integer(digits) = value.get_ref() else {
        wrong_type(value, what, "a whole number", value.get_ref(), to);
        return None;
    };
    let found = integer(digits).and_then(|number| usize::try_from(number).ok());
    if let Some(found) = found.filter(|found| (low..=high).contains(found)) {
        return Some(found);
    }
    let wanted = match high {
        0..=999 => format!("a whole number from {low} to {high}"),
        _ => format!("a whole number, {low} or more"),
    };
    let message = format!("{what} must be {wanted}, not {digits}");
    to.error(value.span().start, finding(code::NUMBER_RANGE, message));
    None
}

/// An integer as a number; beyond 64 bits it loses digits, in another radix its meaning.
fn real(digits: &DeInteger<'_>) -> f64 {
    match integer(digits) {
        Some(number) => number as f64,
        None if digits.radix() == 10 => digits.as_str().parse().unwrap_or(f64::NAN),
        None => f64::NAN,
    }
}

fn integer(digits: &DeInteger<'_>) -> Option<i64> {
    i64::from_str_radix(digits.as_str(), digits.radix()).ok()
}

/// A string.
pub(super) fn text<'t>(value: Value<'t>, what: &str, to: &mut Findings) -> Option<&'t str> {
    match value.get_ref() {
        DeValue::String(text) => Some(text.as_ref()),
        other => {
            wrong_type(value, what, "a string", other, to);
            None
        }
    }
}

/// True or false.
pub(super) fn flag(value: Value<'_>, what: &str, to: &mut Findings) -> Option<bool> {
    match value.get_ref() {
        DeValue::Boolean(flag) => Some(*flag),
        other => {
            wrong_type(value, what, "true or false", other, to);
            None
        }
    }
}

/// One of a few words.
pub(super) fn word<T: Copy>(
    value: Value<'_>,
    what: &str,
    choices: &[(&str, T)],
    to: &mut Findings,
) -> Option<T> {
    let found = text(value, what, to)?;
    if let Some((_, choice)) = choices.iter().find(|(name, _)| *name == found) {
        return Some(*choice);
    }
    let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
    let message = format!("{what} cannot be `{found}`");
    let help = suggest::help(found, &names);
    to.error(
        value.span().start,
        finding(code::WORD_UNKNOWN, message).help(help),
    );
    None
}

/// The values of an array.
pub(super) fn list<'t>(value: Value<'t>, what: &str, to: &mut Findings) -> Option<Vec<Value<'t>>> {
    match value.get_ref() {
        DeValue::Array(values) => Some(values.iter().collect()),
        other => {
            wrong_type(value, what, "an array", other, to);
            None
        }
    }
}

/// An array of finite numbers, all of them valid.
pub(super) fn numbers(value: Value<'_>, what: &str, to: &mut Findings) -> Option<Vec<f64>> {
    let values = list(value, what, to)?;
    let found: Vec<Option<f64>> = values
        .into_iter()
        .map(|one| number(one, what, to))
        .collect();
    found.into_iter().collect()
}
