//! What lies between the logged torque and the torque at the joint.

use idim_runtime::diagnose::{Entry, EntryKind, Hypothesis, TorqueColumn};

use super::along::Along;
use super::reach::{largest, plain, top};
use super::{Effect, Effects, Reach};

pub(super) static DRIVE_GAIN: Effect = Effect {
    entry: Entry {
        name: "drive_gain",
        meaning: "error of the drive's gain, as a fraction of it",
        formula: "DG tau_m",
        parameters: &[("DG", "1")],
        shape: &[],
        confused_with: &["payload", "load_dependent_friction"],
        experiment: "a known mass at the tool",
        kind: EntryKind::ModelDependent,
        hidden_by_parameters: true,
    },
    hypotheses: |_, reach| reach.each_joint(),
    columns: drive_gain,
    described: &[],
    implausible: |values| {
        let wild = values.first().is_some_and(|part| part.abs() > 0.8);
        wild.then_some("the drive's gain would be wrong by more than 80 %")
    },
};

/// Of one joint, or of all alike where none is given.
fn drive_gain(along: &Along<'_>, joints: &[usize], _: &[f64]) -> Vec<TorqueColumn> {
    let torque = |joint: usize| along.signals.tau_model[joint].clone();
    match joints {
        [] => vec![TorqueColumn {
            name: "DG".into(),
            unit: "1",
            torque: (0..along.effects.joints())
                .map(|joint| (joint, torque(joint)))
                .collect(),
        }],
        _ => joints
            .iter()
            .map(|&joint| along.column("DG", "1", joint, torque(joint)))
            .collect(),
    }
}

pub(super) static DRIVE_SATURATION: Effect = Effect {
    entry: Entry {
        name: "drive_saturation",
        meaning: "gain of the drive that changes beyond a torque level",
        formula: "DS (tau_m - clip(tau_m, +-level))",
        parameters: &[("DS", "1")],
        shape: &[("level", "N m")],
        confused_with: &["load_dependent_friction", "nonlinear_viscous"],
        experiment: "one fast move, repeated at lower acceleration",
        kind: EntryKind::ModelDependent,
        hidden_by_parameters: false,
    },
    hypotheses: saturation,
    columns: |along, joints, shape| {
        let (&[joint], &[level]) = (joints, shape) else {
            return Vec::new();
        };
        let level = level.abs();
        let beyond = |tau: &f64| tau - tau.clamp(-level, level);
        let torque = along.signals.tau_model[joint].iter().map(beyond);
        vec![along.column("DS", "1", joint, torque.collect())]
    },
    described: &[],
    implausible: |values| {
        let turned = values.first().is_some_and(|part| *part < -1.5);
        turned.then_some("the torque would fall where the drive is asked for more")
    },
};

/// Levels as fractions of the largest torque.
const LEVELS: [f64; 6] = [0.48, 0.6, 0.7, 0.8, 0.9, 0.99];

fn saturation(_: &Effects, reach: &Reach<'_>) -> Vec<Hypothesis> {
    reach.each_of(
        |joint| largest(&reach.signals.tau_model[joint]) > 0.0,
        |joint| {
            let top = top(&reach.signals.tau_model[joint]);
            LEVELS.iter().map(|fraction| fraction * top).collect()
        },
    )
}

pub(super) static DRIVE_DEAD_ZONE: Effect = Effect {
    entry: Entry {
        name: "drive_dead_zone",
        meaning: "torque that the drive is asked for and does not give, by its sign",
        formula: "DZ tanh(tau_m / (0.03 max|tau_m|))",
        parameters: &[("DZ", "N m")],
        shape: &[],
        confused_with: &["backlash", "stribeck"],
        experiment: "motion where torque and speed differ in sign",
        kind: EntryKind::ModelDependent,
        hidden_by_parameters: false,
    },
    hypotheses: |_, reach| reach.each_joint(),
    columns: |along, joints, _| {
        let column = |&joint: &usize| {
            let torque = direction(&along.signals.tau_model[joint]);
            along.column("DZ", along.force(joint), joint, torque)
        };
        joints.iter().map(column).collect()
    },
    described: &[],
    implausible: |values| {
        let gives = values.first().is_some_and(|lost| *lost < 0.0);
        gives.then_some("the drive would give more than it is asked for near zero")
    },
};

/// The sign of a torque, smooth over 3 % of its largest value.
pub(super) fn direction(torque: &[f64]) -> Vec<f64> {
    let width = 0.03 * top(torque);
    let sign = |tau: &f64| match width > 0.0 {
        true => (tau / width).tanh(),
        false => 0.0,
    };
    torque.iter().map(sign).collect()
}

pub(super) static TIME_SHIFT: Effect = Effect {
    entry: Entry {
        name: "time_shift",
        meaning: "torque logged ahead of the motion; negative: late",
        formula: "TSH d(tau_m)/dt, on one joint or on all",
        parameters: &[("TSH", "s")],
        shape: &[],
        confused_with: &["joint_elasticity", "rotor_inertia"],
        experiment: "a chirp: the phase of a shift is linear in frequency, that of a lag \
                     saturates, elasticity resonates",
        kind: EntryKind::ModelDependent,
        hidden_by_parameters: false,
    },
    hypotheses: |_, reach| {
        let mut all = vec![plain(vec![])];
        all.extend(reach.each_joint());
        let least = SAMPLES / reach.signals.rate_hz;
        all.into_iter()
            .map(|shift| Hypothesis { least, ..shift })
            .collect()
    },
    columns: time_shift,
    described: &[],
    implausible: |values| {
        let far = values.first().is_some_and(|shift| shift.abs() > 0.1);
        far.then_some("the channels of a log are not more than 0.1 s apart")
    },
};

/// Samples between motion and torque that say nothing of the robot: how a logger stamps what it reads
/// and what it sends is its own business.
const SAMPLES: f64 = 1.5;

/// Of one joint, or of all where none is given.
fn time_shift(along: &Along<'_>, joints: &[usize], _: &[f64]) -> Vec<TorqueColumn> {
    let rate = |joint: usize| along.rate(&along.signals.tau_model[joint]);
    match joints {
        [] => vec![TorqueColumn {
            name: "TSH".into(),
            unit: "s",
            torque: (0..along.effects.joints())
                .map(|joint| (joint, rate(joint)))
                .collect(),
        }],
        _ => joints
            .iter()
            .map(|&joint| along.column("TSH", "s", joint, rate(joint)))
            .collect(),
    }
}
