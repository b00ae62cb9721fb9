//! `<joint>`: structure and text of the numbers. Values come from urdf-rs afterwards.

use super::super::check::Named;
use super::super::code;
use super::super::description::{Drive, Mimic, Motion};
use super::super::findings::{Findings, finding};
use super::super::suggest;
use super::super::tree::Edge;
use super::digest::Digest;
use super::element::Element;
use super::number;
use super::origin;

const MATTER: [&str; 6] = ["parent", "child", "origin", "axis", "limit", "mimic"];
const LIMITS: [&str; 4] = ["lower", "upper", "effort", "velocity"];
const TYPES: [&str; 6] = [
    "revolute",
    "continuous",
    "prismatic",
    "fixed",
    "floating",
    "planar",
];

/// What is known of a joint beside its values.
pub(super) struct JointText {
    /// Name, place, parent and child.
    pub(super) edge: Edge,
    /// How it moves.
    pub(super) motion: Motion,
    /// Whether lower and upper limits mean nothing.
    pub(super) continuous: bool,
    /// Where the origin stands, if there is one.
    pub(super) origin: Option<usize>,
    /// Where the axis stands, if there is one.
    pub(super) axis: Option<usize>,
    /// Where the limit stands, if there is one.
    pub(super) limit: Option<usize>,
    /// Which of lower, upper, effort, velocity are stated.
    pub(super) stated: [bool; 4],
    /// What moves it.
    pub(super) drive: Drive,
}

/// Reads a joint into the digest.
pub(super) fn read(joint: Element<'_>, digest: &mut Digest, to: &mut Findings) -> JointText {
    let name = joint.name(to).unwrap_or_default();
    let owner = &format!("joint `{name}`");
    misplaced(joint, owner, to);
    joint.check_children(&MATTER, owner, to);
    let kind = kind(joint, owner, to);
    digest.open("joint", &[("name", name), ("type", kind)]);
    let edge = Edge {
        named: Named {
            name: name.to_owned(),
            span: to.span(joint.offset()),
        },
        parent: end(joint, "parent", owner, digest, to),
        child: end(joint, "child", owner, digest, to),
    };
    let origin = origin::read(joint, owner, digest, to);
    let axis = axis(joint, owner, kind, digest, to);
    let (limit, stated) = limit(joint, owner, digest, to);
    dynamics(joint, owner, to);
    digest.close("joint");
    let motion = match kind {
        "revolute" | "continuous" => Motion::Revolute,
        "prismatic" => Motion::Prismatic,
        _ => Motion::Fixed,
    };
    let continuous = kind == "continuous";
    let drive = drive(joint, owner, to);
    JointText {
        edge,
        motion,
        continuous,
        origin,
        axis,
        limit,
        stated,
        drive,
    }
}

fn misplaced(joint: Element<'_>, owner: &str, to: &mut Findings) {
    for child in joint
        .children()
        .filter(|child| matches!(child.tag(), "joint" | "link"))
    {
        let message = format!("<{}> inside {owner}", child.tag());
        let help = "links and joints stand directly in <robot>";
        to.error(
            child.offset(),
            finding(code::ELEMENT_MISPLACED, message).help(help),
        );
    }
}

/// The type, or `fixed` where it is none that can be modelled.
fn kind<'a>(joint: Element<'a>, owner: &str, to: &mut Findings) -> &'a str {
    let Some(found) = joint.attribute("type") else {
        let help = suggest::help("", &TYPES);
        let found = finding(code::ATTRIBUTE_MISSING, format!("{owner} has no type")).help(help);
        to.error(joint.offset(), found);
        return "fixed";
    };
    match found.text {
        kind @ ("revolute" | "continuous" | "prismatic" | "fixed") => kind,
        kind @ ("floating" | "planar" | "spherical") => {
            let message = format!("{owner} is {kind}, which is not yet supported");
            let help = "supported: revolute, continuous, prismatic, fixed";
            to.error(
                found.offset,
                finding(code::JOINT_UNSUPPORTED, message).help(help),
            );
            "fixed"
        }
        kind => {
            let message = format!("{owner} has the unknown type `{kind}`");
            let help = suggest::help(kind, &TYPES);
            to.error(
                found.offset,
                finding(code::JOINT_TYPE_UNKNOWN, message).help(help),
            );
            "fixed"
        }
    }
}

