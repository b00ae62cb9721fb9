//! The catalogue along one motion: signals, and what several columns are made of.

use std::sync::OnceLock;

use idim_codegen::catalogue::EffectKind;
use idim_codegen::derive::effects::columns_in_noise;
use idim_codegen::expr::Graph;
use idim_codegen::mechanism::{self, JointKind};
use idim_runtime::diagnose::{Hypothesis, Signals, TorqueColumn};
use idim_runtime::signal::central_difference;

use super::evaluate::{Linear, Motion, Shift};
use super::geometry::{StandardValues, standard_values};
use super::{CATALOGUE, Effects};

/// Step of a position in central differences, rad or m.
const STEP: f64 = 1e-5;

/// Effects along signals.
pub(super) struct Along<'a> {
    pub effects: &'a Effects,
    pub signals: Signals<'a>,
    standard: OnceLock<StandardValues>,
    sensitivities: Vec<OnceLock<Sensitivity>>,
    /// The same of the links alone, which gears carry.
    link_sensitivities: Vec<OnceLock<Sensitivity>>,
    carried: OnceLock<Vec<Vec<f64>>>,
}

/// How the model's torque changes with the motion of one joint: on every joint, per rad (m) of
/// position, velocity, acceleration.
pub(super) struct Sensitivity {
    pub position: Vec<Vec<f64>>,
    pub velocity: Vec<Vec<f64>>,
    pub acceleration: Vec<Vec<f64>>,
}

/// A small displacement of a joint along the signals with its time derivatives.
pub(super) struct Displacement {
    pub position: Vec<f64>,
    pub velocity: Vec<f64>,
    pub acceleration: Vec<f64>,
}

impl Displacement {
    pub fn with_capacity(len: usize) -> Displacement {
        let none = || Vec::with_capacity(len);
        Displacement {
            position: none(),
            velocity: none(),
            acceleration: none(),
        }
    }

    /// One more sample.
    pub fn push(&mut self, position: f64, velocity: f64, acceleration: f64) {
        self.position.push(position);
        self.velocity.push(velocity);
        self.acceleration.push(acceleration);
    }

    /// So many times as large.
    pub fn times(mut self, factor: f64) -> Displacement {
        let all = [
            &mut self.position,
            &mut self.velocity,
            &mut self.acceleration,
        ];
        all.into_iter().flatten().for_each(|x| *x *= factor);
        self
    }
}

