//! Whether a log goes with what its companion says about it.

use idim::runtime::log::{Companion, Recording};
use idim::runtime::model::{IdentificationModel, JointKind};
use idim::runtime::simulate::{Parting, off_controller, off_reference};

use super::Failure;

/// A sentence if the log leaves its reference.
///
/// # Errors
/// [`Failure::Simulate`] for a reference that cannot be evaluated along the log.
pub fn reference(
    model: &dyn IdentificationModel,
    recording: &Recording,
    companion: &Companion,
) -> Result<Option<String>, Failure> {
    let Some(reference) = &companion.reference else {
        return Ok(None);
    };
    let part = off_reference(model, recording, reference)?;
    Ok(part.map(|part| {
        let (joint, unit, _) = joint(model, &part);
        format!(
            "{}: {joint} leaves its reference at {:.3} s: it is more than a fifth of its range \
             away, up to {:.3} {unit}. The reference is not that of this log, or the robot did not \
             follow it.",
            recording.name, part.second, part.largest
        )
    }))
}

/// A sentence if the log's torque is not what its controller gives along its motion; `rigid` are
/// the parameters of the feedforward.
///
/// # Errors
/// [`Failure::Simulate`] for a controller that cannot be evaluated along the log.
pub fn controller(
    model: &dyn IdentificationModel,
    rigid: &[f64],
    recording: &Recording,
    companion: &Companion,
) -> Result<Option<String>, Failure> {
    let part = off_controller(model, rigid, (recording, companion))?;
    Ok(part.map(|part| {
        let (joint, _, unit) = joint(model, &part);
        format!(
            "{}: the torque of {joint} leaves what the controller gives along this motion at {:.3} \
             s: it is more than a quarter of its range away, up to {:.3} {unit}. The controller or \
             the reference is not that of this log.",
            recording.name, part.second, part.largest
        )
    }))
}

/// Name of the joint that parts, unit of its position and of its torque.
pub fn joint(
    model: &dyn IdentificationModel,
    part: &Parting,
) -> (String, &'static str, &'static str) {
    let Some(joint) = model.joints().get(part.joint) else {
        return (format!("joint {}", part.joint + 1), "", "");
    };
    let (position, torque) = match joint.kind {
        JointKind::Revolute => ("rad", "N m"),
        JointKind::Prismatic => ("m", "N"),
    };
    (
        format!("joint {} (`{}`)", part.joint + 1, joint.name),
        position,
        torque,
    )
}
