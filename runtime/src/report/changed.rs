//! What has changed on a robot whose parameters are known.

use std::fmt::Write;

use serde::Serialize;

use super::diagnosed::place;
use super::table::significant;
use super::{Diagnosis, Estimated, FoundEffect, Verdict};

/// What a log shows against known parameters, in the words of the workshop; the effects of a
/// diagnosis have the same in theirs.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Changed {
    /// Where the known parameters come from.
    pub against: String,
    /// What is at the tool and was not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub payload: Option<AtTool>,
    /// What the torques must be multiplied with, by the known mass of the load.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque_scale: Option<TorqueScale>,
    /// Friction parameters that are others now.
    pub friction: Vec<FrictionChange>,
    /// All other changes.
    pub other: Vec<OtherChange>,
    /// When something touched the robot, and on which joints that was felt.
    pub contacts: Vec<Contact>,
}

/// A body at the tool.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AtTool {
    /// Mass, kg.
    pub mass: Estimated,
    /// First moments in the frame of the last link, kg m.
    pub moments: [Estimated; 3],
    /// Centre of mass in that frame, m; absent for a mass that is not positive.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub com: Option<[Estimated; 3]>,
}

/// What logged torques must be multiplied with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TorqueScale {
    /// Known mass of the load, kg.
    pub load_mass: f64,
    /// Known mass over the one found.
    pub factor: Estimated,
}

/// A friction parameter of a joint, as known and as it is now.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrictionChange {
    /// Name of the joint.
    pub joint: String,
    /// Its number, counted from 1.
    pub number: usize,
    /// Name of the parameter, such as `FS2`.
    pub parameter: String,
    /// SI unit.
    pub unit: String,
    /// As known; `None` where it is part of another parameter.
    pub before: Option<f64>,
    /// Change.
    pub change: Estimated,
}

/// Another change, in a sentence.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OtherChange {
    /// Name of the effect.
    pub effect: String,
    /// What has changed, by how much.
    pub what: String,
}

/// A stretch of a log in which something touched the robot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contact {
    /// Name of the log.
    pub log: String,
    /// Beginning in the time of the log, s.
    pub from_s: f64,
    /// End in the time of the log, s.
    pub to_s: f64,
    /// The joints that feel it, from the base on.
    pub joints: Vec<Touched>,
}

/// What a joint feels of a contact.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Touched {
    /// Name of the joint.
    pub joint: String,
    /// Its number, counted from 1.
    pub number: usize,
    /// Largest torque beyond what the model allows, N m or N.
    pub torque: f64,
    /// Unit of the torque.
    pub unit: String,
    /// Its strength in standard deviations of the model's own error.
    pub sigmas: f64,
}

impl Changed {
    /// From effects that were found against known parameters (name and value).
    pub fn new(
        against: &str,
        known: &[(&str, f64)],
        effects: &[FoundEffect],
        contacts: Vec<Contact>,
    ) -> Changed {
        let mut changed = Changed {
            against: against.to_owned(),
            contacts,
            ..Changed::default()
        };
        for effect in effects {
            match effect.effect.as_str() {
                "payload" => changed.payload = AtTool::of(effect),
                "friction_change" => changed.friction.extend(friction(effect, known)),
                _ => changed.other.push(other(effect)),
            }
        }
        changed
    }

    /// Whether nothing has changed.
    pub fn is_empty(&self) -> bool {
        let effects = self.friction.is_empty() && self.other.is_empty();
        effects && self.payload.is_none() && self.contacts.is_empty()
    }
}

impl AtTool {
    fn of(effect: &FoundEffect) -> Option<AtTool> {
        let value = |name: &str| {
            let found = effect.parameters.iter().find(|p| p.name == name);
            found.map(|p| Estimated {
                value: p.value,
                sigma: p.sigma,
            })
        };
        let nothing = Estimated {
            value: 0.0,
            sigma: None,
        };
        let mass = value("PM").unwrap_or(nothing);
        let moments = ["PMX", "PMY", "PMZ"].map(|name| value(name).unwrap_or(nothing));
        let known = mass.value > 0.0 && mass.sigma.is_some();
        let com = known.then(|| moments.map(|moment| ratio(moment, mass)));
        Some(AtTool { mass, moments, com })
    }

