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
    let place = text.origin.unwrap_or_default();
    let name = &text.edge.named.name;
    if let Some(far) = origin
        .xyz
        .iter()
        .find(|part| part.abs() > check::DOUBTFUL_LENGTH)
    {
        to.warn(
            place,
            check::doubtful_length(&format!("xyz of joint `{name}`"), *far),
        );
    }
    if let Some(wide) = origin
        .rpy
        .iter()
        .find(|part| part.abs() > check::DOUBTFUL_ANGLE)
    {
        to.warn(
            place,
            check::doubtful_angle(&format!("rpy of joint `{name}`"), *wide),
        );
    }
    for part in &mut origin.rpy {
        let (snapped, Some(turns)) = angle::snap(*part) else {
            continue;
        };
        if (snapped - *part).abs() > angle::REPORTED {
            let to = angle::quarter_turns(turns);
            snaps.push(Snap {
                joint: name.clone(),
                from: *part,
                to,
            });
        }
        *part = snapped;
    }
    origin
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
    let written = joint.axis.xyz.0;
    // Divided by the largest part first, so that no square over- or underflows.
    let largest = written
        .iter()
        .fold(0.0_f64, |most, part| most.max(part.abs()));
    if largest == 0.0 {
        let message = format!("the axis of joint `{name}` is zero");
        let help = "give it a direction, such as xyz=\"0 0 1\"";
        to.error(place, finding(code::AXIS_ZERO, message).help(help));
        return X;
    }
    let scaled = written.map(|part| part / largest);
    let length = scaled.iter().map(|part| part * part).sum::<f64>().sqrt();
    let unit = scaled.map(|part| part / length);
    if (length * largest - 1.0).abs() > UNIT_TOLERANCE {
        let message = format!(
            "the axis of joint `{name}` has length {:.3e}",
            length * largest
        );
        to.warn(
            place,
            finding(code::AXIS_NOT_UNIT, message).help("it is normalised"),
        );
    }
    let Some((index, sign, tilt)) = angle::snap_axis(unit) else {
        return unit;
    };
    if tilt > angle::REPORTED {
        let sign = if sign < 0.0 { "-" } else { "" };
        let to = format!("axis {sign}{}", ["x", "y", "z"][index]);
        snaps.push(Snap {
            joint: name.clone(),
            from: tilt,
            to,
        });
    }
    let mut exact = [0.0; 3];
    exact[index] = sign;
    exact
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
