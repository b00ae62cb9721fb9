//! Robots that move: a description made into a model with values, and what drives it.

use std::error::Error;
use std::ops::Range;

use idim::codegen::Robot;
use idim::codegen::describe::Description;
use idim::codegen::mechanism::Standard;
use idim::codegen::mechanism::inertia::NAMES;
use idim::interpreted::Interpreter;
use idim::runtime::model::IdentificationModel;
use idim::runtime::simulate::{
    Disturbance, Drift, Drive, Dynamics, Encoder, Influence, LoadFriction, Plant, Weight,
};

use super::build::tree;
use super::hidden::{Effect, Hidden, Structure, structure};
use super::random::Random;
use super::robots::PRIOR;

/// Whatever may go wrong.
pub type Failure = Box<dyn Error + Send + Sync>;

/// A robot with values.
pub struct Machine {
    /// Its model.
    pub model: Interpreter,
    /// Its np parameters.
    pub values: Vec<f64>,
    /// The share of the rigid bodies, as a controller's feedforward has it.
    pub rigid: Vec<f64>,
    /// The driven joints of the model, from 0.
    pub driven: Vec<usize>,
    /// Models whose weight is a force on the flange, their values, and when.
    pub forces: Vec<(Interpreter, Vec<f64>, Option<Range<f64>>)>,
}

impl Machine {
    /// The robot of a description with effects.
    pub fn new(description: &Description, effects: &[Effect]) -> Result<Machine, Failure> {
        let Structure {
            description: changed,
            values,
            driven,
        } = structure(description, effects);
        let robot = Robot::new(changed)?;
        let given = |name: &str| {
            let known = values.iter().chain(&robot.description.parameters);
            known
                .clone()
                .find(|(other, _)| other == name)
                .map(|(_, value)| *value)
        };
        let bodies = bodies(&robot);
        let force = |effect: &Effect| match &effect.hidden {
            Hidden::Force { force, window } => Some((*force, window.clone())),
            _ => None,
        };
        let forces = effects.iter().filter_map(force);
        let forces = forces.map(|(force, window)| {
            let (model, values) = pulled(&robot, force)?;
            Ok::<_, Failure>((model, values, window))
        });
        Ok(Machine {
            values: base_values(&robot, |name| {
                given(name).or_else(|| bodies(name)).unwrap_or(0.0)
            }),
            rigid: base_values(&robot, |name| bodies(name).unwrap_or(0.0)),
            forces: forces.collect::<Result<_, _>>()?,
            model: Interpreter::new(&robot),
            driven,
        })
    }

    /// Column of a parameter.
    pub fn column(&self, name: &str) -> Option<usize> {
        let columns = self.model.columns();
        columns.iter().position(|column| column.name == name)
    }

    /// Diagonal of the mass matrix at a position.
    pub fn inertias(&self, q: &[f64]) -> Result<Vec<f64>, Failure> {
        let mut dynamics = Dynamics::new(&self.model, &self.values)?;
        let mass = dynamics.mass(q)?;
        Ok((0..q.len())
            .map(|joint| mass[joint * q.len() + joint])
            .collect())
    }

    /// The robot as its controller meets it.
    pub fn plant<'a>(
        &'a self,
        effects: &[Effect],
        resolution: f64,
        disturbance: &'a [Vec<f64>],
    ) -> Result<Plant<'a>, Failure> {
        let joints = self.driven.len();
        let encoder = Encoder {
            eccentricity: None,
            resolution: Some(resolution),
        };
        let mut plant = Plant {
            model: &self.model,
            parameters: &self.values,
            driven: self.driven.clone(),
            drives: vec![Drive::IDEAL; joints],
            encoders: vec![encoder; joints],
            influences: vec![Box::new(Disturbance::new(disturbance))],
        };
        for effect in effects {
            match &effect.hidden {
                Hidden::Drive { joint, drive } => plant.drives[*joint] = *drive,
                Hidden::Eccentric { joint, wave } => {
                    plant.encoders[*joint].eccentricity = Some(*wave);
                }
                hidden => plant.influences.extend(self.influence(hidden)?),
            }
        }
        for (model, values, window) in &self.forces {
            let weight = Weight::new(model, values, window.clone())?;
            plant.influences.push(Box::new(weight));
        }
        Ok(plant)
    }

    fn influence<'a>(
        &'a self,
        hidden: &Hidden,
    ) -> Result<Option<Box<dyn Influence + 'a>>, Failure> {
        let friction = |symbol: &str, joint: usize| {
            let name = format!("{symbol}{}", self.driven[joint] + 1);
            self.column(&name).ok_or(format!("{name} is no parameter"))
        };
        Ok(match *hidden {
            Hidden::Load { joint, factor } => {
                let place = (self.driven[joint], friction("FS", joint)?);
                Some(Box::new(LoadFriction::new(
                    &self.model,
                    &self.values,
                    place,
                    factor,
                )?))
            }
            Hidden::Drift {
                joint,
                time,
                coulomb,
                viscous,
            } => {
                let change = |symbol, by| {
                    let column = friction(symbol, joint)?;
                    Ok::<_, Failure>((column, self.values[column], by))
                };
                let changes = vec![change("FS", coulomb)?, change("FV", viscous)?];
                Some(Box::new(Drift { time, changes }))
            }
            Hidden::Outside(ref outside) => outside.influence(&self.driven),
            _ => None,
        })
    }
}

