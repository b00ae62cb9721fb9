//! Limits from the description, a file and the command line.

use std::path::PathBuf;

use idim::codegen::Robot;
use idim::runtime::excite::{JointLimits, Stated, StatedLimits, settle};
use idim::runtime::model::IdentificationModel;

use super::Failure;

/// Limits beside those of the description.
#[derive(Debug, clap::Args)]
pub(super) struct Given {
    /// TOML with limits that come before those of the description: lower, upper, velocity,
    /// acceleration, effort in [all] or [joint.NAME].
    #[arg(long, value_name = "FILE")]
    limits: Option<PathBuf>,
    /// Largest speeds, rad/s or m/s: one for all joints, or one for each, separated by commas.
    #[arg(long, value_name = "V,..", value_delimiter = ',')]
    max_velocity: Vec<f64>,
    /// Largest accelerations, rad/s^2 or m/s^2; default: full speed in a quarter of a second.
    #[arg(long, value_name = "A,..", value_delimiter = ',')]
    max_acceleration: Vec<f64>,
    /// Share of the limits of velocity, acceleration and effort that may be used, %.
    #[arg(long, value_name = "PCT", default_value_t = 100.0)]
    use_pct: f64,
    /// Centres of the motion, rad or m, one for each joint; default: searched.
    #[arg(
        long,
        value_name = "Q,..",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    center: Vec<f64>,
}

impl Given {
    /// The limits of every joint, and a sentence for each that was assumed.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a list of the wrong length, [`Failure::Parameters`] for a file that
    /// cannot be used, [`Failure::Excite`] for a limit that is missing.
    pub fn settle(
        &self,
        model: &dyn IdentificationModel,
        robot: &Robot,
    ) -> Result<(Vec<JointLimits>, Vec<String>), Failure> {
        let velocity = each(model, "--max-velocity", &self.max_velocity)?;
        let acceleration = each(model, "--max-acceleration", &self.max_acceleration)?;
        let file = self.file(model)?;
        let joints = model.joints().iter().zip(&robot.mechanism.joints);
        let stated = joints.enumerate().map(|(place, (joint, described))| {
            let option = Stated {
                velocity: velocity.get(place).copied(),
                acceleration: acceleration.get(place).copied(),
                ..Stated::default()
            };
            let described = Stated {
                lower: described.limits.lower,
                upper: described.limits.upper,
                velocity: described.limits.velocity,
                effort: described.limits.effort,
                acceleration: None,
            };
            option.or(file.of(&joint.name)).or(described)
        });
        let stated: Vec<Stated> = stated.collect();
        let (mut limits, assumed) = settle(model.joints(), &stated)?;
        let share = self.use_pct / 100.0;
        if !(share > 0.0 && share <= 1.0) {
            return Err(Failure::Usage {
                message: format!("{} % of the limits cannot be used", self.use_pct),
                help: "give --use-pct a number above 0 and at most 100".into(),
            });
        }
        for limits in &mut limits {
            limits.velocity *= share;
            limits.acceleration *= share;
            limits.effort *= share;
        }
        Ok((limits, assumed))
    }

    /// The given centre.
    ///
    /// # Errors
    /// [`Failure::Usage`] for a list of the wrong length.
    pub fn center(&self, model: &dyn IdentificationModel) -> Result<Option<Vec<f64>>, Failure> {
        let center = each(model, "--center", &self.center)?;
        Ok(Some(center).filter(|center| !center.is_empty()))
    }

    fn file(&self, model: &dyn IdentificationModel) -> Result<StatedLimits, Failure> {
        let Some(path) = &self.limits else {
            return Ok(StatedLimits::default());
        };
        let wrong = |message: String| Failure::Parameters {
            path: path.clone(),
            message,
        };
        let text = std::fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
        StatedLimits::parse(&text, model.joints()).map_err(wrong)
    }
}

/// One value for each joint, from one for all or one for each; nothing from nothing.
///
/// # Errors
/// [`Failure::Usage`].
pub(super) fn each(
    model: &dyn IdentificationModel,
    option: &str,
    values: &[f64],
) -> Result<Vec<f64>, Failure> {
    let joints = model.joints().len();
    match values {
        [one] => Ok(vec![*one; joints]),
        [] => Ok(Vec::new()),
        all if all.len() == joints => Ok(all.to_vec()),
        other => Err(Failure::Usage {
            message: format!(
                "{option} has {} numbers, the robot {joints} joints",
                other.len()
            ),
            help: "give one number for all joints, or one for each, separated by commas".into(),
        }),
    }
}
