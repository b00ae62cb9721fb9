//! What a robot is to the runtime: an identification model, evaluated on batches of states.
//!
//! Generated modules and the interpreter both implement [`IdentificationModel`], so every command
//! works on a robot that was never compiled in. This module owns the words of that contract; it
//! knows neither descriptions nor logs.

use std::borrow::Cow;

use serde::Serialize;

use crate::knowledge::Knowledge;
use crate::settings::Settings;

/// Version of the contract between emitted code and this crate; emitted code refuses to compile
/// against another one.
pub const ABI: u32 = 3;

/// How a joint moves. Angles are rad, displacements m.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum JointKind {
    /// Rotation about the joint's z axis; `q` in rad, torque in N m.
    Revolute,
    /// Translation along the joint's z axis; `q` in m, force in N.
    Prismatic,
}

/// One moving joint, in the order of the columns of a log.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Joint {
    /// Name in the robot's description.
    pub name: Cow<'static, str>,
    /// Revolute or prismatic.
    pub kind: JointKind,
}

/// What a column of the regressor stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ColumnKind {
    /// A rigid-body base parameter (inertia, first moment, mass).
    Inertial,
    /// A rotor inertia seen at the joint.
    Drive,
    /// Viscous, Coulomb friction or offset of a joint.
    Friction,
    /// Any other effect of the catalogue.
    Effect,
}

/// One parameter of the model and its column: names and columns come from this one object.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Column {
    /// Parameter name, such as `ZZR1`, `FV2`.
    pub name: Cow<'static, str>,
    /// SI unit of the parameter, such as `kg m^2`.
    pub unit: Cow<'static, str>,
    /// Link or joint that the parameter belongs to, counted from 1.
    pub joint: usize,
    /// Inertial, drive, friction or effect.
    pub kind: ColumnKind,
    /// One line in words.
    pub meaning: Cow<'static, str>,
    /// The standard parameters it stands for, such as `ZZ1 + IA1 + L^2*M2`.
    pub relation: Cow<'static, str>,
}

/// The five outputs of an identification model. With n joints and np columns:
///
/// - the explicit model \\( \tau = D(q, \dot q, \ddot q) X \\) (Gautier 1996, eq. 5);
/// - the implicit model \\( \tau = \frac{d}{dt}(P(q, \dot q) X) + R(q, \dot q) X \\) (eqs. 7-9);
/// - the power model \\( \dot q^T \tau = (\frac{d}{dt} h(q, \dot q) + dh(q, \dot q)) X \\) (eqs. 10, 23),
///   where `h` holds energies and `dh` the powers that are no derivative of an energy of the
///   state (friction).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Output {
    /// `D`, n x np: N m (or N) per unit of the parameter.
    Explicit,
    /// `P`, n x np: momentum, differentiated in time by the user of the model.
    Momentum,
    /// `R`, n x np: what the implicit model adds to `dP/dt`.
    Rest,
    /// `h`, 1 x np: J per unit of the parameter, differentiated in time by the user of the model.
    Energy,
    /// `dh` of the columns without an energy, 1 x np: W per unit of the parameter.
    Power,
}

impl Output {
    /// All outputs, in a fixed order.
    pub const ALL: [Output; 5] = [
        Output::Explicit,
        Output::Momentum,
        Output::Rest,
        Output::Energy,
        Output::Power,
    ];
}

/// One structurally non-zero entry of an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Row (joint), counted from 0; always 0 for `h` and `dh`.
    pub row: usize,
    /// Column (parameter), counted from 0, an index into [`IdentificationModel::columns`].
    pub column: usize,
    /// Which signal of the output holds the value: equal entries share one signal.
    pub signal: usize,
}

/// Where an output is non-zero, and which of its entries are the same signal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    /// Non-zero entries, ordered by row, then by column.
    pub entries: Cow<'static, [Entry]>,
    /// Number of distinct signals; `entries[..].signal < signals`.
    pub signals: usize,
}

/// A chunk of joint states, structure of arrays: value of joint `j` at sample `i` is
/// `q[j * len + i]`. `q` in rad or m, `qd` and `qdd` its time derivatives.
#[derive(Clone, Copy, Debug)]
pub struct States<'a> {
    /// Samples in the chunk.
    pub len: usize,
    /// Joint positions, `n * len`.
    pub q: &'a [f64],
    /// Joint velocities, `n * len`.
    pub qd: &'a [f64],
    /// Joint accelerations, `n * len`.
    pub qdd: &'a [f64],
    /// Presliding states z/zs of [`IdentificationModel::presliding`], `n * len`, 0 for joints without
    /// one; empty for joints that slide, where they are the signs of the velocities.
    pub slip: &'a [f64],
}

/// A joint whose friction has a memory (Dahl 1968): before it slides, its contact yields
/// elastically. \\( \dot z = \dot q - |\dot q| z / z_s \\), and friction follows \\( z / z_s \\)
/// instead of the sign of the velocity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Presliding {
    /// Joint, counted from 0.
    pub joint: usize,
    /// \\( z_s \\), rad or m: the displacement over which friction turns round.
    pub zs: f64,
}

/// A robot as the runtime sees it. Object safe: generated modules and the interpreter implement it.
pub trait IdentificationModel: Send + Sync {
    /// The robot's name.
    fn name(&self) -> &str;

    /// The n moving joints, in the order of a log's columns.
    fn joints(&self) -> &[Joint];

    /// The np parameters, in the order of the columns of every output.
    fn columns(&self) -> &[Column];

    /// The non-zero entries of an output.
    fn pattern(&self, output: Output) -> &Pattern;

    /// The robot's own defaults for identification, and its drives.
    fn settings(&self) -> &Settings;

    /// What the description knows of the parameters; nothing, unless the model says otherwise.
    fn knowledge(&self) -> &Knowledge {
        const { &Knowledge::NONE }
    }

    /// The joints whose friction has a memory, which the user of the model runs along the motion.
    fn presliding(&self) -> &[Presliding] {
        &[]
    }

    /// Evaluates every distinct signal of an output on a chunk of states.
    ///
    /// `signals` has `pattern(output).signals * states.len` places; signal `s` at sample `i` goes
    /// to `signals[s * states.len + i]`.
    fn evaluate(&self, output: Output, states: &States<'_>, signals: &mut [f64]);
}

impl<T: IdentificationModel + ?Sized> IdentificationModel for &T {
    fn name(&self) -> &str {
        (**self).name()
    }
    fn joints(&self) -> &[Joint] {
        (**self).joints()
    }
    fn columns(&self) -> &[Column] {
        (**self).columns()
    }
    fn pattern(&self, output: Output) -> &Pattern {
        (**self).pattern(output)
    }
    fn settings(&self) -> &Settings {
        (**self).settings()
    }
    fn knowledge(&self) -> &Knowledge {
        (**self).knowledge()
    }
    fn presliding(&self) -> &[Presliding] {
        (**self).presliding()
    }
    fn evaluate(&self, output: Output, states: &States<'_>, signals: &mut [f64]) {
        (**self).evaluate(output, states, signals);
    }
}
