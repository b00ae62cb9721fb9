//! Small models written by hand, from textbook equations.

use crate::model::{
    Column, ColumnKind, Entry, IdentificationModel, Joint, JointKind, Output, Pattern, States,
};
use crate::settings::Settings;

/// Gravity, m/s^2.
pub const G: f64 = 9.81;

/// q, qd, qdd of all joints.
type Sample = [Vec<f64>; 3];
type Formula = fn(&Sample) -> f64;

/// A model as lists of entries (row, column, formula): D, P, h; the other outputs are not needed.
pub struct Small {
    joints: Vec<Joint>,
    columns: Vec<Column>,
    patterns: [Pattern; 3],
    formulas: [Vec<Formula>; 3],
    none: Pattern,
    settings: Settings,
}

impl Small {
    fn new(joints: usize, names: &[&'static str], lists: [&[(usize, usize, Formula)]; 3]) -> Self {
        let column = |name: &&'static str| Column {
            name: (*name).into(),
            unit: "SI".into(),
            joint: 1,
            kind: ColumnKind::Inertial,
            meaning: "".into(),
            relation: "".into(),
        };
        let pattern = |list: &[(usize, usize, Formula)]| {
            let entries = list.iter().enumerate();
            let entry = |(signal, &(row, column, _)): (usize, &(usize, usize, Formula))| Entry {
                row,
                column,
                signal,
            };
            let entries: Vec<Entry> = entries.map(entry).collect();
            Pattern {
                entries: entries.into(),
                signals: list.len(),
            }
        };
        let joint = |j| Joint {
            name: format!("joint {j}").into(),
            kind: JointKind::Revolute,
        };
        Small {
            joints: (1..=joints).map(joint).collect(),
            columns: names.iter().map(column).collect(),
            patterns: lists.map(pattern),
            formulas: lists.map(|list| list.iter().map(|entry| entry.2).collect()),
            none: Pattern {
                entries: vec![].into(),
                signals: 0,
            },
            settings: Settings::default(),
        }
    }

    fn place(output: Output) -> Option<usize> {
        match output {
            Output::Explicit => Some(0),
            Output::Momentum => Some(1),
            Output::Energy => Some(2),
            Output::Rest | Output::Power => None,
        }
    }

    /// h X at a state, J.
    pub fn energy(&self, parameters: &[f64], q: &[f64], qd: &[f64]) -> f64 {
        let sample = [q.to_vec(), qd.to_vec(), vec![0.0; q.len()]];
        let formulas = self.patterns[2].entries.iter().zip(&self.formulas[2]);
        formulas
            .map(|(entry, h)| parameters[entry.column] * h(&sample))
            .sum()
    }
}

impl IdentificationModel for Small {
    fn name(&self) -> &str {
        "small"
    }
    fn joints(&self) -> &[Joint] {
        &self.joints
    }
    fn columns(&self) -> &[Column] {
        &self.columns
    }
    fn pattern(&self, output: Output) -> &Pattern {
        Small::place(output).map_or(&self.none, |place| &self.patterns[place])
    }
    fn settings(&self) -> &Settings {
        &self.settings
    }
    fn evaluate(&self, output: Output, states: &States<'_>, signals: &mut [f64]) {
        let Some(place) = Small::place(output) else {
            return;
        };
        for i in 0..states.len {
            let at = |series: &[f64]| -> Vec<f64> {
                (0..self.joints.len())
                    .map(|j| series[j * states.len + i])
                    .collect()
            };
            let sample = [at(states.q), at(states.qd), at(states.qdd)];
            for (s, formula) in self.formulas[place].iter().enumerate() {
                signals[s * states.len + i] = formula(&sample);
            }
        }
    }
}

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

/// One joint in a vertical plane, hanging at q = 0: parameters ZZ, MX, FV, FS.
pub fn pendulum() -> Small {
    Small::new(
        1,
        &["ZZ1", "MX1", "FV1", "FS1"],
        [
            &[
                (0, 0, |[_, _, qdd]| qdd[0]),
                (0, 1, |[q, _, _]| G * q[0].sin()),
                (0, 2, |[_, qd, _]| qd[0]),
                (0, 3, |[_, qd, _]| sign(qd[0])),
            ],
            &[(0, 0, |[_, qd, _]| qd[0])],
            &[
                (0, 0, |[_, qd, _]| 0.5 * qd[0] * qd[0]),
                (0, 1, |[q, _, _]| -G * q[0].cos()),
            ],
        ],
    )
}

/// Parameters of a frictionless double pendulum: two rods of 1 kg, the first of 0.5 m, the second
/// with its centre at 0.25 m.
pub const DOUBLE: [f64; 9] = [
    0.0833333 + 0.25,
    0.75,
    0.0833333,
    0.125,
    0.25,
    0.0,
    0.0,
    0.0,
    0.0,
];

/// Two joints in a vertical plane, hanging at q = 0: parameters ZZR1, MXR1, ZZ2, LMX2, MX2 (L = 0.5),
/// then FV1, FS1, FS2 and FSM, dry friction of a coupling: FSM sgn(qd1 + qd2) on both joints.
pub fn double_pendulum() -> Small {
    let (kinetic, first): (Formula, Formula) = (
        |[q, qd, _]| qd[0] * (qd[0] + qd[1]) * q[1].cos(),
        |[q, qd, qdd]| {
            let (s, c) = q[1].sin_cos();
            (2.0 * qdd[0] + qdd[1]) * c - qd[1] * (2.0 * qd[0] + qd[1]) * s
        },
    );
    Small::new(
        2,
        &[
            "ZZR1", "MXR1", "ZZ2", "LMX2", "MX2", "FV1", "FS1", "FS2", "FSM",
        ],
        [
            &[
                (0, 0, |[_, _, qdd]| qdd[0]),
                (0, 1, |[q, _, _]| G * q[0].sin()),
                (0, 2, |[_, _, qdd]| qdd[0] + qdd[1]),
                (0, 3, first),
                (0, 4, |[q, _, _]| G * (q[0] + q[1]).sin()),
                (0, 5, |[_, qd, _]| qd[0]),
                (0, 6, |[_, qd, _]| sign(qd[0])),
                (0, 8, |[_, qd, _]| sign(qd[0] + qd[1])),
                (1, 2, |[_, _, qdd]| qdd[0] + qdd[1]),
                (1, 3, |[q, qd, qdd]| {
                    qdd[0] * q[1].cos() + qd[0] * qd[0] * q[1].sin()
                }),
                (1, 4, |[q, _, _]| G * (q[0] + q[1]).sin()),
                (1, 7, |[_, qd, _]| sign(qd[1])),
                (1, 8, |[_, qd, _]| sign(qd[0] + qd[1])),
            ],
            &[
                (0, 0, |[_, qd, _]| qd[0]),
                (0, 2, |[_, qd, _]| qd[0] + qd[1]),
                (0, 3, |[q, qd, _]| (2.0 * qd[0] + qd[1]) * q[1].cos()),
                (1, 2, |[_, qd, _]| qd[0] + qd[1]),
                (1, 3, |[q, qd, _]| qd[0] * q[1].cos()),
            ],
            &[
                (0, 0, |[_, qd, _]| 0.5 * qd[0] * qd[0]),
                (0, 1, |[q, _, _]| -G * q[0].cos()),
                (0, 2, |[_, qd, _]| 0.5 * (qd[0] + qd[1]).powi(2)),
                (0, 3, kinetic),
                (0, 4, |[q, _, _]| -G * (q[0] + q[1]).cos()),
            ],
        ],
    )
}
