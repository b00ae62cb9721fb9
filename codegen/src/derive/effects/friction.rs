//! Friction beyond Coulomb and viscous, and torques along the position: what a measured log asks
//! for besides the usual columns.

use super::{Signs, Torque, by_kind};
use crate::catalogue::EffectKind;
use crate::derive::ParameterKind;
use crate::expr::{Expr, Function, Graph, Input};
use crate::mechanism::{Effect, JointKind};

/// The torques of an effect of this family; none for the others.
pub(super) fn torques(
    graph: &mut Graph,
    kinds: &[JointKind],
    effect: &Effect,
    signs: Signs<'_>,
) -> Vec<Torque> {
    let Some(&joint) = effect.joints.first() else {
        return Vec::new();
    };
    let shape = effect.shape.first().copied().unwrap_or(1.0);
    let force = by_kind(kinds[joint], "N m", "N");
    let one = |symbol, unit, what: &str, torque| vec![column(joint, symbol, unit, what, torque)];
    let qd = graph.input(Input::Qd(joint));
    match effect.kind {
        EffectKind::ViscousAsymmetry => {
            let unit = by_kind(kinds[joint], "N m s/rad", "N s/m");
            let speed = graph.call(Function::Abs, qd);
            one("FVA", unit, "asymmetry of the viscous friction", speed)
        }
        EffectKind::Stribeck => {
            let direction = signs.of_joint(graph, joint);
            let torque = excess(graph, qd, direction, shape);
            one("FST", force, "Stribeck excess of the friction", torque)
        }
        EffectKind::WristStribeck => wrist_stribeck(graph, force, effect, signs),
        EffectKind::NonlinearViscous => {
            let unit = by_kind(kinds[joint], "N m (s/rad)^p", "N (s/m)^p");
            let direction = signs.of_joint(graph, joint);
            let power = graph.call(Function::Power(shape.to_bits()), qd);
            let torque = graph.mul(direction, power);
            one("FVN", unit, "nonlinear viscous friction", torque)
        }
        EffectKind::PositionDependentFriction => {
            let direction = signs.of_joint(graph, joint);
            let [sine, cosine] = waves(graph, joint, shape).map(|wave| graph.mul(wave, direction));
            let what = "friction along the turn";
            let sine = column(joint, "FPS", force, what, sine);
            vec![sine, column(joint, "FPC", force, what, cosine)]
        }
        EffectKind::TorqueRipple => {
            let [sine, cosine] = waves(graph, joint, shape);
            let sine = column(joint, "RS", force, "torque ripple", sine);
            vec![sine, column(joint, "RC", force, "torque ripple", cosine)]
        }
        EffectKind::Spring => {
            let unit = by_kind(kinds[joint], "N m/rad", "N/m");
            let q = graph.input(Input::Q(joint));
            one("K", unit, "spring", q)
        }
        EffectKind::Presliding => {
            let slip = graph.input(Input::Slip(joint));
            let direction = signs.of_joint(graph, joint);
            let torque = graph.sub(slip, direction);
            one("FP", force, "friction before sliding", torque)
        }
        EffectKind::Viscous
        | EffectKind::Coulomb
        | EffectKind::Offset
        | EffectKind::RotorInertia
        | EffectKind::WristCoupling
        | EffectKind::EndStop
        | EffectKind::TransmissionCoupling => Vec::new(),
    }
}

fn column(
    joint: usize,
    symbol: &'static str,
    unit: &'static str,
    what: &str,
    torque: Expr,
) -> Torque {
    Torque {
        symbol,
        joint,
        kind: ParameterKind::Effect,
        unit,
        meaning: format!("{what} of joint {}", joint + 1),
        inertia: vec![],
        rest: vec![(joint, torque)],
    }
}

/// sgn(qd) exp(-(qd / velocity)^2).
fn excess(graph: &mut Graph, qd: Expr, direction: Expr, velocity: f64) -> Expr {
    let relative = graph.scale(1.0 / velocity, qd);
    let near_rest = graph.call(Function::Bell, relative);
    graph.mul(direction, near_rest)
}

/// sin(N q), cos(N q).
fn waves(graph: &mut Graph, joint: usize, times: f64) -> [Expr; 2] {
    let q = graph.input(Input::Q(joint));
    let angle = graph.scale(times, q);
    [Function::Sine, Function::Cosine].map(|function| graph.call(function, angle))
}

/// The Stribeck excess along qd_i + qd_k, on both joints, as FSM of the coupling.
fn wrist_stribeck(
    graph: &mut Graph,
    unit: &'static str,
    effect: &Effect,
    signs: Signs<'_>,
) -> Vec<Torque> {
    let velocity = effect.shape.first().copied().unwrap_or(1.0);
    let &[i, k] = effect.joints.as_slice() else {
        return Vec::new();
    };
    let qd_i = graph.input(Input::Qd(i));
    let qd_k = graph.input(Input::Qd(k));
    let both = graph.add(qd_i, qd_k);
    let direction = signs.of(graph, both, signs.band(i) + signs.band(k));
    let torque = excess(graph, both, direction, velocity);
    vec![Torque {
        symbol: "FSTM",
        joint: k,
        kind: ParameterKind::Effect,
        unit,
        meaning: format!(
            "Stribeck excess of the coupling of joints {} and {}",
            i + 1,
            k + 1
        ),
        inertia: vec![],
        rest: vec![(i, torque), (k, torque)],
    }]
}
