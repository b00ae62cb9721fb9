//! The robot under other gravity and with other lengths: torques of its rigid bodies in variants
//! of its mechanism, in standard parameters, which do not change with either.

use idim_codegen::Robot;
use idim_codegen::base::BaseParameter;
use idim_codegen::derive::{self, ParameterKind};
use idim_codegen::describe::{self, Description, Geometry};
use idim_codegen::expr::Graph;
use idim_codegen::mechanism::inertia::NAMES;
use idim_codegen::mechanism::pose::{about_x, about_z};
use idim_codegen::mechanism::{JointKind, Mechanism, Standard};
use nalgebra::{Matrix3, Rotation3, Vector3};

use super::evaluate::{Linear, Motion};

/// Lengths below this (m) are none.
const SHORTEST: f64 = 1e-6;

/// Step of a length in central differences, m.
const STEP: f64 = 1e-4;

/// Ten standard parameters per link, link by link.
pub(super) type StandardValues = Vec<[f64; 10]>;

/// The rigid bodies of a mechanism; parameter 10 k + p is the p-th of link k, wanted or left out.
pub(super) fn rigid(mechanism: &Mechanism, wanted: impl Fn(usize, usize) -> bool) -> Linear {
    let mut graph = Graph::new();
    let model = derive::standard(&mut graph, mechanism);
    let columns = model.parameters.iter().filter_map(|parameter| {
        let ParameterKind::Inertial(place) = parameter.kind else {
            return None;
        };
        let number = 10 * parameter.link + place;
        wanted(parameter.link, place).then_some((number, parameter.columns.explicit.as_slice()))
    });
    Linear::new(&graph, mechanism.driven, columns)
}

/// The rigid bodies under a gravity of 1 m/s^2 along each axis of frame 0.
pub(super) fn unit_gravity(description: &Description) -> [Linear; 3] {
    [0, 1, 2].map(|axis| {
        let mut gravity = [0.0; 3];
        gravity[axis] = 1.0;
        let turned = Description {
            gravity,
            ..description.clone()
        };
        // At rest only first moments and masses weigh anything.
        rigid(&Mechanism::new(&turned), |_, place| place >= 6)
    })
}

/// The same along the axes of the frame that the first joint of the last link's chain stands in.
pub(super) fn unit_gravity_of_root(mechanism: &Mechanism) -> [Linear; 3] {
    [0, 1, 2].map(|axis| {
        let mut gravity = [0.0; 3];
        gravity[axis] = 1.0;
        let mut turned = mechanism.clone();
        let first = turned.joints.iter_mut().filter(|j| j.parent.is_none());
        first.for_each(|joint| joint.gravity = Some(gravity));
        rigid(&turned, |_, place| place >= 6)
    })
}

/// Axes of the flange, the last body of the last link, in the frame that the first joint of its
/// chain stands in, at positions q of the joints with a drive.
pub(super) fn flange_axes(mechanism: &Mechanism, q: &[f64]) -> Matrix3<f64> {
    let Some(last) = mechanism.tool() else {
        return Matrix3::identity();
    };
    let q = mechanism.positions(q);
    let body = mechanism.joints[last].bodies.last();
    let mut axes = body.map_or(Matrix3::identity(), |body| body.pose.rotation);
    let mut link = Some(last);
    while let Some(number) = link {
        let joint = &mechanism.joints[number];
        let turned = match joint.kind {
            JointKind::Revolute => {
                Rotation3::from_axis_angle(&Vector3::z_axis(), q[number]).into_inner()
            }
            JointKind::Prismatic => Matrix3::identity(),
        };
        let from = about_z(joint.gamma) * about_x(joint.alpha) * about_z(joint.theta);
        axes = from * turned * axes;
        link = joint.parent;
    }
    axes
}

/// The standard parameters that stand behind base parameters: those of the description where it
/// has any, the difference put into the parameter that each base parameter is named after. Any
/// other choice moves torques under changed lengths only within the span of the regressor.
pub(super) fn standard_values(robot: &Robot, x: &[f64]) -> StandardValues {
    let mut values = described(robot);
    let inertial = robot.base.parameters.iter().zip(x);
    let inertial = inertial.filter(|(p, _)| matches!(p.kind, ParameterKind::Inertial(_)));
    let moved: Vec<(usize, usize, f64)> = inertial
        .filter_map(|(parameter, &x)| correction(robot, parameter, x, &values))
        .collect();
    for (link, place, by) in moved {
        values[link][place] += by;
    }
    values
}

