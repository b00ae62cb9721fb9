//! What a diagnosis must not fall for: torque in its own columns, what base parameters hide, what
//! holds on one motion alone, standstill, coloured noise, logs that cannot confirm anything.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

#[allow(dead_code, reason = "the diagnosis' other tests use the rest")]
mod arm;

use arm::{
    COULOMB, Course, Hidden, Plan, RATE_HZ, TRAIN, VALID, arm, names, normal, nothing, said,
};
use idim::catalogue::Effects;
use idim::interpreted::Interpreter;
use idim::runtime::diagnose::{Catalogue, DiagnoseError, Log, Signals};
use idim::runtime::identify::Options as Identification;
use idim::runtime::log::Recording;
use idim::runtime::model::IdentificationModel;
use idim::runtime::observe::{Filtering, ModelKind, Motion, dahl, observe};
use idim::runtime::report::{Diagnosis, Verdict};
use idim::runtime::settings::Derivatives;

/// The bits of every column of the null model and of every candidate along a log, with parameters
/// that do not change. Where the diagnosis refits them, what the model predicts changes with them
/// and with nothing else.
fn columns(recording: &Recording) -> Vec<u64> {
    let robot = arm();
    let (model, catalogue) = (Interpreter::new(&robot), Effects::new(&robot));
    let asked = Identification {
        fq_hz: Some(50.0),
        nd: Some(20),
        derivatives: Some(Derivatives::Central),
        ..Identification::default()
    };
    let filtering = asked.resolve(&model, std::slice::from_ref(recording));
    let filtering: Filtering = filtering.unwrap().filtering;
    let motion = Motion::full(recording, &model, &filtering).unwrap();
    let mut all: Vec<f64> = Vec::new();
    let null = observe(&model, ModelKind::Explicit, &motion, &filtering).unwrap();
    null.blocks.iter().for_each(|block| all.extend(&block.w));
    let parameters: Vec<f64> = (1..=model.columns().len()).map(|k| k as f64).collect();
    let load: Vec<Vec<f64>> = motion
        .q
        .iter()
        .map(|q| q.iter().map(|q| 3.0 * q.cos()).collect())
        .collect();
    let t: Vec<f64> = (0..motion.len).map(|k| k as f64 / RATE_HZ).collect();
    let signals = Signals {
        rate_hz: RATE_HZ,
        t: &t,
        q: &motion.q,
        qd: &motion.qd,
        qdd: &motion.qdd,
        tau_model: &load,
        tau_rigid: &load,
        parameters: &parameters,
        dead_band: &[1e-3, 1e-3],
    };
    let along = catalogue.along(signals);
    for hypothesis in catalogue.hypotheses(&signals) {
        for column in along(&hypothesis, &hypothesis.grid[0]) {
            column
                .torque
                .iter()
                .for_each(|(_, torque)| all.extend(torque));
        }
    }
    all.into_iter().map(f64::to_bits).collect()
}

#[test]
fn no_column_changes_with_the_measured_torque() {
    let plan = Plan {
        periods: 1,
        ..TRAIN
    };
    let log = plan.log(&nothing).recording;
    let with = |tau: Option<Vec<Vec<f64>>>| columns(&Recording { tau, ..log.clone() });
    let mut noise = normal(9);
    let noise = (0..2).map(|_| (0..log.len).map(|_| 1e3 * noise()).collect());
    let own = with(log.tau.clone());
    assert!(own.len() > 50 * log.len, "{}", own.len());
    assert!(own == with(Some(noise.collect())), "noise");
    assert!(
        own == with(Some(vec![vec![f64::NAN; log.len]; 2])),
        "no numbers"
    );
    assert!(own == with(None), "no torque");
}

#[test]
fn what_base_parameters_absorb_is_said_to_be_indistinguishable() {
    // A rotor at the shoulder turns with the link: ZZR1 = ZZ1 + IA1 + L^2 M2.
    let rotor = |joint: usize, course: &Course| match joint {
        0 => course.qdd.iter().map(|qdd| 2.0 * qdd).collect(),
        _ => nothing(joint, course),
    };
    let found = said(&[TRAIN.log(&rotor)], &[VALID.log(&rotor)]).unwrap();
    assert_eq!(found.verdict, Verdict::Nothing, "{:?}", names(&found));
    let inertia = found.parameters.iter().find(|p| p.name == "ZZR1").unwrap();
    assert!((inertia.after.value - 5.5).abs() < 0.05, "{inertia:?}");
    let mut rejected = found.rejected.iter();
    let rotor = rejected.find(|r| r.effect == "rotor_inertia" && r.joints == [1]);
    let why = &rotor.unwrap().why;
    assert!(why.contains("base parameters"), "{why}");
}

