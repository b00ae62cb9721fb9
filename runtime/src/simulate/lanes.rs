//! A few states side by side through one output of a model, in buffers that stay.

use crate::model::{IdentificationModel, Output, States};

/// Reusable states and signals of one output, for up to a fixed number of states at once.
#[derive(Debug)]
pub(super) struct Lanes {
    output: Output,
    joints: usize,
    len: usize,
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
    slip: Vec<f64>,
    signals: Vec<f64>,
}

impl Lanes {
    pub(super) fn new(model: &dyn IdentificationModel, output: Output, capacity: usize) -> Self {
        let joints = model.joints().len();
        let states = || vec![0.0; joints * capacity];
        let signals = vec![0.0; model.pattern(output).signals * capacity];
        Lanes {
            output,
            joints,
            len: 0,
            q: states(),
            qd: states(),
            qdd: states(),
            slip: states(),
            signals,
        }
    }

    /// Makes room for `len` states, all of them at `q` with the velocity `qd` and no acceleration.
    pub(super) fn fill(&mut self, len: usize, q: &[f64], qd: &[f64]) {
        self.len = len;
        for joint in 0..self.joints {
            self.q[joint * len..][..len].fill(q[joint]);
            self.qd[joint * len..][..len].fill(qd[joint]);
            self.qdd[joint * len..][..len].fill(0.0);
        }
    }

    /// Adds to the velocity of a state.
    pub(super) fn push(&mut self, state: usize, factor: f64, direction: &[f64]) {
        for (joint, component) in direction.iter().enumerate() {
            self.qd[joint * self.len + state] += factor * component;
        }
    }

    /// Sets one velocity of a state.
    pub(super) fn set_velocity(&mut self, state: usize, joint: usize, qd: f64) {
        self.qd[joint * self.len + state] = qd;
    }

    /// Sets the acceleration of all states.
    pub(super) fn accelerate(&mut self, qdd: &[f64]) {
        for (joint, qdd) in qdd.iter().enumerate() {
            self.qdd[joint * self.len..][..self.len].fill(*qdd);
        }
    }

    /// Evaluates the output with the presliding states of the joints, or where all slide.
    pub(super) fn run(&mut self, model: &dyn IdentificationModel, slip: &[f64]) {
        let (len, values) = (self.len, self.joints * self.len);
        let count = model.pattern(self.output).signals;
        if count == 0 || len == 0 {
            return;
        }
        for (joint, slip) in slip.iter().enumerate() {
            self.slip[joint * len..][..len].fill(*slip);
        }
        let slip = match slip.is_empty() {
            true => &[][..],
            false => &self.slip[..values],
        };
        let states = States {
            len,
            q: &self.q[..values],
            qd: &self.qd[..values],
            qdd: &self.qdd[..values],
            slip,
        };
        model.evaluate(self.output, &states, &mut self.signals[..count * len]);
    }

    /// Value of a signal at a state.
    pub(super) fn signal(&self, signal: usize, state: usize) -> f64 {
        self.signals[signal * self.len + state]
    }
}
