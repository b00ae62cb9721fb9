//! The canonical form of a robot: a tree of moving links in modified Denavit-Hartenberg frames.
//!
//! Whatever the description was, the mechanism is the same: z along each joint's axis, origins slid
//! along the axes so that offsets vanish, fixed joints merged with their inertia, right angles
//! exact. It is immutable, and nothing after it can fail.

pub mod effects;
pub mod frames;
pub mod from_mdh;
pub mod from_urdf;
mod gear;
pub mod inertia;
pub mod pose;

pub use inertia::Standard;
pub use pose::Pose;

use crate::catalogue::EffectKind;
use crate::describe::{Description, Geometry, Limits, Snap};
use crate::expr::Angle;

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Rotation about z; q in rad.
    Revolute,
    /// Translation along z; q in m.
    Prismatic,
}

/// A moving joint together with the link it carries.
///
/// From the antecedent's frame to this one at q = 0: turn by `gamma` about z, by `alpha` about x,
/// by `theta` about z; the origin is at `position` in the antecedent's frame. A revolute joint adds
/// q to `theta`, a prismatic one slides the origin along its z by q. The first joints of the robot
/// have the identity here: their antecedent's frame is their own at q = 0.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name in the description.
    pub name: String,
    /// Revolute or prismatic.
    pub kind: JointKind,
    /// Index of the antecedent, `None` for the base; always smaller than the joint's own.
    pub parent: Option<usize>,
    /// Rotation about the antecedent's z.
    pub gamma: Angle,
    /// Rotation about x.
    pub alpha: Angle,
    /// Rotation about z at q = 0.
    pub theta: Angle,
    /// Origin in the antecedent's frame at q = 0, m.
    pub position: [f64; 3],
    /// Gravity in the antecedent's frame, m/s^2; only the first joints of the robot have one.
    pub gravity: Option<[f64; 3]>,
    /// Pose at q = 0 in the frame of the description's base; only the first joints of the robot
    /// have one.
    pub base: Option<Pose>,
    /// Limits from the description.
    pub limits: Limits,
    /// The described bodies that move with this joint, each with its pose in the link frame.
    pub bodies: Vec<Body>,
}

/// A body of the description (a URDF link) as part of a link of the mechanism.
#[derive(Clone, Debug)]
pub struct Body {
    /// Name in the description.
    pub name: String,
    /// From the body's own frame to the link frame.
    pub pose: Pose,
    /// The ten parameters about the link frame's origin, in the link frame's axes, if described.
    pub inertial: Option<Standard>,
}

/// An effect on joints given by index.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// Which entry of the catalogue.
    pub kind: EffectKind,
    /// The joints it acts on, as the catalogue orders them.
    pub joints: Vec<usize>,
    /// Shape parameters in the catalogue's order, SI.
    pub shape: Vec<f64>,
}

/// The canonical robot.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// Name of the robot.
    pub name: String,
    /// Moving joints, antecedents first.
    pub joints: Vec<Joint>,
    /// Effects beside the rigid bodies.
    pub effects: Vec<Effect>,
    /// Angles taken for multiples of pi/2, in the description or between the joints' axes.
    pub snaps: Vec<Snap>,
}

impl Mechanism {
    /// Brings a checked description into canonical form.
    pub fn new(description: &Description) -> Mechanism {
        let (axes, mut snaps) = match &description.geometry {
            Geometry::Urdf(tree) => (from_urdf::axes(tree), description.snaps.clone()),
            Geometry::Mdh(rows) => (from_mdh::axes(rows), description.snaps.clone()),
        };
        let joints = frames::place(&axes, description.gravity, &mut snaps);
        let effects = effects::resolve(&joints, &description.effects);
        Mechanism {
            name: description.name.clone(),
            joints,
            effects,
            snaps,
        }
    }

    /// The joints whose friction has a memory, ascending, each with its z_s in rad or m.
    pub fn presliding(&self) -> impl Iterator<Item = (usize, f64)> {
        let zs = |joint: usize| {
            let effect = self.effects.iter().find(|effect| {
                effect.kind == EffectKind::Presliding && effect.joints.contains(&joint)
            })?;
            effect.shape.first().map(|&zs| (joint, zs))
        };
        (0..self.joints.len()).filter_map(zs)
    }

    /// Indices of the joints from the base to `joint`, `joint` itself last.
    pub fn chain(&self, joint: usize) -> Vec<usize> {
        let mut chain = vec![joint];
        let mut at = joint;
        while let Some(parent) = self.joints[at].parent {
            chain.push(parent);
            at = parent;
        }
        chain.reverse();
        chain
    }
}
