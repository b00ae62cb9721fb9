//! The canonical form of a robot: a tree of moving links in modified Denavit-Hartenberg frames.
//!
//! Whatever the description was, the mechanism is the same: z along each joint's axis, origins slid
//! along the axes so that offsets vanish, fixed joints merged with their inertia, right angles
//! exact. It is immutable, and nothing after it can fail.

pub mod alignment;
pub mod dyad;
pub mod effects;
pub mod follow;
pub mod frames;
pub mod from_mdh;
pub mod from_urdf;
mod gear;
pub mod inertia;
pub mod loops;
pub mod plane;
pub mod pose;
pub mod ring;

pub use dyad::Dyad;
pub use follow::{Affine, Follow};
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
    /// Index of the antecedent, `None` for the base; before the joint itself in
    /// [`Mechanism::order`].
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

impl Joint {
    /// All described bodies that move with the joint as one, in the link's frame; without mass if
    /// none is described.
    pub fn carried(&self) -> Standard {
        let bodies = self.bodies.iter().filter_map(|body| body.inertial);
        bodies.fold(Standard::zero(), |sum, body| sum.plus(&body))
    }
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
    /// Moving joints: those with a drive of their own first, in the order of the description, then
    /// those that follow them. The number of a joint is also that of the link it carries.
    pub joints: Vec<Joint>,
    /// How many joints have a drive: the rows of every output, the columns of a log.
    pub driven: usize,
    /// How the joints from `driven` on follow.
    pub follows: Vec<Follow>,
    /// What closed loops make of their joints, each after those it needs.
    pub dyads: Vec<Dyad>,
    /// All joints, antecedents first.
    pub order: Vec<usize>,
    /// Effects beside the rigid bodies.
    pub effects: Vec<Effect>,
    /// Angles taken for multiples of pi/2, in the description or between the joints' axes.
    pub snaps: Vec<Snap>,
}

impl Mechanism {
    /// Brings a checked description into canonical form.
    pub fn new(description: &Description) -> Mechanism {
        let (axes, closures) = axes(description);
        let mut snaps = description.snaps.clone();
        let placed = frames::place(&axes, description.gravity, &mut snaps);
        let numbering = follow::numbering(&axes, &closures);
        let joints = renumbered(placed, &numbering.numbers);
        let effects = effects::resolve(&joints, &description.effects);
        Mechanism {
            name: description.name.clone(),
            joints,
            driven: numbering.driven,
            follows: numbering.follows,
            dyads: numbering.dyads,
            order: numbering.numbers,
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
        (0..self.driven).filter_map(zs)
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

/// Why a closed loop of a description is not modelled, if there is one that is not.
pub fn unsolved(description: &Description) -> Option<loops::LoopError> {
    let (axes, closures) = axes(description);
    follow::solve(&axes, &closures).err()
}

/// Axes in space and the loops that they close.
fn axes(description: &Description) -> (Vec<frames::Axis>, Vec<ring::Closure>) {
    match &description.geometry {
        Geometry::Urdf(tree) => (from_urdf::axes(tree), vec![]),
        Geometry::Mdh(rows) => from_mdh::axes(rows, &description.loops),
    }
}

/// The joints in the order of their numbers, their antecedents by number.
fn renumbered(joints: Vec<Joint>, numbers: &[usize]) -> Vec<Joint> {
    let mut all: Vec<(usize, Joint)> = numbers.iter().copied().zip(joints).collect();
    for (_, joint) in &mut all {
        joint.parent = joint.parent.map(|parent| numbers[parent]);
    }
    all.sort_by_key(|&(number, _)| number);
    all.into_iter().map(|(_, joint)| joint).collect()
}
