//! A robot as its author described it: every number and name resolved, nothing derived yet.
//!
//! Units are SI throughout. What is here is consistent (see [`super::check`]): names are unique,
//! antecedents come before their joints, axes are unit vectors, numbers are finite.

use super::diagnostic::{Diagnostic, Span};
use crate::catalogue::EffectKind;

/// A checked description.
#[derive(Clone, Debug)]
pub struct Description {
    /// Name of the robot: a valid, lower-case Rust identifier.
    pub name: String,
    /// SHA-256 of all the texts that it was read from, in hexadecimal.
    pub hash: String,
    /// Gravity in frame 0, m/s^2.
    pub gravity: [f64; 3],
    /// Named lengths, m, in the order of the text.
    pub lengths: Vec<(String, f64)>,
    /// Where the joints are.
    pub geometry: Geometry,
    /// Where the tree of the joints closes on itself; none in a URDF.
    pub loops: Vec<LoopSpec>,
    /// Every effect on every joint, joint by joint in the order of the joints, then the
    /// `[[effect]]` entries in the order of the text.
    pub effects: Vec<EffectSpec>,
    /// Base parameters that are to be scaled: `LMX2 = "L*MX2"`.
    pub scaled: Vec<ScaledParameter>,
    /// The robot's own options for identification, and its drives.
    pub identify: IdentifySpec,
    /// What the torque channels of its logs mean.
    pub drives: DrivesSpec,
    /// Nominal or identified values by parameter name, SI.
    pub parameters: Vec<(String, f64)>,
    /// Tolerances of the described values, if stated.
    pub prior: Option<PriorSpec>,
    /// Mass of all that moves, kg, if stated.
    pub total_mass: Option<f64>,
    /// What is known of bodies beside any log, in the order of the text.
    pub links: Vec<LinkSpec>,
    /// What was noticed on the way, none of it an error.
    pub warnings: Vec<Diagnostic>,
    /// Angles that were meant to be multiples of pi/2 and are taken as such.
    pub snaps: Vec<Snap>,
}

/// An angle within 1e-3 rad of a multiple of pi/2 that was taken as that multiple.
#[derive(Clone, Debug, PartialEq)]
pub struct Snap {
    /// The joint (or link) whose angle it is.
    pub joint: String,
    /// The value that was written, rad.
    pub from: f64,
    /// The multiple of pi/2 that it is taken for, such as `pi/2`.
    pub to: String,
}

/// The two ways to say where joints are.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// Links and joints of a URDF.
    Urdf(UrdfTree),
    /// Modified Denavit-Hartenberg rows (Khalil-Kleinfinger).
    Mdh(Vec<MdhRow>),
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Rotation about the axis (URDF `revolute` and `continuous`).
    Revolute,
    /// Translation along the axis.
    Prismatic,
    /// No motion.
    Fixed,
}

/// What moves a joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Drive {
    /// A drive of its own.
    #[default]
    Own,
    /// Another joint.
    Mimic(Mimic),
    /// The links of a closed loop.
    Passive,
}

/// A joint that follows another: q = multiplier * q of that joint + offset.
#[derive(Clone, Debug, PartialEq)]
pub struct Mimic {
    /// Name of the joint that is followed: it moves, and may itself follow another.
    pub joint: String,
    /// Factor, never 0; rad/rad, m/rad, rad/m or m/m.
    pub multiplier: f64,
    /// Constant, rad or m.
    pub offset: f64,
    /// Where it is stated.
    pub span: Span,
}

/// A number together with the text it was written as (`L`, `pi/2`, `0.5`).
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Value, SI.
    pub value: f64,
    /// Source text of the expression.
    pub text: String,
}

