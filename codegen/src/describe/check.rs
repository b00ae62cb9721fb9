//! What every description has to be, however it was written.
//!
//! Names are unique, also as identifiers; links form one tree; something moves. The readers call
//! these on names and places, before anything is an index.

use super::code;
use super::description::{Geometry, Motion};
use super::diagnostic::Span;
use super::findings::{Finding, Findings, finding};
use super::identifier;
use std::collections::HashMap;

/// Beyond this an angle was probably written in degrees, rad.
pub(crate) const DOUBTFUL_ANGLE: f64 = 6.5;

/// Beyond this a length was probably written in millimetres, m.
pub(crate) const DOUBTFUL_LENGTH: f64 = 50.0;

/// A name and its place.
pub(crate) struct Named {
    /// The name.
    pub(crate) name: String,
    /// Where it stands.
    pub(crate) span: Span,
}

/// Reports names that occur twice; `what` is `link` or `joint`.
pub(crate) fn unique(what: &str, names: &[&Named], to: &mut Findings) {
    let mut first: HashMap<&str, Span> = HashMap::new();
    for Named { name, span } in names {
        if let Some(before) = first.get(name.as_str()) {
            let message = format!("two {what}s are called `{name}`");
            let help = format!("the first one is on line {}; rename one", before.line);
            to.error_at(*span, finding(code::NAME_REPEATED, message).help(help));
        } else {
            first.insert(name, *span);
        }
    }
}

/// Reports different joint names that become one identifier in generated code.
pub(crate) fn identifiers(names: &[&Named], to: &mut Findings) {
    let mut first: HashMap<String, &Named> = HashMap::new();
    for named in names {
        let snake = identifier::snake_case(&named.name);
        if snake.is_empty() {
            // Nothing of the name is left; joints are then told apart by number alone.
            continue;
        }
        match first.get(&snake) {
            Some(before) if before.name != named.name => {
                let message = format!(
                    "joints `{}` and `{}` are both `{snake}` in generated code",
                    before.name, named.name
                );
                let help = "rename one, so that they differ in more than case and punctuation";
                to.error_at(named.span, finding(code::NAMES_COLLIDE, message).help(help));
            }
            Some(_) => {}
            None => {
                first.insert(snake, named);
            }
        }
    }
}

/// Names and motions of all joints of a geometry.
pub(crate) fn joints(geometry: &Geometry) -> Vec<(String, Motion)> {
    match geometry {
        Geometry::Urdf(tree) => tree
            .joints
            .iter()
            .map(|joint| (joint.name.clone(), joint.motion))
            .collect(),
        Geometry::Mdh(rows) => rows
            .iter()
            .map(|row| (row.name.clone(), row.motion))
            .collect(),
    }
}

/// Reports a robot of which nothing moves.
pub(crate) fn something_moves(joints: &[(String, Motion)], to: &mut Findings) {
    if joints.iter().all(|(_, motion)| *motion == Motion::Fixed) {
        let message = match joints.len() {
            0 => "there is no joint".to_owned(),
            n => format!("none of the {n} joints moves"),
        };
        let help = "a model needs at least one revolute or prismatic joint";
        to.error_at(
            Span::default(),
            finding(code::NO_MOVING_JOINT, message).help(help),
        );
    }
}

/// An angle that looks like degrees.
pub(crate) fn doubtful_angle(what: &str, value: f64) -> Finding {
    finding(
        code::UNIT_DOUBTFUL,
        format!("{what} is {value} rad, more than a full turn"),
    )
    .help("angles are in radians")
}

/// A length that looks like millimetres.
pub(crate) fn doubtful_length(what: &str, value: f64) -> Finding {
    finding(code::UNIT_DOUBTFUL, format!("{what} is {value} m")).help("lengths are in metres")
}
