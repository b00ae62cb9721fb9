//! Effects with a state that runs along the motion.

use std::f64::consts::TAU;

use idim_codegen::catalogue::EffectKind;
use idim_runtime::diagnose::{Entry, EntryKind, Hypothesis, TorqueColumn};
use idim_runtime::observe::dahl;

use super::along::Along;
use super::evaluate::Motion;
use super::gear::Link;
use super::reach::{geometric, plain};
use super::{Effect, Effects, Reach};

pub(super) static PRESLIDING: Effect = Effect {
    entry: Entry {
        name: "presliding",
        meaning: "friction that turns round over a displacement: a contact that yields before it \
                  slides",
        formula: "FP (z/zs - sgn(qd)), dz/dt = qd - |qd| z/zs (Dahl)",
        parameters: &[("FP", "N m")],
        shape: &[("zs", "rad")],
        confused_with: &["stribeck", "backlash", "joint_elasticity"],
        experiment: "small reversals of growing amplitude",
        kind: EntryKind::Memory,
        hidden_by_parameters: false,
    },
    hypotheses: |_, reach| reach.each_of(|_| true, |_| geometric(0.002, 0.08, 6)),
    columns: presliding,
    described: &[EffectKind::Presliding],
    implausible: |values| {
        let negative = values.first().is_some_and(|friction| *friction < 0.0);
        negative.then_some("friction would be largest before the joint slides: no yielding contact")
    },
};

fn presliding(along: &Along<'_>, joints: &[usize], shape: &[f64]) -> Vec<TorqueColumn> {
    let (&[joint], &[zs]) = (joints, shape) else {
        return Vec::new();
    };
    let slip = dahl(&along.signals.qd[joint], along.signals.rate_hz, zs, 0.0);
    let motion = Motion {
        slip: Some((joint, &slip)),
        ..along.motion()
    };
    along.defined_along(&motion, EffectKind::Presliding, joints, shape)
}

pub(super) static FRICTION_DRIFT: Effect = Effect {
    entry: Entry {
        name: "friction_drift",
        meaning: "friction that changes from the beginning of the log, as the robot warms up",
        formula: "(1 - exp(-t/T)) (FDS sgn(qd) + FDV qd)",
        parameters: &[("FDS", "N m"), ("FDV", "N m s/rad")],
        shape: &[("T", "s")],
        confused_with: &["nonlinear_viscous"],
        experiment: "the same motion cold and warm",
        kind: EntryKind::Memory,
        hidden_by_parameters: false,
    },
    hypotheses: |_, reach| {
        let longest = (1.25 * reach.duration()).clamp(1.5, 600.0);
        reach.each_of(|_| true, |_| geometric(1.5, longest, 6))
    },
    columns: friction_drift,
    described: &[],
    implausible: |_| None,
};

fn friction_drift(along: &Along<'_>, joints: &[usize], shape: &[f64]) -> Vec<TorqueColumn> {
    let (&[joint], &[time]) = (joints, shape) else {
        return Vec::new();
    };
    let warm = |t: &f64| -(-t / time).exp_m1();
    let times = |series: &[f64]| -> Vec<f64> {
        let pairs = along.signals.t.iter().zip(series);
        pairs.map(|(t, x)| warm(t) * x).collect()
    };
    let viscous = along.by_kind(joint, "N m s/rad", "N s/m");
    vec![
        along.column("FDS", along.force(joint), joint, times(&along.sign(joint))),
        along.column("FDV", viscous, joint, times(&along.signals.qd[joint])),
    ]
}

