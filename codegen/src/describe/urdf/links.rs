//! `<link>`: structure and text of the numbers. Values come from urdf-rs afterwards.

use super::super::check::Named;
use super::super::code;
use super::super::findings::{Findings, finding};
use super::digest::Digest;
use super::element::{Attribute, Element};
use super::number;
use super::origin;

const COMPONENTS: [&str; 6] = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];

/// What is known of a link beside its values.
pub(super) struct LinkText {
    /// Name and place.
    pub(super) named: Named,
    /// Where `<mass>` and `<inertia>` stand, if the link has an `<inertial>`.
    pub(super) inertial: Option<(usize, usize)>,
}

/// Reads a link into the digest.
pub(super) fn read(link: Element<'_>, digest: &mut Digest, to: &mut Findings) -> LinkText {
    let name = link.name(to).unwrap_or_default();
    let owner = format!("link `{name}`");
    let misplaced = misplaced(link, &owner, to);
    link.check_children(&["inertial"], &owner, to);
    digest.open("link", &[("name", name)]);
    let inertial = link.child("inertial", &owner, to);
    let places = inertial.map(|inertial| read_inertial(inertial, &owner, misplaced, digest, to));
    digest.close("link");
    LinkText {
        named: Named {
            name: name.to_owned(),
            span: to.span(link.offset()),
        },
        inertial: places,
    }
}

/// Reports what stands in a link and is overlooked there; tells whether there is such a thing.
fn misplaced(link: Element<'_>, owner: &str, to: &mut Findings) -> bool {
    let mut some = false;
    for child in link.children() {
        let help = match child.tag() {
            "mass" | "inertia" => "it belongs into <inertial>",
            "joint" | "link" => "links and joints stand directly in <robot>",
            _ => continue,
        };
        let message = format!("<{}> directly in {owner}", child.tag());
        to.error(
            child.offset(),
            finding(code::ELEMENT_MISPLACED, message).help(help),
        );
        some = true;
    }
    some
}

/// Reads an `<inertial>`; gives the places of mass and inertia. What is `misplaced` is not missing
/// as well.
fn read_inertial(
    inertial: Element<'_>,
    owner: &str,
    misplaced: bool,
    digest: &mut Digest,
    to: &mut Findings,
) -> (usize, usize) {
    let owner = &format!("<inertial> of {owner}");
    inertial.check_children(&["origin", "mass", "inertia"], owner, to);
    digest.open("inertial", &[]);
    origin::read(inertial, owner, digest, to);
    let need = |tag, to: &mut Findings| match misplaced {
        true => inertial.child(tag, owner, to),
        false => inertial.need_child(tag, owner, to),
    };
    let mass = need("mass", to);
    let value = mass.and_then(|mass| mass.need("value", owner, to));
    let text = value.and_then(|value| number::checked(value, &format!("mass in {owner}"), 1, to));
    digest.empty("mass", &[("value", text.unwrap_or("1"))]);
    let inertia = need("inertia", to);
    let components = inertia.map(|inertia| read_inertia(inertia, owner, to));
    digest.empty(
        "inertia",
        &components.unwrap_or_else(|| COMPONENTS.map(|name| (name, "0"))),
    );
    digest.close("inertial");
    let place = |element: Option<Element<'_>>| element.unwrap_or(inertial).offset();
    (place(mass), place(inertia))
}

fn read_inertia<'a>(
    inertia: Element<'a>,
    owner: &str,
    to: &mut Findings,
) -> [(&'static str, &'a str); 6] {
    inertia.check_attributes(&COMPONENTS, owner, to);
    COMPONENTS.map(|name| {
        let found: Option<Attribute<'a>> = inertia.need(name, owner, to);
        let what = format!("{name} in {owner}");
        (
            name,
            found
                .and_then(|found| number::checked(found, &what, 1, to))
                .unwrap_or("0"),
        )
    })
}
