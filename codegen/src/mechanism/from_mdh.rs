//! From modified Denavit-Hartenberg rows to axes in space at q = 0.

use super::frames::Axis;
use super::pose::{Pose, about_x, about_z};
use super::{Body, JointKind, Standard};
use crate::describe::{MdhRow, Motion};
use crate::expr::Angle;
use nalgebra::Vector3;

/// The moving axes, with fixed rows merged into what carries them.
pub fn axes(rows: &[MdhRow]) -> Vec<Axis> {
    let mut axes: Vec<Axis> = Vec::new();
    // Pose at q = 0 of every row's frame, and the moving joint that carries it.
    let mut frames: Vec<(Pose, Option<usize>)> = Vec::new();
    for row in rows {
        let (before, carrier) = match row.ant {
            0 => (Pose::identity(), None),
            ant => frames[ant - 1],
        };
        let pose = before.then(&step(row));
        let kind = match row.motion {
            Motion::Revolute => JointKind::Revolute,
            Motion::Prismatic => JointKind::Prismatic,
            Motion::Fixed => {
                frames.push((pose, carrier));
                continue;
            }
        };
        frames.push((pose, Some(axes.len())));
        let body = Body {
            name: row.name.clone(),
            pose,
            inertial: row.inertial.map(Standard::from_values),
        };
        axes.push(Axis {
            name: row.name.clone(),
            kind,
            parent: carrier,
            frame: pose,
            limits: row.limits,
            bodies: vec![body],
        });
    }
    axes
}

/// Rz(gamma) Tz(b) Rx(alpha) Tx(d) Rz(theta) Tz(r) at q = 0.
fn step(row: &MdhRow) -> Pose {
    let turn = |angle: f64| Angle::radians(angle);
    let before = Pose {
        rotation: about_z(turn(row.gamma.value)) * about_x(turn(row.alpha.value)),
        translation: Vector3::new(0.0, 0.0, row.b.value),
    };
    let after = Pose {
        rotation: about_z(turn(row.theta.value)),
        translation: Vector3::new(row.d.value, 0.0, row.r.value),
    };
    before.then(&after)
}
