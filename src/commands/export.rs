//! `idim export`: identified, physically consistent inertias in a URDF.

mod identified;
mod show;

use std::path::PathBuf;

use idim::codegen::mechanism::Joint;
use idim::codegen::mechanism::alignment::{Alignment, Displaced};
use idim::exported::{self, Exported, Options, Plane};
use idim::interpreted::Interpreter;
use serde::Serialize;

use super::{Failure, output, robot};

/// Arguments of `idim export`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Name of a built-in robot, or path of a .urdf, .toml or .par: the one that was identified.
    robot: String,
    /// Parameters: the JSON of `idim identify --json`, or a TOML with a [parameters] table.
    #[arg(long, value_name = "FILE")]
    parameters: PathBuf,
    /// URDF of the robot that gets the inertias; without it, a new one of the robot's frames is made.
    #[arg(long, value_name = "FILE")]
    urdf: Option<PathBuf>,
    /// Where the URDF goes; standard output if absent.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Known mass of all that moves, kg.
    #[arg(long, value_name = "KG")]
    total_mass: Option<f64>,
    /// Known mass of what moves with a joint (or its link), kg; may be repeated.
    #[arg(long = "mass", value_name = "NAME=KG", value_parser = named)]
    masses: Vec<(String, f64)>,
    /// How much the described inertias count against the log; 1: as if they were known to about
    /// their own size.
    #[arg(long, value_name = "X", default_value_t = Options::default().weight)]
    weight: f64,
    /// Begin with a guess where no inertia is described.
    #[arg(long)]
    fill: bool,
    /// Write viscous and Coulomb friction into <dynamics> of the joints.
    #[arg(long)]
    friction: bool,
    /// Keep the mass of each link inside of the shape that the URDF gives it: box, cylinder or sphere.
    #[arg(long, requires = "urdf")]
    boxes: bool,
    /// What moves with a joint (or its link) is symmetric about a plane of its identified frame (see
    /// `idim describe`): xy, xz or yz; may be repeated.
    #[arg(long, value_name = "NAME=PLANE", value_parser = symmetric)]
    symmetric: Vec<(String, Plane)>,
    /// Write bodies and parameters as JSON; `-` for standard output.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Print nothing but what was asked for as a file.
    #[arg(long)]
    quiet: bool,
}

fn named(text: &str) -> Result<(String, f64), String> {
    let parts = text.rsplit_once('=');
    let parts = parts.and_then(|(name, mass)| Some((name.to_owned(), mass.parse().ok()?)));
    parts.ok_or_else(|| "write NAME=KG, such as link_3=4.2".to_owned())
}

fn symmetric(text: &str) -> Result<(String, Plane), String> {
    let plane = |plane: &str| match plane {
        "xy" => Some(Plane::Xy),
        "xz" => Some(Plane::Xz),
        "yz" => Some(Plane::Yz),
        _ => None,
    };
    let parts = text.rsplit_once('=');
    let parts = parts.and_then(|(name, word)| Some((name.to_owned(), plane(word)?)));
    parts.ok_or_else(|| "write NAME=xy, NAME=xz or NAME=yz, such as link_3=xz".to_owned())
}

/// One base parameter before and after.
#[derive(Debug, Serialize)]
struct Parameter {
    name: String,
    unit: String,
    /// Identified value and its standard deviation, SI.
    identified: f64,
    sigma: Option<f64>,
    /// Value of the exported bodies.
    exported: f64,
}

/// What moves with a joint, in the frame of the link (see `idim describe`).
#[derive(Debug, Serialize)]
struct Link {
    joint: String,
    /// kg.
    mass: f64,
    /// m.
    center_of_mass: [f64; 3],
    /// About the centre of mass, kg m^2, ascending.
    principal_moments: [f64; 3],
    /// XX XY XZ YY YZ ZZ MX MY MZ M about the frame's origin, SI.
    standard: [f64; 10],
}

/// A rotor inertia, friction or other parameter beside the links.
#[derive(Debug, Serialize)]
struct Other {
    name: String,
    value: f64,
}

/// Where the URDF puts a link's frame in the identified one.
#[derive(Debug, Serialize)]
struct Frame {
    joint: String,
    /// The URDF's position of the joint is `sign` times the identified one plus `zero`, rad or m.
    sign: f64,
    zero: f64,
    /// Origin of the URDF's frame in the identified one, m.
    xyz: [f64; 3],
    /// Its axes by rows: `x = rotation x_urdf + xyz`.
    rotation: [[f64; 3]; 3],
}

