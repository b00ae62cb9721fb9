//! The state of the joints in the middle of a window: filtered, differentiated, at rest or not.

use super::taps::Taps;
use super::window::{Window, sums};
use super::{OnlineError, Options};
use crate::model::{IdentificationModel, States};
use crate::observe::slipped;
use crate::settings::Velocity;

/// How long a joint has been within a band.
#[derive(Clone, Copy, Debug, Default)]
struct Rest {
    /// Middle of the band, rad or m.
    anchor: f64,
    /// Samples since it was last left.
    still: usize,
}

/// Joint states, `lag` samples behind the newest sample.
#[derive(Clone, Debug)]
pub(super) struct JointStates {
    taps: Taps,
    velocity: Velocity,
    band: f64,
    rate_hz: f64,
    q: Window,
    qd: Window,
    tau: Window,
    rest: Vec<Rest>,
    /// One value per joint each.
    states: [Vec<f64>; 3],
    slip: Vec<f64>,
    torque: Vec<f64>,
    /// Whether each joint moves.
    pub moves: Vec<bool>,
}

impl JointStates {
    pub fn new(model: &dyn IdentificationModel, options: &Options) -> Result<Self, OnlineError> {
        let taps = Taps::new(options)?;
        let joints = model.joints().len();
        let window = |signals| Window::new(signals, taps.window());
        let measured = match options.velocity {
            Velocity::Measured => joints,
            Velocity::Derived => 0,
        };
        let remember = !model.presliding().is_empty();
        Ok(JointStates {
            q: window(joints),
            qd: window(measured),
            tau: Window::new(joints, taps.lag() + 1),
            taps,
            velocity: options.velocity,
            band: options.rest_band,
            rate_hz: options.rate_hz,
            rest: vec![Rest::default(); joints],
            states: std::array::from_fn(|_| vec![0.0; joints]),
            slip: vec![0.0; if remember { joints } else { 0 }],
            torque: vec![0.0; joints],
            moves: vec![false; joints],
        })
    }

    /// Samples between the newest and the states.
    pub fn lag(&self) -> usize {
        self.taps.lag()
    }

    /// Begins again after a gap.
    pub fn clear(&mut self) {
        self.q.clear();
        self.qd.clear();
        self.tau.clear();
        self.rest.fill(Rest::default());
    }

    /// Adds a checked sample; whether there are states now.
    pub fn push(&mut self, model: &dyn IdentificationModel, sample: [&[f64]; 3]) -> bool {
        let [q, qd, tau] = sample;
        self.q.push(q);
        self.tau.push(tau);
        if self.velocity == Velocity::Measured {
            self.qd.push(qd);
        }
        for (rest, q) in self.rest.iter_mut().zip(q) {
            match (q - rest.anchor).abs() <= 0.5 * self.band {
                true => rest.still += 1,
                false => {
                    *rest = Rest {
                        anchor: *q,
                        still: 1,
                    }
                }
            }
        }
        if !self.q.full() {
            return false;
        }
        self.filter();
        self.slide(model);
        true
    }

    /// Positions, velocities and accelerations; a joint at rest is held where it is.
    fn filter(&mut self) {
        let Taps {
            position,
            velocity,
            acceleration,
        } = &self.taps;
        let window = self.taps.window();
        for (joint, rest) in self.rest.iter().enumerate() {
            self.moves[joint] = self.band == 0.0 || rest.still < window;
            let state = match (self.moves[joint], self.velocity) {
                (false, _) => [rest.anchor, 0.0, 0.0],
                (true, Velocity::Derived) => {
                    sums(self.q.of(joint), [position, velocity, acceleration])
                }
                (true, Velocity::Measured) => {
                    let [q] = sums(self.q.of(joint), [position]);
                    let [qd, qdd] = sums(self.qd.of(joint), [position, velocity]);
                    [q, qd, qdd]
                }
            };
            for (series, value) in self.states.iter_mut().zip(state) {
                series[joint] = value;
            }
            self.torque[joint] = self.tau.of(joint)[0];
        }
    }

    /// Runs the presliding states of joints whose friction has a memory.
    fn slide(&mut self, model: &dyn IdentificationModel) {
        for memory in model.presliding() {
            if let Some(state) = self.slip.get_mut(memory.joint) {
                let qd = self.states[1][memory.joint];
                *state = slipped(*state, qd, self.rate_hz, memory.zs);
            }
        }
    }

    /// The states as a chunk of one sample.
    pub fn states(&self) -> States<'_> {
        States {
            len: 1,
            q: &self.states[0],
            qd: &self.states[1],
            qdd: &self.states[2],
            slip: &self.slip,
        }
    }

    /// Torques at the states, N m or N.
    pub fn torque(&self) -> &[f64] {
        &self.torque
    }

    /// Power of all motors at the states, W.
    pub fn power(&self) -> f64 {
        let pairs = self.torque.iter().zip(&self.states[1]);
        pairs.map(|(tau, qd)| tau * qd).sum()
    }
}
