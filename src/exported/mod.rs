//! From identified base parameters to bodies that exist, in a URDF.
//!
//! The way: base parameters with the metric of their log -> [`unknowns`] standard parameters of every
//! link -> [`physical`](idim_runtime::physical) bodies -> [`frames`] of the URDF's own links ->
//! [`share`]d among the described bodies that move together -> the URDF, with [`friction`] if asked
//! for, which is read again and compared before anyone gets it.

mod boxes;
mod frames;
mod friction;
mod metric;
mod share;
mod stated;
mod turned;
mod unknowns;

pub use idim_codegen::describe::MirrorPlane as Plane;

use idim_codegen::Robot;
use idim_codegen::builder::{self, BuildError};
use idim_codegen::describe::shapes::ShapeError;
use idim_codegen::emit::urdf::{self, Dynamics, UrdfError};
use idim_codegen::mechanism::Standard;
use idim_codegen::mechanism::alignment::{AlignError, Alignment};
use idim_runtime::physical::{Bodies, PhysicalError};

use frames::Carrier;
use stated::Stated;
use turned::Turned;

/// Values read again differ by no more than this share of their body's size.
const SAME_VALUE: f64 = 1e-9;

/// What an identification found: np values and their inverse covariance.
#[derive(Clone, Debug, PartialEq)]
pub struct Identified {
    /// Base parameters in the order of the robot's columns, SI.
    pub parameters: Vec<f64>,
    /// np x np, row-major.
    pub precision: Vec<f64>,
}

/// What is known beside the log and the description's own `total_mass` and `[[link]]`, and how much
/// the description counts.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Mass of all that moves, kg; comes before the description's.
    pub total_mass: Option<f64>,
    /// Masses of what moves with a joint, by the name of the joint or of one of its links, kg;
    /// come before the description's.
    pub masses: Vec<(String, f64)>,
    /// How much the described bodies count where they and the data differ
    /// ([`idim_runtime::physical::Problem::weight`]).
    pub weight: f64,
    /// Whether links without a described inertia begin with a guess, a ball on the way to the
    /// next joint.
    pub fill: bool,
    /// Whether viscous and Coulomb friction go into the URDF.
    pub friction: bool,
    /// Whether the mass of links is inside of the shapes that the URDF gives them.
    pub boxes: bool,
    /// Links that are symmetric about a plane of their identified frame, by the name of the joint
    /// or of one of its links; come before the description's.
    pub symmetric: Vec<(String, Plane)>,
}

impl Default for Options {
    /// The description counts little against the data.
    fn default() -> Self {
        Options {
            total_mass: None,
            masses: Vec::new(),
            weight: 0.01,
            fill: false,
            friction: false,
            boxes: false,
            symmetric: Vec::new(),
        }
    }
}

/// The robot as it leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct Exported {
    /// The URDF.
    pub urdf: String,
    /// What was found, in the link frames that were identified.
    pub bodies: Bodies,
    /// Where the URDF puts its link frames in those that were identified; `None` without a URDF.
    pub frames: Option<Alignment>,
    /// Friction that was written, by the name of the joint.
    pub friction: Vec<(String, Dynamics)>,
    /// Names of the scalars among them: `IA1`, `FV1` and the like.
    pub scalars: Vec<String>,
    /// What is to be known of the URDF, in a sentence each: links whose description is no body or
    /// was guessed, where gravity falls, friction that a URDF has no words for.
    pub warnings: Vec<String>,
}

