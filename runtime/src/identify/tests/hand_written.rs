//! Small models written by hand, independent of any generator.

use std::borrow::Cow;

use crate::knowledge::Knowledge;
use crate::model::{
    Column, ColumnKind, Entry, IdentificationModel, Joint, JointKind, Output, Pattern, States,
};
use crate::settings::Settings;

/// One sample of the states of all joints.
pub struct Sample<'a> {
    pub q: &'a [f64],
    pub qd: &'a [f64],
    pub qdd: &'a [f64],
}

/// The non-zero entries of one output, each with its formula, at one sample.
type Formula = fn(&Sample<'_>) -> f64;

/// A model as a list of entries (row, column, formula) per output; every entry is a signal.
pub struct HandWritten {
    joints: Vec<Joint>,
    columns: Vec<Column>,
    outputs: [(Pattern, Vec<Formula>); 5],
    pub settings: Settings,
    pub knowledge: Knowledge,
}

impl HandWritten {
    /// `columns`: name, joint (from 1), kind.
    pub fn new(
        joints: &[(&'static str, JointKind)],
        columns: &[(&'static str, usize, ColumnKind)],
        outputs: [&[(usize, usize, Formula)]; 5],
    ) -> Self {
        let joint = |&(name, kind): &(&'static str, JointKind)| Joint {
            name: name.into(),
            kind,
        };
        HandWritten {
            joints: joints.iter().map(joint).collect(),
            columns: columns.iter().map(column).collect(),
            outputs: outputs.map(output),
            settings: Settings::default(),
            knowledge: Knowledge::NONE,
        }
    }

    /// The same robot with its columns in another order: column `k` is the old `order[k]`.
    pub fn permuted(&self, order: &[usize]) -> Self {
        let place = |old: usize| order.iter().position(|o| *o == old).unwrap();
        let permute = |(pattern, formulas): &(Pattern, Vec<Formula>)| {
            let moved = |e: &Entry| Entry {
                column: place(e.column),
                ..*e
            };
            let mut entries: Vec<Entry> = pattern.entries.iter().map(moved).collect();
            entries.sort_by_key(|e| (e.row, e.column));
            (
                Pattern {
                    entries: entries.into(),
                    signals: pattern.signals,
                },
                formulas.clone(),
            )
        };
        HandWritten {
            joints: self.joints.clone(),
            columns: order.iter().map(|k| self.columns[*k].clone()).collect(),
            outputs: std::array::from_fn(|k| permute(&self.outputs[k])),
            settings: self.settings.clone(),
            knowledge: self.knowledge.clone(),
        }
    }
}

fn column(&(name, joint, kind): &(&'static str, usize, ColumnKind)) -> Column {
    let text = Cow::Borrowed(name);
    Column {
        name: text.clone(),
        unit: "SI".into(),
        joint,
        kind,
        meaning: "".into(),
        relation: text,
    }
}

fn output(list: &[(usize, usize, Formula)]) -> (Pattern, Vec<Formula>) {
    let entry = |(signal, (row, column, _)): (usize, &(usize, usize, Formula))| Entry {
        row: *row,
        column: *column,
        signal,
    };
    let mut entries: Vec<Entry> = list.iter().enumerate().map(entry).collect();
    entries.sort_by_key(|e| (e.row, e.column));
    let formulas = list.iter().map(|(_, _, formula)| *formula).collect();
    (
        Pattern {
            entries: entries.into(),
            signals: list.len(),
        },
        formulas,
    )
}

impl IdentificationModel for HandWritten {
    fn name(&self) -> &str {
        "hand-written"
    }

    fn joints(&self) -> &[Joint] {
        &self.joints
    }

    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn pattern(&self, output: Output) -> &Pattern {
        &self.outputs[output as usize].0
    }

    fn settings(&self) -> &Settings {
        &self.settings
    }

    fn knowledge(&self) -> &Knowledge {
        &self.knowledge
    }

    fn evaluate(&self, output: Output, states: &States<'_>, signals: &mut [f64]) {
        let joints = self.joints.len();
        for i in 0..states.len {
            let at = |series: &[f64]| -> Vec<f64> {
                (0..joints).map(|j| series[j * states.len + i]).collect()
            };
            let (q, qd, qdd) = (at(states.q), at(states.qd), at(states.qdd));
            let sample = Sample {
                q: &q,
                qd: &qd,
                qdd: &qdd,
            };
            for (s, formula) in self.outputs[output as usize].1.iter().enumerate() {
                signals[s * states.len + i] = formula(&sample);
            }
        }
    }
}

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

/// EMPS: one prismatic joint, `tau = M qdd + FV qd + FS sign(qd) + OFF`.
pub fn emps() -> HandWritten {
    use ColumnKind::{Friction, Inertial};
    HandWritten::new(
        &[("carriage", JointKind::Prismatic)],
        &[
            ("M1", 1, Inertial),
            ("FV1", 1, Friction),
            ("FS1", 1, Friction),
            ("OFF1", 1, Friction),
        ],
        [
            &[
                (0, 0, |s| s.qdd[0]),
                (0, 1, |s| s.qd[0]),
                (0, 2, |s| sign(s.qd[0])),
                (0, 3, |_| 1.0),
            ],
            &[(0, 0, |s| s.qd[0])],
            &[
                (0, 1, |s| s.qd[0]),
                (0, 2, |s| sign(s.qd[0])),
                (0, 3, |_| 1.0),
            ],
            &[(0, 0, |s| 0.5 * s.qd[0] * s.qd[0])],
            &[
                (0, 1, |s| s.qd[0] * s.qd[0]),
                (0, 2, |s| s.qd[0].abs()),
                (0, 3, |s| s.qd[0]),
            ],
        ],
    )
}

/// The planar SCARA of Gautier 1996, section 7.1, with its two misprints corrected.
pub fn scara() -> HandWritten {
    use ColumnKind::{Friction, Inertial};
    HandWritten::new(
        &[
            ("shoulder", JointKind::Revolute),
            ("elbow", JointKind::Revolute),
        ],
        &[
            ("ZZR1", 1, Inertial),
            ("FV1", 1, Friction),
            ("FS1", 1, Friction),
            ("ZZ2", 2, Inertial),
            ("LMX2", 2, Inertial),
            ("LMY2", 2, Inertial),
            ("FV2", 2, Friction),
            ("FS2", 2, Friction),
        ],
        [
            &[
                (0, 0, |s| s.qdd[0]),
                (0, 1, |s| s.qd[0]),
                (0, 2, |s| sign(s.qd[0])),
                (0, 3, |s| s.qdd[0] + s.qdd[1]),
                (0, 4, |s| {
                    let (sin, cos) = s.q[1].sin_cos();
                    (2.0 * s.qdd[0] + s.qdd[1]) * cos - s.qd[1] * (2.0 * s.qd[0] + s.qd[1]) * sin
                }),
                (0, 5, |s| {
                    let (sin, cos) = s.q[1].sin_cos();
                    -(2.0 * s.qdd[0] + s.qdd[1]) * sin - s.qd[1] * (2.0 * s.qd[0] + s.qd[1]) * cos
                }),
                (1, 3, |s| s.qdd[0] + s.qdd[1]),
                (1, 4, |s| {
                    s.qdd[0] * s.q[1].cos() + s.qd[0] * s.qd[0] * s.q[1].sin()
                }),
                (1, 5, |s| {
                    s.qd[0] * s.qd[0] * s.q[1].cos() - s.qdd[0] * s.q[1].sin()
                }),
                (1, 6, |s| s.qd[1]),
                (1, 7, |s| sign(s.qd[1])),
            ],
            &[
                (0, 0, |s| s.qd[0]),
                (0, 3, |s| s.qd[0] + s.qd[1]),
                (0, 4, |s| (2.0 * s.qd[0] + s.qd[1]) * s.q[1].cos()),
                (0, 5, |s| -(2.0 * s.qd[0] + s.qd[1]) * s.q[1].sin()),
                (1, 3, |s| s.qd[0] + s.qd[1]),
                (1, 4, |s| s.qd[0] * s.q[1].cos()),
                (1, 5, |s| -s.qd[0] * s.q[1].sin()),
            ],
            &[
                (0, 1, |s| s.qd[0]),
                (0, 2, |s| sign(s.qd[0])),
                (1, 4, |s| s.qd[0] * (s.qd[0] + s.qd[1]) * s.q[1].sin()),
                (1, 5, |s| s.qd[0] * (s.qd[0] + s.qd[1]) * s.q[1].cos()),
                (1, 6, |s| s.qd[1]),
                (1, 7, |s| sign(s.qd[1])),
            ],
            &[
                (0, 0, |s| 0.5 * s.qd[0] * s.qd[0]),
                (0, 3, |s| 0.5 * (s.qd[0] + s.qd[1]).powi(2)),
                (0, 4, |s| s.qd[0] * (s.qd[0] + s.qd[1]) * s.q[1].cos()),
                (0, 5, |s| -s.qd[0] * (s.qd[0] + s.qd[1]) * s.q[1].sin()),
            ],
            &[
                (0, 1, |s| s.qd[0] * s.qd[0]),
                (0, 2, |s| s.qd[0].abs()),
                (0, 6, |s| s.qd[1] * s.qd[1]),
                (0, 7, |s| s.qd[1].abs()),
            ],
        ],
    )
}