/// A row of a modified Denavit-Hartenberg table:
/// T = Rz(gamma) Tz(b) Rx(alpha) Tx(d) Rz(theta) Tz(r) from the antecedent's frame to this one.
#[derive(Clone, Debug)]
pub struct MdhRow {
    /// Joint name.
    pub name: String,
    /// Revolute, prismatic or fixed.
    pub motion: Motion,
    /// Antecedent: 0 is the base, k the k-th row (counted from 1), always an earlier row.
    pub ant: usize,
    /// Rotation about the antecedent's z, rad.
    pub gamma: Quantity,
    /// Translation along the antecedent's z, m.
    pub b: Quantity,
    /// Rotation about x, rad.
    pub alpha: Quantity,
    /// Translation along x, m.
    pub d: Quantity,
    /// Rotation about z, rad; added to q of a revolute joint.
    pub theta: Quantity,
    /// Translation along z, m; added to q of a prismatic joint.
    pub r: Quantity,
    /// What moves it.
    pub drive: Drive,
    /// XX, XY, XZ, YY, YZ, ZZ, MX, MY, MZ, M about the origin of this frame, if described.
    pub inertial: Option<[f64; 10]>,
    /// Limits, if stated.
    pub limits: Limits,
    /// Where the row stands.
    pub span: Span,
}

/// A closed loop: a frame that two branches of the tree of rows have in common once it is
/// assembled.
#[derive(Clone, Debug)]
pub struct LoopSpec {
    /// What messages call it.
    pub name: String,
    /// The joint that is cut to make a tree, as one branch reaches it. Its `ant` counts rows, and
    /// behind them the `cut` frames of all loops, then their `meets` frames.
    pub cut: MdhRow,
    /// The same frame as the other branch has it: a fixed row.
    pub meets: MdhRow,
    /// Whether the loop is assembled the other way round.
    pub flipped: bool,
    /// Where it is stated.
    pub span: Span,
}

/// Limits of a joint, SI; `None` where nothing is stated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Lowest position, rad or m.
    pub lower: Option<f64>,
    /// Highest position, rad or m.
    pub upper: Option<f64>,
    /// Largest speed, rad/s or m/s.
    pub velocity: Option<f64>,
    /// Largest torque or force, N m or N.
    pub effort: Option<f64>,
}

/// The links and joints of a URDF, in the order of the document.
#[derive(Clone, Debug)]
pub struct UrdfTree {
    /// All links; exactly one of them (the root) is no joint's child.
    pub links: Vec<UrdfLink>,
    /// All joints; each link but the root is the child of exactly one.
    pub joints: Vec<UrdfJoint>,
}

/// A link of a URDF.
#[derive(Clone, Debug)]
pub struct UrdfLink {
    /// Name.
    pub name: String,
    /// Inertial values about the centre of mass, if stated.
    pub inertial: Option<UrdfInertial>,
    /// Where the element stands.
    pub span: Span,
}

/// A URDF `<inertial>`: about the centre of mass, not about the link frame's origin.
#[derive(Clone, Copy, Debug)]
pub struct UrdfInertial {
    /// Mass, kg.
    pub mass: f64,
    /// Pose of the centre-of-mass frame in the link frame.
    pub origin: Pose,
    /// ixx, ixy, ixz, iyy, iyz, izz about the centre of mass in the centre-of-mass frame, kg m^2.
    pub inertia: [f64; 6],
}

/// Roll-pitch-yaw (fixed axes x, y, z; rad) and translation (m).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Roll, pitch, yaw: R = Rz(yaw) Ry(pitch) Rx(roll). Snapped to multiples of pi/2.
    pub rpy: [f64; 3],
    /// Translation, m.
    pub xyz: [f64; 3],
}

/// A joint of a URDF.
#[derive(Clone, Debug)]
pub struct UrdfJoint {
    /// Name.
    pub name: String,
    /// Revolute, prismatic or fixed.
    pub motion: Motion,
    /// Index of the parent link in [`UrdfTree::links`].
    pub parent: usize,
    /// Index of the child link in [`UrdfTree::links`].
    pub child: usize,
    /// Pose of the joint frame in the parent's frame.
    pub origin: Pose,
    /// Unit axis in the joint frame.
    pub axis: [f64; 3],
    /// What moves it.
    pub drive: Drive,
    /// Limits, if stated.
    pub limits: Limits,
    /// Where the element stands.
    pub span: Span,
}

/// An effect on one joint or on several.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectSpec {
    /// Which entry of the catalogue.
    pub kind: EffectKind,
    /// Names of the moving joints it acts on, in the order that the catalogue gives them a
    /// meaning.
    pub joints: Vec<String>,
    /// Shape parameters by name, SI, in the catalogue's order; defaults filled in.
    pub shape: Vec<(&'static str, f64)>,
    /// Where it is asked for.
    pub span: Span,
}

