//! What robots have and the catalogue has not.

use idim::codegen::catalogue::EffectKind;
use idim::codegen::describe::{Description, Motion};
use idim::runtime::simulate::{Influence, Moment};

use super::build::{ask, fasten, hanging, rock, tree};
use super::hidden::{Effect, Hidden};
use super::host::Host;
use super::random::Random;
use super::robots::Rating;

/// Something outside of the catalogue. Joints count from 0; SI.
#[derive(Clone, Debug)]
pub enum Outside {
    /// A hose along a joint: it drags, over a far longer way than a contact yields.
    Hose { joint: usize, torque: f64, way: f64 },
    /// A spring that a crank pulls, as gravity compensators have: stiffness times free length,
    /// the crank's angle, ratio of crank and distance.
    Crank {
        joint: usize,
        torque: f64,
        angle: f64,
        ratio: f64,
    },
    /// Cogging that fades with speed.
    FadingCogging {
        joint: usize,
        torque: f64,
        times: f64,
        speed: f64,
    },
    /// Friction of a joint that depends on the position of another (cables inside).
    CableFriction {
        joint: usize,
        other: usize,
        torque: f64,
        phase: f64,
    },
    /// Friction that steps up and down, as grease comes and goes: time between steps.
    Grease {
        joint: usize,
        torque: f64,
        interval: f64,
    },
    /// A base that rocks: axis, stiffness, damping.
    Rocking {
        axis: [f64; 3],
        stiffness: f64,
        damping: f64,
    },
    /// A load that swings below the flange: mass, length, damping.
    Swinging {
        mass: f64,
        length: f64,
        damping: f64,
    },
}

impl Outside {
    /// Hidden joints.
    pub fn put(&self, to: &mut Description, values: &mut Vec<(&'static str, String, f64)>) {
        match *self {
            Outside::Rocking {
                axis,
                stiffness,
                damping,
            } => {
                let joint = rock(tree(to), axis);
                ask(to, EffectKind::Spring, vec![joint.clone()], &[]);
                ask(to, EffectKind::Viscous, vec![joint.clone()], &[]);
                values.push(("K", joint.clone(), stiffness));
                values.push(("FV", joint, damping));
            }
            Outside::Swinging {
                mass,
                length,
                damping,
            } => {
                let body = hanging(mass, length);
                let joint = fasten(tree(to), Motion::Revolute, [1.0, 0.0, 0.0], body);
                ask(to, EffectKind::Viscous, vec![joint.clone()], &[]);
                values.push(("FV", joint, damping));
            }
            _ => {}
        }
    }

    /// What acts on the joints, on a robot whose driven joints are these.
    pub fn influence(&self, driven: &[usize]) -> Option<Box<dyn Influence>> {
        let at = |joint: usize| driven[joint];
        Some(match *self {
            Outside::Hose { joint, torque, way } => Box::new(Hose {
                joint: at(joint),
                torque,
                way,
                last: None,
                pull: 0.0,
            }),
            Outside::Crank {
                joint,
                torque,
                angle,
                ratio,
            } => {
                let joint = at(joint);
                Box::new(Acting(move |_: f64, q: &[f64], _: &[f64]| {
                    let (sin, cos) = (q[joint] - angle).sin_cos();
                    let length = (1.0 + ratio * ratio - 2.0 * ratio * cos).sqrt();
                    (joint, torque * (1.0 - 0.55 / length) * sin)
                }))
            }
            Outside::FadingCogging {
                joint,
                torque,
                times,
                speed,
            } => {
                let joint = at(joint);
                Box::new(Acting(move |_: f64, q: &[f64], qd: &[f64]| {
                    let fades = 1.0 / (1.0 + (qd[joint] / speed).powi(2));
                    (joint, torque * fades * (times * q[joint]).sin())
                }))
            }
            Outside::CableFriction {
                joint,
                other,
                torque,
                phase,
            } => {
                let (joint, other) = (at(joint), at(other));
                Box::new(Acting(move |_: f64, q: &[f64], qd: &[f64]| {
                    let level = 1.0 + (1.5 * q[other] + phase).sin();
                    (joint, torque * level * (qd[joint] / 0.02).tanh())
                }))
            }
            Outside::Grease {
                joint,
                torque,
                interval,
            } => {
                let joint = at(joint);
                Box::new(Acting(move |t: f64, _: &[f64], qd: &[f64]| {
                    let up = (t / interval).sin() * (0.618 * t / interval + 1.0).sin() > 0.0;
                    (
                        joint,
                        if up {
                            torque * (qd[joint] / 0.02).tanh()
                        } else {
                            0.0
                        },
                    )
                }))
            }
            Outside::Rocking { .. } | Outside::Swinging { .. } => return None,
        })
    }
}

/// A torque on one joint that depends on the state and the time.
struct Acting<F>(F);

impl<F: FnMut(f64, &[f64], &[f64]) -> (usize, f64)> Influence for Acting<F> {
    fn torque(&mut self, t: f64, q: &[f64], qd: &[f64], torque: &mut [f64]) {
        let (joint, adds) = (self.0)(t, q, qd);
        torque[joint] += adds;
    }
}

/// Drag that turns round over a way, sample by sample.
struct Hose {
    joint: usize,
    torque: f64,
    way: f64,
    last: Option<f64>,
    pull: f64,
}

impl Influence for Hose {
    fn begin(&mut self, moment: &Moment<'_>, _: &mut [f64]) {
        let q = moment.q[self.joint];
        let by = q - self.last.unwrap_or(q);
        self.pull += (by - by.abs() * self.pull) / self.way;
        self.last = Some(q);
    }

