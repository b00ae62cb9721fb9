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
    if let (Some(_), Some(quaternion)) = (origin.attribute("rpy"), origin.attribute("quat_xyzw")) {
        let message = format!("<origin> in {owner} has both rpy and quat_xyzw");
        let help = "keep one of the two orientations";
        to.error(
            quaternion.offset,
            finding(code::KEYS_EXCLUDE, message).help(help),
        );
        attributes.retain(|(name, _)| *name != "quat_xyzw");
    }
    digest.empty("origin", &attributes);
    Some(origin.offset())
}
