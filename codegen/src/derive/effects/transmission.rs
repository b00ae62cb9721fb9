//! What stands between a drive and its joints: end stops, and shafts that two joints turn together.

use super::{Signs, Torque, by_kind};
use crate::derive::ParameterKind;
use crate::expr::{Function, Graph, Input};
use crate::mechanism::{Effect, JointKind};

/// KE side max(0, side (q - position)), with max(0, x) = (x + |x|) / 2.
pub(super) fn end_stop(graph: &mut Graph, kinds: &[JointKind], effect: &Effect) -> Vec<Torque> {
    let Some(&joint) = effect.joints.first() else {
        return Vec::new();
    };
    let position = effect.shape.first().copied().unwrap_or(0.0);
    let upper = effect.shape.get(1).is_none_or(|side| *side >= 0.0);
    let q = graph.input(Input::Q(joint));
    let at = graph.constant(position);
    let beyond = graph.sub(q, at);
    let beyond = if upper { beyond } else { -beyond };
    let depth = graph.call(Function::Abs, beyond);
    let depth = graph.add(beyond, depth);
    let depth = graph.scale(0.5, depth);
    vec![Torque {
        symbol: "KE",
        joint,
        kind: ParameterKind::Effect,
        unit: by_kind(kinds[joint], "N m/rad", "N/m"),
        meaning: format!("stiffness of the end stop of joint {}", joint + 1),
        inertia: vec![],
        rest: vec![(joint, if upper { depth } else { -depth })],
    }]
}

/// FSX sgn(v) and FVX v along v = qd_i + ratio qd_j, on joint i and times the ratio on joint j.
pub(super) fn coupling(
    graph: &mut Graph,
    kinds: &[JointKind],
    effect: &Effect,
    signs: Signs<'_>,
) -> Vec<Torque> {
    let &[i, j] = effect.joints.as_slice() else {
        return Vec::new();
    };
    let ratio = effect.shape.first().copied().unwrap_or(1.0);
    let [qd_i, qd_j] = [i, j].map(|joint| graph.input(Input::Qd(joint)));
    let turned = graph.scale(ratio, qd_j);
    let both = graph.add(qd_i, turned);
    let band = signs.band(i) + ratio.abs() * signs.band(j);
    let direction = signs.of(graph, both, band);
    let mut torque = |symbol, unit, what: &str, torque| Torque {
        symbol,
        joint: j,
        kind: ParameterKind::Effect,
        unit,
        meaning: format!("{what} of the shaft of joints {} and {}", i + 1, j + 1),
        inertia: vec![],
        rest: vec![(i, torque), (j, graph.scale(ratio, torque))],
    };
    let (force, damping) = (
        by_kind(kinds[j], "N m", "N"),
        by_kind(kinds[j], "N m s/rad", "N s/m"),
    );
    vec![
        torque("FSX", force, "Coulomb friction", direction),
        torque("FVX", damping, "viscous friction", both),
    ]
}