    /// The scale of the torques if this is a load of known mass, kg.
    pub(crate) fn scale(&self, load_mass: f64) -> TorqueScale {
        let known = Estimated {
            value: load_mass,
            sigma: Some(0.0),
        };
        TorqueScale {
            load_mass,
            factor: ratio(known, self.mass),
        }
    }
}

/// A quotient, its sigma as if both were independent.
fn ratio(above: Estimated, below: Estimated) -> Estimated {
    let value = above.value / below.value;
    let sigma = above.sigma.zip(below.sigma);
    Estimated {
        value,
        sigma: sigma.map(|(a, b)| a.hypot(value * b) / below.value.abs()),
    }
}

fn friction<'a>(
    effect: &'a FoundEffect,
    known: &'a [(&'a str, f64)],
) -> impl Iterator<Item = FrictionChange> + 'a {
    effect.parameters.iter().map(move |found| {
        let parameter = found.name.trim_start_matches('D').to_owned();
        let before = known.iter().find(|(name, _)| *name == parameter);
        FrictionChange {
            joint: effect.joint.clone().unwrap_or_default(),
            number: effect.joints.first().copied().unwrap_or_default(),
            before: before.map(|(_, value)| *value),
            unit: found.unit.clone(),
            change: Estimated {
                value: found.value,
                sigma: found.sigma,
            },
            parameter,
        }
    })
}

fn other(effect: &FoundEffect) -> OtherChange {
    let place = place(effect.joint.as_deref(), &effect.joints);
    let all = match (place.is_empty(), effect.effect.as_str()) {
        (true, "drive_gain" | "time_shift") => " on all joints".to_owned(),
        _ => place,
    };
    let values: Vec<String> = effect
        .parameters
        .iter()
        .map(in_words(&effect.effect))
        .collect();
    OtherChange {
        effect: effect.effect.clone(),
        what: format!("{}{all}: {}", title(&effect.effect), values.join(", ")),
    }
}

fn title(effect: &str) -> &str {
    match effect {
        "drive_gain" => "torque scale",
        "time_shift" => "delay",
        "base_tilt" => "base tilted",
        "rotor_inertia" => "rotor inertia",
        "external_force" => "constant force at the flange, all the time",
        "torque_offset" => "offset of the torque",
        other => other,
    }
}

/// A parameter as people say it.
fn in_words(effect: &str) -> impl Fn(&super::EffectParameter) -> String {
    let (factor, unit): (f64, _) = match effect {
        "drive_gain" => (100.0, Some("%")),
        "time_shift" => (-1e3, Some("ms (torque after motion)")),
        "base_tilt" => (1f64.to_degrees(), Some("deg")),
        _ => (1.0, None),
    };
    let named = matches!(effect, "base_tilt" | "external_force");
    move |found| {
        let sigma = found.sigma.map_or_else(String::new, |sigma| {
            format!(" +- {}", significant(sigma * factor.abs(), 2))
        });
        let sign = if found.value * factor > 0.0 && !named {
            "+"
        } else {
            ""
        };
        let name = if named {
            format!("{} ", found.name)
        } else {
            String::new()
        };
        let value = significant(found.value * factor, 3);
        format!("{name}{sign}{value}{sigma} {}", unit.unwrap_or(&found.unit))
    }
}

/// What has changed, in a line each; the first says it all.
pub(super) fn glance(diagnosis: &Diagnosis, changed: &Changed) -> String {
    let mut text = format!(
        "{}, known from {}: {}\n",
        diagnosis.robot,
        changed.against,
        sentence(diagnosis, changed)
    );
    let lines = lines(changed);
    if !lines.is_empty() {
        text.push_str("\nwhat has changed\n");
    }
    for line in lines {
        // Writing to a String does not fail.
        let _ = writeln!(text, "  {line}");
    }
    text
}

/// The verdict in a sentence.
pub(super) fn sentence(diagnosis: &Diagnosis, changed: &Changed) -> String {
    let effects = diagnosis.effects.len();
    match (diagnosis.verdict, effects, changed.contacts.len()) {
        (Verdict::Nothing, ..) => "nothing has changed that these logs could show".to_owned(),
        (Verdict::Unknown, 0, _) => {
            "something has changed that is none of the changes looked for".to_owned()
        }
        (Verdict::Unknown, ..) => {
            "something has changed; what was found helps and does not explain it".to_owned()
        }
        (Verdict::Named, 0, _) => "nothing but contact".to_owned(),
        (Verdict::Named, 1, 0) => "one thing has changed, and it explains the gap".to_owned(),
        (Verdict::Named, n, 0) => format!("{n} things have changed, and they explain the gap"),
        (Verdict::Named, 1, _) => "one thing has changed, and something touched it".to_owned(),
        (Verdict::Named, n, _) => format!("{n} things have changed, and something touched it"),
    }
}

