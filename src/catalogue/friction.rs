//! Friction beyond Coulomb and viscous.

use idim_codegen::catalogue::EffectKind;
use idim_runtime::diagnose::{Entry, EntryKind, Hypothesis};

use super::reach::{geometric, largest, plain, whole};
use super::{Effect, Effects, Reach};

pub(super) static VISCOUS_ASYMMETRY: Effect = Effect {
    entry: Entry {
        name: "viscous_asymmetry",
        meaning: "viscous friction that differs between the two directions",
        formula: "FVA |qd|",
        parameters: &[("FVA", "N m s/rad")],
        shape: &[],
        confused_with: &["torque_offset"],
        experiment: "two or more speed levels in both directions",
        kind: EntryKind::Static,
        hidden_by_parameters: false,
    },
    hypotheses: |_, reach| reach.each_joint(),
    columns: |along, joints, shape| along.defined(EffectKind::ViscousAsymmetry, joints, shape),
    described: &[EffectKind::ViscousAsymmetry],
    implausible: |_| None,
};

pub(super) static STRIBECK: Effect = Effect {
    entry: Entry {
        name: "stribeck",
        meaning: "friction near rest in excess of Coulomb's",
        formula: "FST sgn(qd) exp(-(qd/velocity)^2)",
        parameters: &[("FST", "N m")],
        shape: &[("velocity", "rad/s")],
        confused_with: &["presliding", "backlash"],
        experiment: "slow passes at constant speed in both directions",
        kind: EntryKind::Static,
        hidden_by_parameters: false,
    },
    hypotheses: |_, reach| {
        let grid = |joint: usize| geometric(0.02 * reach.speed[joint], 0.5 * reach.speed[joint], 6);
        reach.each_of(|_| true, grid)
    },
    columns: |along, joints, shape| along.defined(EffectKind::Stribeck, joints, shape),
    described: &[EffectKind::Stribeck],
    implausible: |values| {
        let falls = values.first().is_some_and(|excess| *excess < 0.0);
        falls.then_some("friction would be less near rest than in sliding: no Stribeck excess")
    },
};

pub(super) static NONLINEAR_VISCOUS: Effect = Effect {
    entry: Entry {
        name: "nonlinear_viscous",
        meaning: "friction that grows along a power of the speed",
        formula: "FVN sgn(qd) |qd|^p",
        parameters: &[("FVN", "N m (s/rad)^p")],
        shape: &[("p", "1")],
        confused_with: &["stribeck", "friction_drift"],
        experiment: "constant speeds up to top speed",
        kind: EntryKind::Static,
        hidden_by_parameters: false,
    },
    hypotheses: |_, reach| reach.each_of(|_| true, |_| vec![1.3, 1.6, 2.0, 2.5, 3.2, 4.0]),
    columns: |along, joints, shape| along.defined(EffectKind::NonlinearViscous, joints, shape),
    described: &[EffectKind::NonlinearViscous],
    implausible: |_| None,
};

pub(super) static POSITION_DEPENDENT_FRICTION: Effect = Effect {
    entry: Entry {
        name: "position_dependent_friction",
        meaning: "friction that varies along the turn",
        formula: "(FPS sin(N q) + FPC cos(N q)) sgn(qd)",
        parameters: &[("FPS", "N m"), ("FPC", "N m")],
        shape: &[("N", "1")],
        confused_with: &["torque_ripple"],
        experiment: "the same arc in both directions",
        kind: EntryKind::Static,
        hidden_by_parameters: false,
    },
    hypotheses: |effects, reach| reach.each_of(|joint| effects.is_revolute(joint), |_| whole(1, 4)),
    columns: |along, joints, shape| {
        along.defined(EffectKind::PositionDependentFriction, joints, shape)
    },
    described: &[EffectKind::PositionDependentFriction],
    implausible: |_| None,
};

pub(super) static TRANSMISSION_COUPLING: Effect = Effect {
    entry: Entry {
        name: "transmission_coupling",
        meaning: "friction of a shaft that two neighbouring joints turn together",
        formula: "(FSX sgn(v) + FVX v) (1, ratio) on two joints, v = qd_i + ratio qd_j",
        parameters: &[("FSX", "N m"), ("FVX", "N m s/rad")],
        shape: &[("ratio", "1")],
        confused_with: &["stribeck", "viscous_asymmetry"],
        experiment: "move the first joint alone, the second alone, both together",
        kind: EntryKind::Static,
        hidden_by_parameters: false,
    },
    hypotheses: wrist_pairs,
    columns: |along, joints, shape| along.defined(EffectKind::TransmissionCoupling, joints, shape),
    described: &[EffectKind::TransmissionCoupling],
    implausible: |values| {
        let drives = values.first().is_some_and(|coulomb| *coulomb < 0.0);
        drives.then_some("friction of the common shaft would be negative")
    },
};

/// Neighbours among the last three joints, turning the same way or against each other; any other
/// ratio is a robot's own and has to be described.
fn wrist_pairs(effects: &Effects, reach: &Reach<'_>) -> Vec<Hypothesis> {
    let moving: Vec<usize> = reach.moving().collect();
    let turns = |joint: usize| effects.is_revolute(joint) && moving.contains(&joint);
    let first = effects.joints().saturating_sub(3);
    let mut all = Vec::new();
    for joint in first..effects.joints().saturating_sub(1) {
        if turns(joint) && turns(joint + 1) {
            for ratio in [1.0, -1.0] {
                let mut pair = plain(vec![joint, joint + 1]);
                pair.grid = vec![vec![ratio]];
                pair.bounds = vec![ratio..ratio];
                all.push(pair);
            }
        }
    }
    all
}

pub(super) static LOAD_DEPENDENT_FRICTION: Effect = Effect {
    entry: Entry {
        name: "load_dependent_friction",
        meaning: "friction in proportion to the load that a gear carries",
        formula: "FL |tau_rigid| sgn(qd)",
        parameters: &[("FL", "1")],
        shape: &[],
        confused_with: &["drive_gain"],
        experiment: "the same arc loaded and unloaded, in both directions",
        kind: EntryKind::ModelDependent,
        hidden_by_parameters: false,
    },
    hypotheses: |_, reach| {
        let loaded = |joint: usize| largest(&reach.signals.tau_rigid[joint]) > 0.0;
        reach
            .moving()
            .filter(|&joint| loaded(joint))
            .map(|joint| plain(vec![joint]))
            .collect()
    },
    columns: |along, joints, _| {
        let column = |&joint: &usize| {
            let load = along.signals.tau_rigid[joint].iter();
            let torque = load
                .zip(along.sign(joint))
                .map(|(load, sign)| load.abs() * sign);
            along.column("FL", "1", joint, torque.collect())
        };
        joints.iter().map(column).collect()
    },
    described: &[],
    implausible: |values| match values.first() {
        Some(part) if *part < 0.0 => Some("friction would fall under load"),
        Some(part) if *part > 1.0 => Some("friction would be larger than the load that causes it"),
        _ => None,
    },
};
