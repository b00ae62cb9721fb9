//! Rigid displacements at q = 0.

use nalgebra::{Matrix3, Vector3};

use crate::describe;
use crate::expr::Angle;

/// A rotation and a translation: x -> R x + p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Rotation.
    pub rotation: Matrix3<f64>,
    /// Translation, m.
    pub translation: Vector3<f64>,
}

impl Pose {
    /// The identity.
    pub fn identity() -> Pose {
        Pose {
            rotation: Matrix3::identity(),
            translation: Vector3::zeros(),
        }
    }

    /// `self` followed by `next`, given in the frame that `self` leads to.
    pub fn then(&self, next: &Pose) -> Pose {
        Pose {
            rotation: self.rotation * next.rotation,
            translation: self.translation + self.rotation * next.translation,
        }
    }

    /// The displacement back.
    pub fn inverse(&self) -> Pose {
        let rotation = self.rotation.transpose();
        Pose {
            rotation,
            translation: -(rotation * self.translation),
        }
    }

    /// A URDF pose: roll, pitch, yaw about fixed axes, right angles exact.
    pub fn from_rpy(pose: &describe::Pose) -> Pose {
        let [roll, pitch, yaw] = pose.rpy.map(Angle::radians);
        Pose {
            rotation: about_z(yaw) * about_y(pitch) * about_x(roll),
            translation: Vector3::from(pose.xyz),
        }
    }
}

/// Rotation about x.
pub fn about_x(angle: Angle) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c)
}

/// Rotation about y.
pub fn about_y(angle: Angle) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    Matrix3::new(c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c)
}

/// Rotation about z.
pub fn about_z(angle: Angle) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)
}