/// What has changed, each in a line.
pub(super) fn lines(changed: &Changed) -> Vec<String> {
    let mut all = Vec::new();
    all.extend(changed.payload.as_ref().map(at_tool));
    all.extend(changed.torque_scale.as_ref().map(|s| scale(s, changed)));
    let frictions = changed.friction.chunk_by(|a, b| a.number == b.number);
    all.extend(frictions.map(friction_in_words));
    all.extend(changed.other.iter().map(|other| other.what.clone()));
    all.extend(changed.contacts.iter().map(contact));
    all
}

fn with_sigma(found: &Estimated, digits: usize) -> String {
    let sigma = found
        .sigma
        .map_or(String::new(), |s| format!(" +- {}", significant(s, 2)));
    format!("{}{sigma}", significant(found.value, digits))
}

fn at_tool(load: &AtTool) -> String {
    let three = |values: &[Estimated; 3]| {
        values
            .each_ref()
            .map(|value| with_sigma(value, 3))
            .join(", ")
    };
    let about = match &load.com {
        Some(com) => format!("centre of mass ({}) m", three(com)),
        None => format!("first moments ({}) kg m", three(&load.moments)),
    };
    let mass = with_sigma(&load.mass, 4);
    format!("payload at the tool: {mass} kg, {about} in the frame of the last link")
}

fn scale(scale: &TorqueScale, changed: &Changed) -> String {
    let off = 100.0 * (scale.factor.value - 1.0);
    let seen = changed.payload.as_ref().map_or(0.0, |load| load.mass.value);
    format!(
        "torque scale: {} kg read as {} kg: torques, and what was known from them, are {} % too {}; \
         multiply by {}",
        scale.load_mass,
        significant(seen, 4),
        significant(off.abs(), 2),
        if off > 0.0 { "small" } else { "large" },
        with_sigma(&scale.factor, 4)
    )
}

fn friction_in_words(changes: &[FrictionChange]) -> String {
    let one = |change: &FrictionChange| {
        let sigma = change
            .change
            .sigma
            .map_or(String::new(), |s| format!(" +- {}", significant(s, 2)));
        let by = change.change.value;
        let Some(before) = change.before else {
            return format!(
                "{} by {}{sigma} {}",
                change.parameter,
                significant(by, 3),
                change.unit
            );
        };
        let offset = change.parameter.starts_with("OFF");
        let share = match before > 0.0 && !offset {
            true => format!(" ({:+.0} %)", 100.0 * by / before),
            false => String::new(),
        };
        format!(
            "{} {} -> {}{sigma} {}{share}",
            change.parameter,
            significant(before, 3),
            significant(before + by, 3),
            change.unit
        )
    };
    // What has not changed by more than its error is not said.
    let clear = |change: &&FrictionChange| {
        let sigma = change.change.sigma.unwrap_or(f64::INFINITY);
        change.change.value.abs() > 2.0 * sigma
    };
    let said: Vec<String> = changes.iter().filter(clear).map(one).collect();
    let said = match said.is_empty() {
        true => changes.iter().map(one).collect(),
        false => said,
    };
    let place = changes.first().map(|c| place(Some(&c.joint), &[c.number]));
    format!("friction{}: {}", place.unwrap_or_default(), said.join(", "))
}

fn contact(contact: &Contact) -> String {
    let felt = |touched: &Touched| {
        let torque = significant(touched.torque, 2);
        format!("{} ({torque} {})", touched.joint, touched.unit)
    };
    let joints: Vec<String> = contact.joints.iter().map(felt).collect();
    let last = contact.joints.last().map_or(0, |touched| touched.number);
    format!(
        "contact {:.2} to {:.2} s, on link {last} or beyond: felt by {}",
        contact.from_s,
        contact.to_s,
        joints.join(", ")
    )
}