/// The link that `<parent>` or `<child>` names, with its place.
fn end(
    joint: Element<'_>,
    tag: &'static str,
    owner: &str,
    digest: &mut Digest,
    to: &mut Findings,
) -> Named {
    let found = joint
        .need_child(tag, owner, to)
        .and_then(|end| end.need("link", owner, to));
    let (name, offset) = found.map_or(("", joint.offset()), |link| (link.text.trim(), link.offset));
    digest.empty(tag, &[("link", name)]);
    Named {
        name: name.to_owned(),
        span: to.span(offset),
    }
}

fn axis(
    joint: Element<'_>,
    owner: &str,
    kind: &str,
    digest: &mut Digest,
    to: &mut Findings,
) -> Option<usize> {
    let axis = joint.child("axis", owner, to)?;
    // Exporters write all sorts of things for the axis of a fixed joint, which has none.
    if kind == "fixed" {
        return None;
    }
    let xyz = axis.need("xyz", owner, to)?;
    let text = number::checked(xyz, &format!("axis of {owner}"), 3, to)?;
    digest.empty("axis", &[("xyz", text)]);
    Some(axis.offset())
}

fn limit(
    joint: Element<'_>,
    owner: &str,
    digest: &mut Digest,
    to: &mut Findings,
) -> (Option<usize>, [bool; 4]) {
    let Some(limit) = joint.child("limit", owner, to) else {
        return (None, [false; 4]);
    };
    limit.check_attributes(&["lower", "upper", "effort", "velocity"], owner, to);
    let texts = LIMITS.map(|name| {
        let found = limit.attribute(name)?;
        number::checked_limit(found, &format!("{name} of <limit> in {owner}"), to)
    });
    // urdf-rs wants a velocity; whether one is stated is known from here.
    let [lower, upper, effort, velocity] = texts.map(|text| text.unwrap_or("0"));
    let attributes = [
        ("lower", lower),
        ("upper", upper),
        ("effort", effort),
        ("velocity", velocity),
    ];
    digest.empty("limit", &attributes);
    (Some(limit.offset()), texts.map(|text| text.is_some()))
}

/// Damping and friction are estimated, not read; but what no joint has is worth a word.
fn dynamics(joint: Element<'_>, owner: &str, to: &mut Findings) {
    let Some(dynamics) = joint.child("dynamics", owner, to) else {
        return;
    };
    for name in ["damping", "friction"] {
        let Some(found) = dynamics.attribute(name) else {
            continue;
        };
        let what = format!("{name} of <dynamics> in {owner}");
        let text = number::checked(found, &what, 1, to);
        if text
            .and_then(|text| text.trim().parse().ok())
            .is_some_and(|value: f64| value < 0.0)
        {
            let message = format!("{what} is negative");
            let help = "it is not used: friction is estimated";
            to.warn(
                found.offset,
                finding(code::DAMPING_NEGATIVE, message).help(help),
            );
        }
    }
}

/// `<mimic joint="a" multiplier="2" offset="0"/>`.
fn drive(joint: Element<'_>, owner: &str, to: &mut Findings) -> Drive {
    let Some(mimic) = joint.child("mimic", owner, to) else {
        return Drive::Own;
    };
    mimic.check_attributes(&["joint", "multiplier", "offset"], owner, to);
    let Some(followed) = mimic.need("joint", owner, to) else {
        return Drive::Own;
    };
    let mut number = |name: &str, default: f64| {
        let Some(found) = mimic.attribute(name) else {
            return default;
        };
        let what = format!("{name} of <mimic> in {owner}");
        let text = number::checked(found, &what, 1, to);
        text.and_then(|text| text.trim().parse().ok())
            .unwrap_or(default)
    };
    let (multiplier, offset) = (number("multiplier", 1.0), number("offset", 0.0));
    if multiplier == 0.0 {
        let message = format!("the multiplier of <mimic> in {owner} is 0");
        let help = "a joint that does not follow is fixed";
        to.error(
            mimic.offset(),
            finding(code::NUMBER_RANGE, message).help(help),
        );
    }
    Drive::Mimic(Mimic {
        joint: followed.text.trim().to_owned(),
        multiplier,
        offset,
        span: to.span(followed.offset),
    })
}