fn correction(
    robot: &Robot,
    parameter: &BaseParameter,
    x: f64,
    values: &StandardValues,
) -> Option<(usize, usize, f64)> {
    let terms = parameter.relation.iter().filter_map(|(factor, name)| {
        let (link, place) = inertial(name)?;
        Some((*factor, link, place))
    });
    // Rotors that are regrouped with a link are none of it, as far as they are described.
    let described = |name: &str| {
        let mut named = robot.description.parameters.iter();
        named.find_map(|(known, value)| (known == name).then_some(*value))
    };
    let others = parameter.relation.iter();
    let others = others.filter(|(_, name)| inertial(name).is_none());
    let beside_bodies: f64 = others
        .map(|(factor, name)| factor * described(name).unwrap_or(0.0))
        .sum();
    let present: f64 = terms
        .clone()
        .map(|(factor, link, place)| factor * values.get(link).map_or(0.0, |ten| ten[place]))
        .sum::<f64>()
        + beside_bodies;
    let (factor, link, place) = terms.clone().next()?;
    (link < values.len()).then_some((link, place, (x - present) / factor))
}

/// What the description says of the links' inertias; zero where it is silent.
pub(super) fn described(robot: &Robot) -> StandardValues {
    let link = |joint: &idim_codegen::mechanism::Joint| {
        let bodies = joint.bodies.iter().filter_map(|body| body.inertial);
        bodies
            .reduce(|a, b| a.plus(&b))
            .map_or([0.0; 10], |sum| sum.values())
    };
    let mut values: StandardValues = robot.mechanism.joints.iter().map(link).collect();
    for (name, value) in &robot.description.parameters {
        if let Some((link, place)) = inertial(name)
            && let Some(ten) = values.get_mut(link)
        {
            ten[place] = *value;
        }
    }
    values
}

/// Link and place of a standard inertial parameter such as `XX3`.
pub(super) fn inertial(name: &str) -> Option<(usize, usize)> {
    let symbol = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let place = NAMES.iter().position(|known| *known == symbol)?;
    let number: usize = name[symbol.len()..].parse().ok()?;
    Some((number.checked_sub(1)?, place))
}

/// A robot one step longer and one step shorter between a joint and its antecedent.
#[derive(Clone, Debug)]
pub(super) struct Length {
    /// Longer and shorter; with each the map of the ten standard parameters of every link from
    /// the frames of the robot to those of the variant, row by row.
    variants: [(Linear, Vec<[[f64; 10]; 10]>); 2],
}

impl Length {
    /// The variants at a joint; `None` if there is no length to change.
    pub fn of(robot: &Robot, joint: usize) -> Option<Length> {
        let carried = &robot.mechanism.joints[joint];
        carried.parent?;
        // One link of a loop alone cannot be longer: the loop would close elsewhere.
        if !robot.description.loops.is_empty() {
            return None;
        }
        let longer = changed(&robot.description, &carried.name, STEP)?;
        let shorter = changed(&robot.description, &carried.name, -STEP)?;
        let variants = [longer, shorter].map(|description| {
            let mechanism = Mechanism::new(&description);
            let maps = (0..mechanism.joints.len())
                .map(|link| frame_change(&robot.mechanism, &mechanism, link))
                .collect();
            (rigid(&mechanism, |_, _| true), maps)
        });
        Some(Length { variants }).filter(|length| length.matters(&robot.mechanism))
    }

