//! The catalogue along one motion: signals, and what several columns are made of.

use std::sync::OnceLock;

use idim_codegen::catalogue::EffectKind;
use idim_codegen::derive::effects::columns_in_noise;
use idim_codegen::expr::Graph;
use idim_codegen::mechanism::{self, JointKind};
use idim_runtime::diagnose::{Hypothesis, Signals, TorqueColumn};
use idim_runtime::signal::central_difference;

use super::evaluate::{Linear, Motion};
use super::geometry::{StandardValues, standard_values};
use super::sensitivity::{Sensitivity, sensitivity};
use super::{CATALOGUE, Effects};

/// Effects along signals.
pub(super) struct Along<'a> {
    pub effects: &'a Effects,
    pub signals: Signals<'a>,
    standard: OnceLock<StandardValues>,
    sensitivities: Vec<OnceLock<Sensitivity>>,
    /// The same of the links alone, which gears carry: where joints follow others.
    link_sensitivities: Vec<OnceLock<Sensitivity>>,
    beside_links: Vec<OnceLock<BesideLinks>>,
    carried: OnceLock<Vec<Vec<f64>>>,
}

/// What is not of the links in such a change: on every joint, per velocity and acceleration of one,
/// the same along the whole motion.
struct BesideLinks {
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
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
            beside_links: (0..effects.joints()).map(|_| OnceLock::new()).collect(),
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
        self.moved(self.sensitivity(joint), |_| [0.0; 2], by)
    }

    /// The same when only the link is, its drive where it was measured.
    pub fn link_displaced(&self, joint: usize, by: &Displacement) -> Vec<(usize, Vec<f64>)> {
        let (all, beside) = self.link_sensitivity(joint);
        let less = |on: usize| [beside.velocity[on], beside.acceleration[on]];
        self.moved(all, less, by)
    }

    /// How the torque that the gear of a joint carries changes with acceleration, velocity and
    /// position of its link, at each sample.
    pub fn carried_by(&self, joint: usize) -> impl Fn(usize) -> [f64; 3] {
        let (all, beside) = self.link_sensitivity(joint);
        move |i| {
            [
                all.acceleration[joint][i] - beside.acceleration[joint],
                all.velocity[joint][i] - beside.velocity[joint],
                all.position[joint][i],
            ]
        }
    }

    /// How the model's torque changes with the motion of a joint.
    fn sensitivity(&self, joint: usize) -> &Sensitivity {
        self.sensitivities[joint].get_or_init(|| {
            let (model, parameters) = (&self.effects.smooth, self.signals.parameters);
            sensitivity(model, parameters, &self.motion(), joint)
        })
    }

    /// How a torque changes with the motion of a joint that is that of the links, but for what is
    /// beside them. Rotors and viscous friction of drives are, and change it by the same all along the
    /// motion; where joints follow others, rotors need not, and the links have a model of their own.
    fn link_sensitivity(&self, joint: usize) -> (&Sensitivity, &BesideLinks) {
        let mechanism = &self.effects.robot.mechanism;
        let beside = &self.beside_links[joint];
        if mechanism.driven == mechanism.joints.len() {
            let all = self.sensitivity(joint);
            return (all, beside.get_or_init(|| self.beside_links(joint)));
        }
        let links = self.link_sensitivities[joint].get_or_init(|| {
            let values: Vec<f64> = self.standard().iter().flatten().copied().collect();
            sensitivity(self.effects.links(), &values, &self.motion(), joint)
        });
        let nothing = || BesideLinks {
            velocity: vec![0.0; self.effects.joints()],
            acceleration: vec![0.0; self.effects.joints()],
        };
        (links, beside.get_or_init(nothing))
    }

    /// What in the change of the whole torque is not of the links: the difference to their own model at
    /// the first sample.
    fn beside_links(&self, joint: usize) -> BesideLinks {
        let first = |series: &[Vec<f64>]| -> Vec<Vec<f64>> {
            let joints = series.iter();
            joints
                .map(|s| s.iter().take(1).copied().collect())
                .collect()
        };
        let all = self.motion();
        let (q, qd, qdd) = (first(all.q), first(all.qd), first(all.qdd));
        let motion = Motion {
            q: &q,
            qd: &qd,
            qdd: &qdd,
            ..all
        };
        let values: Vec<f64> = self.standard().iter().flatten().copied().collect();
        let links = sensitivity(self.effects.links(), &values, &motion, joint);
        let all = self.sensitivity(joint);
        let apart = |all: &[Vec<f64>], links: &[Vec<f64>]| -> Vec<f64> {
            let of_joint = |(all, links): (&Vec<f64>, &Vec<f64>)| {
                all.iter().zip(links).map(|(all, link)| all - link).next()
            };
            let joints = all.iter().zip(links);
            joints.map(|pair| of_joint(pair).unwrap_or(0.0)).collect()
        };
        BesideLinks {
            velocity: apart(&all.velocity, &links.velocity),
            acceleration: apart(&all.acceleration, &links.acceleration),
        }
    }

    /// The change of the torque on every joint by a sensitivity, `less` so much per velocity and
    /// acceleration on each.
    fn moved(
        &self,
        all: &Sensitivity,
        less: impl Fn(usize) -> [f64; 2],
        by: &Displacement,
    ) -> Vec<(usize, Vec<f64>)> {
        let torque = |on: usize| -> Vec<f64> {
            let [less_b, less_c] = less(on);
            let position = all.position[on].iter().zip(&by.position);
            let velocity = all.velocity[on].iter().zip(&by.velocity);
            let acceleration = all.acceleration[on].iter().zip(&by.acceleration);
            let terms = position.zip(velocity).zip(acceleration);
            terms
                .map(|(((a, z), (b, zd)), (c, zdd))| a * z + (b - less_b) * zd + (c - less_c) * zdd)
                .collect()
        };
        (0..self.effects.joints())
            .map(|on| (on, torque(on)))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use idim_codegen::builder;

    use super::*;

    #[test]
    fn links_change_their_torque_as_their_own_model_does() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("robots");
        for robot in ["puma560.toml", "rx90.toml"] {
            let robot = builder::read(&path.join(robot)).unwrap().robot;
            let (n, np) = (robot.mechanism.driven, robot.base.parameters.len());
            let series = |by: f64| -> Vec<Vec<f64>> {
                let wave =
                    |joint: usize, i: usize| (by + 1.3 * joint as f64 + 0.9 * i as f64).sin();
                (0..n)
                    .map(|joint| (0..7).map(|i| wave(joint, i)).collect())
                    .collect()
            };
            let (q, qd, qdd) = (series(0.2), series(1.1), series(2.7));
            let parameters: Vec<f64> = (0..np).map(|k| 1.0 + (0.7 * k as f64).cos()).collect();
            let effects = Effects::new(&robot);
            let signals = Signals {
                rate_hz: 1e3,
                t: &[0.0; 7],
                q: &q,
                qd: &qd,
                qdd: &qdd,
                tau_model: &q,
                tau_rigid: &q,
                parameters: &parameters,
                dead_band: &vec![0.0; n],
            };
            let along = Along::new(&effects, signals);
            let values: Vec<f64> = along.standard().iter().flatten().copied().collect();
            for joint in 0..n {
                let links = sensitivity(effects.links(), &values, &along.motion(), joint);
                let (all, beside) = along.link_sensitivity(joint);
                for on in 0..n {
                    for i in 0..7 {
                        let [a, b, c] = [
                            all.position[on][i] - links.position[on][i],
                            all.velocity[on][i] - links.velocity[on][i] - beside.velocity[on],
                            all.acceleration[on][i]
                                - links.acceleration[on][i]
                                - beside.acceleration[on],
                        ];
                        let size = links.acceleration[joint][i].abs().max(1.0);
                        // Differences of positions lose as many digits as their step is small.
                        assert!(a.abs() < 1e-8 * size, "{joint} on {on}: {a}");
                        assert!(b.abs() < 1e-12 * size && c.abs() < 1e-12 * size);
                    }
                }
            }
        }
    }
}
