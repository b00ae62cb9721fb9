//! Robots in URDF.
//!
//! The text is guarded, parsed with places ([`document`]), and walked once: structure, names and
//! the text of every number are checked there, and what is sound goes into a [`digest`] that
//! urdf-rs reads. Values are checked last, and each finding knows its line and column.

mod digest;
mod document;
mod element;
mod guard;
mod inertia;
mod joints;
mod links;
mod massless;
mod number;
mod origin;
mod values;
mod walk;

#[cfg(test)]
mod tests;

use super::check::{self, Known};
use super::code;
use super::description::{Snap, UrdfTree};
use super::diagnostic::{Diagnostic, Span};
use super::findings::{Findings, finding};
use super::tree;
use walk::Texts;

/// A robot as a URDF gives it.
pub(super) struct Robot {
    /// Its name.
    pub(super) name: String,
    /// Links and joints.
    pub(super) tree: UrdfTree,
    /// Angles taken as multiples of pi/2.
    pub(super) snaps: Vec<Snap>,
    /// What was noticed.
    pub(super) warnings: Vec<Diagnostic>,
}

/// Reads a URDF text.
pub(super) fn read(text: &str, file: &str) -> Result<Robot, Vec<Diagnostic>> {
    let mut to = Findings::new(text, file);
    let read = read_robot(text, &mut to);
    let warnings = to.decide()?;
    match read {
        Some((name, tree, snaps)) => Ok(Robot {
            name,
            tree,
            snaps,
            warnings,
        }),
        // Nothing is missing without an error; if it were, this is better than a wrong robot.
        None => Err(vec![
            finding(code::URDF_REFUSED, "this URDF cannot be read").on_file(file),
        ]),
    }
}

fn read_robot(text: &str, to: &mut Findings) -> Option<(String, UrdfTree, Vec<Snap>)> {
    let document = document::parse(text, to)?;
    let root = document::robot(&document, to)?;
    let name = root.name(to).unwrap_or_default().to_owned();
    let texts = Texts::read(root, to)?;
    // Follows from what was reported already would bury it.
    let sound = to.errors_of_group("IDIM02") == 0;
    let order = if sound {
        tree::order(&texts.links(), &texts.edges(), to)
    } else {
        None
    };
    let robot = match urdf_rs::read_from_string(&texts.digest) {
        Ok(robot) => robot,
        Err(error) => {
            let message = format!("urdf-rs cannot read this robot: {error}");
            to.error_at(Span::default(), finding(code::URDF_REFUSED, message));
            return None;
        }
    };
    let (tree, snaps) = texts.with_values(&robot, order, to)?;
    let joints: Vec<Known> = tree.joints.iter().map(Known::of_urdf).collect();
    check::mimics(&joints, to);
    massless::check(&tree, to);
    Some((name, tree, snaps))
}
