//! Axes as lines in space, and the turns about z that bring one onto another.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::super::pose::Pose;
use super::SAME;

/// A line, or of a prismatic joint only its direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    point: Vector3<f64>,
    direction: Vector3<f64>,
    /// Whether it matters where it is.
    placed: bool,
}

impl Line {
    /// The z axis of a frame.
    pub fn of(frame: &Pose, placed: bool) -> Line {
        Line {
            point: frame.translation,
            direction: frame.rotation.column(2).into(),
            placed,
        }
    }

    /// Whether turns about z leave it where it is.
    pub fn is_fixed(&self) -> bool {
        across(&self.direction).is_none() && !(self.placed && across(&self.foot()).is_some())
    }

    /// Its point next to the z axis; any one where it is parallel.
    fn foot(&self) -> Vector3<f64> {
        let (p, d) = (&self.point, &self.direction);
        match across(d) {
            Some(_) => p - d * ((p.x * d.x + p.y * d.y) / (d.x * d.x + d.y * d.y)),
            None => *p,
        }
    }

    /// Turns about z that may bring this line onto another, whose direction may be opposite, rad in
    /// (-pi, pi].
    pub fn turns_onto(&self, other: &Line) -> Vec<f64> {
        let mut turns = Vec::new();
        if let (Some(from), Some(to)) = (across(&self.direction), across(&other.direction)) {
            turns.extend([to - from, to - from + PI]);
        }
        let feet = (across(&self.foot()), across(&other.foot()));
        if let (true, (Some(from), Some(to))) = (self.placed, feet) {
            turns.push(to - from);
        }
        turns.into_iter().map(wrapped).collect()
    }
}

/// Direction of a vector in the plane square to z, rad, if it has one there.
fn across(vector: &Vector3<f64>) -> Option<f64> {
    (vector.x.hypot(vector.y) > SAME).then(|| vector.y.atan2(vector.x))
}

/// In (-pi, pi].
fn wrapped(angle: f64) -> f64 {
    let turn = angle.rem_euclid(TAU);
    if turn > PI { turn - TAU } else { turn }
}