/// `<dynamics>` of a joint, SI.
#[derive(Debug, Serialize)]
struct Dynamics {
    joint: String,
    damping: Option<f64>,
    friction: Option<f64>,
}

/// The JSON of `export`.
#[derive(Debug, Serialize)]
struct Report {
    robot: String,
    /// In the identified frames.
    links: Vec<Link>,
    /// Frames of the URDF; empty where they are the identified ones.
    frames: Vec<Frame>,
    /// How far the frames are apart at random poses, m and rad.
    frames_apart: Option<f64>,
    /// Friction written, with `--friction`.
    dynamics: Vec<Dynamics>,
    others: Vec<Other>,
    parameters: Vec<Parameter>,
    /// Distance of all parameters from the identified ones, in standard deviations squared, and
    /// their number: bodies explain what was measured if it is not much larger.
    distance: f64,
    warnings: Vec<String>,
}

/// Exports.
///
/// # Errors
/// [`Failure`] when a file cannot be read, used or written, or when there are no such bodies.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let robot = robot::derived(&arguments.robot)?;
    let model = Interpreter::new(&robot);
    let found = identified::read(&arguments.parameters, &model, &robot)?;
    let text = arguments.urdf.as_ref().map(|path| {
        std::fs::read_to_string(path).map_err(|error| Failure::Parameters {
            path: path.clone(),
            message: error.to_string(),
        })
    });
    let options = Options {
        total_mass: arguments.total_mass,
        masses: arguments.masses.clone(),
        weight: arguments.weight,
        // A new URDF has no description to begin with.
        fill: arguments.fill || arguments.urdf.is_none(),
        friction: arguments.friction,
        boxes: arguments.boxes,
        symmetric: arguments.symmetric.clone(),
    };
    let exported = exported::export(
        &robot,
        text.transpose()?.as_deref(),
        &found.identified,
        &options,
    )?;
    let report = report(&robot, &found, &exported);
    match &arguments.output {
        Some(path) => output::write_whole(path, &exported.urdf)?,
        None if output::claims_stdout(arguments.json.as_deref()) => {}
        None => output::print(&exported.urdf)?,
    }
    if let Some(path) = &arguments.json {
        output::json(path, &report)?;
    }
    let silent = arguments.output.is_none() || output::claims_stdout(arguments.json.as_deref());
    match arguments.quiet || silent {
        true => Ok(()),
        false => output::print(&show::text(&report)),
    }
}

fn report(robot: &idim::codegen::Robot, found: &identified::Found, exported: &Exported) -> Report {
    let joints = robot.mechanism.joints.iter();
    let links = joints.zip(&exported.bodies.links);
    let parameters = robot.base.parameters.iter().enumerate();
    Report {
        robot: robot.mechanism.name.clone(),
        links: links
            .map(|(joint, values)| show::link(&joint.name, values))
            .collect(),
        frames: exported
            .frames
            .as_ref()
            .map_or(Vec::new(), |found| frames(robot, found)),
        frames_apart: exported.frames.as_ref().map(|found| found.apart),
        dynamics: exported
            .friction
            .iter()
            .map(|(joint, dynamics)| Dynamics {
                joint: joint.clone(),
                damping: dynamics.damping,
                friction: dynamics.friction,
            })
            .collect(),
        others: exported
            .scalars
            .iter()
            .zip(&exported.bodies.scalars)
            .map(|(name, value)| Other {
                name: name.clone(),
                value: *value,
            })
            .collect(),
        parameters: parameters
            .map(|(k, parameter)| Parameter {
                name: parameter.name.clone(),
                unit: parameter.unit.clone(),
                identified: found.identified.parameters[k],
                sigma: found.sigma[k],
                exported: exported.bodies.parameters[k],
            })
            .collect(),
        distance: exported.bodies.distance,
        warnings: exported.warnings.clone(),
    }
}

fn frames(robot: &idim::codegen::Robot, found: &Alignment) -> Vec<Frame> {
    if found.is_identity() {
        return Vec::new();
    }
    let links = robot.mechanism.joints.iter().zip(&found.links);
    let frame = |(joint, link): (&Joint, &Displaced)| {
        let row = |i: usize| std::array::from_fn(|k| link.pose.rotation[(i, k)] + 0.0);
        Frame {
            joint: joint.name.clone(),
            sign: link.sign,
            zero: link.zero + 0.0,
            xyz: link.pose.translation.into(),
            rotation: std::array::from_fn(row),
        }
    };
    links.map(frame).collect()
}