/// Why there is no URDF.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// No bodies with such parameters.
    #[error(transparent)]
    Physical(#[from] PhysicalError),
    /// The URDF is not one.
    #[error(transparent)]
    Urdf(#[from] UrdfError),
    /// The URDF cannot be read as a robot.
    #[error(transparent)]
    Description(#[from] BuildError),
    /// The URDF is of another robot.
    #[error(
        "the URDF is not of the robot that was identified: {0}; identify with a .toml that has \
         `urdf = ` this file"
    )]
    Other(#[from] AlignError),
    /// Joints that follow others, which a new URDF has no words for.
    #[error(
        "{} follow other joints, and a new URDF would let them hang loose; name the robot's own with \
         --urdf",
        .0.join(", ")
    )]
    Follows(Vec<String>),
    /// Links that move and have no inertia to begin with.
    #[error(
        "no inertia is described for what moves with {}: the log says nothing of some of its \
         directions; describe it, even roughly, or ask for a guess with --fill",
        .0.join(", ")
    )]
    NoInertia(Vec<String>),
    /// A mass of something that is not there.
    #[error("there is no joint or moving link `{name}`; there are {}", known.join(", "))]
    UnknownLink {
        /// What was named.
        name: String,
        /// What could be.
        known: Vec<String>,
    },
    /// What was written does not say what it should.
    #[error("the written URDF reads back differently at link {0}: please report this")]
    Defect(usize),
    /// Planes of symmetry in two frames of one body.
    #[error(
        "the planes that what moves with `{0}` is symmetric about are stated in two frames; state \
         them in one [[link]] alone"
    )]
    Planes(String),
    /// A shape that is none.
    #[error(transparent)]
    Shapes(#[from] ShapeError),
    /// No shapes to stay inside of.
    #[error(
        "no moving link has a shape that is read: --boxes takes <box>, <cylinder> and <sphere> of \
         <collision> or <visual> in the file of --urdf, and no meshes; give the links such shapes, or \
         leave it out; or state a box in [[link]] of the description"
    )]
    NoShapes,
    /// No friction to write.
    #[error(
        "no friction was identified: the robot's model has neither FV nor FS; add \"viscous\" and \
         \"coulomb\" to its `effects` and identify again, or leave out --friction"
    )]
    NoFriction,
}

/// Finds the bodies and writes them into the text of a URDF, or into a new one of the robot's own
/// frames.
///
/// # Errors
/// [`ExportError`].
pub fn export(
    robot: &Robot,
    urdf: Option<&str>,
    identified: &Identified,
    options: &Options,
) -> Result<Exported, ExportError> {
    let carrier = Carrier::of(robot, urdf)?;
    let stated = Stated::of(robot)?;
    let mut unknowns = unknowns::Unknowns::of(robot, &carrier.mechanism, &stated, options)?;
    let mut warnings = carrier.warnings();
    warnings.append(&mut unknowns.warnings);
    let mut problem = unknowns.problem(robot, identified, options)?;
    let shapes = urdf.filter(|_| options.boxes);
    if options.boxes || stated.has_boxes() {
        let joints = [&robot.mechanism, &carrier.mechanism];
        problem.bounds = boxes::of(joints, &stated, shapes, &mut warnings)?;
    }
    let planes = stated.planes(&robot.mechanism.joints, &unknowns.planes)?;
    let (turned, mirrors) = Turned::of(problem.links.len(), &planes);
    problem.mirrors = mirrors;
    let bodies = turned.back(turned.problem(problem).solve()?);
    let names: Vec<String> = unknowns.scalars.into_iter().map(|s| s.name).collect();
    let friction = match options.friction {
        true => friction::of(&carrier.mechanism, &names, &bodies.scalars, &mut warnings)?,
        false => Vec::new(),
    };
    let links = bodies.links.iter();
    let links: Vec<Standard> = links.map(|v| Standard::from_values(*v)).collect();
    let written = match urdf {
        Some(text) => urdf::rewrite(text, &share::shares(&carrier.mechanism, &links))?,
        None => urdf::fresh(&carrier.mechanism, &links),
    };
    let written = urdf::with_dynamics(&written, &friction)?;
    reads_back(&written, &carrier.own(&links))?;
    friction::reads_back(&written, &friction)?;
    Ok(Exported {
        urdf: written,
        frames: carrier.frames,
        scalars: names,
        friction,
        warnings,
        bodies,
    })
}

/// Whether a reader of the written text finds these links.
fn reads_back(text: &str, links: &[Standard]) -> Result<(), ExportError> {
    let read = builder::read_texts(&[("robot.urdf", text)])?;
    for (number, (joint, wanted)) in read.mechanism.joints.iter().zip(links).enumerate() {
        let found = joint.carried();
        let size = wanted.inertia.trace() + wanted.moment.norm() + wanted.mass;
        let pairs = found.values().into_iter().zip(wanted.values());
        if pairs
            .into_iter()
            .any(|(a, b)| (a - b).abs() > SAME_VALUE * size)
        {
            return Err(ExportError::Defect(number + 1));
        }
    }
    Ok(())
}
