//! What a `[[joint]]` row or a `[joint.NAME]` table says beside the geometry.

use super::super::check::Known;
use super::super::code;
use super::super::description::{Drive, Limits, Mimic};
use super::super::findings::{Findings, finding};
use super::effects::{self, Wanted};
use super::table::{Table, Value};
use super::value;
use toml::de::DeValue;

/// Effects and gain of one joint.
#[derive(Default)]
pub(super) struct Extras {
    /// Effects in place of the default ones, if stated.
    pub(super) effects: Option<Vec<Wanted>>,
    /// Drive gain with its place, if stated.
    pub(super) gain: Option<(f64, usize)>,
}

/// Reads `effects` and `gain`.
pub(super) fn extras(table: &mut Table<'_>, to: &mut Findings) -> Extras {
    let effects = table
        .get("effects")
        .and_then(|value| effects::wanted(value, &table.path("effects"), to));
    let gain = table.get("gain").and_then(|value| {
        let gain = value::number(value, &table.path("gain"), to)?;
        Some((gain, value.span().start))
    });
    Extras { effects, gain }
}

/// Reports effects or a gain of a joint without a drive.
pub(super) fn check_motion(joint: &Known, extras: &Extras, offset: usize, to: &mut Findings) {
    if let Some((why, help)) = joint.idle()
        && (extras.effects.is_some() || extras.gain.is_some())
    {
        let message = format!("{why}: it has neither effects nor a gain");
        to.error(offset, finding(code::EFFECT_JOINT, message).help(help));
    }
}

/// Reads `passive = true`, or `mimic = { joint = "a", multiplier = 2, offset = 0 }`.
pub(super) fn drive(table: &mut Table<'_>, to: &mut Findings) -> Drive {
    let passive = table.get("passive");
    let is_passive =
        passive.and_then(|value| value::flag(value, &table.path("passive"), to)) == Some(true);
    let Some(value) = table.get("mimic") else {
        return if is_passive {
            Drive::Passive
        } else {
            Drive::Own
        };
    };
    if let (true, Some(passive)) = (is_passive, passive) {
        let message = format!("{} both follows a joint and is passive", table.name);
        to.error(passive.span().start, finding(code::KEYS_EXCLUDE, message));
    }
    let what = table.path("mimic");
    let Some(mut mimic) = Table::from_value(value, &what, to) else {
        return Drive::Own;
    };
    let followed = mimic.need("joint", to);
    let followed = followed.and_then(|value| value::text(value, &mimic.path("joint"), to));
    let mut number = |key| {
        let value = mimic.get(key)?;
        let number = value::number(value, &mimic.path(key), to)?;
        Some((number, value.span().start))
    };
    let (multiplier, at) = number("multiplier").unwrap_or((1.0, 0));
    let offset = number("offset").map_or(0.0, |(offset, _)| offset);
    mimic.finish(to);
    if multiplier == 0.0 {
        let message = format!("the multiplier of {what} is 0");
        let help = "a joint that does not follow is fixed";
        to.error(at, finding(code::NUMBER_RANGE, message).help(help));
    }
    followed.map_or(Drive::Own, |joint| {
        Drive::Mimic(Mimic {
            joint: joint.to_owned(),
            multiplier,
            offset,
            span: to.span(value.span().start),
        })
    })
}

/// Reads `limits`: `[lower, upper]`, or a table of lower, upper, velocity, effort.
pub(super) fn limits(table: &mut Table<'_>, to: &mut Findings) -> Limits {
    let Some(value) = table.get("limits") else {
        return Limits::default();
    };
    let what = table.path("limits");
    let limits = match value.get_ref() {
        DeValue::Array(_) => range(value, &what, to),
        _ => keyed(value, &what, to),
    };
    let limits = limits.unwrap_or_default();
    if let (Some(lower), Some(upper)) = (limits.lower, limits.upper)
        && lower > upper
    {
        let message = format!("{what}: lower {lower} is above upper {upper}");
        to.error(value.span().start, finding(code::LIMITS_REVERSED, message));
    }
    limits
}

fn range(value: Value<'_>, what: &str, to: &mut Findings) -> Option<Limits> {
    let numbers = value::numbers(value, what, to)?;
    if let [lower, upper] = numbers[..] {
        return Some(Limits {
            lower: Some(lower),
            upper: Some(upper),
            ..Limits::default()
        });
    }
    let message = format!(
        "{what} has {} numbers instead of lower and upper",
        numbers.len()
    );
    to.error(value.span().start, finding(code::NUMBER_COUNT, message));
    None
}

fn keyed(value: Value<'_>, what: &str, to: &mut Findings) -> Option<Limits> {
    const POSITIVE: (f64, f64) = (f64::MIN_POSITIVE, f64::MAX);
    const ANY: (f64, f64) = (f64::MIN, f64::MAX);
    let mut table = Table::from_value(value, what, to)?;
    let mut read = |key, range| {
        let value = table.get(key)?;
        value::number_within(value, &table.path(key), range, to)
    };
    let limits = Limits {
        lower: read("lower", ANY),
        upper: read("upper", ANY),
        velocity: read("velocity", POSITIVE),
        effort: read("effort", POSITIVE),
    };
    table.finish(to);
    Some(limits)
}
