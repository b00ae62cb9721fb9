//! Effects of a given strength on a given robot.

use idim::runtime::simulate::Drive;

use super::columns::columns;
use super::hidden::{Effect, Hidden};
use super::host::Host;
use super::random::Random;

/// Every entry of the catalogue.
pub const NAMES: [&str; 24] = [
    "torque_offset",
    "viscous_asymmetry",
    "stribeck",
    "nonlinear_viscous",
    "position_dependent_friction",
    "torque_ripple",
    "spring",
    "end_stop",
    "transmission_coupling",
    "rotor_inertia",
    "payload",
    "base_tilt",
    "external_force",
    "load_dependent_friction",
    "drive_gain",
    "drive_saturation",
    "drive_dead_zone",
    "time_shift",
    "link_length",
    "encoder_eccentricity",
    "presliding",
    "friction_drift",
    "joint_elasticity",
    "backlash",
];

/// An effect of the catalogue of strength `s` (1: clear); nothing where the robot cannot have it.
pub fn propose(name: &'static str, s: f64, host: &Host, random: &mut Random) -> Option<Effect> {
    let joint = random.whole(0, host.ratings.len() - 1);
    let of_joint = |hidden: Hidden| Some((vec![joint], hidden));
    let of_robot = |hidden: Hidden| Some((vec![], hidden));
    let (joints, hidden) = match name {
        "rotor_inertia" => of_joint(rotor(joint, s, host, random)),
        "payload" => Some((vec![host.ratings.len() - 1], payload(s, host, random))),
        "base_tilt" => of_robot(tilt(s, random)),
        "external_force" => of_robot(force(s, host, random)),
        "load_dependent_friction" => of_joint(Hidden::Load {
            joint,
            factor: 0.09 * s * random.uniform(0.6, 1.4),
        }),
        "drive_gain" | "drive_saturation" | "drive_dead_zone" => {
            of_joint(drive(name, joint, s, host, random))
        }
        "time_shift" => Some(shift(joint, s, random)),
        "link_length" => {
            let by = 0.007 * s * random.sign() * random.uniform(0.6, 1.4);
            let long = host.lengths[joint] > 0.05;
            long.then_some((vec![joint], Hidden::Length { joint, by }))
        }
        "encoder_eccentricity" => {
            let size = 5e-4 * s * random.uniform(0.6, 1.4);
            let phase = random.uniform(0.0, std::f64::consts::TAU);
            let times = random.whole(2, 14) as f64;
            // Errors of an acceleration grow with the square of N.
            let size = size * 6.0 / times;
            let wave = (times, size * phase.cos(), size * phase.sin());
            let turns = !host.ratings[joint].slides;
            turns.then_some((vec![joint], Hidden::Eccentric { joint, wave }))
        }
        "friction_drift" => of_joint(Hidden::Drift {
            joint,
            time: random.ratio(2.5, 20.0),
            coulomb: -0.5 * s.min(1.7) * host.coulomb[joint] * random.uniform(0.5, 1.0),
            viscous: -0.5 * s.min(1.7) * host.viscous[joint] * random.uniform(0.5, 1.0),
        }),
        "joint_elasticity" => of_joint(elastic(joint, s, host, random)),
        "backlash" => of_joint(backlash(joint, s, host, random)),
        _ => columns(name, joint, s, host, random),
    }?;
    Some(Effect {
        name,
        joints,
        hidden,
    })
}

fn rotor(joint: usize, s: f64, host: &Host, random: &mut Random) -> Hidden {
    let part = (0.3 * s * random.uniform(0.6, 1.4)).min(0.8);
    Hidden::Rotor {
        joint,
        change: random.sign() * part * host.rotor[joint],
    }
}

fn payload(s: f64, host: &Host, random: &mut Random) -> Hidden {
    Hidden::Payload {
        mass: 0.02 * s * host.mass * random.uniform(0.6, 1.4),
        com: [
            0.02 * random.normal(),
            0.02 * random.normal(),
            random.uniform(0.02, 0.1),
        ],
        radii: [(); 3].map(|()| random.uniform(0.02, 0.05)),
    }
}

fn tilt(s: f64, random: &mut Random) -> Hidden {
    let size = 0.035 * s * random.uniform(0.6, 1.4);
    let way = random.uniform(0.0, std::f64::consts::TAU);
    Hidden::Tilt {
        x: size * way.cos(),
        y: size * way.sin(),
    }
}

fn force(s: f64, host: &Host, random: &mut Random) -> Hidden {
    let size = 0.35 * s * host.mass * random.uniform(0.6, 1.4);
    let way = [(); 3].map(|()| random.normal());
    let norm = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    // A planar arm feels nothing along its axes.
    let flat = if host.ratings.len() < 3 {
        [1.0, 1.0, 0.0]
    } else {
        [1.0; 3]
    };
    let part = |k: usize| size * way[k] * flat[k] / norm;
    Hidden::Force {
        force: [part(0), part(1), part(2)],
        window: None,
    }
}

fn drive(name: &str, joint: usize, s: f64, host: &Host, random: &mut Random) -> Hidden {
    let ideal = Drive::IDEAL;
    let size = s * random.uniform(0.6, 1.4);
    let drive = match name {
        "drive_gain" => Drive {
            gain: 1.0 + random.sign() * (0.09 * size).min(0.3),
            ..ideal
        },
        "drive_saturation" => {
            let level = random.uniform(0.5, 0.85) * host.peak[joint];
            let share = 1.0 - (0.35 * size).min(0.85);
            Drive {
                saturation: Some((level, share)),
                ..ideal
            }
        }
        _ => Drive {
            dead_zone: 0.025 * size * host.ratings[joint].scale,
            ..ideal
        },
    };
    Hidden::Drive { joint, drive }
}

fn shift(joint: usize, s: f64, random: &mut Random) -> (Vec<usize>, Hidden) {
    let by = 0.005 * s * random.uniform(0.6, 1.4);
    if random.uniform(0.0, 1.0) < 0.4 {
        return (vec![], Hidden::Late { by });
    }
    let drive = Drive {
        lag: 1.6 * by,
        ..Drive::IDEAL
    };
    (vec![joint], Hidden::Drive { joint, drive })
}

/// A link that swings at 3 to 14 Hz behind its locked drive.
fn elastic(joint: usize, s: f64, host: &Host, random: &mut Random) -> Hidden {
    let frequency = (6.5 * random.ratio(0.75, 1.33) / s.sqrt()).clamp(3.0, 14.0);
    let omega = std::f64::consts::TAU * frequency;
    let stiffness = host.carried[joint] * omega * omega;
    let damping = 2.0 * random.ratio(0.03, 0.2) * host.carried[joint] * omega;
    Hidden::Elastic {
        joint,
        stiffness,
        damping,
    }
}

/// Stops so stiff that the gear yields by a tenth of the gap under the largest load.
fn backlash(joint: usize, s: f64, host: &Host, random: &mut Random) -> Hidden {
    let gap = 2.5e-3 * s * random.uniform(0.6, 1.4);
    let (carried, rotor) = (host.carried[joint], host.rotor[joint]);
    let reduced = carried * rotor / (carried + rotor);
    // What steps of 0.25 ms can follow.
    let stiffness = (10.0 * host.peak[joint] / gap).min(reduced * 2500.0f64.powi(2));
    let damping = 0.1 * (stiffness * reduced).sqrt();
    Hidden::Backlash {
        joint,
        gap,
        stiffness,
        damping,
    }
}
