//! Torques along a motion, and columns that no model has.

use idim::runtime::model::{ColumnKind, IdentificationModel, Output, States};
use idim::runtime::observe::Motion;

use super::Oracle;
use super::rows::sign;
use crate::cases::hidden::Hidden;
use crate::cases::motion::RATE_HZ;

/// A column: joints of the model and torque.
pub type Column = Vec<(usize, Vec<f64>)>;

impl Oracle<'_> {
    /// Columns that the model has not: joint of the model and torque, along a motion that begins at
    /// a time of the log, s.
    pub(super) fn extra(&self, motion: &Motion, begin: f64) -> Vec<Column> {
        let mut columns = Vec::new();
        for effect in self.effects {
            match effect.hidden {
                Hidden::Drift { joint, time, .. } => {
                    let at = self.machine.driven[joint];
                    let warm = |k: usize| -(-(begin + k as f64 / RATE_HZ) / time).exp_m1();
                    let qd = &motion.qd[at];
                    columns.push(vec![(
                        at,
                        (0..qd.len()).map(|k| warm(k) * sign(qd[k])).collect(),
                    )]);
                    columns.push(vec![(at, (0..qd.len()).map(|k| warm(k) * qd[k]).collect())]);
                }
                Hidden::Load { joint, .. } => {
                    let at = self.machine.driven[joint];
                    let load = product(&self.machine.model, &self.rigid_values(), motion);
                    let pairs = load[at].iter().zip(&motion.qd[at]);
                    columns.push(vec![(
                        at,
                        pairs.map(|(load, qd)| load.abs() * sign(*qd)).collect(),
                    )]);
                }
                _ => {}
            }
        }
        for (model, values, window) in &self.machine.forces {
            let still = Motion {
                qd: motion.qd.iter().map(|qd| vec![0.0; qd.len()]).collect(),
                qdd: motion.qd.iter().map(|qd| vec![0.0; qd.len()]).collect(),
                ..motion.clone()
            };
            let within = |k: usize| {
                let t = begin + k as f64 / RATE_HZ;
                window.as_ref().is_none_or(|window| window.contains(&t))
            };
            let mut torque = product(model, values, &still);
            for series in &mut torque {
                let outside = series.iter_mut().enumerate().filter(|(k, _)| !within(*k));
                outside.for_each(|(_, torque)| *torque = 0.0);
            }
            columns.push(torque.into_iter().enumerate().collect());
        }
        columns
    }

    /// The described rigid bodies and rotors alone.
    fn rigid_values(&self) -> Vec<f64> {
        let columns = self
            .machine
            .model
            .columns()
            .iter()
            .zip(&self.machine.values);
        columns
            .map(|(column, value)| match column.kind {
                ColumnKind::Inertial | ColumnKind::Drive => *value,
                ColumnKind::Friction | ColumnKind::Effect => 0.0,
            })
            .collect()
    }
}

/// D X along a motion.
pub fn product(model: &dyn IdentificationModel, x: &[f64], motion: &Motion) -> Vec<Vec<f64>> {
    const BLOCK: usize = 512;
    let pattern = model.pattern(Output::Explicit);
    let mut tau = vec![vec![0.0; motion.len]; model.joints().len()];
    let mut signals = Vec::new();
    for start in (0..motion.len).step_by(BLOCK) {
        let end = motion.len.min(start + BLOCK);
        let part = |series: &[Vec<f64>]| -> Vec<f64> {
            series
                .iter()
                .flat_map(|s| &s[start..end])
                .copied()
                .collect()
        };
        let [q, qd, qdd, slip] =
            [&motion.q, &motion.qd, &motion.qdd, &motion.slip].map(|s| part(s));
        let len = end - start;
        signals.resize(pattern.signals * len, 0.0);
        let states = States {
            len,
            q: &q,
            qd: &qd,
            qdd: &qdd,
            slip: &slip,
        };
        model.evaluate(Output::Explicit, &states, &mut signals);
        for entry in pattern.entries.iter() {
            let signal = &signals[entry.signal * len..][..len];
            let sums = tau[entry.row][start..end].iter_mut().zip(signal);
            sums.for_each(|(sum, value)| *sum += x[entry.column] * value);
        }
    }
    tau
}
