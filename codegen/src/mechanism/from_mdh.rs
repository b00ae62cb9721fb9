//! From modified Denavit-Hartenberg rows to axes in space at q = 0.

use super::frames::Axis;
use super::pose::{Pose, about_x, about_z};
use super::ring::{Closure, End};
use super::{Body, JointKind, Standard};
use crate::describe::{LoopSpec, MdhRow, Motion};
use crate::expr::Angle;
use nalgebra::Vector3;

/// The moving axes, with fixed rows merged into what carries them, and the loops that they close.
pub fn axes(rows: &[MdhRow], loops: &[LoopSpec]) -> (Vec<Axis>, Vec<Closure>) {
    let mut axes: Vec<Axis> = Vec::new();
    // Pose at q = 0 of every row's frame, and the moving joint that carries it.
    let mut frames: Vec<(Pose, Option<usize>)> = Vec::new();
    for row in rows {
        let (pose, carrier) = stand(&frames, row);
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
            drive: row.drive.clone(),
            limits: row.limits,
            bodies: vec![body],
        });
    }
    (axes, closures(frames, loops))
}

/// Pose of a row's frame at q = 0, and the moving joint that carries it if it is fixed.
fn stand(frames: &[(Pose, Option<usize>)], row: &MdhRow) -> (Pose, Option<usize>) {
    let before = row.ant.checked_sub(1).and_then(|ant| frames.get(ant));
    let (before, carrier) = before.copied().unwrap_or((Pose::identity(), None));
    (before.then(&step(row)), carrier)
}

/// The loops; their frames count on behind the rows, all cut ones before all others.
fn closures(mut frames: Vec<(Pose, Option<usize>)>, loops: &[LoopSpec]) -> Vec<Closure> {
    let sides = loops.iter().map(|one| &one.cut);
    let sides = sides.chain(loops.iter().map(|one| &one.meets));
    let rows = frames.len();
    for side in sides {
        let frame = stand(&frames, side);
        frames.push(frame);
    }
    let end = |place: usize| {
        let (pose, carrier) = frames[place];
        End { pose, carrier }
    };
    let pairs = loops.iter().enumerate();
    pairs
        .map(|(index, one)| Closure {
            name: one.name.clone(),
            motion: one.cut.motion,
            ends: [end(rows + index), end(rows + loops.len() + index)],
            flipped: one.flipped,
        })
        .collect()
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
