//! Bodies that move and have no inertial values.

use super::super::code;
use super::super::description::{Motion, UrdfTree};
use super::super::findings::{Findings, finding};
use super::super::suggest;

/// Warns of moving links that have no mass, nor anything fixed to them that has.
pub(super) fn check(tree: &UrdfTree, to: &mut Findings) {
    let mut body: Vec<usize> = (0..tree.links.len()).collect();
    let mut moved = vec![false; tree.links.len()];
    for joint in &tree.joints {
        match joint.motion {
            // Parents come first, so that the parent's body is known.
            Motion::Fixed => body[joint.child] = body[joint.parent],
            _ => moved[joint.child] = true,
        }
    }
    let mut heavy = vec![false; tree.links.len()];
    for (link, &body) in tree.links.iter().zip(&body) {
        // A mass of zero beside an inertia has been warned of already.
        heavy[body] |= link.inertial.is_some_and(|inertial| {
            inertial.mass != 0.0 || inertial.inertia.iter().any(|part| *part != 0.0)
        });
    }
    let light: Vec<usize> = (0..tree.links.len())
        .filter(|&link| moved[link] && !heavy[link])
        .collect();
    let Some(&first) = light.first() else { return };
    let names: Vec<&str> = light
        .iter()
        .map(|&link| tree.links[link].name.as_str())
        .collect();
    let message = match names.len() {
        1 => format!("link `{}` moves and has no mass", names[0]),
        n => format!(
            "{n} links move and have no mass: {}",
            suggest::listed(&names)
        ),
    };
    let help = "parameters are estimated all the same; the URDF says nothing about them";
    to.warn_at(
        tree.links[first].span,
        finding(code::MASSLESS, message).help(help),
    );
}