/// A base parameter under another name and scale, such as `LMX2 = "L*MX2"`.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaledParameter {
    /// The new name.
    pub name: String,
    /// The factor in front of the parameter.
    pub factor: Quantity,
    /// The parameter that is scaled.
    pub parameter: String,
    /// Where it is asked for.
    pub span: Span,
}

/// The `[identify]` table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IdentifySpec {
    /// Cut-off of the prefilter of q, Hz.
    pub fq_hz: Option<f64>,
    /// Order of the prefilter.
    pub order: Option<usize>,
    /// Decimation ratio.
    pub nd: Option<usize>,
    /// What is cut off at either end.
    pub trim: Option<usize>,
    /// Samples cut off at the start and at the end, before decimation.
    pub border: Option<(usize, usize)>,
    /// `matlab` or `scipy`.
    pub edges: Option<EdgesSpec>,
    /// `none`, `joint` or `robust`.
    pub weights: Option<WeightsSpec>,
    /// `derived` or `measured`.
    pub velocity: Option<VelocitySpec>,
    /// Whether the torque passes the prefilter too.
    pub prefilter_torque: Option<bool>,
    /// `parameters` or `mean`.
    pub degrees_of_freedom: Option<FreedomSpec>,
}

/// What a residual's degrees of freedom are counted against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FreedomSpec {
    /// r - np.
    Parameters,
    /// r - 1.
    Mean,
}

/// Edge rules of filters by the tools they come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgesSpec {
    /// Matlab's filtfilt and decimate.
    Matlab,
    /// SciPy's sosfiltfilt, every nd-th sample.
    Scipy,
}

/// Weights of the equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WeightsSpec {
    /// Ordinary least squares.
    None,
    /// One weight per joint.
    Joint,
    /// Huber.
    Robust,
}

/// Source of the joint velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VelocitySpec {
    /// Central differences of q.
    Derived,
    /// The log's own.
    Measured,
}

/// The `[drives]` table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DrivesSpec {
    /// N m (or N) per logged unit, one per moving joint; empty: none stated.
    pub gains: Vec<f64>,
    /// Coupling matrix, row-major, n x n; empty: identity. q_motor = C q_joint,
    /// tau_joint = C^T tau_motor.
    pub coupling: Vec<f64>,
    /// Whether the logged torque is the commanded one.
    pub commanded: bool,
}

/// The `[prior]` table: one sigma of the described values; infinite where nothing is stated, which
/// is then no knowledge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PriorSpec {
    /// Fraction of each link's mass.
    pub mass: f64,
    /// Centre of mass, m.
    pub com: f64,
    /// Centre of mass, fraction.
    pub com_fraction: f64,
    /// Fraction of the inertia tensor.
    pub inertia: f64,
    /// Rotation of the inertia tensor, rad.
    pub inertia_rotation: f64,
    /// Fraction of the rotor inertia.
    pub rotor_inertia: f64,
    /// Fraction of FV, FS.
    pub friction: f64,
}

/// A `[[link]]`: what is known of a body beside any log.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkSpec {
    /// A joint, for all that moves with it, or a link of a URDF. What follows is in the frame of
    /// that link, or of the joint's row; of a URDF's joint, in that of its child link.
    pub name: String,
    /// Mass of what moves with the joint, kg.
    pub mass: Option<f64>,
    /// Lowest and highest corner of a box around the mass, m.
    pub corners: Option<[[f64; 3]; 2]>,
    /// Planes that what moves with the joint is symmetric about.
    pub symmetric: Vec<MirrorPlane>,
    /// Where it is stated.
    pub span: Span,
}

/// A plane through the origin of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MirrorPlane {
    /// That of x and y.
    Xy,
    /// That of x and z.
    Xz,
    /// That of y and z.
    Yz,
}

impl MirrorPlane {
    /// The axis square to it, 0 to 2.
    pub fn normal(self) -> usize {
        match self {
            MirrorPlane::Yz => 0,
            MirrorPlane::Xz => 1,
            MirrorPlane::Xy => 2,
        }
    }
}