    /// Whether any torque depends on the length: along the axis of its antecedent it does not.
    fn matters(&self, mechanism: &Mechanism) -> bool {
        let joints = mechanism.joints.len();
        let series = |by: f64| -> Vec<Vec<f64>> {
            let value = |joint: usize, i: usize| (by + 1.7 * joint as f64 + 2.3 * i as f64).sin();
            (0..joints)
                .map(|joint| (0..8).map(|i| value(joint, i)).collect())
                .collect()
        };
        let motion = Motion {
            q: &series(0.1),
            qd: &series(1.2),
            qdd: &series(2.5),
            slip: None,
            still: false,
            shift: None,
        };
        let bodies = vec![[0.5, 0.1, -0.2, 0.6, 0.15, 0.7, 0.3, -0.4, 0.5, 1.0]; joints];
        let derivative = self.derivative(&motion, &bodies);
        derivative
            .iter()
            .flatten()
            .any(|torque| torque.abs() > 1e-6)
    }

    /// d tau / d length of every joint along a motion, N m (N) per m.
    pub fn derivative(&self, motion: &Motion<'_>, values: &StandardValues) -> Vec<Vec<f64>> {
        let [longer, shorter] = [0, 1].map(|side| {
            let (rigid, maps) = &self.variants[side];
            let x: Vec<f64> = maps
                .iter()
                .zip(values)
                .flat_map(|(map, ten)| apply(map, ten))
                .collect();
            rigid.torque(motion, &x)
        });
        let difference = |(a, b): (Vec<f64>, Vec<f64>)| -> Vec<f64> {
            let pairs = a.iter().zip(&b);
            pairs.map(|(a, b)| (a - b) / (2.0 * STEP)).collect()
        };
        longer.into_iter().zip(shorter).map(difference).collect()
    }
}

pub(super) fn apply(map: &[[f64; 10]; 10], ten: &[f64; 10]) -> [f64; 10] {
    map.map(|row| row.iter().zip(ten).map(|(a, b)| a * b).sum())
}

/// The description with a moving joint `by` (m) further from its antecedent, along the line
/// between them; `None` if they are in one place.
pub(super) fn changed(description: &Description, joint: &str, by: f64) -> Option<Description> {
    let mut changed = description.clone();
    match &mut changed.geometry {
        Geometry::Urdf(tree) => {
            let joint = tree.joints.iter_mut().find(|known| known.name == joint)?;
            lengthen(&mut joint.origin.xyz.each_mut(), by)?
        }
        Geometry::Mdh(rows) => {
            let row = rows.iter_mut().find(|known| known.name == joint)?;
            // Along its axis a prismatic joint's distance is its own variable.
            let slides = row.motion == describe::Motion::Prismatic;
            let [b, d, r] = [&mut row.b.value, &mut row.d.value, &mut row.r.value];
            match slides {
                true => lengthen(&mut [b, d], by)?,
                false => lengthen(&mut [b, d, r], by)?,
            }
        }
    }
    Some(changed)
}

fn lengthen(parts: &mut [&mut f64], by: f64) -> Option<()> {
    let length = parts.iter().map(|part| **part * **part).sum::<f64>().sqrt();
    if length < SHORTEST {
        return None;
    }
    for part in parts {
        **part *= 1.0 + by / length;
    }
    Some(())
}

/// How the ten parameters of a link change from its frame in one mechanism to that in another:
/// its first body is where it was, seen from the joint.
pub(super) fn frame_change(from: &Mechanism, to: &Mechanism, link: usize) -> [[f64; 10]; 10] {
    let pose = |mechanism: &Mechanism| mechanism.joints[link].bodies.first().map(|body| body.pose);
    let mut map = [[0.0; 10]; 10];
    for column in 0..10 {
        let mut unit = [0.0; 10];
        unit[column] = 1.0;
        let moved = match (pose(from), pose(to)) {
            (Some(from), Some(to)) => standard(&unit).moved(&to.then(&from.inverse())).values(),
            _ => unit,
        };
        for (row, value) in map.iter_mut().zip(moved) {
            row[column] = value;
        }
    }
    map
}

fn standard(ten: &[f64; 10]) -> Standard {
    let [xx, xy, xz, yy, yz, zz, mx, my, mz, mass] = *ten;
    let mut standard = Standard::zero();
    for (row, values) in [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        .iter()
        .enumerate()
    {
        for (column, value) in values.iter().enumerate() {
            standard.inertia[(row, column)] = *value;
        }
    }
    for (place, value) in [mx, my, mz].iter().enumerate() {
        standard.moment[place] = *value;
    }
    standard.mass = mass;
    standard
}
