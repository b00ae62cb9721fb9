//! Effects beside the rigid bodies, each written once as the torque it adds.
//!
//! A column is tau = B qdd + t(q, qd) with a constant symmetric B. Everything else follows from
//! it: D = B qdd + t, P = B qd, R = t, h = qd^T B qd / 2, dh = qd^T t.

use crate::catalogue::EffectKind;
use crate::expr::{Expr, Function, Graph, Input};
use crate::mechanism::{Effect, JointKind};

use super::{Columns, ParameterKind, Standard};

mod friction;
mod signs;
mod transmission;

use signs::Signs;

/// The definition of one column.
struct Torque {
    symbol: &'static str,
    /// Joint whose number the parameter carries.
    joint: usize,
    kind: ParameterKind,
    unit: &'static str,
    meaning: String,
    /// B, entry by entry: (row, column), value 1.
    inertia: Vec<(usize, usize)>,
    /// t, entry by entry.
    rest: Vec<(usize, Expr)>,
}

/// The parameters of an effect and their columns.
pub fn columns(graph: &mut Graph, kinds: &[JointKind], effect: &Effect) -> Vec<Standard> {
    columns_in_noise(graph, kinds, effect, &[])
}

/// The same for velocities that are not certain: below `dead_band`, rad/s or m/s for each joint,
/// the sign of a velocity is interpolated, so that the noise of an encoder at rest is no torque.
pub fn columns_in_noise(
    graph: &mut Graph,
    kinds: &[JointKind],
    effect: &Effect,
    dead_band: &[f64],
) -> Vec<Standard> {
    let signs = Signs(dead_band);
    let torques = match effect.kind {
        EffectKind::Viscous => viscous(graph, kinds, effect),
        EffectKind::Coulomb => coulomb(graph, kinds, effect, signs),
        EffectKind::Offset => offset(graph, kinds, effect),
        EffectKind::RotorInertia => rotor_inertia(kinds, effect),
        EffectKind::WristCoupling => wrist_coupling(graph, kinds, effect, signs),
        EffectKind::EndStop => transmission::end_stop(graph, kinds, effect),
        EffectKind::TransmissionCoupling => transmission::coupling(graph, kinds, effect, signs),
        _ => friction::torques(graph, kinds, effect, signs),
    };
    torques
        .into_iter()
        .map(|torque| torque.standard(graph))
        .collect()
}

fn by_kind(kind: JointKind, revolute: &'static str, prismatic: &'static str) -> &'static str {
    match kind {
        JointKind::Revolute => revolute,
        JointKind::Prismatic => prismatic,
    }
}

/// FV qd.
fn viscous(graph: &mut Graph, kinds: &[JointKind], effect: &Effect) -> Vec<Torque> {
    let joint = effect.joints[0];
    let qd = graph.input(Input::Qd(joint));
    vec![Torque {
        symbol: "FV",
        joint,
        kind: ParameterKind::Friction,
        unit: by_kind(kinds[joint], "N m s/rad", "N s/m"),
        meaning: format!("viscous friction of joint {}", joint + 1),
        inertia: vec![],
        rest: vec![(joint, qd)],
    }]
}

/// FS sgn(qd), or FS tanh(qd / smoothing).
fn coulomb(
    graph: &mut Graph,
    kinds: &[JointKind],
    effect: &Effect,
    signs: Signs<'_>,
) -> Vec<Torque> {
    let joint = effect.joints[0];
    let qd = graph.input(Input::Qd(joint));
    let smoothing = effect.shape.first().copied().unwrap_or(0.0);
    let direction = if smoothing > 0.0 {
        let relative = graph.scale(1.0 / smoothing, qd);
        graph.call(Function::Tanh, relative)
    } else {
        signs.of_joint(graph, joint)
    };
    vec![Torque {
        symbol: "FS",
        joint,
        kind: ParameterKind::Friction,
        unit: by_kind(kinds[joint], "N m", "N"),
        meaning: format!("Coulomb friction of joint {}", joint + 1),
        inertia: vec![],
        rest: vec![(joint, direction)],
    }]
}

/// OFF.
fn offset(graph: &mut Graph, kinds: &[JointKind], effect: &Effect) -> Vec<Torque> {
    let joint = effect.joints[0];
    vec![Torque {
        symbol: "OFF",
        joint,
        kind: ParameterKind::Friction,
        unit: by_kind(kinds[joint], "N m", "N"),
        meaning: format!("torque offset of joint {}", joint + 1),
        inertia: vec![],
        rest: vec![(joint, graph.one())],
    }]
}

