//! What has to be known of a robot to hide something in it.

use idim::codegen::describe::{Description, Geometry};
use idim::runtime::log::{Fourier, Reference};
use idim::runtime::simulate::{Grid, Trajectory, inverse_dynamics};

use super::machine::{Failure, Machine};
use super::motion::{RATE_HZ, samples};
use super::robots::Rating;

/// What has to be known of an individual to hide something in it.
pub struct Host {
    /// What its joints are built for.
    pub ratings: Vec<Rating>,
    /// Coulomb and viscous friction, rotor inertias, inertia that each gear carries.
    pub coulomb: Vec<f64>,
    pub viscous: Vec<f64>,
    pub rotor: Vec<f64>,
    pub carried: Vec<f64>,
    /// Largest torque and range of position along the training motion.
    pub peak: Vec<f64>,
    pub range: Vec<(f64, f64)>,
    /// Distance of each joint from the one before, m; 0 for the first.
    pub lengths: Vec<f64>,
    /// Mass of everything, kg.
    pub mass: f64,
}

/// What has to be known of an individual along its training motion.
pub fn host_of(
    description: &Description,
    machine: &Machine,
    ratings: &[Rating],
    motion: &Fourier,
) -> Result<Host, Failure> {
    let of = |symbol: &str| -> Vec<f64> {
        (1..=ratings.len())
            .map(|number| known(description, &format!("{symbol}{number}")))
            .collect()
    };
    let rotor = of("IA");
    let centers: Vec<f64> = ratings.iter().map(|rating| rating.center).collect();
    let inertias = machine.inertias(&centers)?;
    let grid = Grid {
        rate_hz: RATE_HZ,
        start: 0.0,
        len: samples(motion),
    };
    let trajectory = Trajectory::of(&Reference::Fourier(motion.clone()), &grid)?;
    let torque = inverse_dynamics(&machine.model, &machine.values, &trajectory)?;
    let ends = |q: &Vec<f64>| {
        let nothing = (f64::INFINITY, f64::NEG_INFINITY);
        q.iter()
            .fold(nothing, |(low, high), q| (low.min(*q), high.max(*q)))
    };
    let (mut lengths, mut mass) = (Vec::new(), 0.0);
    if let Geometry::Urdf(tree) = &description.geometry {
        let moving = tree
            .joints
            .iter()
            .filter(|joint| joint.name.starts_with("joint"));
        let length = |at: [f64; 3]| at.iter().map(|x| x * x).sum::<f64>().sqrt();
        lengths = moving.map(|joint| length(joint.origin.xyz)).collect();
        mass = tree
            .links
            .iter()
            .filter_map(|link| link.inertial)
            .map(|body| body.mass)
            .sum();
    }
    if let Some(first) = lengths.first_mut() {
        *first = 0.0;
    }
    Ok(Host {
        ratings: ratings.to_vec(),
        coulomb: of("FS"),
        viscous: of("FV"),
        carried: inertias
            .iter()
            .zip(&rotor)
            .map(|(all, rotor)| (all - rotor).max(1e-4))
            .collect(),
        rotor,
        peak: torque
            .iter()
            .map(|tau| tau.iter().fold(0.0, |a: f64, x| a.max(x.abs())))
            .collect(),
        range: trajectory.q.iter().map(ends).collect(),
        lengths,
        mass,
    })
}

fn known(description: &Description, name: &str) -> f64 {
    let all = &description.parameters;
    all.iter()
        .find(|(other, _)| other == name)
        .map_or(0.0, |(_, value)| *value)
}
