//! What a motion must keep to.

use serde::Serialize;

use super::error::ExciteError;
use crate::model::{IdentificationModel, Joint};

/// Limits of one joint, SI. All must be finite but the effort.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct JointLimits {
    /// Lowest position, rad or m.
    pub lower: f64,
    /// Highest position.
    pub upper: f64,
    /// Largest speed, rad/s or m/s.
    pub velocity: f64,
    /// Largest acceleration, rad/s^2 or m/s^2.
    pub acceleration: f64,
    /// Largest torque or force, N m or N; infinite without one.
    #[serde(serialize_with = "finite")]
    pub effort: f64,
}

/// JSON has no infinity: `null`.
fn finite<S: serde::Serializer>(value: &f64, to: S) -> Result<S::Ok, S::Error> {
    value.is_finite().then_some(*value).serialize(to)
}

impl JointLimits {
    /// Middle of the positions.
    pub(super) fn middle(&self) -> f64 {
        0.5 * (self.lower + self.upper)
    }

    fn check(&self, joint: &Joint) -> Result<(), ExciteError> {
        let name = || joint.name.to_string();
        let range = self.upper - self.lower;
        // Written so that NaN fails too.
        if !(range > 0.0 && range.is_finite()) {
            return Err(ExciteError::Range {
                joint: name(),
                lower: self.lower,
                upper: self.upper,
            });
        }
        let finite = [
            ("velocity", self.velocity),
            ("acceleration", self.acceleration),
        ];
        for (what, value) in finite {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ExciteError::NotPositive {
                    what,
                    joint: name(),
                    value,
                });
            }
        }
        if self.effort > 0.0 {
            return Ok(());
        }
        Err(ExciteError::NotPositive {
            what: "effort",
            joint: name(),
            value: self.effort,
        })
    }
}

/// Whether there are limits for every joint that some motion keeps to.
///
/// # Errors
/// [`ExciteError::Joints`], [`ExciteError::Range`], [`ExciteError::NotPositive`].
pub(super) fn check(
    model: &dyn IdentificationModel,
    limits: &[JointLimits],
) -> Result<(), ExciteError> {
    let joints = model.joints();
    for_all_joints(model, "the list of limits", limits.len())?;
    let mut pairs = limits.iter().zip(joints);
    pairs.try_for_each(|(limits, joint)| limits.check(joint))
}

/// # Errors
/// [`ExciteError::Joints`].
pub(super) fn for_all_joints(
    model: &dyn IdentificationModel,
    what: &'static str,
    has: usize,
) -> Result<(), ExciteError> {
    let needs = model.joints().len();
    match has == needs {
        true => Ok(()),
        false => Err(ExciteError::Joints {
            what,
            has,
            robot: model.name().to_owned(),
            needs,
        }),
    }
}