/// IA qdd.
fn rotor_inertia(kinds: &[JointKind], effect: &Effect) -> Vec<Torque> {
    let joint = effect.joints[0];
    vec![Torque {
        symbol: "IA",
        joint,
        kind: ParameterKind::Drive,
        unit: by_kind(kinds[joint], "kg m^2", "kg"),
        meaning: format!("rotor inertia of joint {} seen at the joint", joint + 1),
        inertia: vec![(joint, joint)],
        rest: vec![],
    }]
}

/// Two wrist joints driven through each other (Gautier, TX40): joint i gets
/// IAM qdd_k + FVM qd_k + FSM sgn(qd_i + qd_k), joint k the same with i and k exchanged.
fn wrist_coupling(
    graph: &mut Graph,
    kinds: &[JointKind],
    effect: &Effect,
    signs: Signs<'_>,
) -> Vec<Torque> {
    let (i, k) = (effect.joints[0], effect.joints[1]);
    let qd_i = graph.input(Input::Qd(i));
    let qd_k = graph.input(Input::Qd(k));
    let both = graph.add(qd_i, qd_k);
    let direction = signs.of(graph, both, signs.band(i) + signs.band(k));
    let torque = |symbol, unit, what: &str, inertia, rest| Torque {
        symbol,
        joint: k,
        kind: ParameterKind::Effect,
        unit,
        meaning: format!("{what} of the coupling of joints {} and {}", i + 1, k + 1),
        inertia,
        rest,
    };
    vec![
        torque(
            "IAM",
            by_kind(kinds[k], "kg m^2", "kg"),
            "rotor inertia",
            vec![(i, k), (k, i)],
            vec![],
        ),
        torque(
            "FVM",
            by_kind(kinds[k], "N m s/rad", "N s/m"),
            "viscous friction",
            vec![],
            vec![(i, qd_k), (k, qd_i)],
        ),
        torque(
            "FSM",
            by_kind(kinds[k], "N m", "N"),
            "Coulomb friction",
            vec![],
            vec![(i, direction), (k, direction)],
        ),
    ]
}

impl Torque {
    /// The columns in all outputs that follow from the torque.
    fn standard(self, graph: &mut Graph) -> Standard {
        let mut columns = Columns::default();
        let mut twice_energy = graph.zero();
        for &(row, column) in &self.inertia {
            let qdd = graph.input(Input::Qdd(column));
            let qd = graph.input(Input::Qd(column));
            let qd_row = graph.input(Input::Qd(row));
            accumulate(graph, &mut columns.explicit, row, qdd);
            accumulate(graph, &mut columns.momentum, row, qd);
            let product = graph.mul(qd_row, qd);
            twice_energy = graph.add(twice_energy, product);
        }
        let mut power = graph.zero();
        for &(row, torque) in &self.rest {
            let qd = graph.input(Input::Qd(row));
            accumulate(graph, &mut columns.explicit, row, torque);
            accumulate(graph, &mut columns.rest, row, torque);
            let product = match self.is_sign_of(graph, torque, qd) {
                true => graph.call(Function::Abs, qd),
                false => graph.mul(qd, torque),
            };
            power = graph.add(power, product);
        }
        let energy = graph.scale(0.5, twice_energy);
        columns.energy = Some(energy).filter(|&h| !graph.is_zero(h));
        columns.power = Some(power).filter(|&dh| !graph.is_zero(dh));
        Standard {
            name: format!("{}{}", self.symbol, self.joint + 1),
            unit: self.unit,
            meaning: self.meaning,
            link: self.joint,
            kind: self.kind,
            columns,
        }
    }

    /// Whether a torque is the sign of a velocity: then its power is the absolute value.
    fn is_sign_of(&self, graph: &mut Graph, torque: Expr, qd: Expr) -> bool {
        graph.call(Function::Sign, qd) == torque
    }
}

fn accumulate(graph: &mut Graph, entries: &mut Vec<(usize, Expr)>, row: usize, term: Expr) {
    match entries.iter_mut().find(|(known, _)| *known == row) {
        Some(entry) => entry.1 = graph.add(entry.1, term),
        None => entries.push((row, term)),
    }
}
