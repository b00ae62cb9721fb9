//! The names of the effects a description can ask for, and what each needs to be asked for.
//!
//! The torque that an effect adds is defined once, in [`crate::derive`]; here is only what a reader
//! of descriptions has to know.

/// An entry of the catalogue of effects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum EffectKind {
    /// Viscous friction `FV qd`.
    Viscous,
    /// Coulomb friction `FS sgn(qd)`, or `FS tanh(qd / smoothing)`.
    Coulomb,
    /// Constant torque `OFF`.
    Offset,
    /// Rotor inertia seen at the joint, `IA qdd`.
    RotorInertia,
    /// Mechanical coupling of two wrist joints driven through each other (Staubli TX40).
    WristCoupling,
    /// Viscous friction that differs between the directions, `FVA |qd|`.
    ViscousAsymmetry,
    /// Friction in excess of Coulomb's near rest, `FST sgn(qd) exp(-(qd / velocity)^2)`.
    Stribeck,
    /// The same of the drive behind a wrist coupling, along the sum of the two velocities.
    WristStribeck,
    /// Friction along a power of the speed, `FVN sgn(qd) |qd|^p`.
    NonlinearViscous,
    /// Friction that varies along a turn, `(FPS sin(N q) + FPC cos(N q)) sgn(qd)`.
    PositionDependentFriction,
    /// Torque that varies along a turn, `RS sin(N q) + RC cos(N q)`.
    TorqueRipple,
    /// Spring `K q`; where it is at rest is told by the offset.
    Spring,
    /// Elastic end stop `KE side max(0, side (q - position))`.
    EndStop,
    /// Friction of a shaft that two joints turn together: `FSX sgn(v) + FVX v` on the first and
    /// `ratio` times that on the second, v = qd_i + ratio qd_j.
    TransmissionCoupling,
    /// Friction that turns round over a displacement zs, `FP (z/zs - sgn(qd))` with Dahl's
    /// `dz/dt = qd - |qd| z/zs`: what Coulomb friction lacks before the joint slides.
    Presliding,
}

/// A shape parameter: it enters the torque non-linearly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Key in a description.
    pub name: &'static str,
    /// Value when the description is silent, SI.
    pub default: f64,
    /// Lowest and highest admissible value.
    pub range: (f64, f64),
}

impl EffectKind {
    /// Every entry, in the order of the catalogue.
    pub const ALL: [EffectKind; 15] = [
        EffectKind::Viscous,
        EffectKind::Coulomb,
        EffectKind::Offset,
        EffectKind::RotorInertia,
        EffectKind::WristCoupling,
        EffectKind::ViscousAsymmetry,
        EffectKind::Stribeck,
        EffectKind::WristStribeck,
        EffectKind::NonlinearViscous,
        EffectKind::PositionDependentFriction,
        EffectKind::TorqueRipple,
        EffectKind::Spring,
        EffectKind::EndStop,
        EffectKind::TransmissionCoupling,
        EffectKind::Presliding,
    ];

    /// The name in descriptions and reports.
    pub fn name(self) -> &'static str {
        match self {
            EffectKind::Viscous => "viscous",
            EffectKind::Coulomb => "coulomb",
            EffectKind::Offset => "offset",
            EffectKind::RotorInertia => "rotor_inertia",
            EffectKind::WristCoupling => "wrist_coupling",
            EffectKind::ViscousAsymmetry => "viscous_asymmetry",
            EffectKind::Stribeck => "stribeck",
            EffectKind::WristStribeck => "wrist_stribeck",
            EffectKind::NonlinearViscous => "nonlinear_viscous",
            EffectKind::PositionDependentFriction => "position_dependent_friction",
            EffectKind::TorqueRipple => "torque_ripple",
            EffectKind::Spring => "spring",
            EffectKind::EndStop => "end_stop",
            EffectKind::TransmissionCoupling => "transmission_coupling",
            EffectKind::Presliding => "presliding",
        }
    }

    /// The entry of that name; `torque_offset` is another name of `offset`.
    pub fn from_name(name: &str) -> Option<EffectKind> {
        if name == "torque_offset" {
            return Some(EffectKind::Offset);
        }
        EffectKind::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// How many joints it takes to say where it acts.
    pub fn arity(self) -> usize {
        match self {
            EffectKind::WristCoupling
            | EffectKind::WristStribeck
            | EffectKind::TransmissionCoupling => 2,
            _ => 1,
        }
    }

    /// Its shape parameters; empty where the torque is linear in all of them.
    pub fn shapes(self) -> &'static [Shape] {
        match self {
            EffectKind::Coulomb => &[Shape {
                name: "smoothing",
                default: 0.0,
                range: (0.0, f64::MAX),
            }],
            EffectKind::Stribeck | EffectKind::WristStribeck => &[Shape {
                name: "velocity",
                default: 0.1,
                range: (f64::MIN_POSITIVE, f64::MAX),
            }],
            EffectKind::NonlinearViscous => &[Shape {
                name: "p",
                default: 2.0,
                range: (0.1, 10.0),
            }],
            EffectKind::PositionDependentFriction | EffectKind::TorqueRipple => &[Shape {
                name: "N",
                default: 1.0,
                range: (f64::MIN_POSITIVE, f64::MAX),
            }],
            EffectKind::EndStop => &[
                Shape {
                    name: "position",
                    default: 0.0,
                    range: (f64::MIN, f64::MAX),
                },
                Shape {
                    name: "side",
                    default: 1.0,
                    range: (-1.0, 1.0),
                },
            ],
            EffectKind::TransmissionCoupling => &[Shape {
                name: "ratio",
                default: 1.0,
                range: (-100.0, 100.0),
            }],
            EffectKind::Presliding => &[Shape {
                name: "zs",
                default: 0.001,
                range: (f64::MIN_POSITIVE, f64::MAX),
            }],
            _ => &[],
        }
    }
}
