//! From the values that urdf-rs read to links and joints of the description.

use super::super::angle;
use super::super::check;
use super::super::code;
use super::super::description::{Limits, Motion, Pose, Snap, UrdfInertial};
use super::super::findings::{Findings, finding};
use super::inertia;
use super::joints::JointText;
use super::links::LinkText;

/// How far from 1 the length of an axis may be without a word: `0.7071` is meant to be a unit axis.
const UNIT_TOLERANCE: f64 = 1e-3;

/// The inertial values of a link, if it has any.
pub(super) fn inertial(
    link: &urdf_rs::Link,
    text: &LinkText,
    to: &mut Findings,
) -> Option<UrdfInertial> {
    let (mass_at, inertia_at) = text.inertial?;
    let urdf_rs::Inertia {
        ixx,
        ixy,
        ixz,
        iyy,
        iyz,
        izz,
    } = link.inertial.inertia;
    let inertial = UrdfInertial {
        mass: link.inertial.mass.value,
        // As it is written: a snap would change the inertia and simplify nothing.
        origin: pose(&link.inertial.origin),
        inertia: [ixx, ixy, ixz, iyy, iyz, izz],
    };
    inertia::check(&text.named.name, &inertial, (mass_at, inertia_at), to);
    Some(inertial)
}

fn pose(pose: &urdf_rs::Pose) -> Pose {
    Pose {
        rpy: pose.rpy.0,
        xyz: pose.xyz.0,
    }
}

/// The pose of a joint, its angles snapped.
pub(super) fn origin(
    joint: &urdf_rs::Joint,
    text: &JointText,
    snaps: &mut Vec<Snap>,
    to: &mut Findings,
) -> Pose {
    let mut origin = pose(&joint.origin);
    check_units(&origin, text, to);
    for part in &mut origin.rpy {
        let (snapped, Some(turns)) = angle::snap(*part) else {
            continue;
        };
        if (snapped - *part).abs() > angle::REPORTED {
            snaps.push(snap(text, *part, angle::quarter_turns(turns)));
        }
        *part = snapped;
    }
    origin
}

fn snap(text: &JointText, from: f64, to: String) -> Snap {
    let joint = text.edge.named.name.clone();
    Snap { joint, from, to }
}

/// Warns of what looks like millimetres or degrees.
fn check_units(origin: &Pose, text: &JointText, to: &mut Findings) {
    let place = text.origin.unwrap_or_default();
    let name = &text.edge.named.name;
    let beyond = |parts: [f64; 3], limit: f64| parts.into_iter().find(|part| part.abs() > limit);
    if let Some(far) = beyond(origin.xyz, check::DOUBTFUL_LENGTH) {
        let what = format!("xyz of joint `{name}`");
        to.warn(place, check::doubtful_length(&what, far));
    }
    if let Some(wide) = beyond(origin.rpy, check::DOUBTFUL_ANGLE) {
        let what = format!("rpy of joint `{name}`");
        to.warn(place, check::doubtful_angle(&what, wide));
    }
}

/// The unit axis of a joint, snapped to a coordinate axis that it is close to.
pub(super) fn axis(
    joint: &urdf_rs::Joint,
    text: &JointText,
    snaps: &mut Vec<Snap>,
    to: &mut Findings,
) -> [f64; 3] {
    const X: [f64; 3] = [1.0, 0.0, 0.0];
    let Some(place) = text.axis else { return X };
    let name = &text.edge.named.name;
    let Some((unit, length)) = normalised(joint.axis.xyz.0) else {
        let message = format!("the axis of joint `{name}` is zero");
        let help = "give it a direction, such as xyz=\"0 0 1\"";
        to.error(place, finding(code::AXIS_ZERO, message).help(help));
        return X;
    };
    if (length - 1.0).abs() > UNIT_TOLERANCE {
        let message = format!("the axis of joint `{name}` has length {length:.3e}");
        let help = "it is normalised";
        to.warn(place, finding(code::AXIS_NOT_UNIT, message).help(help));
    }
    let Some((index, sign, tilt)) = angle::snap_axis(unit) else {
        return unit;
    };
    if tilt > angle::REPORTED {
        let minus = if sign < 0.0 { "-" } else { "" };
        let axis = ["x", "y", "z"][index];
        snaps.push(snap(text, tilt, format!("axis {minus}{axis}")));
    }
    let mut exact = [0.0; 3];
    exact[index] = sign;
    exact
}

/// Direction and length of a vector, unless it is zero.
fn normalised(vector: [f64; 3]) -> Option<([f64; 3], f64)> {
    let largest = vector
        .iter()
        .fold(0.0_f64, |most, part| most.max(part.abs()));
    if largest == 0.0 {
        return None;
    }
    // Divided by the largest part first, so that no square over- or underflows.
    let scaled = vector.map(|part| part / largest);
    let length = scaled.iter().map(|part| part * part).sum::<f64>().sqrt();
    Some((scaled.map(|part| part / length), length * largest))
}

/// The limits that a joint states.
pub(super) fn limits(joint: &urdf_rs::Joint, text: &JointText, to: &mut Findings) -> Limits {
    if text.motion == Motion::Fixed {
        return Limits::default();
    }
    let limit = &joint.limit;
    let [lower, upper, effort, velocity] = text.stated;
    let stated = |is: bool, value: f64| (is && value.is_finite()).then_some(value);
    let mut limits = Limits {
        lower: stated(lower && !text.continuous, limit.lower),
        upper: stated(upper && !text.continuous, limit.upper),
        velocity: stated(velocity, limit.velocity),
        effort: stated(effort, limit.effort),
    };
    check_range(&mut limits, text, to);
    check_size("velocity", &mut limits.velocity, text, to);
    check_size("effort", &mut limits.effort, text, to);
    limits
}

fn check_range(limits: &mut Limits, text: &JointText, to: &mut Findings) {
    let name = &text.edge.named.name;
    let silent = |message: String| {
        finding(code::LIMITS_MISSING, message)
            .help("an exciting trajectory cannot be planned for it")
    };
    match (limits.lower, limits.upper) {
        _ if text.continuous => {}
        (Some(lower), Some(upper)) if lower > upper => {
            let message = format!("joint `{name}`: lower limit {lower} is above upper {upper}");
            let place = text.limit.unwrap_or_default();
            to.error(
                place,
                finding(code::LIMITS_REVERSED, message).help("exchange them"),
            );
        }
        (Some(lower), Some(upper)) if lower == upper => {
            let message = format!("joint `{name}`: both limits are {lower}; taken as not stated");
            to.warn(text.limit.unwrap_or_default(), silent(message));
            (limits.lower, limits.upper) = (None, None);
        }
        (None, None) => {
            let message = format!("joint `{name}` has no lower and upper limit");
            match text.limit {
                Some(place) => to.warn(place, silent(message)),
                None => to.warn_at(text.edge.named.span, silent(message)),
            }
        }
        _ => {}
    }
}

/// Zero is what exporters write when nobody told them; below zero is a mistake.
fn check_size(what: &str, value: &mut Option<f64>, text: &JointText, to: &mut Findings) {
    let name = &text.edge.named.name;
    let place = text.limit.unwrap_or_default();
    match *value {
        Some(size) if size < 0.0 => {
            let message = format!("joint `{name}`: {what} limit {size} is negative");
            to.error(
                place,
                finding(code::NUMBER_RANGE, message).help("limits are magnitudes"),
            );
        }
        Some(0.0) => {
            let message = format!("joint `{name}`: {what} limit 0 is taken as not stated");
            to.warn(place, finding(code::LIMITS_MISSING, message));
            *value = None;
        }
        _ => {}
    }
}
