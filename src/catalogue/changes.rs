//! What can change on a robot whose parameters are known: the entries of the catalogue that base
//! parameters would hide otherwise, and friction.

use idim_codegen::derive::ParameterKind;
use idim_runtime::diagnose::{
    Catalogue, ColumnsAlong, Entry, EntryKind, Hypothesis, Signals, TorqueColumn,
};

use super::along::Along;
use super::drive::DRIVE_GAIN;
use super::reach::{Reach, plain};
use super::{CATALOGUE, Effects};

/// What can change without a part being replaced or worn.
const ASKED: [&str; 7] = [
    "payload",
    "drive_gain",
    "time_shift",
    "base_tilt",
    "external_force",
    "rotor_inertia",
    "torque_offset",
];

/// Friction of a joint other than it was, in the model's own parameters.
pub(super) const FRICTION_CHANGE: &str = "friction_change";

/// The entry after those of the catalogue.
fn friction_change() -> Entry {
    Entry {
        name: FRICTION_CHANGE,
        meaning: "friction of a joint other than in the known model",
        formula: "DFV qd + DFS sgn(qd) + DOFF",
        parameters: &[("DFV", "N m s/rad"), ("DFS", "N m"), ("DOFF", "N m")],
        shape: &[],
        confused_with: &["drive_gain", "torque_offset"],
        experiment: "the joint moved alone, slow and fast, in both directions, cold and warm",
        kind: EntryKind::Static,
        hidden_by_parameters: true,
    }
}

/// The changes of a robot whose parameters are known.
#[derive(Debug)]
pub struct Changes<'a> {
    effects: &'a Effects,
    entries: Vec<Entry>,
}

impl<'a> Changes<'a> {
    /// Those of the robot of a catalogue.
    pub fn new(effects: &'a Effects) -> Self {
        let mut entries = effects.entries.clone();
        entries.push(friction_change());
        Changes { effects, entries }
    }

    fn is_friction(&self, hypothesis: &Hypothesis) -> bool {
        hypothesis.entry == CATALOGUE.len()
    }

    /// The friction parameters that the model has on a joint, of FV, FS and OFF.
    fn friction(&self, joint: usize) -> impl Iterator<Item = &'static str> {
        let parameters = &self.effects.robot.base.parameters;
        ["FV", "FS", "OFF"].into_iter().filter(move |symbol| {
            let name = format!("{symbol}{}", joint + 1);
            let mut own = parameters
                .iter()
                .filter(|p| p.kind == ParameterKind::Friction);
            own.any(|p| p.relation.iter().any(|(_, standard)| *standard == name))
        })
    }
}

impl Catalogue for Changes<'_> {
    fn entries(&self) -> &[Entry] {
        &self.entries
    }

    fn hypotheses(&self, signals: &Signals<'_>) -> Vec<Hypothesis> {
        let asked = |hypothesis: &Hypothesis| ASKED.contains(&self.entries[hypothesis.entry].name);
        let mut all = self.effects.hypotheses(signals);
        all.retain(asked);
        let reach = Reach::new(signals);
        let with = |joint: &usize| self.friction(*joint).next().is_some();
        let friction = reach.moving().filter(with).map(|joint| Hypothesis {
            entry: CATALOGUE.len(),
            ..plain(vec![joint])
        });
        all.extend(friction);
        let gain = CATALOGUE
            .iter()
            .position(|e| e.entry.name == DRIVE_GAIN.entry.name);
        // One scale of all torques.
        all.extend(
            gain.filter(|_| self.effects.joints() > 1)
                .map(|entry| Hypothesis {
                    entry,
                    ..plain(vec![])
                }),
        );
        all
    }

    fn columns(
        &self,
        hypothesis: &Hypothesis,
        shape: &[f64],
        signals: &Signals<'_>,
    ) -> Vec<TorqueColumn> {
        self.along(*signals)(hypothesis, shape)
    }

    fn along<'b>(&'b self, signals: Signals<'b>) -> ColumnsAlong<'b> {
        let along = Along::new(self.effects, signals);
        Box::new(move |hypothesis, shape| match hypothesis.joints[..] {
            [joint] if self.is_friction(hypothesis) => {
                let own = self.friction(joint);
                own.map(|symbol| friction(&along, joint, symbol)).collect()
            }
            _ => along.columns(hypothesis, shape),
        })
    }

    fn implausible(
        &self,
        hypothesis: &Hypothesis,
        shape: &[f64],
        values: &[f64],
    ) -> Option<String> {
        self.effects.implausible(hypothesis, shape, values)
    }
}

/// The torque of one more unit of a friction parameter.
fn friction(along: &Along<'_>, joint: usize, symbol: &str) -> TorqueColumn {
    let (unit, torque) = match symbol {
        "FV" => {
            let unit = along.by_kind(joint, "N m s/rad", "N s/m");
            (unit, along.signals.qd[joint].clone())
        }
        "FS" => (along.force(joint), along.sign(joint)),
        _ => (along.force(joint), vec![1.0; along.len()]),
    };
    along.column(&format!("D{symbol}"), unit, joint, torque)
}
