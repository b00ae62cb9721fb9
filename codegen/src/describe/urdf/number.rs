//! Attributes that hold numbers: their text is checked here, with its place, and read by urdf-rs.

use super::super::code;
use super::super::findings::{Finding, Findings, finding};
use super::element::Attribute;

/// Whether infinity is a value.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Infinity {
    /// It is a mistake.
    Refused,
    /// It says that there is no limit.
    Unlimited,
}

/// The text of `count` finite numbers; `None`, with an error, if it is anything else.
pub(super) fn checked<'a>(
    attribute: Attribute<'a>,
    what: &str,
    count: usize,
    to: &mut Findings,
) -> Option<&'a str> {
    let words: Vec<&str> = attribute
        .text
        .split_whitespace()
        .take(2 * count + 8)
        .collect();
    let wrong = words
        .iter()
        .find_map(|word| mistake(word, what, Infinity::Refused));
    let wrong = wrong.or_else(|| (words.len() != count).then(|| miscounted(&words, what, count)));
    match wrong {
        None => Some(attribute.text),
        Some(found) => {
            to.error(attribute.offset, found);
            None
        }
    }
}

/// The text of one number that may be infinite.
pub(super) fn checked_limit<'a>(
    attribute: Attribute<'a>,
    what: &str,
    to: &mut Findings,
) -> Option<&'a str> {
    let text = attribute.text.trim();
    match mistake(text, what, Infinity::Unlimited) {
        None => Some(text),
        Some(found) => {
            to.error(attribute.offset, found);
            None
        }
    }
}

fn miscounted(words: &[&str], what: &str, count: usize) -> Finding {
    let numbers = if count == 1 { "number" } else { "numbers" };
    let message = match words.len() {
        0 => format!("{what} is empty"),
        found => format!("{what} has {found} numbers instead of {count}"),
    };
    finding(code::NUMBER_COUNT, message).help(format!("write {count} {numbers}"))
}

fn mistake(word: &str, what: &str, infinity: Infinity) -> Option<Finding> {
    match word.parse::<f64>() {
        Ok(number) if number.is_finite() => None,
        Ok(number) if number.is_infinite() && infinity == Infinity::Unlimited => None,
        Ok(_) => {
            let message = format!("{what} is {}, which is no finite number", shown(word));
            Some(finding(code::NUMBER_NOT_FINITE, message))
        }
        Err(_) => {
            let message = format!("{what}: `{}` is not a number", shown(word));
            Some(finding(code::NUMBER_INVALID, message).help(hint(word)))
        }
    }
}

/// What people write instead of numbers.
fn hint(word: &str) -> &'static str {
    if word.contains("$(") {
        "run xacro on the file first"
    } else if word.contains(',') {
        "decimal numbers are written with a point: 0.5; several are separated by spaces"
    } else if word.starts_with("0x") || word.starts_with("0X") {
        "write it in decimal"
    } else if word.starts_with(|first: char| first.is_ascii_digit()) {
        "write the number alone, in SI units"
    } else {
        "write a decimal number"
    }
}

/// A word of a sane length for a message.
fn shown(word: &str) -> String {
    const LONGEST: usize = 40;
    if word.chars().count() <= LONGEST {
        return word.to_owned();
    }
    word.chars().take(LONGEST).chain("...".chars()).collect()
}
