//! The standard parameters behind the base parameters, and where each begins.

use idim_codegen::Robot;
use idim_codegen::knowledge;
use idim_codegen::mechanism::{Joint, Mechanism};
use idim_runtime::physical::{Known, Prior, Problem, Pseudo, Scalar};

use super::stated::Stated;
use super::{ExportError, Identified, Options, Plane};

/// Standard deviation of a mass that is stated, as a share of it.
const STATED: f64 = 1e-4;

/// Where a positive parameter begins that is neither described nor identified by itself, in its
/// unit.
const SMALL: f64 = 0.1;

/// A guessed link: mass per length, kg/m, radius of gyration as a share of its length, and the
/// shortest length taken, m.
const SLENDER: f64 = 15.0;
const ROUND: f64 = 0.25;
const SHORT: f64 = 0.1;

/// A parameter beside the inertial ones.
pub(super) struct Named {
    pub name: String,
    scalar: Scalar,
}

/// All unknowns.
pub(super) struct Unknowns {
    links: Vec<Prior>,
    pub scalars: Vec<Named>,
    known: Vec<Known>,
    /// Links and normals of planes of symmetry that the options state.
    pub planes: Vec<(usize, usize)>,
    pub warnings: Vec<String>,
}

impl Unknowns {
    /// Links from the bodies of the `carrier`, all else from the relations of the robot.
    pub fn of(
        robot: &Robot,
        carrier: &Mechanism,
        stated: &Stated<'_>,
        options: &Options,
    ) -> Result<Unknowns, ExportError> {
        let mut warnings = Vec::new();
        let links = links(carrier, options.fill, &mut warnings)?;
        Ok(Unknowns {
            scalars: scalars(robot),
            known: known(carrier, stated, options)?,
            planes: planes(carrier, options)?,
            links,
            warnings,
        })
    }

    /// The problem to solve.
    pub fn problem(
        &self,
        robot: &Robot,
        identified: &Identified,
        options: &Options,
    ) -> Result<Problem, ExportError> {
        let place = |name: &str| {
            inertial(name).unwrap_or_else(|| {
                let scalar = self.scalars.iter().position(|scalar| scalar.name == name);
                10 * self.links.len() + scalar.unwrap_or(0)
            })
        };
        let parameters = robot.base.parameters.iter();
        let map: Vec<Vec<(usize, f64)>> = parameters
            .map(|parameter| {
                let terms = parameter.relation.iter();
                terms.map(|(factor, name)| (place(name), *factor)).collect()
            })
            .collect();
        // A positive parameter that is a base parameter by itself begins where it was found.
        let mut scalars: Vec<Scalar> = self.scalars.iter().map(|s| s.scalar.clone()).collect();
        let first = 10 * self.links.len();
        for (row, value) in map.iter().zip(&identified.parameters) {
            if let [(at, factor)] = row[..]
                && let Some(Scalar::Positive(start)) = scalars.get_mut(at.wrapping_sub(first))
                && value / factor > 0.0
            {
                *start = value / factor;
            }
        }
        Ok(Problem {
            links: self.links.clone(),
            scalars,
            map,
            estimate: identified.parameters.clone(),
            precision: identified.precision.clone(),
            known: self.known.clone(),
            bounds: Vec::new(),
            mirrors: Vec::new(),
            weight: options.weight,
        })
    }
}

/// Place of an inertial parameter such as `XX3` among the unknowns.
fn inertial(name: &str) -> Option<usize> {
    knowledge::inertial(name).map(|(link, place)| 10 * link + place)
}

/// What stands in the relations beside inertial parameters, each once. Rotor inertias are
/// positive, and friction where it is viscous and Coulomb alone: beside other terms of friction,
/// neither is a friction by itself.
fn scalars(robot: &Robot) -> Vec<Named> {
    let relations = robot.base.parameters.iter().flat_map(|p| &p.relation);
    let mut names: Vec<&String> = Vec::new();
    for (_, name) in relations {
        if inertial(name).is_none() && !names.contains(&name) {
            names.push(name);
        }
    }
    let symbol = |name: &str| {
        name.trim_end_matches(|c: char| c.is_ascii_digit())
            .to_owned()
    };
    let plain = |number: &str| {
        let mut own = names
            .iter()
            .filter(|name| name[symbol(name).len()..] == *number);
        own.all(|name| !name.starts_with('F') || ["FV", "FS"].contains(&symbol(name).as_str()))
    };
    let mut named: Vec<Named> = Vec::new();
    for name in &names {
        let mut stated = robot.description.parameters.iter();
        let stated = stated.find(|(stated, value)| stated == *name && *value > 0.0);
        let positive = match symbol(name).as_str() {
            "IA" => true,
            "FV" | "FS" => plain(&name[symbol(name).len()..]),
            _ => false,
        };
        let scalar = match positive {
            true => Scalar::Positive(stated.map_or(SMALL, |(_, value)| *value)),
            false => Scalar::Free,
        };
        named.push(Named {
            name: (*name).clone(),
            scalar,
        });
    }
    named
}

