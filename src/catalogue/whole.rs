//! The robot that a diagnosis found, to simulate: beside what a description can ask for, the base
//! turned, links of other lengths, gears that yield, forces from outside.

use std::collections::BTreeMap;

use idim_codegen::Robot;
use idim_codegen::base::BaseError;
use idim_codegen::catalogue::EffectKind;
use idim_codegen::mechanism::{self, Mechanism};
use idim_runtime::diagnose::EntryKind;
use idim_runtime::report::{Diagnosis, FoundEffect};
use idim_runtime::simulate::Influence;
use nalgebra::{Rotation3, Vector3};

use super::acting::Acting;
use super::geometry::{apply, changed, frame_change, inertial, standard_values};
use super::{Effects, Extension};

/// Torque under which a gear with play yields by a tenth of its gap, as a share of the largest.
const YIELDS: f64 = 0.1;

/// Highest resonance of a drive on the stops of its gear, rad/s: what short steps can follow.
const STIFFEST: f64 = 2500.0;

/// Damping of that resonance.
const STOPS_DAMPING: f64 = 0.05;

/// A gear of a [`Whole`] robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gear {
    /// The joint of its link, from 0, without a drive.
    pub link: usize,
    /// Stiffness, N m/rad or N/m.
    pub stiffness: f64,
    /// Play, rad or m.
    pub gap: f64,
}

/// A robot with everything of it that a diagnosis found.
#[derive(Debug)]
pub struct Whole {
    /// The robot; links behind gears are joints of their own.
    pub robot: Robot,
    /// Its base parameters, SI.
    pub parameters: Vec<f64>,
    /// The joints with a drive, from 0, in the order of the described robot's.
    pub driven: Vec<usize>,
    /// Its gears.
    pub gears: Vec<Gear>,
    /// Places in [`Diagnosis::effects`] of those that it has not, nor its drives and encoders.
    pub left_out: Vec<usize>,
}

/// What it is made from: ten values of each link, all other standard parameters by name.
struct Parts {
    mechanism: Mechanism,
    links: Vec<[f64; 10]>,
    others: BTreeMap<String, f64>,
    driven: Vec<usize>,
    gears: Vec<Gear>,
}

impl Effects {
    /// The robot that a diagnosis found; `largest` is the largest torque of each joint, N m or N,
    /// which tells how stiff the stops of a gear must at least be.
    ///
    /// # Errors
    /// [`BaseError`] if its base parameters are not clear.
    pub fn whole(
        &self,
        diagnosis: &Diagnosis,
        extension: &Extension,
        largest: &[f64],
    ) -> Result<Whole, BaseError> {
        let places = extension.elsewhere.iter().map(|(place, _)| *place);
        let found: Vec<(usize, &FoundEffect)> = places
            .filter_map(|place| Some((place, diagnosis.effects.get(place)?)))
            .collect();
        let mut description = extension.robot.description.clone();
        // Values are taken from here, and joints may be more than are described.
        description.prior = None;
        for (_, effect) in &found {
            let value = |k: usize| effect.parameters.get(k).map_or(0.0, |found| found.value);
            match effect.effect.as_str() {
                "base_tilt" => {
                    description.gravity = turned(description.gravity, value(0), value(1))
                }
                "link_length" => {
                    let joint = effect.joint.as_deref().unwrap_or_default();
                    description = changed(&description, joint, value(0)).unwrap_or(description);
                }
                _ => {}
            }
        }
        let mut parts = Parts::new(extension, Mechanism::new(&description));
        let mut left_out = Vec::new();
        for (place, effect) in found {
            let simulated = match effect.effect.as_str() {
                "joint_elasticity" | "backlash" => parts.split(effect, largest).is_some(),
                "base_tilt" | "link_length" => true,
                name => IN_PLANTS.contains(&name) || self.acts(effect),
            };
            if !simulated {
                left_out.push(place);
            }
        }
        let robot = Robot::of(description, parts.mechanism.clone())?;
        let value = |(factor, name): &(f64, String)| factor * parts.value(name);
        let parameters = robot.base.parameters.iter();
        Ok(Whole {
            parameters: parameters
                .map(|p| p.relation.iter().map(value).sum())
                .collect(),
            robot,
            driven: parts.driven,
            gears: parts.gears,
            left_out,
        })
    }

    /// Whether an effect acts by its own columns at a state.
    fn acts(&self, effect: &FoundEffect) -> bool {
        let known = |(hypothesis, _): &(idim_runtime::diagnose::Hypothesis, Vec<f64>)| {
            self.entries[hypothesis.entry].kind == EntryKind::Static
        };
        self.found(effect).filter(known).is_some()
    }

    /// What acts on a [`Whole`] robot by its own columns at each state: forces on the flange, and
    /// effects that the robot has already with another shape.
    pub fn influences<'a>(
        &'a self,
        diagnosis: &Diagnosis,
        extension: &Extension,
        whole: &Whole,
    ) -> Vec<Box<dyn Influence + 'a>> {
        let behind = |driven: usize| whole.gears.iter().filter(move |g| g.link == driven + 1);
        let places = whole.driven.iter();
        let places: Vec<Vec<usize>> = places
            .map(|&k| {
                [k].into_iter()
                    .chain(behind(k).map(|gear| gear.link))
                    .collect()
            })
            .collect();
        let effects = extension.elsewhere.iter();
        let effects = effects.filter_map(|(place, _)| diagnosis.effects.get(*place));
        let by_columns = effects.filter(|effect| {
            let name = effect.effect.as_str();
            let other = ["base_tilt", "link_length"].contains(&name) || IN_PLANTS.contains(&name);
            !other && self.acts(effect)
        });
        let acting = |effect: &FoundEffect| -> Option<Box<dyn Influence + 'a>> {
            let (hypothesis, shape) = self.found(effect)?;
            Some(Box::new(Acting {
                effects: self,
                hypothesis,
                shape,
                values: effect.parameters.iter().map(|p| p.value).collect(),
                places: places.clone(),
                dead_band: vec![SIGN; self.joints()],
                held: Vec::new(),
            }))
        };
        by_columns.filter_map(acting).collect()
    }
}