#[test]
fn what_improves_the_training_log_alone_is_rejected_and_says_why() {
    let ripple = |joint: usize, course: &Course| match joint {
        1 => course.map(|q, _| 0.8 * (6.0 * q + 0.4).sin()),
        _ => nothing(joint, course),
    };
    let found = said(&[TRAIN.log(&ripple)], &[VALID.log(&nothing)]).unwrap();
    let names = names(&found);
    assert!(
        !names.iter().any(|(name, _)| *name == "torque_ripple"),
        "{names:?}"
    );
    assert_ne!(found.verdict, Verdict::Named, "{names:?}");
    let mut rejected = found.rejected.iter();
    let ripple = rejected.find(|r| r.effect == "torque_ripple" && r.joints == [2]);
    let why = &ripple.unwrap().why;
    assert!(
        why.contains("improves the training log") && why.contains("validation"),
        "{why}"
    );
}

/// A spring on a crank pulls at the elbow: over the elbow's short way it is a ripple or a spring to
/// within the noise, and neither would hold beyond it.
#[test]
fn a_ripple_that_has_not_repeated_is_a_hint() {
    let crank = |joint: usize, course: &Course| match joint {
        1 => course.map(|q, _| {
            let (sin, cos) = (q - 0.3).sin_cos();
            let length = (1.0 + 0.75 * 0.75 - 1.5 * cos).sqrt();
            6.0 * (1.0 - 0.55 / length) * sin
        }),
        _ => nothing(joint, course),
    };
    let found = said(&[TRAIN.log(&crank)], &[VALID.log(&crank)]).unwrap();
    let names = names(&found);
    assert_eq!(found.verdict, Verdict::Unknown, "{names:?}");
    assert!(names.contains(&("torque_ripple", &[2])), "{names:?}");
    let told = |w: &String| w.contains("periods of the torque_ripple of joint `elbow`");
    assert!(found.warnings.iter().any(told), "{:?}", found.warnings);
}

#[test]
fn a_standstill_makes_no_friction_effect() {
    // A joint at rest is held by any torque below its Coulomb friction.
    let held = |joint: usize, course: &Course| -> Vec<f64> {
        let hold = |(t, qd): (&f64, &f64)| match qd.abs() < 1e-12 {
            true => 0.8 * COULOMB[joint] * (2.0 * t.floor()).sin(),
            false => 0.0,
        };
        course.t.iter().zip(&course.qd).map(hold).collect()
    };
    for seed in [1, 5, 7] {
        let plan = Plan {
            seed,
            period: 10.0,
            rests: true,
            ..TRAIN
        };
        let other = Plan {
            seed: seed + 1,
            periods: 2,
            ..plan
        };
        let found = said(&[plan.log(&held)], &[other.log(&held)]).unwrap();
        assert_eq!(
            found.verdict,
            Verdict::Nothing,
            "{seed}: {:?}",
            names(&found)
        );
    }
}

#[test]
fn a_correct_model_with_coloured_noise_lacks_nothing() {
    let repeated = [(3, 0.02), (4, 0.1), (5, 0.5)].map(|(seed, colour)| Plan {
        seed,
        colour,
        ..TRAIN
    });
    let once = [(6, 0.05), (7, 0.2), (12, 0.1)].map(|(seed, colour)| Plan {
        seed,
        colour,
        period: 24.0,
        periods: 1,
        rests: false,
    });
    for plan in repeated.into_iter().chain(once) {
        let other = Plan {
            seed: plan.seed + 50,
            period: 12.0,
            periods: 1,
            ..plan
        };
        let found = said(&[plan.log(&nothing)], &[other.log(&nothing)]).unwrap();
        let about = (plan.seed, names(&found), &found.located);
        assert_eq!(found.verdict, Verdict::Nothing, "{about:?}");
    }
}

