//! Bodies, gravity and lengths other than described.

use idim_codegen::catalogue::EffectKind;
use idim_runtime::diagnose::{Entry, EntryKind, Hypothesis, TorqueColumn};

use idim_codegen::mechanism::inertia::NAMES;

use super::along::Along;
use super::evaluate::Motion;
use super::geometry::flange_axes;
use super::reach::plain;
use super::{Effect, Effects, Reach};

pub(super) static ROTOR_INERTIA: Effect = Effect {
    entry: Entry {
        name: "rotor_inertia",
        meaning: "rotor inertia seen at the joint, beyond that of the model",
        formula: "IA qdd",
        parameters: &[("IA", "kg m^2")],
        shape: &[],
        confused_with: &["joint_elasticity", "time_shift"],
        experiment: "only against a known or calibrated value: state it in [parameters] with its \
                     tolerance in [prior]",
        kind: EntryKind::Static,
        hidden_by_parameters: true,
    },
    hypotheses: |_, reach| reach.each_joint(),
    columns: |along, joints, shape| along.defined(EffectKind::RotorInertia, joints, shape),
    described: &[EffectKind::RotorInertia],
    implausible: |_| None,
};

pub(super) static PAYLOAD: Effect = Effect {
    entry: Entry {
        name: "payload",
        meaning: "a body at the tool: ten standard parameters in the frame of the last link",
        formula: "the ten columns of the last link",
        parameters: &[
            ("PXX", "kg m^2"),
            ("PXY", "kg m^2"),
            ("PXZ", "kg m^2"),
            ("PYY", "kg m^2"),
            ("PYZ", "kg m^2"),
            ("PZZ", "kg m^2"),
            ("PMX", "kg m"),
            ("PMY", "kg m"),
            ("PMZ", "kg m"),
            ("PM", "kg"),
        ],
        shape: &[],
        confused_with: &["base_tilt", "drive_gain", "link_length"],
        experiment: "the same motion with and without the body; the wrist tilted, at rest",
        kind: EntryKind::Static,
        hidden_by_parameters: true,
    },
    hypotheses: on_last_link,
    columns: payload,
    described: &[],
    implausible: |_| None,
};

/// On the joint whose link carries it, the last with a drive before the tool, if anything moves at
/// all.
fn on_last_link(effects: &Effects, reach: &Reach<'_>) -> Vec<Hypothesis> {
    let mechanism = &effects.robot.mechanism;
    let chain = mechanism.tool().map(|tool| mechanism.chain(tool));
    let mut outwards = chain.into_iter().flatten().rev();
    let last = outwards.find(|&joint| joint < mechanism.driven);
    let last = last.unwrap_or_default();
    let moves = reach.moving().next();
    moves.map(|_| plain(vec![last])).into_iter().collect()
}

/// On no joint, if anything moves at all.
fn whole_robot(_: &Effects, reach: &Reach<'_>) -> Vec<Hypothesis> {
    reach
        .moving()
        .next()
        .map(|_| plain(vec![]))
        .into_iter()
        .collect()
}

/// The columns of the last link that are not zero.
fn payload(along: &Along<'_>, _: &[usize], _: &[f64]) -> Vec<TorqueColumn> {
    let last = along.effects.robot.mechanism.tool().unwrap_or_default();
    let all = along.effects.tool().columns(&along.motion());
    let own = all.into_iter().skip(10 * last).take(10).enumerate();
    let column = |(place, torque): (usize, Vec<(usize, Vec<f64>)>)| TorqueColumn {
        name: format!("P{}", NAMES[place]),
        unit: PAYLOAD.entry.parameters[place].1,
        torque,
    };
    own.filter(|(_, torque)| !torque.is_empty())
        .map(column)
        .collect()
}

pub(super) static BASE_TILT: Effect = Effect {
    entry: Entry {
        name: "base_tilt",
        meaning: "base turned about x and y of frame 0 against the described gravity",
        formula: "TX d(tau_gravity)/d(angle about x) + TY d(tau_gravity)/d(angle about y)",
        parameters: &[("TX", "rad"), ("TY", "rad")],
        shape: &[],
        confused_with: &["payload", "torque_offset"],
        experiment: "turn the first joint through a full turn, standing still now and then",
        kind: EntryKind::Static,
        hidden_by_parameters: true,
    },
    hypotheses: |effects, reach| match effects.robot.description.gravity == [0.0; 3] {
        true => Vec::new(),
        false => whole_robot(effects, reach),
    },
    columns: base_tilt,
    described: &[],
    implausible: |values| {
        let far = values.iter().any(|angle| angle.abs() > 0.35);
        far.then_some("a base that is tilted by more than 20 degrees would have been seen")
    },
};

/// A base turned by a small angle about e sees gravity g - angle e x g.
fn base_tilt(along: &Along<'_>, _: &[usize], _: &[f64]) -> Vec<TorqueColumn> {
    let [gx, gy, gz] = along.effects.robot.description.gravity;
    let x: Vec<f64> = along.standard().iter().flatten().copied().collect();
    let still = standing(along);
    let of_axis = |model: &super::Linear| model.torque(&still, &x);
    let gravity = along.effects.gravity().each_ref().map(of_axis);
    let turned = |name: &str, direction: [f64; 3]| TorqueColumn {
        name: name.into(),
        unit: "rad",
        torque: combined(&gravity, direction),
    };
    vec![turned("TX", [0.0, gz, -gy]), turned("TY", [-gz, 0.0, gx])]
}

