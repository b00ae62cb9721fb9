//! How far described values may be wrong: independent deviations of each body, rotor and friction,
//! carried to the base parameters.

use nalgebra::{DVector, Matrix3, Vector3};

use super::inertial;
use super::values::{Known, Values};
use crate::derive::ParameterKind;
use crate::describe::PriorSpec;
use crate::mechanism::Standard;
use crate::mechanism::inertia::NAMES;
use crate::robot::Robot;

/// A tolerance of zero means "known"; this much of the value is left to rounding.
const FINEST: f64 = 1e-6;

/// Independent deviations, each as what one standard deviation of it changes in the base
/// parameters.
#[derive(Clone, Debug, Default)]
pub struct Deviations {
    /// Those whose size the tolerances bound.
    pub bounded: Vec<DVector<f64>>,
    /// Those that nothing is known of, in any size.
    pub free: Vec<DVector<f64>>,
}

impl Deviations {
    fn add(&mut self, direction: DVector<f64>, sigma: f64) {
        if sigma.is_finite() {
            self.bounded.push(direction * sigma);
        } else {
            self.free.push(direction);
        }
    }
}

/// The deviations that tolerances leave a robot.
pub fn deviations(robot: &Robot, values: &Values, prior: &PriorSpec) -> Deviations {
    let mut all = Deviations::default();
    for body in &values.bodies {
        for (deviation, sigma) in of_body(body, prior) {
            all.add(carried(robot, body.link, &deviation.values()), sigma);
        }
    }
    for link in 0..robot.mechanism.joints.len() {
        if !values.describes(link) {
            for parameter in 0..NAMES.len() {
                let mut unit = [0.0; 10];
                unit[parameter] = 1.0;
                all.add(carried(robot, link, &unit), f64::INFINITY);
            }
        }
    }
    for (name, kind) in others(robot) {
        let sigma = fraction(&name, kind, prior) * values.standard(&name).unwrap_or(0.0).abs();
        // A fraction of nothing says nothing.
        let sigma = if sigma > 0.0 { sigma } else { f64::INFINITY };
        all.add(along(robot, |term| f64::from(term == name)), sigma);
    }
    all
}

/// Standard parameters of drives, friction and effects.
fn others(robot: &Robot) -> Vec<(String, ParameterKind)> {
    let mut names = Vec::new();
    for parameter in &robot.base.parameters {
        for (_, name) in &parameter.relation {
            let rigid = inertial(name).is_some();
            if !rigid && !names.iter().any(|(known, _)| known == name) {
                // Only rotor inertias are regrouped with others.
                let kind = match parameter.kind {
                    ParameterKind::Inertial(_) => ParameterKind::Drive,
                    kind => kind,
                };
                names.push((name.clone(), kind));
            }
        }
    }
    names
}

/// Tolerance of a drive's or joint's parameter as a fraction of its value.
fn fraction(name: &str, kind: ParameterKind, prior: &PriorSpec) -> f64 {
    let fraction = match kind {
        ParameterKind::Drive => prior.rotor_inertia,
        ParameterKind::Friction if name.starts_with("FV") || name.starts_with("FS") => {
            prior.friction
        }
        _ => f64::INFINITY,
    };
    fraction.max(FINEST)
}

/// What ten standard parameters of a link add to the base parameters.
fn carried(robot: &Robot, link: usize, values: &[f64; 10]) -> DVector<f64> {
    along(robot, |name| match inertial(name) {
        Some((of, parameter)) if of == link => values[parameter],
        _ => 0.0,
    })
}

/// K times a vector of standard parameters, given by name.
fn along(robot: &Robot, value: impl Fn(&str) -> f64) -> DVector<f64> {
    let sums = robot.base.parameters.iter().map(|parameter| {
        let terms = parameter.relation.iter();
        terms.fold(0.0, |sum, (factor, name)| sum + factor * value(name))
    });
    DVector::from_iterator(robot.base.parameters.len(), sums)
}

/// The ten deviations of a body in its link frame, per unit, with their standard deviations: mass;
/// centre of mass along the axes of the body's own frame; principal moments about it; products of
/// inertia.
fn of_body(body: &Known, prior: &PriorSpec) -> Vec<(Standard, f64)> {
    let own = body.inertial.moved(&body.pose.inverse());
    let (mass, com) = (own.mass, own.moment / own.mass);
    let about_com = own.inertia - mass * shift(&com, &com);
    let principal = about_com.symmetric_eigen();
    let (axes, moments) = (principal.eigenvectors, principal.eigenvalues);
    let size = moments.amax();
    let radius = (size / mass.abs()).sqrt();
    let mut all = Vec::with_capacity(10);
    let mut push = |inertia: Matrix3<f64>, moment: Vector3<f64>, mass: f64, sigma: f64| {
        let deviation = Standard {
            inertia,
            moment,
            mass,
        };
        all.push((deviation.moved(&body.pose), sigma));
    };
    let of_mass = prior.mass.max(FINEST) * mass.abs();
    push(shift(&com, &com), com, 1.0, of_mass);
    for (axis, along) in com.iter().enumerate() {
        let unit = Vector3::ith(axis, 1.0);
        let inertia = mass * (shift(&com, &unit) + shift(&unit, &com));
        let sigma = prior.com.hypot(prior.com_fraction * along);
        push(inertia, mass * unit, 0.0, sigma.max(FINEST * radius));
    }
    let part = prior.inertia;
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (u, v) = (axes.column(i).into_owned(), axes.column(j).into_owned());
        // Without a tolerance of the moments there is none of the products.
        let (own, mixed) = match part.is_finite() {
            true => (
                part * moments[i].abs(),
                of_product([moments[i], moments[j], moments[k]], mass, prior),
            ),
            false => (part, part),
        };
        let product = u * v.transpose() + v * u.transpose();
        let still = Vector3::zeros();
        push(u * u.transpose(), still, 0.0, own.max(FINEST * size));
        push(product, still, 0.0, mixed.max(FINEST * size));
    }
    all
}

/// Standard deviation of a product of inertia in principal axes i, j: what turning them makes of
/// the deviating moments, \\( \phi_k (I_i (1 + f_i) - I_j (1 + f_j)) \\), and, since of nearly
/// equal moments little more is left, the products of two deviations: of the other turns,
/// \\( \phi_i \phi_j (I_k - (I_i + I_j) / 2) \\), and of the centre of mass.
fn of_product([i, j, k]: [f64; 3], mass: f64, prior: &PriorSpec) -> f64 {
    let (turn, part) = (prior.inertia_rotation, prior.inertia);
    let first = turn * (i - j).hypot(part * i.hypot(j));
    let second = turn * turn * (k - 0.5 * (i + j));
    let moved = if prior.com.is_finite() {
        mass * prior.com * prior.com
    } else {
        0.0
    };
    first.hypot(second).hypot(moved)
}

/// \\( (a^T b) E - a b^T \\): inertia of a unit mass with a = b its place.
fn shift(a: &Vector3<f64>, b: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::identity() * a.dot(b) - a * b.transpose()
}
