//! Named effects as a description asks for them: what `--write` adds, and the robot that has them.

use std::fmt::Write;

use idim_codegen::Robot;
use idim_codegen::base::BaseError;
use idim_codegen::catalogue::EffectKind;
use idim_codegen::describe::{EffectSpec, Span};
use idim_runtime::diagnose::Hypothesis;

use super::{CATALOGUE, Effects};

impl Effects {
    /// An effect with a shape as entries of a description; those that the robot has already are
    /// left out. Empty for what a description cannot ask for: corrections of signals and geometry,
    /// bodies, and what depends on the model's own torque.
    pub fn described(&self, hypothesis: &Hypothesis, shape: &[f64]) -> Vec<EffectSpec> {
        let kinds = CATALOGUE
            .get(hypothesis.entry)
            .map_or(&[][..], |effect| effect.described);
        let names = hypothesis.joints.iter();
        let names = names.filter_map(|&joint| self.robot.mechanism.joints.get(joint));
        let joints: Vec<String> = names.map(|joint| joint.name.clone()).collect();
        let spec = |kind: &EffectKind| EffectSpec {
            kind: *kind,
            joints: joints.clone(),
            shape: named(*kind, shape),
            span: Span { line: 0, column: 0 },
        };
        let known = |spec: &EffectSpec| {
            let mut present = self.robot.description.effects.iter();
            present.any(|other| (other.kind, &other.joints) == (spec.kind, &spec.joints))
        };
        kinds.iter().map(spec).filter(|spec| !known(spec)).collect()
    }

    /// An effect of the catalogue on one joint, counted from 0, with its default shape, as entries of
    /// a description; empty for what is not known, what the robot has already, and what a
    /// description cannot ask for.
    pub fn asked(&self, name: &str, joint: usize) -> Vec<EffectSpec> {
        let Some(entry) = CATALOGUE
            .iter()
            .position(|effect| effect.entry.name == name)
        else {
            return Vec::new();
        };
        let hypothesis = Hypothesis {
            entry,
            joints: vec![joint],
            grid: Vec::new(),
            bounds: Vec::new(),
            least: 0.0,
        };
        self.described(&hypothesis, &[])
    }

    /// Whether a description can ask for an effect.
    pub fn can_be_described(&self, name: &str) -> bool {
        let mut all = CATALOGUE.iter();
        all.any(|effect| effect.entry.name == name && !effect.described.is_empty())
    }

    /// The robot with further effects: a model whose columns are theirs too, to identify and to
    /// simulate with.
    ///
    /// # Errors
    /// [`BaseError`] if the columns of the effects cannot be told from those of the robot.
    pub fn extended(&self, specs: &[EffectSpec]) -> Result<Robot, BaseError> {
        let mut description = self.robot.description.clone();
        description.effects.extend_from_slice(specs);
        Robot::new(description)
    }
}

/// Values of a kind's shape parameters with their names.
fn named(kind: EffectKind, shape: &[f64]) -> Vec<(&'static str, f64)> {
    let parameters = kind.shapes().iter().enumerate();
    parameters
        .map(|(place, known)| {
            (
                known.name,
                shape.get(place).copied().unwrap_or(known.default),
            )
        })
        .collect()
}

/// `[[effect]]` tables for a description.
pub fn toml(specs: &[EffectSpec]) -> String {
    let mut text = String::new();
    for spec in specs {
        let _ = write!(text, "\n[[effect]]\nkind = \"{}\"\n", spec.kind.name());
        let quoted: Vec<String> = spec.joints.iter().map(|joint| quote(joint)).collect();
        let _ = match quoted.as_slice() {
            [joint] => writeln!(text, "joint = {joint}"),
            joints => writeln!(text, "joints = [{}]", joints.join(", ")),
        };
        for (name, value) in &spec.shape {
            let _ = writeln!(text, "{name} = {value:?}");
        }
    }
    text
}

/// A TOML basic string.
fn quote(text: &str) -> String {
    let mut quoted = String::from('"');
    for letter in text.chars() {
        match letter {
            '"' | '\\' => quoted.extend(['\\', letter]),
            letter if letter.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", letter as u32);
            }
            letter => quoted.push(letter),
        }
    }
    quoted.push('"');
    quoted
}