fn standing<'a>(along: &Along<'a>) -> Motion<'a> {
    Motion {
        still: true,
        ..along.motion()
    }
}

/// Torques under unit gravity along three axes, for gravity along a direction.
fn combined(axes: &[Vec<Vec<f64>>; 3], direction: [f64; 3]) -> Vec<(usize, Vec<f64>)> {
    let joints = axes[0].len();
    let of_joint = |joint: usize| {
        let [x, y, z] = axes.each_ref().map(|torque| &torque[joint]);
        let [a, b, c] = direction;
        let sums = x.iter().zip(y).zip(z);
        let torque = sums.map(|((x, y), z)| a * x + b * y + c * z).collect();
        (joint, torque)
    };
    (0..joints).map(of_joint).collect()
}

pub(super) static EXTERNAL_FORCE: Effect = Effect {
    entry: Entry {
        name: "external_force",
        meaning: "constant force on the flange, in the axes of frame 0 or of the flange",
        formula: "-J_v^T (FX, FY, FZ)",
        parameters: &[("FX", "N"), ("FY", "N"), ("FZ", "N")],
        shape: &[("axes", "0: frame 0, 1: flange")],
        confused_with: &["payload", "base_tilt"],
        experiment: "the same pose twice, the hose moved in between",
        kind: EntryKind::Static,
        hidden_by_parameters: false,
    },
    hypotheses: |effects, reach| {
        let axes = |hypothesis: Hypothesis| Hypothesis {
            grid: vec![vec![0.0], vec![1.0]],
            bounds: vec![0.0..1.0],
            ..hypothesis
        };
        whole_robot(effects, reach).into_iter().map(axes).collect()
    },
    columns: |along, _, shape| match shape {
        [axes] if *axes > 0.5 => force_with_flange(along),
        _ => force(along, along.effects.gravity()),
    },
    described: &[],
    implausible: |_| None,
};

/// A force on a point is the weight of a unit mass there under unit gravity along the force.
fn force(along: &Along<'_>, gravity: &[super::Linear; 3]) -> Vec<TorqueColumn> {
    let robot = &along.effects.robot.mechanism;
    let Some(last) = robot.tool() else {
        return Vec::new();
    };
    // The flange is the frame of the last body on the last link.
    let flange = robot.joints[last].bodies.last();
    let at = flange.map_or([0.0; 3], |body| body.pose.translation.into());
    let mut x = vec![0.0; 10 * robot.joints.len()];
    x[10 * last + 6..10 * last + 9].copy_from_slice(&at);
    x[10 * last + 9] = 1.0;
    let still = standing(along);
    let along_axis = |(name, model): (&str, &super::Linear)| TorqueColumn {
        name: name.into(),
        unit: "N",
        torque: model.torque(&still, &x).into_iter().enumerate().collect(),
    };
    let names = ["FX", "FY", "FZ"].into_iter();
    names.zip(gravity).map(along_axis).collect()
}

/// A force that turns with the flange.
fn force_with_flange(along: &Along<'_>) -> Vec<TorqueColumn> {
    let fixed = force(along, along.effects.gravity_of_root());
    let mechanism = &along.effects.robot.mechanism;
    let q = along.signals.q;
    let axes: Vec<_> = (0..along.len())
        .map(|i| {
            let q: Vec<f64> = q.iter().map(|series| series[i]).collect();
            flange_axes(mechanism, &q)
        })
        .collect();
    let mut turned = fixed.clone();
    for (axis, column) in turned.iter_mut().enumerate() {
        for (place, (_, torque)) in column.torque.iter_mut().enumerate() {
            for (i, (value, axes)) in torque.iter_mut().zip(&axes).enumerate() {
                let part = |from: usize| axes[(from, axis)] * fixed[from].torque[place].1[i];
                *value = (0..3).map(part).sum();
            }
        }
    }
    turned
}

pub(super) static LINK_LENGTH: Effect = Effect {
    entry: Entry {
        name: "link_length",
        meaning: "distance of a joint from its antecedent longer than described",
        formula: "DL d(tau_m)/d(length)",
        parameters: &[("DL", "m")],
        shape: &[],
        confused_with: &["payload", "joint_elasticity"],
        experiment: "a geometric calibration",
        kind: EntryKind::ModelDependent,
        hidden_by_parameters: true,
    },
    hypotheses: |effects, _| {
        let has_length = |joint: &usize| effects.length(*joint).is_some();
        (0..effects.joints())
            .filter(has_length)
            .map(|joint| plain(vec![joint]))
            .collect()
    },
    columns: |along, joints, _| {
        let column = |&joint: &usize| {
            let length = along.effects.length(joint)?;
            let torque = length.derivative(&along.motion(), along.standard());
            Some(TorqueColumn {
                name: format!("DL{}", joint + 1),
                unit: "m",
                torque: torque.into_iter().enumerate().collect(),
            })
        };
        joints.iter().filter_map(column).collect()
    },
    described: &[],
    implausible: |values| {
        let far = values.first().is_some_and(|length| length.abs() > 0.03);
        far.then_some("a length that is wrong by more than 3 cm would have been seen")
    },
};
