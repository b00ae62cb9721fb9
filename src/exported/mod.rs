//! From identified base parameters to bodies that exist, in a URDF.
//!
//! The way: base parameters with the metric of their log -> [`unknowns`] standard parameters of every
//! link -> [`physical`](idim_runtime::physical) bodies -> [`share`]d among the described bodies that
//! move together -> the URDF, which is read again and compared before anyone gets it.

mod metric;
mod share;
mod unknowns;

use idim_codegen::Robot;
use idim_codegen::builder::{self, BuildError};
use idim_codegen::emit::urdf::{self, UrdfError};
use idim_codegen::mechanism::{Mechanism, Standard};
use idim_runtime::physical::{Bodies, PhysicalError};

/// Frames of two descriptions of one robot differ by no more, m and rad.
const SAME_FRAME: f64 = 1e-6;

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

/// What is known beside the log, and how much the description counts.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Mass of all that moves, kg.
    pub total_mass: Option<f64>,
    /// Masses of what moves with a joint, by the name of the joint or of one of its links, kg.
    pub masses: Vec<(String, f64)>,
    /// How much the described bodies count where they and the data differ
    /// ([`idim_runtime::physical::Problem::weight`]).
    pub weight: f64,
    /// Whether links without a described inertia begin with a guess, a ball on the way to the
    /// next joint.
    pub fill: bool,
}

impl Default for Options {
    /// The description counts little against the data.
    fn default() -> Self {
        Options {
            total_mass: None,
            masses: Vec::new(),
            weight: 0.01,
            fill: false,
        }
    }
}

/// The robot as it leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct Exported {
    /// The URDF.
    pub urdf: String,
    /// What was found.
    pub bodies: Bodies,
    /// Names of the scalars among them: `IA1`, `FV1` and the like.
    pub scalars: Vec<String>,
    /// Links whose description is no body or was guessed, in a sentence each.
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
    Other(String),
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
    let carrier = urdf.map(|text| builder::read_texts(&[("robot.urdf", text)]));
    let carrier = carrier.transpose()?;
    let carrier = carrier
        .as_ref()
        .map_or(&robot.mechanism, |read| &read.mechanism);
    same_frames(&robot.mechanism, carrier)?;
    let following = &carrier.joints[carrier.driven..];
    if urdf.is_none() && !following.is_empty() {
        let names = following.iter().map(|joint| format!("`{}`", joint.name));
        return Err(ExportError::Follows(names.collect()));
    }
    let unknowns = unknowns::Unknowns::of(robot, carrier, options)?;
    let bodies = unknowns.problem(robot, identified, options)?.solve()?;
    let links: Vec<Standard> = bodies
        .links
        .iter()
        .map(|v| Standard::from_values(*v))
        .collect();
    let written = match urdf {
        Some(text) => urdf::rewrite(text, &share::shares(carrier, &links))?,
        None => urdf::fresh(carrier, &links),
    };
    reads_back(&written, &links)?;
    Ok(Exported {
        urdf: written,
        scalars: unknowns
            .scalars
            .into_iter()
            .map(|scalar| scalar.name)
            .collect(),
        warnings: unknowns.warnings,
        bodies,
    })
}

/// Whether two descriptions put the same frames on the same joints: only then do their standard
/// parameters mean the same.
fn same_frames(identified: &Mechanism, carrier: &Mechanism) -> Result<(), ExportError> {
    let (a, b) = (&identified.joints, &carrier.joints);
    if a.len() != b.len() {
        let message = format!(
            "it has {} moving joints, and {} were identified",
            b.len(),
            a.len()
        );
        return Err(ExportError::Other(message));
    }
    for (number, (a, b)) in a.iter().zip(b).enumerate() {
        let angles = [(a.gamma, b.gamma), (a.alpha, b.alpha), (a.theta, b.theta)];
        // The first frame is where the base is said to be.
        let turned = angles.iter().any(|(a, b)| {
            let apart = (a.value() - b.value()).rem_euclid(std::f64::consts::TAU);
            apart.min(std::f64::consts::TAU - apart) > SAME_FRAME
        });
        let moved = a
            .position
            .iter()
            .zip(b.position)
            .any(|(a, b)| (a - b).abs() > SAME_FRAME);
        if a.kind != b.kind || a.parent != b.parent || (a.parent.is_some() && (turned || moved)) {
            let (number, name) = (number + 1, &b.name);
            let message = format!("joint {number} (`{name}`) is elsewhere or another one");
            return Err(ExportError::Other(message));
        }
    }
    Ok(())
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
