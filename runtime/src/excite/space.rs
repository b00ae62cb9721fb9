//! The motions that are searched: one vector of numbers for all joints.

use super::family::{Basis, Sampled};
use super::limits::JointLimits;
use crate::model::States;

/// Motions of one family within limits, as vectors z: for each joint its centre, unless that is
/// given, and its free coefficients, both in units of about the limits.
pub(super) struct Space<'a> {
    pub basis: Basis,
    pub limits: &'a [JointLimits],
    /// Given centres, rad or m.
    center: Option<&'a [f64]>,
    /// Size of a coefficient of 1 of each joint, rad or m.
    unit: Vec<f64>,
}

/// A motion of all joints at instants, structure of arrays.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Path {
    pub len: usize,
    pub q: Vec<f64>,
    pub qd: Vec<f64>,
    pub qdd: Vec<f64>,
}

impl Path {
    /// Positions, velocities or accelerations.
    pub fn derivative(&mut self, order: usize) -> &mut [f64] {
        match order {
            0 => &mut self.q,
            1 => &mut self.qd,
            _ => &mut self.qdd,
        }
    }

    pub fn states(&self) -> States<'_> {
        States {
            len: self.len,
            q: &self.q,
            qd: &self.qd,
            qdd: &self.qdd,
            slip: &[],
        }
    }
}

/// Instants at which the size of the functions of a family is taken.
const INSTANTS: usize = 200;

impl<'a> Space<'a> {
    pub fn new(basis: Basis, limits: &'a [JointLimits], center: Option<&'a [f64]>) -> Space<'a> {
        let sampled = basis.sample(INSTANTS, false);
        let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let [q, qd, qdd] = [&sampled.q, &sampled.qd, &sampled.qdd].map(|values| largest(values));
        let unit = |limits: &JointLimits| {
            let half = 0.5 * (limits.upper - limits.lower);
            (half / q)
                .min(limits.velocity / qd)
                .min(limits.acceleration / qdd)
        };
        Space {
            unit: limits.iter().map(unit).collect(),
            basis,
            limits,
            center,
        }
    }

    /// Numbers of a joint.
    pub fn width(&self) -> usize {
        self.basis.len() + self.places_of_center()
    }

    /// Numbers of a motion.
    pub fn len(&self) -> usize {
        self.width() * self.limits.len()
    }

    /// 1 if the centre is searched, 0 if it is given.
    fn places_of_center(&self) -> usize {
        usize::from(self.center.is_none())
    }

    /// Half the range of a joint.
    fn half(&self, joint: usize) -> f64 {
        0.5 * (self.limits[joint].upper - self.limits[joint].lower)
    }

    /// Centre of a joint, rad or m.
    pub fn center(&self, z: &[f64], joint: usize) -> f64 {
        match self.center {
            Some(center) => center[joint],
            None => self.limits[joint].middle() + self.half(joint) * z[joint * self.width()],
        }
    }

    /// Free coefficients of a joint, rad or m.
    pub fn free(&self, z: &[f64], joint: usize) -> Vec<f64> {
        let from = joint * self.width() + self.places_of_center();
        let own = &z[from..from + self.basis.len()];
        own.iter().map(|value| self.unit[joint] * value).collect()
    }

    /// The same motion with the deviation of a joint from its centre times a factor.
    pub fn scale(&self, z: &mut [f64], joint: usize, factor: f64) {
        let from = joint * self.width() + self.places_of_center();
        let own = &mut z[from..from + self.basis.len()];
        own.iter_mut().for_each(|value| *value *= factor);
    }

    /// The same motion with a centre that is at most `share` of half the range from the middle.
    pub fn hold_center(&self, z: &mut [f64], joint: usize, share: f64) {
        if self.center.is_none() {
            let place = joint * self.width();
            z[place] = z[place].clamp(-share, share);
        }
    }

    /// The motion at instants.
    pub fn path(&self, z: &[f64], sampled: &Sampled) -> Path {
        let (n, len) = (self.limits.len(), sampled.len);
        let mut path = Path {
            len,
            q: vec![0.0; n * len],
            qd: vec![0.0; n * len],
            qdd: vec![0.0; n * len],
        };
        for joint in 0..n {
            let own = joint * len..(joint + 1) * len;
            path.q[own.clone()].fill(self.center(z, joint));
            for (k, factor) in self.free(z, joint).into_iter().enumerate() {
                let parts = [
                    (&mut path.q, &sampled.q),
                    (&mut path.qd, &sampled.qd),
                    (&mut path.qdd, &sampled.qdd),
                ];
                for (to, from) in parts {
                    let from = &from[k * len..(k + 1) * len];
                    let pairs = to[own.clone()].iter_mut().zip(from);
                    pairs.for_each(|(to, from)| *to += factor * from);
                }
            }
        }
        path
    }

    /// From the slopes of a number with respect to a path to those with respect to z.
    pub fn slopes(&self, slope: &Path, sampled: &Sampled) -> Vec<f64> {
        let len = sampled.len;
        let mut slopes = Vec::with_capacity(self.len());
        for joint in 0..self.limits.len() {
            let own = joint * len..(joint + 1) * len;
            if self.center.is_none() {
                slopes.push(self.half(joint) * slope.q[own.clone()].iter().sum::<f64>());
            }
            for k in 0..self.basis.len() {
                let function = k * len..(k + 1) * len;
                let dot = |a: &[f64], b: &[f64]| -> f64 {
                    let pairs = a[own.clone()].iter().zip(&b[function.clone()]);
                    pairs.map(|(a, b)| a * b).sum()
                };
                let sum = dot(&slope.q, &sampled.q)
                    + dot(&slope.qd, &sampled.qd)
                    + dot(&slope.qdd, &sampled.qdd);
                slopes.push(self.unit[joint] * sum);
            }
        }
        slopes
    }
}