fn links(
    mechanism: &Mechanism,
    fill: bool,
    warnings: &mut Vec<String>,
) -> Result<Vec<Prior>, ExportError> {
    let mut links = Vec::with_capacity(mechanism.joints.len());
    let mut missing = Vec::new();
    for (index, joint) in mechanism.joints.iter().enumerate() {
        let described = Prior::of(&joint.carried().values());
        match described {
            Some(prior) => {
                if prior.mended {
                    warnings.push(format!(
                        "What moves with `{}` is described as no body or as one that is too thin; \
                         where the log is silent, it is taken for the nearest one that exists.",
                        joint.name
                    ));
                }
                links.push(prior);
            }
            None => {
                missing.push(format!("`{}`", joint.name));
                links.push(Prior {
                    pseudo: guess(mechanism, index),
                    mended: false,
                });
            }
        }
    }
    match (missing.is_empty(), fill) {
        (true, _) => {}
        (false, true) => warnings.push(format!(
            "No inertia is described for what moves with {}: where the log is silent, it is a \
             guess from the distance to the next joint.",
            missing.join(", ")
        )),
        (false, false) => return Err(ExportError::NoInertia(missing)),
    }
    Ok(links)
}

/// A ball half-way to the next joint.
fn guess(mechanism: &Mechanism, link: usize) -> Pseudo {
    let next = mechanism
        .joints
        .iter()
        .find(|joint| joint.parent == Some(link));
    let to = next.map_or([0.0; 3], |joint| joint.position);
    let length = to.iter().map(|x| x * x).sum::<f64>().sqrt().max(SHORT);
    Pseudo::ball(SLENDER * length, ROUND * length, to.map(|x| 0.5 * x))
}

/// Masses that are stated; those of the options come before those of the description.
fn known(
    mechanism: &Mechanism,
    stated: &Stated<'_>,
    options: &Options,
) -> Result<Vec<Known>, ExportError> {
    let mass = |link: usize| 10 * link + 9;
    let known = |what: String, factors: Vec<(usize, f64)>, value: f64| Known {
        what,
        factors,
        sigma: STATED * value.abs(),
        value,
    };
    let mut all = Vec::new();
    if let Some(total) = options.total_mass.or(stated.total_mass) {
        let links = (0..mechanism.joints.len()).map(|link| (mass(link), 1.0));
        all.push(known(
            "mass of all that moves".into(),
            links.collect(),
            total,
        ));
    }
    let mut single: Vec<(usize, &str, f64)> = Vec::new();
    for (name, value) in &options.masses {
        single.push((link(mechanism, name)?, name, *value));
    }
    let options = single.len();
    for one in stated.masses() {
        if single[..options].iter().all(|before| before.0 != one.0) {
            single.push(one);
        }
    }
    let single = single.into_iter();
    all.extend(single.map(|(link, name, value)| {
        known(format!("mass of `{name}`"), vec![(mass(link), 1.0)], value)
    }));
    Ok(all)
}

/// Planes that links are symmetric about, by link and normal.
fn planes(mechanism: &Mechanism, options: &Options) -> Result<Vec<(usize, usize)>, ExportError> {
    let planes = options.symmetric.iter();
    let plane = |(name, plane): &(String, Plane)| Ok((link(mechanism, name)?, plane.normal()));
    planes.map(plane).collect()
}

/// The link that a joint or one of its bodies names.
fn link(mechanism: &Mechanism, name: &str) -> Result<usize, ExportError> {
    let is =
        |joint: &Joint| joint.name == name || joint.bodies.iter().any(|body| body.name == name);
    let found = mechanism.joints.iter().position(is);
    found.ok_or_else(|| ExportError::UnknownLink {
        name: name.to_owned(),
        known: mechanism
            .joints
            .iter()
            .map(|joint| joint.name.clone())
            .collect(),
    })
}
