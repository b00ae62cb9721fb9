//! What a diagnosis found, as a robot: its description with the effects and its parameters.

use std::collections::BTreeMap;

use idim_codegen::Robot;
use idim_codegen::base::BaseError;
use idim_codegen::describe::EffectSpec;
use idim_runtime::diagnose::Hypothesis;
use idim_runtime::report::{Diagnosis, FoundEffect};

use super::changes::FRICTION_CHANGE;
use super::{CATALOGUE, Effects};

/// The effect that is a part of the last link.
const PAYLOAD: &str = "payload";

/// A robot with the effects that a diagnosis found.
#[derive(Debug)]
pub struct Extension {
    /// The effects as entries of a description.
    pub specs: Vec<EffectSpec>,
    /// The robot that has them.
    pub robot: Robot,
    /// Its base parameters, refitted, in the order of its columns; SI.
    pub parameters: Vec<f64>,
    /// Effects that no description can ask for: place in [`Diagnosis::effects`], and where it
    /// belongs instead.
    pub elsewhere: Vec<(usize, &'static str)>,
}

impl Effects {
    /// The robot with what a diagnosis of it found.
    ///
    /// # Errors
    /// [`BaseError`] if the columns of the effects cannot be told from those of the robot.
    pub fn extension(&self, diagnosis: &Diagnosis) -> Result<Extension, BaseError> {
        let mut specs: Vec<EffectSpec> = Vec::new();
        let mut elsewhere = Vec::new();
        let mut standard = self.standard(diagnosis);
        for (place, effect) in diagnosis.effects.iter().enumerate() {
            if effect.effect == FRICTION_CHANGE {
                self.add(effect, &mut standard);
                continue;
            }
            let entries = self
                .found(effect)
                .and_then(|(hypothesis, shape)| self.written(&hypothesis, &shape));
            // A description takes an effect on a joint once.
            let twice = |new: &EffectSpec| specs.iter().any(|old| same(old, new) && old != new);
            let Some(entries) = entries.filter(|new| !new.iter().any(twice)) else {
                elsewhere.push((place, belongs(&effect.effect)));
                continue;
            };
            for new in entries {
                if !specs.iter().any(|old| same(old, &new)) {
                    specs.push(new);
                }
            }
            self.add(effect, &mut standard);
        }
        let robot = self.extended(&specs)?;
        let value = |(factor, name): &(f64, String)| factor * standard.get(name).unwrap_or(&0.0);
        let parameters = robot.base.parameters.iter();
        let parameters = parameters.map(|p| p.relation.iter().map(value).sum());
        Ok(Extension {
            parameters: parameters.collect(),
            specs,
            robot,
            elsewhere,
        })
    }

    /// Adds the parameters of an effect to the standard ones.
    fn add(&self, effect: &FoundEffect, standard: &mut BTreeMap<String, f64>) {
        for parameter in &effect.parameters {
            let name = self.standard_name(&effect.effect, &parameter.name);
            *standard.entry(name).or_default() += parameter.value;
        }
    }

    /// The standard parameter that a parameter of an effect is: a body at the tool is part of the
    /// last link, all others have their own names.
    fn standard_name(&self, effect: &str, parameter: &str) -> String {
        match (effect, parameter.strip_prefix(['P', 'D'])) {
            (PAYLOAD, Some(own)) => format!("{own}{}", self.joints()),
            (FRICTION_CHANGE, Some(own)) => own.to_owned(),
            _ => parameter.to_owned(),
        }
    }

    /// Standard parameters that give the refitted base parameters: each in the one that it is
    /// named after. Torques depend on no other choice.
    fn standard(&self, diagnosis: &Diagnosis) -> BTreeMap<String, f64> {
        let refitted = |name: &str| {
            let mut parameters = diagnosis.parameters.iter();
            parameters.find(|parameter| parameter.name == name)
        };
        let base = self.robot.base.parameters.iter();
        base.filter_map(|parameter| {
            let (factor, own) = parameter.relation.first()?;
            Some((own.clone(), refitted(&parameter.name)?.after.value / factor))
        })
        .collect()
    }

    /// A found effect as a hypothesis with its shape; `None` for one of another catalogue.
    pub(super) fn found(&self, effect: &FoundEffect) -> Option<(Hypothesis, Vec<f64>)> {
        let entry = self.entries.iter().position(|e| e.name == effect.effect)?;
        let shape = self.entries[entry].shape.iter();
        let shape: Option<Vec<f64>> = shape
            .map(|(name, _)| effect.shape.get(*name).copied())
            .collect();
        let hypothesis = Hypothesis {
            entry,
            joints: effect
                .joints
                .iter()
                .filter_map(|j| j.checked_sub(1))
                .collect(),
            grid: Vec::new(),
            bounds: Vec::new(),
            least: 0.0,
        };
        Some((hypothesis, shape?))
    }

    /// What a description has to say for an effect; `None` if it cannot, or has the same effect on
    /// the same joints with another shape already.
    fn written(&self, hypothesis: &Hypothesis, shape: &[f64]) -> Option<Vec<EffectSpec>> {
        let effect = CATALOGUE.get(hypothesis.entry)?;
        if effect.entry.name == PAYLOAD {
            return Some(Vec::new());
        }
        let kinds = effect.described;
        let specs = self.described(hypothesis, shape);
        let wanted = |kind: &&idim_codegen::catalogue::EffectKind| !kind.shapes().is_empty();
        let shaped = kinds.iter().filter(wanted).count();
        let there = specs.iter().filter(|s| !s.shape.is_empty()).count();
        (!kinds.is_empty() && there == shaped).then_some(specs)
    }
}

fn same(one: &EffectSpec, other: &EffectSpec) -> bool {
    (one.kind, &one.joints) == (other.kind, &other.joints)
}

/// Where an effect belongs that no `[[effect]]` can ask for.
fn belongs(effect: &str) -> &'static str {
    match effect {
        "base_tilt" => "`gravity`, turned by these angles",
        "external_force" => "nowhere in a description: it is an event of this log",
        "load_dependent_friction" => {
            "the gear; a description cannot ask for friction that depends on the model's own torque"
        }
        "drive_gain" => "`[drives] gains`: divide the joint's gain by 1 + DG",
        "drive_saturation" | "drive_dead_zone" => {
            "the drive: calibrate its current or torque against a known load"
        }
        "time_shift" => "the clock of the log: shift the torque by TSH before it is read",
        "link_length" => "the geometry: the distance of the joint from its antecedent",
        "encoder_eccentricity" => "the position channel: add the error to q before it is read",
        "friction_drift" => {
            "nowhere in a description: friction of a robot that warms up; log it warm"
        }
        "joint_elasticity" | "backlash" => {
            "the gear; a description has rigid links, so motor and joint are one"
        }
        _ => "the same effect on the same joint, which the description has with another shape",
    }
}
