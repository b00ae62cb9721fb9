//! The lengths that the geometry is made of, by name: those of the description's `[lengths]` where
//! a row of its table is one of them, otherwise `d3`, `r4`, `b2` as in the table of Khalil and
//! Kleinfinger (`p2x` where an origin is not placed by its rule).

use crate::describe::{Description, Geometry, MdhRow, Quantity};
use crate::mechanism::{Joint, Mechanism};

/// Displacements below this (m) are rounding, as in [`crate::mechanism::frames`].
const ROUNDING: f64 = 1e-9;

/// A named length and where the mechanism has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Length {
    /// Name in relations.
    pub name: String,
    /// Value, m.
    pub value: f64,
    /// Joint and direction in its antecedent's frame: the length moves the origin along it.
    places: Vec<(usize, [f64; 3])>,
}

/// The lengths of a mechanism that are not zero, from the base outwards.
pub fn of(mechanism: &Mechanism, description: &Description) -> Vec<Length> {
    let mut lengths: Vec<Length> = Vec::new();
    // With other lengths their loops would close elsewhere, or not at all.
    if !mechanism.dyads.is_empty() {
        return lengths;
    }
    for (index, joint) in mechanism.joints.iter().enumerate() {
        for (symbol, value, direction) in displacements(joint) {
            let (name, stated) = stated(description, &joint.name, symbol, value)
                .unwrap_or_else(|| (own_name(description, symbol, index), value));
            let place = (index, direction.map(|x| x * (value / stated)));
            match lengths.iter_mut().find(|length| length.name == name) {
                Some(length) => length.places.push(place),
                None => lengths.push(Length {
                    name,
                    value: stated,
                    places: vec![place],
                }),
            }
        }
    }
    lengths
}

/// The mechanism with other values of its lengths.
pub fn changed(mechanism: &Mechanism, lengths: &[Length], values: &[f64]) -> Mechanism {
    let mut changed = mechanism.clone();
    for joint in &mut changed.joints {
        joint.position = [0.0; 3];
    }
    for (length, value) in lengths.iter().zip(values) {
        for &(joint, direction) in &length.places {
            for (x, along) in changed.joints[joint].position.iter_mut().zip(direction) {
                *x += value * along;
            }
        }
    }
    changed
}

/// The steps to a joint's origin: symbol, length, direction in the antecedent's frame.
fn displacements(joint: &Joint) -> Vec<(&'static str, f64, [f64; 3])> {
    let ((sg, cg), (sa, ca)) = (joint.gamma.sin_cos(), joint.alpha.sin_cos());
    let [x, y, z] = joint.position;
    let (along, across) = (cg * x + sg * y, cg * y - sg * x);
    let r = match sa == 0.0 {
        true => z * ca,
        false => -across / sa,
    };
    let steps = [
        ("d", along, [cg, sg, 0.0]),
        ("b", z - r * ca, [0.0, 0.0, 1.0]),
        ("r", r, [sg * sa, -cg * sa, ca]),
    ];
    let placed = (across + r * sa).abs() < ROUNDING;
    let raw = [
        ("px", x, [1.0, 0.0, 0.0]),
        ("py", y, [0.0, 1.0, 0.0]),
        ("pz", z, [0.0, 0.0, 1.0]),
    ];
    let steps = if placed { steps } else { raw };
    let there = |step: &(&str, f64, [f64; 3])| step.1.abs() >= ROUNDING;
    steps.into_iter().filter(there).collect()
}

/// The described length that a displacement is, with its value, whatever the sense of the axes.
fn stated(
    description: &Description,
    joint: &str,
    symbol: &str,
    value: f64,
) -> Option<(String, f64)> {
    let Geometry::Mdh(rows) = &description.geometry else {
        return None;
    };
    let row = rows.iter().find(|row| row.name == joint)?;
    let text = quantity(row, symbol)?.text.trim();
    let name = text.strip_prefix('-').unwrap_or(text).trim();
    let known = |(known, length): &&(String, f64)| {
        known == name && (length.abs() - value.abs()).abs() < ROUNDING
    };
    description.lengths.iter().find(known).cloned()
}

fn quantity<'a>(row: &'a MdhRow, symbol: &str) -> Option<&'a Quantity> {
    match symbol {
        "d" => Some(&row.d),
        "b" => Some(&row.b),
        "r" => Some(&row.r),
        _ => None,
    }
}

/// `d3` of the third joint, `p3x`; marked where the description calls another length so.
fn own_name(description: &Description, symbol: &str, joint: usize) -> String {
    let (letter, axis) = symbol.split_at(1);
    let mut name = format!("{letter}{}{axis}", joint + 1);
    while description.lengths.iter().any(|(known, _)| *known == name) {
        name.push('_');
    }
    name
}
