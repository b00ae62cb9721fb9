//! Values of the standard and base parameters.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Vector3};

use super::inertial;
use crate::base::BaseParameter;
use crate::mechanism::inertia::NAMES;
use crate::mechanism::{Pose, Standard};
use crate::robot::Robot;

/// A body whose inertial values are described, as part of a link.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    /// Link, counted from 0.
    pub link: usize,
    /// From the body's own frame to the link frame.
    pub pose: Pose,
    /// The ten parameters in the link frame.
    pub inertial: Standard,
}

/// Values of standard parameters, and the bodies they come from.
#[derive(Clone, Debug)]
pub struct Values {
    /// By name, SI.
    standard: BTreeMap<String, f64>,
    /// What `[parameters]` states, by name.
    stated: BTreeMap<String, f64>,
    /// Described bodies with a mass.
    pub bodies: Vec<Known>,
}

impl Values {
    /// Inertial values of the description's bodies, and what `[parameters]` states.
    pub fn of(robot: &Robot) -> Values {
        let stated: BTreeMap<String, f64> = robot.description.parameters.iter().cloned().collect();
        let bodies: Vec<Known> = (0..robot.mechanism.joints.len())
            .flat_map(|link| bodies(robot, link, &stated))
            .collect();
        let mut standard = BTreeMap::new();
        for link in 0..robot.mechanism.joints.len() {
            let own = bodies.iter().filter(|body| body.link == link);
            let Some(sum) = own.map(|body| body.inertial).reduce(|a, b| a.plus(&b)) else {
                continue;
            };
            for (name, value) in NAMES.iter().zip(sum.values()) {
                standard.insert(format!("{name}{}", link + 1), value);
            }
        }
        standard.extend(stated.iter().map(|(name, value)| (name.clone(), *value)));
        Values {
            standard,
            stated,
            bodies,
        }
    }

    /// Value of a standard parameter.
    pub fn standard(&self, name: &str) -> Option<f64> {
        self.standard.get(name).copied()
    }

    /// Whether the inertial values of a link are described.
    pub fn describes(&self, link: usize) -> bool {
        self.bodies.iter().any(|body| body.link == link)
    }

    /// Value of each base parameter.
    pub fn nominal(&self, robot: &Robot) -> Vec<Option<f64>> {
        let value = |parameter: &BaseParameter| {
            let own = self.stated.get(&parameter.name).copied();
            own.or_else(|| self.sum(parameter))
        };
        robot.base.parameters.iter().map(value).collect()
    }

    /// A base parameter from the standard ones.
    fn sum(&self, parameter: &BaseParameter) -> Option<f64> {
        let terms = parameter.relation.iter();
        let terms = terms.map(|(factor, name)| Some(factor * self.standard(name)?));
        terms.sum()
    }

    /// The rigid-body share of each base parameter; empty if no link is described.
    pub fn rigid(&self, robot: &Robot) -> Vec<f64> {
        if self.bodies.is_empty() {
            return Vec::new();
        }
        let share = |parameter: &BaseParameter| {
            let rigid = parameter.relation.iter();
            let rigid = rigid.filter(|(_, name)| inertial(name).is_some());
            // Summed in the order of the relation, from a positive zero.
            rigid.fold(0.0, |sum, (factor, name)| {
                sum + factor * self.standard(name).unwrap_or(0.0)
            })
        };
        robot.base.parameters.iter().map(share).collect()
    }
}

/// The bodies of a link that have a mass. Zero masses are places where nothing was filled in, or
/// frames without a body. Without any, a link whose ten parameters are all stated is one body.
fn bodies(robot: &Robot, link: usize, stated: &BTreeMap<String, f64>) -> Vec<Known> {
    let joint = &robot.mechanism.joints[link];
    let described = joint.bodies.iter().filter_map(|body| {
        Some(Known {
            link,
            pose: body.pose,
            inertial: body.inertial.filter(|inertial| inertial.mass != 0.0)?,
        })
    });
    let described: Vec<Known> = described.collect();
    if !described.is_empty() {
        return described;
    }
    let value = |name: &&str| stated.get(&format!("{name}{}", link + 1)).copied();
    let all: Option<Vec<f64>> = NAMES.iter().map(value).collect();
    let body = all.and_then(|all| {
        let [xx, xy, xz, yy, yz, zz, mx, my, mz, mass] = all[..] else {
            return None;
        };
        let inertial = Standard {
            inertia: Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
            moment: Vector3::new(mx, my, mz),
            mass,
        };
        (mass != 0.0).then_some(Known {
            link,
            pose: Pose::identity(),
            inertial,
        })
    });
    body.into_iter().collect()
}
