//! What can be hidden in a robot, and the description of the robot that has it.

use std::ops::Range;

use idim::codegen::catalogue::EffectKind;
use idim::codegen::describe::{Description, Motion};
use idim::codegen::mechanism::Mechanism;
use idim::runtime::simulate::Drive;

use super::build::{ask, body, fasten, lengthen, split, tilted, tree};
use super::outside::Outside;

/// One hidden effect.
#[derive(Clone, Debug)]
pub struct Effect {
    /// Its name in the catalogue, or that of something outside of it.
    pub name: &'static str,
    /// The joints it belongs to, from 0; empty for the whole robot.
    pub joints: Vec<usize>,
    /// What it is.
    pub hidden: Hidden,
}

/// A column of the catalogue: its kind, joints and shape, and its parameters by symbol and joint.
#[derive(Clone, Debug)]
pub struct Column {
    pub kind: EffectKind,
    pub joints: Vec<usize>,
    pub shape: Vec<f64>,
    pub values: Vec<(&'static str, f64)>,
}

/// How an effect is put into a robot. Joints count from 0; units are SI.
#[derive(Clone, Debug)]
pub enum Hidden {
    /// Columns that a description can ask for.
    Columns(Vec<Column>),
    /// Added to the rotor inertia.
    Rotor { joint: usize, change: f64 },
    /// A body at the flange: mass, centre of mass, radii of gyration.
    Payload {
        mass: f64,
        com: [f64; 3],
        radii: [f64; 3],
    },
    /// A base turned about x, then y.
    Tilt { x: f64, y: f64 },
    /// A force on the flange, in frame 0; all the time or in a window.
    Force {
        force: [f64; 3],
        window: Option<Range<f64>>,
    },
    /// A joint further from its antecedent.
    Length { joint: usize, by: f64 },
    /// Coulomb friction in proportion to the load.
    Load { joint: usize, factor: f64 },
    /// A drive that does not do what it is told.
    Drive { joint: usize, drive: Drive },
    /// A log whose torques come late.
    Late { by: f64 },
    /// An encoder's error along the turn: N, sine, cosine.
    Eccentric { joint: usize, wave: (f64, f64, f64) },
    /// Coulomb and viscous friction that approach others: changes and time constant.
    Drift {
        joint: usize,
        time: f64,
        coulomb: f64,
        viscous: f64,
    },
    /// A gear that yields.
    Elastic {
        joint: usize,
        stiffness: f64,
        damping: f64,
    },
    /// A gear with play between two stops.
    Backlash {
        joint: usize,
        gap: f64,
        stiffness: f64,
        damping: f64,
    },
    /// Something that no catalogue has.
    Outside(Outside),
}

/// A robot with hidden joints and columns.
#[derive(Clone, Debug)]
pub struct Structure {
    /// What it would be described as.
    pub description: Description,
    /// Values of the parameters of what is hidden, by name.
    pub values: Vec<(String, f64)>,
    /// The driven joints, from 0.
    pub driven: Vec<usize>,
}

/// The robot of a description with effects.
pub fn structure(description: &Description, effects: &[Effect]) -> Structure {
    let names = joint_names(description);
    let mut changed = description.clone();
    let mut values = Vec::new();
    for effect in effects {
        put(&effect.hidden, &names, &mut changed, &mut values);
    }
    let order = joint_names(&changed);
    let driven: Vec<usize> = names
        .iter()
        .filter_map(|name| order.iter().position(|other| other == name))
        .collect();
    // Numbers of joints move up where others come in between.
    for (name, _) in &mut changed.parameters {
        let symbol = name.trim_end_matches(|c: char| c.is_ascii_digit());
        let number: usize = name[symbol.len()..].parse().unwrap_or(1);
        *name = format!("{symbol}{}", driven[number - 1] + 1);
    }
    let number = |joint: &str| {
        order
            .iter()
            .position(|other| other == joint)
            .map_or(0, |p| p + 1)
    };
    let values = values
        .into_iter()
        .map(|(symbol, joint, value): Value| (format!("{symbol}{}", number(&joint)), value))
        .collect();
    Structure {
        description: changed,
        values,
        driven,
    }
}

/// Symbol, joint by name, value.
type Value = (&'static str, String, f64);

/// Names of the moving joints.
pub fn joint_names(description: &Description) -> Vec<String> {
    let joints = Mechanism::new(description).joints;
    joints.into_iter().map(|joint| joint.name).collect()
}

fn put(hidden: &Hidden, names: &[String], to: &mut Description, values: &mut Vec<Value>) {
    match hidden {
        Hidden::Columns(columns) => columns.iter().for_each(|column| {
            let joints: Vec<String> = column.joints.iter().map(|&j| names[j].clone()).collect();
            for (symbol, value) in &column.values {
                values.push((symbol, joints.last().cloned().unwrap_or_default(), *value));
            }
            ask(to, column.kind, joints, &column.shape);
        }),
        Hidden::Rotor { joint, change } => {
            let name = format!("IA{}", joint + 1);
            let known = to.parameters.iter_mut().filter(|(other, _)| *other == name);
            known.for_each(|(_, value)| *value += change);
        }
        Hidden::Payload { mass, com, radii } => {
            let moments = radii.map(|r| mass * r * r);
            let inertial = body(*mass, *com, moments);
            fasten(tree(to), Motion::Fixed, [0.0, 0.0, 1.0], inertial);
        }
        Hidden::Tilt { x, y } => to.gravity = tilted(to.gravity, *x, *y),
        Hidden::Length { joint, by } => {
            let name = &names[*joint];
            let found = tree(to)
                .joints
                .iter_mut()
                .filter(|known| known.name == *name);
            found.for_each(|joint| lengthen(&mut joint.origin.xyz, *by));
        }
        Hidden::Elastic {
            joint,
            stiffness,
            damping,
        } => {
            let gear = split(tree(to), &names[*joint]);
            ask(to, EffectKind::Spring, vec![gear.clone()], &[]);
            ask(to, EffectKind::Viscous, vec![gear.clone()], &[]);
            values.push(("K", gear.clone(), *stiffness));
            values.push(("FV", gear, *damping));
        }
        Hidden::Backlash {
            joint,
            gap,
            stiffness,
            damping,
        } => {
            let gear = split(tree(to), &names[*joint]);
            for side in [1.0, -1.0] {
                let stop = [0.5 * side * gap, side];
                ask(to, EffectKind::EndStop, vec![gear.clone()], &stop);
            }
            ask(to, EffectKind::Viscous, vec![gear.clone()], &[]);
            values.push(("KE", gear.clone(), *stiffness));
            values.push(("FV", gear, *damping));
        }
        Hidden::Outside(outside) => outside.put(to, values),
        Hidden::Force { .. }
        | Hidden::Load { .. }
        | Hidden::Drive { .. }
        | Hidden::Late { .. }
        | Hidden::Eccentric { .. }
        | Hidden::Drift { .. } => {}
    }
}
