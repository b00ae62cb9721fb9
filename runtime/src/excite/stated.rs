//! Limits as descriptions and files state them, and what is assumed where they state none.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use serde::Deserialize;

use super::error::ExciteError;
use super::limits::JointLimits;
use crate::model::{Joint, JointKind};

/// Assumed for a revolute joint: half a turn to both sides, half a turn a second.
const REVOLUTE: (f64, f64) = (PI, PI);

/// Assumed speed of a prismatic joint, m/s; its positions cannot be assumed.
const PRISMATIC: f64 = 0.5;

/// Assumed time from rest to full speed, s.
const TO_SPEED: f64 = 0.25;

/// What is stated of one joint's limits, SI.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stated {
    /// Lowest position, rad or m.
    pub lower: Option<f64>,
    /// Highest position.
    pub upper: Option<f64>,
    /// Largest speed.
    pub velocity: Option<f64>,
    /// Largest acceleration.
    pub acceleration: Option<f64>,
    /// Largest torque or force, N m or N.
    pub effort: Option<f64>,
}

/// A file of limits: `[all]` for every joint, `[joint.NAME]` for one.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StatedLimits {
    /// Of every joint that does not state its own.
    #[serde(default)]
    pub all: Stated,
    /// By name of the joint.
    #[serde(default)]
    pub joint: BTreeMap<String, Stated>,
}

impl Stated {
    /// These, and where they state nothing, others.
    #[must_use]
    pub fn or(self, other: Stated) -> Stated {
        Stated {
            lower: self.lower.or(other.lower),
            upper: self.upper.or(other.upper),
            velocity: self.velocity.or(other.velocity),
            acceleration: self.acceleration.or(other.acceleration),
            effort: self.effort.or(other.effort),
        }
    }
}

impl StatedLimits {
    /// Reads a file of limits.
    ///
    /// # Errors
    /// Line, column and mistake of malformed TOML, an unknown key, a wrong type, or a joint that the
    /// robot has not.
    pub fn parse(text: &str, joints: &[Joint]) -> Result<StatedLimits, String> {
        let limits: StatedLimits = toml::from_str(text).map_err(|error| error.to_string())?;
        let known = |name: &str| joints.iter().any(|joint| joint.name == name);
        match limits.joint.keys().find(|name| !known(name)) {
            None => Ok(limits),
            Some(name) => {
                let names: Vec<&str> = joints.iter().map(|joint| joint.name.as_ref()).collect();
                Err(format!(
                    "there is no joint `{name}`; the robot has {}",
                    names.join(", ")
                ))
            }
        }
    }

    /// What the file states of a joint.
    pub fn of(&self, joint: &str) -> Stated {
        let own = self.joint.get(joint).copied().unwrap_or_default();
        own.or(self.all)
    }
}

/// Limits of all joints from what is stated, and a sentence for each that had to be assumed.
///
/// # Errors
/// [`ExciteError::Missing`]: a prismatic joint without limits of position.
pub fn settle(
    joints: &[Joint],
    stated: &[Stated],
) -> Result<(Vec<JointLimits>, Vec<String>), ExciteError> {
    let mut assumed = Vec::new();
    let pairs = joints.iter().zip(stated);
    let limits = pairs.map(|(joint, stated)| one(joint, stated, &mut assumed));
    let limits = limits.collect::<Result<Vec<_>, _>>()?;
    Ok((limits, assumed))
}

fn one(
    joint: &Joint,
    stated: &Stated,
    assumed: &mut Vec<String>,
) -> Result<JointLimits, ExciteError> {
    let turns = joint.kind == JointKind::Revolute;
    let (angle, length) = if turns {
        ("rad", REVOLUTE.0)
    } else {
        ("m", 0.0)
    };
    let mut said = Vec::new();
    let mut assume = |what: &'static str, value: Option<f64>, default: f64, unit: String| {
        value.unwrap_or_else(|| {
            said.push(format!("{what} {default:.4} {unit}"));
            default
        })
    };
    if !turns && (stated.lower.is_none() || stated.upper.is_none()) {
        return Err(ExciteError::Missing {
            what: "position",
            joint: joint.name.to_string(),
        });
    }
    let lower = assume("lower", stated.lower, -length, angle.into());
    let upper = assume("upper", stated.upper, length, angle.into());
    let speed = if turns { REVOLUTE.1 } else { PRISMATIC };
    let velocity = assume("velocity", stated.velocity, speed, format!("{angle}/s"));
    let default = velocity / TO_SPEED;
    let unit = format!("{angle}/s^2");
    let acceleration = assume("acceleration", stated.acceleration, default, unit);
    if !said.is_empty() {
        assumed.push(format!(
            "Joint `{}` does not state all its limits; assumed are {}.",
            joint.name,
            said.join(", ")
        ));
    }
    Ok(JointLimits {
        lower,
        upper,
        velocity,
        acceleration,
        effort: stated.effort.unwrap_or(f64::INFINITY),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joints() -> [Joint; 2] {
        let joint = |(name, kind): (&'static str, JointKind)| Joint {
            name: name.into(),
            kind,
        };
        [
            ("turn", JointKind::Revolute),
            ("slide", JointKind::Prismatic),
        ]
        .map(joint)
    }

    #[test]
    fn own_limits_come_before_those_of_all_and_the_rest_is_assumed() {
        let text = "[all]\nvelocity = 2\n[joint.turn]\nvelocity = 1\n[joint.slide]\nlower = 0\nupper = 0.3";
        let file = StatedLimits::parse(text, &joints()).unwrap();
        let stated = joints().map(|joint| file.of(&joint.name));
        let (limits, assumed) = settle(&joints(), &stated).unwrap();
        assert_eq!((limits[0].velocity, limits[1].velocity), (1.0, 2.0));
        assert_eq!((limits[0].lower, limits[0].acceleration), (-PI, 4.0));
        assert_eq!(limits[1].effort, f64::INFINITY);
        assert!(assumed[0].contains("`turn`") && assumed[0].contains("lower -3.1416 rad"));
        assert!(
            assumed[1].contains("acceleration 8.0000 m/s^2"),
            "{assumed:?}"
        );
    }

    #[test]
    fn prismatic_joint_without_positions_is_named() {
        let error = settle(&joints(), &[Stated::default(); 2]).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("joint `slide` has no position limit")
        );
    }

    #[test]
    fn mistakes_in_a_file_are_told() {
        for (text, message) in [
            ("[joint.turn]\nspeed = 1", "unknown field `speed`"),
            (
                "[joint.other]\nlower = 1",
                "no joint `other`; the robot has turn, slide",
            ),
            ("[all]\nlower = 'a'", "line 2"),
        ] {
            let found = StatedLimits::parse(text, &joints()).unwrap_err();
            assert!(found.contains(message), "{found}");
        }
    }
}