pub(super) static JOINT_ELASTICITY: Effect = Effect {
    entry: Entry {
        name: "joint_elasticity",
        meaning: "a gear that yields: the link follows the drive behind a resonance",
        formula: "d(tau_links)/dq_j along -CE k z and its time derivatives, M z'' + (C + d) z' + \
                  (K + k) z = tau_links_j: M, C, K of the link at each pose, k and d such that one \
                  with the median M swings with f and damping",
        parameters: &[("CE", "rad/(N m)")],
        shape: &[("f", "Hz"), ("damping", "1")],
        confused_with: &["rotor_inertia", "time_shift", "link_length"],
        experiment: "a chirp; a test with the output locked",
        kind: EntryKind::Yielding,
        hidden_by_parameters: false,
    },
    hypotheses: elasticity_grid,
    columns: elasticity,
    described: &[],
    implausible: |values| match values.first() {
        Some(yields) if *yields < 0.0 => Some("the stiffness of the joint would be negative"),
        _ => None,
    },
};

/// Frequencies from 2 to 15 Hz with three dampings.
fn elasticity_grid(_: &Effects, reach: &Reach<'_>) -> Vec<Hypothesis> {
    let nyquist = 0.5 * reach.signals.rate_hz;
    let highest = 15f64.min(0.8 * nyquist);
    let on_joint = |joint: usize| {
        let mut elastic = plain(vec![joint]);
        elastic.grid = geometric(2.0, highest, 7)
            .into_iter()
            .flat_map(|f| [0.03, 0.1, 0.3].map(|damping| vec![f, damping]))
            .collect();
        elastic.bounds = vec![2.0..highest.max(2.0), 0.02..0.3];
        elastic
    };
    reach.moving().map(on_joint).collect()
}

/// The link lies behind its drive by what the gear yields to the torque that it carries. The shape is
/// that of a link with the median of its inertia on a locked drive.
fn elasticity(along: &Along<'_>, joints: &[usize], shape: &[f64]) -> Vec<TorqueColumn> {
    let (&[joint], &[f, damping]) = (joints, shape) else {
        return Vec::new();
    };
    let Some(link) = Link::of(along, joint) else {
        return Vec::new();
    };
    let w = TAU * f;
    let stiffness = w * w * link.mass;
    let behind = link.yields(stiffness, 2.0 * damping * w * link.mass);
    vec![TorqueColumn {
        name: format!("CE{}", joint + 1),
        unit: along.by_kind(joint, "rad/(N m)", "m/N"),
        torque: along.link_displaced(joint, &behind.times(-stiffness)),
    }]
}

pub(super) static BACKLASH: Effect = Effect {
    entry: Entry {
        name: "backlash",
        meaning: "play of a gear: the link lies behind or before the drive by half the gap",
        formula: "d(tau_links)/dq_j along -gap z/play and its time derivatives, M z'' + C z' + K z = \
                  tau_links_j between stops at +-play/2 that do not throw back; gap and play agree \
                  where the model is right",
        parameters: &[("gap", "rad")],
        shape: &[("play", "rad")],
        confused_with: &["presliding", "stribeck", "joint_elasticity"],
        experiment: "sign changes of the load at a constant direction of motion",
        kind: EntryKind::Yielding,
        hidden_by_parameters: false,
    },
    hypotheses: |_, reach| reach.each_of(|_| true, |_| geometric(4e-4, 2.5e-2, 7)),
    columns: backlash,
    described: &[],
    implausible: |values| match values.first() {
        Some(gap) if *gap < 0.0 => Some("the gap would be negative"),
        Some(gap) if *gap > 0.2 => Some("a gap of more than 0.2 rad would have been heard"),
        _ => None,
    },
};

fn backlash(along: &Along<'_>, joints: &[usize], shape: &[f64]) -> Vec<TorqueColumn> {
    let (&[joint], &[play]) = (joints, shape) else {
        return Vec::new();
    };
    let Some(link) = Link::of(along, joint) else {
        return Vec::new();
    };
    vec![TorqueColumn {
        name: format!("gap{}", joint + 1),
        unit: along.by_kind(joint, "rad", "m"),
        torque: along.link_displaced(joint, &link.plays(play).times(-1.0 / play)),
    }]
}
