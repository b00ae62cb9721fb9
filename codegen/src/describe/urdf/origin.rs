//! `<origin>`: a pose whose parts may be left out.

use super::super::code;
use super::super::findings::{Findings, finding};
use super::digest::Digest;
use super::element::Element;
use super::number;

/// Reads the `<origin>` of an element into the digest; gives its place.
pub(super) fn read(
    parent: Element<'_>,
    owner: &str,
    digest: &mut Digest,
    to: &mut Findings,
) -> Option<usize> {
    let origin = parent.child("origin", owner, to)?;
    origin.check_attributes(&["xyz", "rpy", "quat_xyzw"], owner, to);
    let mut attributes = Vec::new();
    for (name, count) in [("xyz", 3), ("rpy", 3), ("quat_xyzw", 4)] {
        let Some(found) = origin.attribute(name) else {
            continue;
        };
        let what = format!("{name} of <origin> in {owner}");
        if let Some(text) = number::checked(found, &what, count, to) {
            attributes.push((name, text));
        }
    }
    if let Some(quaternion) = origin.attribute("quat_xyzw") {
        let refused = if origin.attribute("rpy").is_some() {
            let message = format!("<origin> in {owner} has both rpy and quat_xyzw");
            Some(finding(code::KEYS_EXCLUDE, message).help("keep one of the two orientations"))
        } else if !digest.knows_quaternions() {
            let message = format!("quat_xyzw of <origin> in {owner} means nothing in URDF 1.0");
            let help = "write <robot version=\"1.1\">, or rpy";
            Some(finding(code::ATTRIBUTE_UNKNOWN, message).help(help))
        } else {
            None
        };
        if let Some(found) = refused {
            to.error(quaternion.offset, found);
            attributes.retain(|(name, _)| *name != "quat_xyzw");
        }
    }
    digest.empty("origin", &attributes);
    Some(origin.offset())
}