/// A ripple of the elbow.
fn ripple(joint: usize, course: &Course) -> Vec<f64> {
    match joint {
        1 => course.map(|q, _| 0.8 * (6.0 * q + 0.4).sin()),
        _ => nothing(joint, course),
    }
}

/// What is said of a ripple with a validation log that is changed.
fn with_validation(change: impl Fn(&mut Recording)) -> Result<Diagnosis, DiagnoseError> {
    let mut valid = VALID.log(&ripple);
    change(&mut valid.recording);
    said(&[TRAIN.log(&ripple)], &[valid])
}

#[test]
fn a_validation_log_of_another_robot_is_refused() {
    let error = with_validation(|log| {
        let tau = log.tau.as_mut().unwrap();
        tau.swap(0, 1);
    });
    let error = error.unwrap_err();
    assert!(matches!(error, DiagnoseError::OtherRobot { .. }), "{error}");
    assert!(error.to_string().contains("log2.csv"), "{error}");
}

#[test]
fn a_validation_log_in_another_unit_is_refused_with_its_factor() {
    let error = with_validation(|log| {
        let tau = log.tau.iter_mut().flatten().flatten();
        tau.for_each(|tau| *tau *= 1000.0);
    });
    match error.unwrap_err() {
        DiagnoseError::OtherUnit { joint, factor, .. } => {
            assert_eq!(joint, "shoulder");
            assert!((factor / 1000.0 - 1.0).abs() < 0.02, "{factor}");
        }
        other => panic!("{other}"),
    }
}

#[test]
fn the_training_log_does_not_prove_itself() {
    let log = || TRAIN.log(&ripple);
    let found = said(&[log()], &[log()]).unwrap();
    let told = found
        .warnings
        .iter()
        .any(|w| w.contains("confirms and proves nothing"));
    assert!(told, "{:?}", found.warnings);
    assert!(
        found.gap.on.contains("nothing is proven"),
        "{}",
        found.gap.on
    );
}

#[test]
fn too_little_data_says_how_much_is_needed() {
    let short = |seconds: f64| {
        let plan = Plan {
            periods: 1,
            ..TRAIN
        };
        let mut log: Log = plan.log(&nothing);
        let keep = (seconds * RATE_HZ) as usize;
        let all = &mut log.recording;
        let series = all.q.iter_mut().chain(all.tau.iter_mut().flatten());
        series.for_each(|series| series.truncate(keep));
        all.stamps.truncate(keep);
        all.len = keep;
        said(&[log], &[])
    };
    let DiagnoseError::TooShort { seconds, .. } = short(1.5).unwrap_err() else {
        panic!("1.5 s are too little");
    };
    let error = short(1.5).unwrap_err().to_string();
    let told = format!("at least {seconds:.1} s of motion");
    assert!(error.contains(&told), "{error}");
    assert!(short(seconds + 0.1).is_ok(), "{seconds}");
    assert!(matches!(short(0.3), Err(DiagnoseError::Observe(_))));
}

/// What is said of hidden torque in both logs.
fn of(hidden: Hidden<'_>) -> Diagnosis {
    said(&[TRAIN.log(hidden)], &[VALID.log(hidden)]).unwrap()
}

#[test]
fn effects_that_cancel_get_no_wrong_name() {
    // After each reversal one adds what the other lacks.
    let both = |joint: usize, course: &Course| -> Vec<f64> {
        if joint == 1 {
            return nothing(joint, course);
        }
        let contact = dahl(&course.qd, RATE_HZ, 0.02, 0.0);
        let torque = |(contact, qd): (&f64, &f64)| {
            let stribeck = 3.0 * qd.signum() * (-(qd / 0.2).powi(2)).exp();
            stribeck + 3.0 * (contact - qd.signum())
        };
        contact.iter().zip(&course.qd).map(torque).collect()
    };
    let found = of(&both);
    let names = names(&found);
    let true_names = ["stribeck", "presliding"];
    let right = names
        .iter()
        .all(|(name, joints)| true_names.contains(name) && *joints == [1]);
    assert!(found.verdict != Verdict::Named || right, "{names:?}");
    assert!(found.verdict != Verdict::Nothing);
}