    fn torque(&mut self, _: f64, _: &[f64], _: &[f64], torque: &mut [f64]) {
        torque[self.joint] += self.torque * self.pull;
    }
}

/// Something outside of the catalogue; always clear.
pub fn outside(host: &Host, random: &mut Random) -> Option<Effect> {
    let joint = random.whole(0, host.ratings.len() - 1);
    let Rating {
        scale,
        speed,
        slides,
        ..
    } = host.ratings[joint];
    let (low, high) = host.range[joint];
    let torque = 0.05 * scale * random.uniform(0.7, 1.4);
    let (name, joints, outside) = match random.whole(0, 6) {
        0 => {
            let way = random.uniform(0.15, 0.35) * (high - low);
            ("hose", vec![joint], Outside::Hose { joint, torque, way })
        }
        1 if !slides => {
            let (angle, ratio) = (random.uniform(low, high), random.uniform(0.6, 0.85));
            (
                "crank",
                vec![joint],
                Outside::Crank {
                    joint,
                    torque: 1.6 * torque,
                    angle,
                    ratio,
                },
            )
        }
        2 if !slides => {
            let (times, speed) = (
                random.whole(3, 9) as f64,
                speed * random.uniform(0.12, 0.25),
            );
            (
                "fading_cogging",
                vec![joint],
                Outside::FadingCogging {
                    joint,
                    torque,
                    times,
                    speed,
                },
            )
        }
        3 => {
            let other = (joint + random.whole(1, host.ratings.len() - 1)) % host.ratings.len();
            let phase = random.uniform(0.0, std::f64::consts::TAU);
            (
                "cable_friction",
                vec![joint],
                Outside::CableFriction {
                    joint,
                    other,
                    torque,
                    phase,
                },
            )
        }
        4 => {
            let interval = random.uniform(0.5, 0.9);
            (
                "grease",
                vec![joint],
                Outside::Grease {
                    joint,
                    torque,
                    interval,
                },
            )
        }
        5 => {
            let axis = random.one_of(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
            let inertia = host.mass * 0.3;
            let omega = std::f64::consts::TAU * random.uniform(3.0, 5.0);
            let (stiffness, damping) = (inertia * omega * omega, 0.1 * inertia * omega);
            (
                "rocking_base",
                vec![],
                Outside::Rocking {
                    axis,
                    stiffness,
                    damping,
                },
            )
        }
        6 if host.ratings.len() > 2 => {
            let (mass, length) = (0.03 * host.mass, random.uniform(0.1, 0.25));
            let damping = 0.02 * mass * length * (9.81 * length).sqrt();
            (
                "swinging_load",
                vec![],
                Outside::Swinging {
                    mass,
                    length,
                    damping,
                },
            )
        }
        _ => return None,
    };
    Some(Effect {
        name,
        joints,
        hidden: Hidden::Outside(outside),
    })
}