/// Base parameters from their own names or the regrouping relations.
fn base_values(robot: &Robot, value: impl Fn(&str) -> f64) -> Vec<f64> {
    let sum = |parameter: &idim::codegen::base::BaseParameter| {
        let terms = parameter.relation.iter();
        terms.map(|(factor, name)| factor * value(name)).sum()
    };
    robot.base.parameters.iter().map(sum).collect()
}

/// Standard inertial parameters of the bodies by name.
fn bodies(robot: &Robot) -> impl Fn(&str) -> Option<f64> + use<> {
    let link = |joint: &idim::codegen::mechanism::Joint| {
        let bodies = joint.bodies.iter().filter_map(|body| body.inertial);
        bodies
            .fold(Standard::zero(), |sum, body| sum.plus(&body))
            .values()
    };
    let links: Vec<[f64; 10]> = robot.mechanism.joints.iter().map(link).collect();
    move |name| {
        let symbol = name.trim_end_matches(|c: char| c.is_ascii_digit());
        let place = NAMES.iter().position(|known| *known == symbol)?;
        let number: usize = name[symbol.len()..].parse().ok()?;
        links.get(number.checked_sub(1)?).map(|ten| ten[place])
    }
}

/// A robot under a gravity that is a force, in which only a unit mass at the flange has weight.
fn pulled(robot: &Robot, force: [f64; 3]) -> Result<(Interpreter, Vec<f64>), Failure> {
    let description = Description {
        gravity: force,
        ..robot.description.clone()
    };
    let pulled = Robot::new(description)?;
    let carrier = pulled.mechanism.joints.iter().enumerate().rev();
    let flange = |(number, joint): (usize, &idim::codegen::mechanism::Joint)| {
        let body = joint.bodies.iter().find(|body| body.name == "flange")?;
        Some((number + 1, <[f64; 3]>::from(body.pose.translation)))
    };
    let (number, [x, y, z]) = carrier.filter_map(flange).next().ok_or("no flange")?;
    let values = base_values(&pulled, |name| {
        match name.strip_suffix(&number.to_string()) {
            Some("MX") => x,
            Some("MY") => y,
            Some("MZ") => z,
            Some("M") => 1.0,
            _ => 0.0,
        }
    });
    Ok((Interpreter::new(&pulled), values))
}

/// An individual of a description: its values within the stated tolerances, its friction that of
/// the day.
pub fn individual(description: &Description, random: &mut Random) -> Description {
    let [mass, com, com_fraction, inertia, rotation, rotor, _] = PRIOR;
    let mut own = description.clone();
    for link in &mut tree(&mut own).links {
        let Some(body) = &mut link.inertial else {
            continue;
        };
        body.mass *= 1.0 + mass * random.normal();
        for x in &mut body.origin.xyz {
            *x += com.hypot(com_fraction * *x) * random.normal();
        }
        let stretch = [(); 3].map(|()| 1.0 + 0.5 * inertia * random.normal());
        let pairs = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
        for (moment, (a, b)) in body.inertia.iter_mut().zip(pairs) {
            *moment *= stretch[a] * stretch[b];
        }
        for angle in &mut body.origin.rpy {
            *angle += rotation * random.normal();
        }
    }
    for (name, value) in &mut own.parameters {
        *value *= match name.starts_with("IA") {
            true => 1.0 + rotor * random.normal(),
            false => random.ratio(0.7, 1.4),
        };
    }
    own
}
