//! Named effects as descriptions have them.

use idim_codegen::base::BaseParameter;
use idim_codegen::builder;
use idim_codegen::robot::Output;
use idim_runtime::diagnose::{Catalogue, TorqueColumn};
use idim_runtime::observe::{Filtering, dahl};
use idim_runtime::report::{
    Change, Diagnosis, EffectParameter, Estimated, Fit, FoundEffect, Gap, Refitted, Verdict,
};
use idim_runtime::settings::{Derivatives, Edges, Velocity};

use super::arm::{Course, PLAIN, RATE};
use crate::catalogue::evaluate::{Linear, Motion};
use crate::catalogue::{Effects, toml};

#[test]
fn what_is_written_is_read_back_and_has_the_columns_of_the_catalogue() {
    let robot = PLAIN.robot();
    let effects = Effects::new(&robot);
    let course = Course::of(&robot);
    let mut names = Vec::new();
    for hypothesis in effects.hypotheses(&course.signals()) {
        let shape = &hypothesis.grid[0];
        let specs = effects.described(&hypothesis, shape);
        let entry = &effects.entries()[hypothesis.entry];
        if specs.is_empty() || names.contains(&entry.name) {
            continue;
        }
        names.push(entry.name);
        // Read back from its text it is the same effect.
        let text = format!(
            "name = \"probe\"\n[[joint]]\nname = \"yaw\"\nkind = \"revolute\"\n\
             [[joint]]\nname = \"pitch\"\nkind = \"revolute\"\nd = 0.3\n\
             [[joint]]\nname = \"elbow\"\nkind = \"revolute\"\nd = 0.3\n\
             [[joint]]\nname = \"roll\"\nkind = \"revolute\"\nd = 0.3\n{}",
            toml(&specs)
        );
        let read = builder::read_texts(&[("probe.toml", &text)]).unwrap();
        let tail = &read.description.effects[read.description.effects.len() - specs.len()..];
        for (read, written) in tail.iter().zip(&specs) {
            assert_eq!((read.kind, &read.joints), (written.kind, &written.joints));
            assert_eq!(read.shape, written.shape, "{}", entry.name);
        }
        // The extended robot has as many parameters more as the effect has columns of its own.
        let extended = effects.extended(&specs).unwrap();
        let more = extended.base.parameters.len() - robot.base.parameters.len();
        assert!(
            more >= 1 && more <= entry.parameters.len(),
            "{}",
            entry.name
        );
        assert!(!extended.entries(Output::Explicit).is_empty());
    }
    let expected = [
        "viscous_asymmetry",
        "stribeck",
        "nonlinear_viscous",
        "position_dependent_friction",
        "torque_ripple",
        "spring",
        "end_stop",
        "transmission_coupling",
        "presliding",
    ];
    assert_eq!(names, expected);
}

/// A diagnosis that found one effect on given joints.
pub fn diagnosis(robot: &idim_codegen::Robot, effect: FoundEffect) -> Diagnosis {
    let estimated = |value: f64| Estimated { value, sigma: None };
    let refitted = |(place, parameter): (usize, &BaseParameter)| Refitted {
        name: parameter.name.clone(),
        unit: parameter.unit.clone(),
        before: estimated(0.0),
        after: estimated(1.0 + place as f64),
    };
    let fit = || Fit {
        total_pct: 0.0,
        joints: Vec::new(),
    };
    Diagnosis {
        robot: "probe".into(),
        logs: Vec::new(),
        validation: Vec::new(),
        filter: filtering(),
        ranking: Vec::new(),
        command: None,
        pictures: None,
        verdict: Verdict::Named,
        effects: vec![effect],
        rejected: Vec::new(),
        located: Vec::new(),
        smooths: Vec::new(),
        gap: Gap {
            torque: Change {
                before: fit(),
                after: fit(),
            },
            simulation: None,
            on: String::new(),
        },
        parameters: robot
            .base
            .parameters
            .iter()
            .enumerate()
            .map(refitted)
            .collect(),
        changed: None,
        warnings: Vec::new(),
    }
}

fn filtering() -> Filtering {
    Filtering {
        fq_hz: 50.0,
        order: 4,
        nd: 10,
        trim: 0,
        border: (0, 0),
        edges: Edges::Scipy,
        derivatives: Derivatives::Central,
        velocity: Velocity::Derived,
        prefilter_torque: false,
        chosen: Vec::new(),
    }
}

