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
    pub const ALL: [EffectKind; 5] = [
        EffectKind::Viscous,
        EffectKind::Coulomb,
        EffectKind::Offset,
        EffectKind::RotorInertia,
        EffectKind::WristCoupling,
    ];

    /// The name in descriptions and reports.
    pub fn name(self) -> &'static str {
        match self {
            EffectKind::Viscous => "viscous",
            EffectKind::Coulomb => "coulomb",
            EffectKind::Offset => "offset",
            EffectKind::RotorInertia => "rotor_inertia",
            EffectKind::WristCoupling => "wrist_coupling",
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
            EffectKind::WristCoupling => 2,
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
            _ => &[],
        }
    }
}
