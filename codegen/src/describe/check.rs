//! What every description has to be, however it was written.
//!
//! Names are unique, also as identifiers; links form one tree; something moves. The readers call
//! these on names and places, before anything is an index.

use super::code;
use super::description::{Drive, Geometry, MdhRow, Mimic, Motion, UrdfJoint};
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

/// A joint as far as effects, drives and logs see it.
#[derive(Clone, Debug)]
pub(crate) struct Known {
    /// Its name.
    pub(crate) name: String,
    /// How it moves.
    pub(crate) motion: Motion,
    /// What moves it.
    pub(crate) drive: Drive,
}

impl Known {
    /// A joint of a URDF.
    pub(crate) fn of_urdf(joint: &UrdfJoint) -> Known {
        Known {
            name: joint.name.clone(),
            motion: joint.motion,
            drive: joint.drive.clone(),
        }
    }

    /// A row of a table.
    pub(crate) fn of_row(row: &MdhRow) -> Known {
        Known {
            name: row.name.clone(),
            motion: row.motion,
            drive: row.drive.clone(),
        }
    }

    /// Whether it moves by a drive of its own.
    pub(crate) fn is_driven(&self) -> bool {
        self.motion != Motion::Fixed && self.drive == Drive::Own
    }

    /// Why nothing acts on it, if so: what to say and what to do.
    pub(crate) fn idle(&self) -> Option<(String, String)> {
        let name = &self.name;
        match &self.drive {
            _ if self.motion == Motion::Fixed => Some((
                format!("joint `{name}` does not move"),
                "effects act on moving joints".to_owned(),
            )),
            Drive::Own => None,
            Drive::Passive => Some((
                format!("joint `{name}` is moved by a closed loop"),
                "state the effect on the joints that drive the loop".to_owned(),
            )),
            Drive::Mimic(Mimic { joint, .. }) => Some((
                format!("joint `{name}` follows `{joint}`"),
                format!("its friction and inertia are part of `{joint}`'s; state the effect there"),
            )),
        }
    }
}

/// All joints of a geometry.
pub(crate) fn joints(geometry: &Geometry) -> Vec<Known> {
    match geometry {
        Geometry::Urdf(tree) => tree.joints.iter().map(Known::of_urdf).collect(),
        Geometry::Mdh(rows) => rows.iter().map(Known::of_row).collect(),
    }
}

/// Reports joints that follow what cannot be followed: nothing, themselves, what does not move.
pub(crate) fn mimics(joints: &[Known], to: &mut Findings) {
    for joint in joints {
        let Drive::Mimic(mimic) = &joint.drive else {
            continue;
        };
        let (name, other) = (&joint.name, &mimic.joint);
        let followed = joints.iter().find(|known| known.name == *other);
        let (why, help) = match followed {
            None => {
                let moving = joints.iter().filter(|known| known.motion != Motion::Fixed);
                let names = moving.map(|known| known.name.as_str());
                (
                    format!("`{other}`, which is no joint"),
                    to.suggest(other, names),
                )
            }
            Some(followed) if followed.motion == Motion::Fixed => (
                format!("`{other}`, which does not move"),
                "make it fixed too".to_owned(),
            ),
            Some(followed) if followed.drive == Drive::Passive => (
                format!("`{other}`, which a closed loop moves: that is not modelled yet"),
                "let it follow a joint with a drive".to_owned(),
            ),
            Some(_) if joint.motion == Motion::Fixed => (
                format!("`{other}`, but does not move"),
                "a fixed joint follows nothing".to_owned(),
            ),
            Some(_) => match cycle(joints, joint) {
                Some(path) => (
                    path,
                    "one joint of a chain of followers needs a drive of its own".to_owned(),
                ),
                None => continue,
            },
        };
        let message = format!("joint `{name}` mimics {why}");
        let found = finding(code::JOINT_UNSUPPORTED, message).help(help);
        to.error_at(mimic.span, found);
    }
}

/// The way from a joint over those that it follows back to itself, if there is one.
fn cycle(joints: &[Known], start: &Known) -> Option<String> {
    let mut path = vec![];
    let mut at = start;
    for _ in 0..joints.len() {
        let Drive::Mimic(Mimic { joint: next, .. }) = &at.drive else {
            return None;
        };
        path.push(format!("`{next}`"));
        if *next == start.name {
            return Some(match path.len() {
                1 => "itself".to_owned(),
                _ => format!("itself: {}", path.join(", which mimics ")),
            });
        }
        at = joints.iter().find(|known| known.name == *next)?;
    }
    None
}

/// Reports a robot of which nothing moves.
pub(crate) fn something_moves(joints: &[Known], to: &mut Findings) {
    if joints.iter().all(|joint| joint.motion == Motion::Fixed) {
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
