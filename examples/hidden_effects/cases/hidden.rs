//! What can be hidden in a robot, and the description of the robot that has it.

use std::ops::Range;

use idim::codegen::catalogue::EffectKind;
use idim::codegen::describe::{
    Description, EffectSpec, Geometry, Limits, Motion, Pose, Span, UrdfInertial, UrdfJoint,
    UrdfLink, UrdfTree,
};
use idim::codegen::mechanism::Mechanism;
use idim::runtime::simulate::Drive;

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

/// Mass and moments of links that are only joints: next to nothing.
const NOTHING: (f64, f64) = (1e-5, 1e-8);

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

/// The links and joints; all robots here are URDFs.
pub fn tree(description: &mut Description) -> &mut UrdfTree {
    if let Geometry::Mdh(_) = description.geometry {
        let (links, joints) = (Vec::new(), Vec::new());
        description.geometry = Geometry::Urdf(UrdfTree { links, joints });
    }
    match &mut description.geometry {
        Geometry::Urdf(tree) => tree,
        Geometry::Mdh(_) => unreachable!("replaced above"),
    }
}

/// Asks for an effect.
pub fn ask(to: &mut Description, kind: EffectKind, joints: Vec<String>, shape: &[f64]) {
    let named = kind.shapes().iter().zip(shape);
    to.effects.push(EffectSpec {
        kind,
        joints,
        shape: named.map(|(known, value)| (known.name, *value)).collect(),
        span: Span { line: 0, column: 0 },
    });
}

fn body(mass: f64, com: [f64; 3], [xx, yy, zz]: [f64; 3]) -> UrdfInertial {
    UrdfInertial {
        mass,
        origin: Pose {
            rpy: [0.0; 3],
            xyz: com,
        },
        inertia: [xx, 0.0, 0.0, yy, 0.0, zz],
    }
}

fn link(tree: &mut UrdfTree, inertial: UrdfInertial) -> usize {
    let name = format!("added{}", tree.links.len());
    tree.links.push(UrdfLink {
        name,
        inertial: Some(inertial),
        span: Span { line: 0, column: 0 },
    });
    tree.links.len() - 1
}

/// Hangs a body on the flange (the last link there is); returns the name of the joint.
pub fn fasten(
    tree: &mut UrdfTree,
    motion: Motion,
    axis: [f64; 3],
    inertial: UrdfInertial,
) -> String {
    let flange = tree.links.iter().position(|link| link.name == "flange");
    let parent = flange.unwrap_or_default();
    let child = link(tree, inertial);
    let name = format!("hanging{child}");
    tree.joints.push(UrdfJoint {
        name: name.clone(),
        motion,
        parent,
        child,
        origin: Pose::default(),
        axis,
        limits: Limits::default(),
        span: Span { line: 0, column: 0 },
    });
    name
}

/// Puts a joint behind another one: the first turns a drive, the second what the drive carries.
/// Returns the name of the second.
fn split(tree: &mut UrdfTree, joint: &str) -> String {
    let (mass, moment) = NOTHING;
    let between = link(tree, body(mass, [0.0; 3], [moment; 3]));
    let gear = format!("{joint}_gear");
    let place = tree.joints.iter().position(|known| known.name == joint);
    let place = place.unwrap_or_default();
    let carried = tree.joints[place].child;
    tree.joints[place].child = between;
    let behind = UrdfJoint {
        name: gear.clone(),
        parent: between,
        child: carried,
        origin: Pose::default(),
        limits: Limits::default(),
        ..tree.joints[place].clone()
    };
    tree.joints.insert(place + 1, behind);
    gear
}

/// Puts a joint between the base and everything on it, turning about x or y of frame 0 at the
/// floor; returns its name.
pub fn rock(tree: &mut UrdfTree, axis: [f64; 3]) -> String {
    let (mass, moment) = NOTHING;
    let is_child = |link: usize| tree.joints.iter().any(|joint| joint.child == link);
    let root = (0..tree.links.len()).find(|&link| !is_child(link));
    let root = root.unwrap_or_default();
    let rocking = link(tree, body(mass, [0.0; 3], [moment; 3]));
    for joint in tree.joints.iter_mut().filter(|joint| joint.parent == root) {
        joint.parent = rocking;
    }
    tree.joints.insert(
        0,
        UrdfJoint {
            name: "rocking".into(),
            motion: Motion::Revolute,
            parent: root,
            child: rocking,
            origin: Pose::default(),
            axis,
            limits: Limits::default(),
            span: Span { line: 0, column: 0 },
        },
    );
    "rocking".into()
}

/// A hanging body.
pub fn hanging(mass: f64, below: f64) -> UrdfInertial {
    body(mass, [0.0, 0.0, below], [mass * 0.0004; 3])
}

/// Gravity as a base that is turned about x, then about y, sees it.
fn tilted([gx, gy, gz]: [f64; 3], x: f64, y: f64) -> [f64; 3] {
    let ((sx, cx), (sy, cy)) = (x.sin_cos(), y.sin_cos());
    let (gy, gz) = (cx * gy + sx * gz, cx * gz - sx * gy);
    [cy * gx - sy * gz, gy, cy * gz + sy * gx]
}

fn lengthen(at: &mut [f64; 3], by: f64) {
    let length = at.iter().map(|x| x * x).sum::<f64>().sqrt();
    at.iter_mut()
        .for_each(|x| *x *= 1.0 + by / length.max(f64::MIN_POSITIVE));
}