impl<'a> Along<'a> {
    pub fn new(effects: &'a Effects, signals: Signals<'a>) -> Along<'a> {
        let none = |_| OnceLock::new();
        Along {
            effects,
            signals,
            standard: OnceLock::new(),
            sensitivities: (0..effects.joints()).map(none).collect(),
            link_sensitivities: (0..effects.joints()).map(none).collect(),
            carried: OnceLock::new(),
        }
    }

    /// The columns of a hypothesis; none for one that is not of this robot.
    pub fn columns(&self, hypothesis: &Hypothesis, shape: &[f64]) -> Vec<TorqueColumn> {
        let joints = &hypothesis.joints;
        let known = joints.iter().all(|&joint| joint < self.effects.joints());
        match CATALOGUE.get(hypothesis.entry) {
            Some(effect) if known => (effect.columns)(self, joints, shape),
            _ => Vec::new(),
        }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.signals.t.len()
    }

    /// The motion as it is.
    pub fn motion(&self) -> Motion<'a> {
        Motion {
            q: self.signals.q,
            qd: self.signals.qd,
            qdd: self.signals.qdd,
            slip: None,
            still: false,
            shift: None,
        }
    }

    /// An effect as codegen defines it.
    pub fn defined(&self, kind: EffectKind, joints: &[usize], shape: &[f64]) -> Vec<TorqueColumn> {
        self.defined_along(&self.motion(), kind, joints, shape)
    }

    /// The same along a motion with its presliding state.
    pub fn defined_along(
        &self,
        motion: &Motion<'_>,
        kind: EffectKind,
        joints: &[usize],
        shape: &[f64],
    ) -> Vec<TorqueColumn> {
        let mut graph = Graph::new();
        let robot = &self.effects.robot.mechanism;
        let kinds: Vec<JointKind> = robot.driven().iter().map(|joint| joint.kind).collect();
        let effect = mechanism::Effect {
            kind,
            joints: joints.to_vec(),
            shape: shape.to_vec(),
        };
        let parameters = columns_in_noise(&mut graph, &kinds, &effect, self.signals.dead_band);
        let columns = parameters.iter().map(|p| p.columns.explicit.as_slice());
        let torques = Linear::new(&graph, kinds.len(), columns.enumerate()).columns(motion);
        let column = |(parameter, torque): (idim_codegen::derive::Standard, _)| TorqueColumn {
            name: parameter.name,
            unit: parameter.unit,
            torque,
        };
        parameters.into_iter().zip(torques).map(column).collect()
    }

    /// A column on one joint.
    pub fn column(
        &self,
        symbol: &str,
        unit: &'static str,
        joint: usize,
        torque: Vec<f64>,
    ) -> TorqueColumn {
        TorqueColumn {
            name: format!("{symbol}{}", joint + 1),
            unit,
            torque: vec![(joint, torque)],
        }
    }

    /// The unit of a force at a joint.
    pub fn force(&self, joint: usize) -> &'static str {
        self.by_kind(joint, "N m", "N")
    }

    pub fn by_kind(
        &self,
        joint: usize,
        turning: &'static str,
        sliding: &'static str,
    ) -> &'static str {
        match self.effects.is_revolute(joint) {
            true => turning,
            false => sliding,
        }
    }

    /// The sign of a joint's velocity, interpolated inside its dead band.
    pub fn sign(&self, joint: usize) -> Vec<f64> {
        let band = self.signals.dead_band.get(joint).copied().unwrap_or(0.0);
        let sign = |qd: &f64| match band > 0.0 {
            true => (qd / band).clamp(-1.0, 1.0),
            false if *qd == 0.0 => 0.0,
            false => qd.signum(),
        };
        self.signals.qd[joint].iter().map(sign).collect()
    }

    /// Derivative of a series in time.
    pub fn rate(&self, series: &[f64]) -> Vec<f64> {
        central_difference(series, self.signals.rate_hz)
    }

    /// The standard parameters that stand behind the present ones.
    pub fn standard(&self) -> &StandardValues {
        self.standard
            .get_or_init(|| standard_values(&self.effects.robot, self.signals.parameters))
    }

    /// Torque that the gears carry: that of the links, without rotors and friction on their drives'
    /// side.
    pub fn carried(&self) -> &[Vec<f64>] {
        self.carried.get_or_init(|| {
            let values: Vec<f64> = self.standard().iter().flatten().copied().collect();
            self.effects.links().torque(&self.motion(), &values)
        })
    }

    /// The change of the torque on every joint when drive and link of one joint are elsewhere than
    /// measured, to first order.
    pub fn displaced(&self, joint: usize, by: &Displacement) -> Vec<(usize, Vec<f64>)> {
        let all = || self.sensitivity(&self.effects.smooth, self.signals.parameters, joint);
        self.moved(self.sensitivities[joint].get_or_init(all), by)
    }

    /// The same when only the link is, its drive where it was measured.
    pub fn link_displaced(&self, joint: usize, by: &Displacement) -> Vec<(usize, Vec<f64>)> {
        self.moved(self.link_sensitivity(joint), by)
    }

    /// How the torque of the links changes with the motion of one of them.
    pub fn link_sensitivity(&self, joint: usize) -> &Sensitivity {
        self.link_sensitivities[joint].get_or_init(|| {
            let values: Vec<f64> = self.standard().iter().flatten().copied().collect();
            self.sensitivity(self.effects.links(), &values, joint)
        })
    }

    fn moved(&self, sensitivity: &Sensitivity, by: &Displacement) -> Vec<(usize, Vec<f64>)> {
        let torque = |on: usize| -> Vec<f64> {
            let (a, b, c) = (
                &sensitivity.position[on],
                &sensitivity.velocity[on],
                &sensitivity.acceleration[on],
            );
            let position = a.iter().zip(&by.position);
            let velocity = b.iter().zip(&by.velocity);
            let acceleration = c.iter().zip(&by.acceleration);
            let terms = position.zip(velocity).zip(acceleration);
            terms
                .map(|(((a, z), (b, zd)), (c, zdd))| a * z + b * zd + c * zdd)
                .collect()
        };
        (0..self.effects.joints())
            .map(|on| (on, torque(on)))
            .collect()
    }

    /// Central differences: exact for velocity and acceleration, in which the torque of rigid
    /// bodies is quadratic and linear.
    fn sensitivity(&self, model: &Linear, parameters: &[f64], joint: usize) -> Sensitivity {
        let at = |shift: Shift| {
            let motion = Motion {
                shift: Some(shift),
                ..self.motion()
            };
            model.torque(&motion, parameters)
        };
        let difference = |shift: fn(usize, f64) -> Shift, step: f64| {
            let (mut up, down) = (at(shift(joint, step)), at(shift(joint, -step)));
            for (up, down) in up.iter_mut().zip(&down) {
                let pairs = up.iter_mut().zip(down);
                pairs.for_each(|(up, down)| *up = (*up - down) / (2.0 * step));
            }
            up
        };
        Sensitivity {
            position: difference(Shift::Position, STEP),
            velocity: difference(Shift::Velocity, 1.0),
            acceleration: difference(Shift::Acceleration, 1.0),
        }
    }
}