/// Velocity under which the sign of one is not certain in a simulation, rad/s or m/s.
const SIGN: f64 = 1e-3;

/// Effects of drives, encoders and friction that changes, which any plant can have.
const IN_PLANTS: [&str; 7] = [
    "drive_gain",
    "drive_saturation",
    "drive_dead_zone",
    "time_shift",
    "encoder_eccentricity",
    "friction_drift",
    "load_dependent_friction",
];

/// Gravity as a base sees it that is turned about x, then about y, rad.
fn turned(gravity: [f64; 3], x: f64, y: f64) -> [f64; 3] {
    let about = |axis, angle: f64| Rotation3::from_axis_angle(&axis, -angle);
    let seen = about(Vector3::y_axis(), y) * about(Vector3::x_axis(), x) * Vector3::from(gravity);
    seen.into()
}

impl Parts {
    /// Of an extended robot's parameters in a mechanism of other lengths or under other gravity.
    fn new(extension: &Extension, mechanism: Mechanism) -> Parts {
        let (robot, x) = (&extension.robot, &extension.parameters);
        let links = standard_values(robot, x);
        let moved = links
            .iter()
            .enumerate()
            .map(|(link, ten)| apply(&frame_change(&robot.mechanism, &mechanism, link), ten));
        let described = robot.description.parameters.iter();
        let described = described.filter(|(name, _)| inertial(name).is_none());
        let mut others: BTreeMap<String, f64> = described.cloned().collect();
        for (parameter, x) in robot.base.parameters.iter().zip(x) {
            if let Some((factor, own)) = parameter.relation.first()
                && inertial(own).is_none()
            {
                others.insert(own.clone(), x / factor);
            }
        }
        Parts {
            links: moved.collect(),
            driven: (0..mechanism.driven).collect(),
            mechanism,
            others,
            gears: Vec::new(),
        }
    }

    /// A standard parameter by its name.
    fn value(&self, name: &str) -> f64 {
        match inertial(name) {
            Some((link, place)) => self.links.get(link).map_or(0.0, |ten| ten[place]),
            None => self.others.get(name).copied().unwrap_or(0.0),
        }
    }

    /// Puts a gear behind a drive; `None` where no rotor is known that it could yield to, or where
    /// there is a gear already.
    fn split(&mut self, effect: &FoundEffect, largest: &[f64]) -> Option<()> {
        let [number] = effect.joints[..] else {
            return None;
        };
        let own = number.checked_sub(1)?;
        let drive = *self.driven.get(own)?;
        let rotor = self.value(&format!("IA{}", drive + 1));
        let known = self.gears.iter().any(|gear| gear.link == drive + 1);
        let value = effect.parameters.first()?.value;
        if known || rotor <= 0.0 || value <= 0.0 {
            return None;
        }
        let gear = match effect.effect.as_str() {
            "backlash" => {
                let least = largest.get(own)? / (YIELDS * value);
                Gear {
                    link: drive + 1,
                    stiffness: least.min(rotor * STIFFEST.powi(2)),
                    gap: value,
                }
            }
            _ => Gear {
                link: drive + 1,
                stiffness: 1.0 / value,
                gap: 0.0,
            },
        };
        let damping = match (effect.shape.get("f"), effect.shape.get("damping")) {
            (Some(f), Some(damping)) => {
                2.0 * damping * gear.stiffness / (std::f64::consts::TAU * f)
            }
            _ => 2.0 * STOPS_DAMPING * (gear.stiffness * rotor).sqrt(),
        };
        self.put(drive, gear, damping);
        Some(())
    }

    fn put(&mut self, drive: usize, gear: Gear, damping: f64) {
        self.mechanism = self.mechanism.with_gear(drive);
        self.links.insert(drive, [0.0; 10]);
        let renamed = |(name, value): (&String, &f64)| (renumbered(name, drive), *value);
        self.others = self.others.iter().map(renamed).collect();
        let later = |joint: usize| if joint > drive { joint + 1 } else { joint };
        self.driven.iter_mut().for_each(|k| *k = later(*k));
        self.gears.iter_mut().for_each(|g| g.link = later(g.link));
        let mut ask = |kind: EffectKind, shape: Vec<f64>| {
            self.mechanism.effects.push(mechanism::Effect {
                kind,
                joints: vec![gear.link],
                shape,
            });
        };
        ask(EffectKind::Viscous, vec![]);
        let symbol = match gear.gap > 0.0 {
            true => {
                for side in [1.0, -1.0] {
                    ask(EffectKind::EndStop, vec![0.5 * side * gear.gap, side]);
                }
                "KE"
            }
            false => {
                ask(EffectKind::Spring, vec![]);
                "K"
            }
        };
        let number = gear.link + 1;
        self.others.insert(format!("FV{number}"), damping);
        self.others
            .insert(format!("{symbol}{number}"), gear.stiffness);
        self.gears.push(gear);
    }
}

/// The name of a parameter of drives and friction once a joint came in behind `drive`.
fn renumbered(name: &str, drive: usize) -> String {
    let symbol = name.trim_end_matches(|c: char| c.is_ascii_digit());
    match name[symbol.len()..].parse::<usize>() {
        Ok(number) if number > drive + 1 => format!("{symbol}{}", number + 1),
        _ => name.to_owned(),
    }
}
