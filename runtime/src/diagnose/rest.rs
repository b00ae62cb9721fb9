//! A model whose friction does not switch on noise: inside the dead band of a velocity, where its
//! sign is not certain, the torque runs straight from one side to the other.

use crate::knowledge::Knowledge;
use crate::model::{
    Column, ColumnKind, IdentificationModel, Joint, Output, Pattern, Presliding, States,
};
use crate::settings::Settings;

/// The model, and the velocity of each joint under which its sign is not certain.
pub(super) struct Rested<'a> {
    model: &'a dyn IdentificationModel,
    dead_band: Vec<f64>,
    /// Signals of D that only friction and effects use, with the row (joint) that they stand in.
    switching: Vec<(usize, usize)>,
}

impl<'a> Rested<'a> {
    pub fn new(model: &'a dyn IdentificationModel, dead_band: Vec<f64>) -> Self {
        let pattern = model.pattern(Output::Explicit);
        let smooth = |column: usize| {
            matches!(
                model.columns()[column].kind,
                ColumnKind::Inertial | ColumnKind::Drive
            )
        };
        let shared: Vec<usize> = pattern
            .entries
            .iter()
            .filter(|e| smooth(e.column))
            .map(|e| e.signal)
            .collect();
        let own = pattern
            .entries
            .iter()
            .filter(|e| !shared.contains(&e.signal));
        let mut switching: Vec<(usize, usize)> = own.map(|e| (e.signal, e.row)).collect();
        switching.sort_unstable();
        switching.dedup_by_key(|(signal, _)| *signal);
        Rested {
            model,
            dead_band,
            switching,
        }
    }

    /// The samples at which some joint is in its dead band, with all such joints at one side.
    fn beside(&self, states: &States<'_>, samples: &[usize], side: f64) -> [Vec<f64>; 4] {
        let gather = |series: &[f64]| -> Vec<f64> {
            series
                .chunks_exact(states.len)
                .flat_map(|s| samples.iter().map(|&i| s[i]))
                .collect()
        };
        let mut qd = gather(states.qd);
        for (series, band) in qd.chunks_exact_mut(samples.len()).zip(&self.dead_band) {
            let near = series.iter_mut().filter(|v| v.abs() < *band);
            near.for_each(|v| *v = side * band);
        }
        [
            gather(states.q),
            qd,
            gather(states.qdd),
            gather(states.slip),
        ]
    }
}

impl IdentificationModel for Rested<'_> {
    fn name(&self) -> &str {
        self.model.name()
    }
    fn joints(&self) -> &[Joint] {
        self.model.joints()
    }
    fn columns(&self) -> &[Column] {
        self.model.columns()
    }
    fn pattern(&self, output: Output) -> &Pattern {
        self.model.pattern(output)
    }
    fn settings(&self) -> &Settings {
        self.model.settings()
    }
    fn knowledge(&self) -> &Knowledge {
        self.model.knowledge()
    }
    fn presliding(&self) -> &[Presliding] {
        self.model.presliding()
    }
    fn evaluate(&self, output: Output, states: &States<'_>, signals: &mut [f64]) {
        self.model.evaluate(output, states, signals);
        let len = states.len;
        let slow = |i: &usize| {
            let mut joints = self.dead_band.iter().enumerate();
            joints.any(|(joint, band)| states.qd[joint * len + i].abs() < *band)
        };
        let samples: Vec<usize> = (0..len).filter(slow).collect();
        if output != Output::Explicit || samples.is_empty() {
            return;
        }
        let count = samples.len();
        let sides = [-1.0, 1.0].map(|side| {
            let [q, qd, qdd, slip] = self.beside(states, &samples, side);
            let beside = States {
                len: count,
                q: &q,
                qd: &qd,
                qdd: &qdd,
                slip: &slip,
            };
            let mut out = vec![0.0; self.pattern(output).signals * count];
            self.model.evaluate(output, &beside, &mut out);
            out
        });
        for &(signal, joint) in &self.switching {
            let band = self.dead_band[joint];
            for (k, &i) in samples.iter().enumerate() {
                let part = states.qd[joint * len + i] / band;
                if part.abs() < 1.0 {
                    let [below, above] = [0, 1].map(|side: usize| sides[side][signal * count + k]);
                    signals[signal * len + i] = 0.5 * ((1.0 - part) * below + (1.0 + part) * above);
                }
            }
        }
    }
}
