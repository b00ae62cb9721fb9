//! Torques along the position, and errors of the measured one.

use idim_codegen::catalogue::EffectKind;
use idim_runtime::diagnose::{Entry, EntryKind, Hypothesis, TorqueColumn};

use super::along::{Along, Displacement};
use super::reach::{plain, whole};
use super::{Effect, Effects, Reach};

pub(super) static TORQUE_OFFSET: Effect = Effect {
    entry: Entry {
        name: "torque_offset",
        meaning: "constant torque",
        formula: "OFF",
        parameters: &[("OFF", "N m")],
        shape: &[],
        confused_with: &["viscous_asymmetry", "spring"],
        experiment: "a wide range of positions; standstill approached from both directions",
        kind: EntryKind::Static,
        hidden_by_parameters: false,
    },
    hypotheses: |_, reach| reach.each_joint(),
    columns: |along, joints, shape| along.defined(EffectKind::Offset, joints, shape),
    described: &[EffectKind::Offset],
    implausible: |_| None,
};

pub(super) static TORQUE_RIPPLE: Effect = Effect {
    entry: Entry {
        name: "torque_ripple",
        meaning: "torque that varies along the turn, of motor or gear",
        formula: "RS sin(N q) + RC cos(N q)",
        parameters: &[("RS", "N m"), ("RC", "N m")],
        shape: &[("N", "1")],
        confused_with: &["encoder_eccentricity"],
        experiment: "the same arc at two speeds: ripple stays, eccentricity grows with the square \
                     of speed",
        kind: EntryKind::Static,
        hidden_by_parameters: false,
    },
    hypotheses: |effects, reach| {
        reach.each_of(|joint| effects.is_revolute(joint), |_| whole(2, 20))
    },
    columns: |along, joints, shape| along.defined(EffectKind::TorqueRipple, joints, shape),
    described: &[EffectKind::TorqueRipple],
    implausible: |_| None,
};

pub(super) static SPRING: Effect = Effect {
    entry: Entry {
        name: "spring",
        meaning: "spring between a link and its antecedent",
        formula: "K q + OFF",
        parameters: &[("K", "N m/rad"), ("OFF", "N m")],
        shape: &[],
        confused_with: &["torque_offset", "end_stop"],
        experiment: "a wide range of positions",
        kind: EntryKind::Static,
        hidden_by_parameters: false,
    },
    hypotheses: |_, reach| reach.each_joint(),
    columns: |along, joints, shape| {
        let mut columns = along.defined(EffectKind::Spring, joints, shape);
        columns.extend(along.defined(EffectKind::Offset, joints, &[]));
        columns
    },
    described: &[EffectKind::Spring, EffectKind::Offset],
    implausible: |_| None,
};

pub(super) static END_STOP: Effect = Effect {
    entry: Entry {
        name: "end_stop",
        meaning: "elastic stop near an end of the range",
        formula: "KE side max(0, side (q - position))",
        parameters: &[("KE", "N m/rad")],
        shape: &[("position", "rad"), ("side", "1")],
        confused_with: &["spring", "torque_ripple"],
        experiment: "a slow approach to the limit",
        kind: EntryKind::Static,
        hidden_by_parameters: false,
    },
    hypotheses: end_stops,
    columns: |along, joints, shape| along.defined(EffectKind::EndStop, joints, shape),
    described: &[EffectKind::EndStop],
    implausible: |values| {
        let pulls = values.first().is_some_and(|stiffness| *stiffness < 0.0);
        pulls.then_some("the stop would pull into the limit: its stiffness is negative")
    },
};

/// Begins of the stop as fractions of the range before its end.
const STOPS: [f64; 4] = [1.0 / 3.0, 0.22, 0.14, 0.07];

/// A stop on either side, within the outer third of the motion.
fn end_stops(_: &Effects, reach: &Reach<'_>) -> Vec<Hypothesis> {
    let on_side = |joint: usize, side: f64| {
        let (low, high) = reach.range[joint];
        let end = if side > 0.0 { high } else { low };
        let at = |fraction: &f64| end - side * fraction * (high - low);
        let mut stop = plain(vec![joint]);
        stop.grid = STOPS
            .iter()
            .map(|fraction| vec![at(fraction), side])
            .collect();
        let (far, near) = (at(&STOPS[0]), at(&0.02));
        stop.bounds = vec![far.min(near)..far.max(near), side..side];
        stop
    };
    reach
        .moving()
        .flat_map(|joint| [on_side(joint, 1.0), on_side(joint, -1.0)])
        .collect()
}

pub(super) static ENCODER_ECCENTRICITY: Effect = Effect {
    entry: Entry {
        name: "encoder_eccentricity",
        meaning: "error of the measured position along the turn: what has to be added to it",
        formula: "d(tau_m)/dq_j along ECS sin(N q_j) + ECC cos(N q_j) and its time derivatives",
        parameters: &[("ECS", "rad"), ("ECC", "rad")],
        shape: &[("N", "1")],
        confused_with: &["torque_ripple"],
        experiment: "the same arc at two speeds",
        kind: EntryKind::ModelDependent,
        hidden_by_parameters: false,
    },
    hypotheses: |effects, reach| {
        reach.each_of(|joint| effects.is_revolute(joint), |_| whole(2, 14))
    },
    columns: eccentricity,
    described: &[],
    implausible: |values| {
        let size = values.iter().fold(0.0, |sum: f64, value| sum.hypot(*value));
        (size > 0.1).then_some("an encoder is not wrong by more than 0.1 rad")
    },
};

fn eccentricity(along: &Along<'_>, joints: &[usize], shape: &[f64]) -> Vec<TorqueColumn> {
    let (&[joint], &[n]) = (joints, shape) else {
        return Vec::new();
    };
    let len = along.len();
    let mut both = [(); 2].map(|()| Displacement::with_capacity(len));
    for i in 0..len {
        let (qd, qdd) = (along.signals.qd[joint][i], along.signals.qdd[joint][i]);
        let (sin, cos) = (n * along.signals.q[joint][i]).sin_cos();
        // The sine, and the sine a quarter of a turn ahead.
        for (by, (sin, cos)) in both.iter_mut().zip([(sin, cos), (cos, -sin)]) {
            by.push(sin, n * qd * cos, n * qdd * cos - n * n * qd * qd * sin);
        }
    }
    let named = ["ECS", "ECC"].into_iter().zip(both);
    let column = |(symbol, by): (&str, Displacement)| TorqueColumn {
        name: format!("{symbol}{}", joint + 1),
        unit: "rad",
        torque: along.displaced(joint, &by),
    };
    named.map(column).collect()
}