/// D X of a robot.
fn model_torque(robot: &idim_codegen::Robot, motion: &Motion<'_>, x: &[f64]) -> Vec<Vec<f64>> {
    let columns = robot.base.parameters.iter();
    let columns = columns.map(|parameter| parameter.columns.explicit.as_slice());
    Linear::new(&robot.graph, 4, columns.enumerate()).torque(motion, x)
}

#[test]
fn what_is_found_is_written_with_its_values_or_said_to_belong_elsewhere() {
    let robot = PLAIN.robot();
    let effects = Effects::new(&robot);
    let course = Course::of(&robot);
    let mut elsewhere = Vec::new();
    for hypothesis in effects.hypotheses(&course.signals()) {
        let entry = &effects.entries()[hypothesis.entry];
        let shape = &hypothesis.grid[0];
        let made = effects.columns(&hypothesis, shape, &course.signals());
        let parameter = |column: &TorqueColumn| EffectParameter {
            name: column.name.clone(),
            unit: column.unit.into(),
            value: 0.25,
            sigma: None,
        };
        let names = entry.shape.iter().map(|(name, _)| (*name).to_owned());
        let found = diagnosis(
            &robot,
            FoundEffect {
                effect: entry.name.into(),
                joint: None,
                joints: hypothesis.joints.iter().map(|joint| joint + 1).collect(),
                meaning: String::new(),
                formula: String::new(),
                parameters: made.iter().map(parameter).collect(),
                shape: names.zip(shape.iter().copied()).collect(),
                p_value: 0.0,
                gain_pct: 0.0,
                alternatives: Vec::new(),
                experiment: String::new(),
            },
        );
        let extension = effects.extension(&found).unwrap();
        assert_eq!(
            extension.specs,
            effects.described(&hypothesis, shape),
            "{}",
            entry.name
        );
        if let Some((_, belongs)) = extension.elsewhere.first() {
            assert!(!belongs.is_empty());
            elsewhere.push(entry.name);
            continue;
        }
        // The torque of the written robot is that of the refit and the effect, wherever no sign
        // is interpolated.
        let values: Vec<f64> = found.parameters.iter().map(|p| p.after.value).collect();
        let mut expected = model_torque(&robot, &course.motion(), &values);
        for column in &made {
            for (joint, torque) in &column.torque {
                let pairs = expected[*joint].iter_mut().zip(torque);
                pairs.for_each(|(sum, torque)| *sum += 0.25 * torque);
            }
        }
        let slip = (entry.name == "presliding").then(|| {
            let joint = hypothesis.joints[0];
            (joint, dahl(&course.qd[joint], RATE, shape[0], 0.0))
        });
        let motion = Motion {
            slip: slip
                .as_ref()
                .map(|(joint, state)| (*joint, state.as_slice())),
            ..course.motion()
        };
        let torque = model_torque(&extension.robot, &motion, &extension.parameters);
        let together = |i: usize| match (&hypothesis.joints[..], &shape[..]) {
            (&[a, b], &[ratio]) => course.qd[a][i] + ratio * course.qd[b][i],
            _ => f64::INFINITY,
        };
        let moves = |i: usize| {
            let own = course.qd.iter().all(|qd| qd[i].abs() > 0.05);
            own && together(i).abs() > 0.2
        };
        let counted = (0..course.t.len()).filter(|&i| moves(i));
        for (i, joint) in counted.flat_map(|i| (0..4).map(move |joint| (i, joint))) {
            let (torque, expected) = (torque[joint][i], expected[joint][i]);
            let apart = (torque - expected).abs();
            assert!(
                apart < 1e-10 * (1.0 + expected.abs()),
                "{}: {apart}",
                entry.name
            );
        }
    }
    elsewhere.dedup();
    let expected = [
        "base_tilt",
        "external_force",
        "load_dependent_friction",
        "drive_gain",
        "drive_saturation",
        "drive_dead_zone",
        "time_shift",
        "link_length",
        "encoder_eccentricity",
        "friction_drift",
        "joint_elasticity",
        "backlash",
    ];
    assert_eq!(elsewhere, expected);
}
