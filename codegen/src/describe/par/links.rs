//! What a `.par` says of the links and joints beside their geometry.

use super::super::code;
use super::super::description::{Drive, EffectSpec, MdhRow, Motion};
use super::super::diagnostic::Span;
use super::super::findings::{Findings, finding};
use super::super::toml::plain_effect;
use super::document::Item;
use super::values::Values;
use crate::catalogue::EffectKind;

/// The ten standard parameters of a link, in the order of the mechanism.
const INERTIAL: [&str; 10] = ["XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M"];

/// The effects of the format.
const EFFECTS: [(&str, EffectKind); 3] = [
    ("FV", EffectKind::Viscous),
    ("FS", EffectKind::Coulomb),
    ("IA", EffectKind::RotorInertia),
];

/// What an effect without a list says, and the joints of a file that has none of the lists.
const DEFAULT: [EffectKind; 4] = [
    EffectKind::Viscous,
    EffectKind::Coulomb,
    EffectKind::Offset,
    EffectKind::RotorInertia,
];

/// Gives the rows the inertial values that are numbers.
pub(super) fn inertial(values: &Values<'_, '_>, rows: &mut [MdhRow], to: &mut Findings) {
    let count = rows.len();
    let lists = INERTIAL.map(|key| values.list(key, count, to));
    for (index, row) in rows.iter_mut().enumerate() {
        let number = |place: usize, to: &mut Findings| match lists[place] {
            None => Some(0.0),
            Some(list) if values.symbol(list[index]).is_some() => None,
            Some(list) => {
                let what = format!("`{}` of link {}", INERTIAL[place], index + 1);
                values.number(list[index], &what, to)
            }
        };
        let found: Vec<Option<f64>> = (0..INERTIAL.len()).map(|place| number(place, to)).collect();
        let mut known = [0.0; 10];
        let all = found.iter().zip(&mut known).all(|(found, known)| {
            *known = found.unwrap_or_default();
            found.is_some()
        });
        row.inertial = (all && known[9] > 0.0).then_some(known);
        if let (true, Some(list)) = (known[9] < 0.0, lists[9]) {
            let message = format!("`M` of link {} is negative", index + 1);
            to.warn(
                list[index].offset,
                finding(code::MASS_NOT_POSITIVE, message),
            );
        }
    }
}

/// Effects joint by joint, and the values of those that are numbers. An effect acts where its list
/// has something other than 0; a file without these lists has the defaults of every description.
pub(super) fn effects(
    values: &Values<'_, '_>,
    rows: &[MdhRow],
    to: &mut Findings,
) -> (Vec<EffectSpec>, Vec<(String, f64)>) {
    let moving = rows.iter().enumerate();
    let moving = moving.filter(|(_, row)| row.motion != Motion::Fixed && row.drive == Drive::Own);
    let silent = EFFECTS.iter().all(|(key, _)| values.entry(key).is_none());
    let lists = EFFECTS.map(|(key, _)| values.list(key, rows.len(), to));
    warn_of_passive(rows, &lists, to);
    let (mut effects, mut known) = (Vec::new(), Vec::new());
    for (joint, (index, row)) in moving.enumerate() {
        if silent {
            effects.extend(DEFAULT.map(|kind| plain_effect(kind, &row.name, Span::default())));
            continue;
        }
        for ((key, kind), list) in EFFECTS.iter().zip(lists) {
            let Some(item) = list.map(|list| list[index]) else {
                continue;
            };
            let value = match values.symbol(item) {
                Some(_) => None,
                None => values.number(item, &format!("`{key}` of joint {}", index + 1), to),
            };
            if value != Some(0.0) {
                effects.push(plain_effect(*kind, &row.name, to.span(item.offset)));
            }
            known.extend(
                value
                    .filter(|&v| v != 0.0)
                    .map(|v| (format!("{key}{}", joint + 1), v)),
            );
        }
    }
    (effects, known)
}

/// Warns of effects on joints without a drive: they are no columns of their own.
fn warn_of_passive(rows: &[MdhRow], lists: &[Option<&[Item<'_>]>; 3], to: &mut Findings) {
    for ((key, _), list) in EFFECTS.iter().zip(lists) {
        let items = rows.iter().zip(list.iter().copied().flatten());
        let mut stated = items
            .filter(|(row, item)| row.drive == Drive::Passive && item.text.parse() != Ok(0.0f64));
        if let Some((row, item)) = stated.next() {
            let message = format!("`{key}` of {}, which has no drive, is left out", row.name);
            let help = "effects act on the joints that drive a closed loop";
            to.warn(item.offset, finding(code::PAR_LEFT_OUT, message).help(help));
        }
    }
}

/// Gravity in frame 0; a third component that is a symbol is -9.81, as the format has it.
pub(super) fn gravity(values: &Values<'_, '_>, to: &mut Findings) -> [f64; 3] {
    const DOWN: [f64; 3] = [0.0, 0.0, -9.81];
    let Some(list) = values.list("g", 3, to) else {
        return DOWN;
    };
    let mut gravity = DOWN;
    for (axis, (&item, value)) in list.iter().zip(&mut gravity).enumerate() {
        let symbolic = axis == 2 && values.symbol(item) == Some(item.text);
        if !symbolic {
            *value = values.number(item, "`G`", to).unwrap_or(*value);
        }
    }
    gravity
}

/// Reports what would change the model if it were not left out.
pub(super) fn left_out(values: &Values<'_, '_>, to: &mut Findings) {
    let zero = |text: &str| text.parse() == Ok(0.0f64);
    let first = |key: &str| {
        let entry = values.entry(key).filter(|entry| entry.list)?;
        entry.items.iter().copied().find(|item| !zero(item.text))
    };
    if let Some(item) = first("eta") {
        let message = "`eta`: flexible joints cannot be described here";
        let help = "write 0, and let `idim diagnose` look for elasticity";
        to.error(
            item.offset,
            finding(code::JOINT_UNSUPPORTED, message).help(help),
        );
    }
    for (keys, what) in [
        (
            ["FX", "FY", "FZ", "CX", "CY", "CZ"].as_slice(),
            "an external force",
        ),
        (
            ["W0", "WP0", "V0", "VP0"].as_slice(),
            "a motion of the base",
        ),
    ] {
        if let Some((key, item)) = keys.iter().find_map(|key| Some((key, first(key)?))) {
            let message = format!("`{key}`: {what} is left out of the model");
            to.warn(item.offset, finding(code::PAR_LEFT_OUT, message));
        }
    }
}
