//! The robot of the URDF, seen in the link frames that were identified.

use idim_codegen::Robot;
use idim_codegen::builder;
use idim_codegen::mechanism::alignment::{Alignment, align};
use idim_codegen::mechanism::{Mechanism, Standard};
use nalgebra::Vector3;

use super::ExportError;

/// Frames that stay nearer together at random poses, m and rad, are not worth a word.
const EXACT: f64 = 1e-9;

/// Gravity that falls along another direction is worth one, rad.
const UPRIGHT: f64 = 1e-6;

/// What carries the bodies into the URDF.
pub(super) struct Carrier {
    /// The bodies of the URDF in the identified link frames; without a URDF, those identified.
    pub mechanism: Mechanism,
    /// Where the URDF puts its own frames.
    pub frames: Option<Alignment>,
    /// Where gravity falls in the frame of the URDF's base, as a unit vector.
    down: Option<Vector3<f64>>,
}

impl Carrier {
    /// Finds the URDF's frames in those identified.
    ///
    /// # Errors
    /// [`ExportError::Description`], [`ExportError::Other`], [`ExportError::Follows`].
    pub fn of(robot: &Robot, urdf: Option<&str>) -> Result<Carrier, ExportError> {
        let own = &robot.mechanism;
        let Some(text) = urdf else {
            return fresh(own);
        };
        let other = builder::read_texts(&[("robot.urdf", text)])?.mechanism;
        let frames = align(own, &other)?;
        let gravity = Vector3::from(robot.description.gravity);
        Ok(Carrier {
            mechanism: frames.carried(own, &other),
            down: (frames.base.rotation.transpose() * gravity).try_normalize(0.0),
            frames: Some(frames),
        })
    }

    /// Links in the URDF's own frames.
    pub fn own(&self, links: &[Standard]) -> Vec<Standard> {
        let Some(frames) = &self.frames else {
            return links.to_vec();
        };
        let pairs = links.iter().zip(&frames.links);
        pairs
            .map(|(link, frame)| link.moved(&frame.pose.inverse()))
            .collect()
    }

    /// What is to be known of frames and gravity.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let inexact = self.frames.as_ref().filter(|frames| frames.apart > EXACT);
        if let Some(frames) = inexact {
            warnings.push(format!(
                "The link frames of the URDF and those identified agree to {:.1e} m and rad only.",
                frames.apart
            ));
        }
        let tilted = |down: &Vector3<f64>| down.x.hypot(down.y) > UPRIGHT || down.z > 0.0;
        if let Some(down) = self.down.filter(tilted) {
            warnings.push(format!(
                "Where the robot was identified, gravity falls along ({:.4}, {:.4}, {:.4}) of the \
                 URDF's base, not along -z: mount it so.",
                down.x, down.y, down.z
            ));
        }
        warnings
    }
}

/// A new URDF of the identified frames.
fn fresh(own: &Mechanism) -> Result<Carrier, ExportError> {
    let following = &own.joints[own.driven..];
    if !following.is_empty() {
        let names = following.iter().map(|joint| format!("`{}`", joint.name));
        return Err(ExportError::Follows(names.collect()));
    }
    Ok(Carrier {
        mechanism: own.clone(),
        frames: None,
        down: None,
    })
}
