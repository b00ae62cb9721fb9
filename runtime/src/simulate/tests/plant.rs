//! Drives, encoders and what acts beside a model, each against its own law.

use super::model::{DOUBLE, G, double_pendulum, pendulum};
use crate::log::{Controller, Feedforward, Fourier, Law, Reference, Start};
use crate::signal::central_difference;
use crate::simulate::{
    ClosedLoop, Disturbance, Drift, Drive, Encoder, Grid, Influence, LoadFriction, Measured,
    Method, Options, Plant, SimulateError, Weight, controlled,
};

const GRID: Grid = Grid {
    rate_hz: 1000.0,
    start: 0.0,
    len: 3001,
};

/// ZZ, MX, FV, FS.
const PENDULUM: [f64; 4] = [0.35, 0.8, 0.15, 0.0];

fn swinging() -> Reference {
    Reference::Fourier(Fourier {
        f0_hz: 1.0 / 3.0,
        periods: 1.0,
        center: vec![0.5],
        sin: vec![vec![0.7, -0.2]],
        cos: vec![vec![0.3, 0.1]],
    })
}

fn still() -> Reference {
    Reference::Fourier(Fourier {
        f0_hz: 1.0,
        periods: 3.0,
        center: vec![0.5],
        sin: vec![vec![0.0]],
        cos: vec![vec![0.0]],
    })
}

fn controller() -> Controller {
    Controller {
        law: Law::Pd,
        kp: vec![300.0],
        kd: vec![15.0],
        feedforward: Feedforward::None,
        velocity_filter_hz: None,
        torque_limit: None,
        start: Start::Reference,
    }
}

fn run(plant: Plant<'_>, reference: &Reference) -> Measured {
    let controller = controller();
    let plan = ClosedLoop {
        reference,
        controller: &controller,
        rigid: &PENDULUM,
        grid: GRID,
        start: None,
    };
    let options = Options {
        method: Method::Fixed { step_s: 1e-3 },
        ..Options::default()
    };
    controlled(plant, &pendulum(), &plan, &options).unwrap()
}

fn with(parameters: &[f64], influence: impl Influence) -> Measured {
    let model = pendulum();
    let mut plant = Plant::ideal(&model, parameters);
    plant.influences.push(Box::new(influence));
    run(plant, &swinging())
}

fn without(parameters: &[f64]) -> Measured {
    let model = pendulum();
    run(Plant::ideal(&model, parameters), &swinging())
}

fn furthest(one: &Measured, other: &Measured, samples: std::ops::Range<usize>) -> f64 {
    let [one, other] = [one, other].map(|run| &run.motion.q[0][samples.clone()]);
    one.iter()
        .zip(other)
        .fold(0.0, |far: f64, (a, b)| far.max((a - b).abs()))
}

#[test]
fn drive_loses_its_dead_zone_and_gives_its_share_beyond_its_level() {
    let drive = Drive {
        gain: 2.0,
        dead_zone: 1.0,
        saturation: Some((5.0, 0.5)),
        lag: 0.0,
    };
    for (command, torque) in [
        (0.4, 0.0),
        (2.0, 3.0),
        (-2.0, -3.0),
        (4.0, 6.0),
        (-4.0, -6.0),
    ] {
        assert_eq!(drive.delivers(command), torque, "{command}");
    }
    assert_eq!(Drive::IDEAL.delivers(-3.25), -3.25);
}

#[test]
fn lagging_drive_follows_the_held_command_exponentially() {
    let model = pendulum();
    let mut plant = Plant::ideal(&model, &PENDULUM);
    plant.drives[0].lag = 0.01;
    let run = run(plant, &swinging());
    let (applied, command) = (&run.motion.tau[0], &run.tau[0]);
    let keep = (-0.1f64).exp();
    for k in 1..GRID.len {
        let expected = command[k - 1] + (applied[k - 1] - command[k - 1]) * keep;
        assert!((applied[k] - expected).abs() < 1e-9, "{k}");
    }
}

#[test]
fn encoder_reads_its_error_and_its_steps_and_the_controller_follows_them() {
    let model = pendulum();
    let encoder = Encoder {
        eccentricity: Some((3.0, 2e-2, -1e-2)),
        resolution: Some(1e-3),
    };
    let mut plant = Plant::ideal(&model, &PENDULUM);
    plant.encoders[0] = encoder;
    let seen = run(plant, &still());
    for (read, q) in seen.q[0].iter().zip(&seen.motion.q[0]) {
        let exact = q + 2e-2 * (3.0 * q).sin() - 1e-2 * (3.0 * q).cos();
        assert!((read - exact).abs() <= 0.5e-3 + 1e-12);
        assert!((read / 1e-3 - (read / 1e-3).round()).abs() < 1e-9);
    }
    // Held by what is read, the true position is off by the error.
    let exact = run(Plant::ideal(&model, &PENDULUM), &still());
    let [off, held] = [&seen, &exact].map(|run| *run.motion.q[0].last().unwrap());
    let error = 2e-2 * (3.0 * off).sin() - 1e-2 * (3.0 * off).cos();
    assert!((held - off - error).abs() < 2e-3, "{held} {off} {error}");
}

#[test]
fn weight_of_another_model_is_that_of_a_greater_first_moment() {
    let model = pendulum();
    let weight = Weight::new(&model, &[0.0, 0.3, 0.0, 0.0], None).unwrap();
    let heavier = without(&[0.35, 1.1, 0.15, 0.0]);
    assert!(furthest(&with(&PENDULUM, weight), &heavier, 0..GRID.len) < 1e-12);
}

#[test]
fn weight_in_a_window_acts_in_that_window() {
    let model = pendulum();
    let weight = Weight::new(&model, &[0.0, 0.3, 0.0, 0.0], Some(1.0..2.0)).unwrap();
    let (touched, free) = (with(&PENDULUM, weight), without(&PENDULUM));
    assert_eq!(furthest(&touched, &free, 0..1001), 0.0);
    assert!(furthest(&touched, &free, 1001..2000) > 1e-3);
    // The loop forgets the contact.
    assert!(furthest(&touched, &free, 2900..3001) < 1e-6);
}

#[test]
fn friction_that_has_drifted_is_the_other_friction() {
    let warm = Drift {
        time: 0.02,
        changes: vec![(2, 0.15, 0.25), (3, 0.5, 0.4)],
    };
    let drifted = with(&[0.35, 0.8, 0.15, 0.5], warm);
    let other = without(&[0.35, 0.8, 0.4, 0.9]);
    let cold = without(&[0.35, 0.8, 0.15, 0.5]);
    assert!(furthest(&drifted, &other, 1500..3001) < 1e-7);
    assert!(furthest(&drifted, &cold, 1500..3001) > 1e-3);
}

#[test]
fn friction_under_load_is_the_share_of_the_rigid_torque() {
    let model = pendulum();
    let (level, factor) = (0.2, 0.15);
    let parameters = [0.35, 0.8, 0.15, level];
    let load = LoadFriction::new(&model, &parameters, (0, 3), factor).unwrap();
    let loaded = with(&parameters, load);
    let (q, qd) = (&loaded.motion.q[0], &loaded.motion.qd[0]);
    let qdd = central_difference(qd, GRID.rate_hz);
    let mut checked = 0;
    for k in 200..GRID.len - 10 {
        if (k - 3..k + 3).any(|i| qd[i].abs() < 0.05) {
            continue;
        }
        let [zz, mx, fv, _] = parameters;
        let side = qd[k].signum();
        let rigid = zz * qdd[k] + mx * G * q[k].sin() + fv * qd[k];
        // A model written by hand does not know which of its columns are friction: all are load.
        let expected = rigid + side * (level + factor * (rigid + level * side).abs());
        let mean = 0.5 * (loaded.tau[0][k - 1] + loaded.tau[0][k]);
        assert!((mean - expected).abs() < 0.02, "{k}: {mean} {expected}");
        checked += 1;
    }
    assert!(checked > 1500);
}

#[test]
fn disturbance_acts_along_with_the_drive() {
    let series = vec![vec![0.7; GRID.len]];
    let model = pendulum();
    let mut plant = Plant::ideal(&model, &PENDULUM);
    plant.influences.push(Box::new(Disturbance::new(&series)));
    let held = run(plant, &still());
    let (q, tau) = (
        held.motion.q[0].last().unwrap(),
        held.tau[0].last().unwrap(),
    );
    assert!((tau + 0.7 - 0.8 * G * q.sin()).abs() < 1e-6);
}

#[test]
fn plant_of_other_joints_than_the_controller_is_refused() {
    let model = double_pendulum();
    let plant = Plant::ideal(&model, &DOUBLE);
    let (reference, controller) = (swinging(), controller());
    let plan = ClosedLoop {
        reference: &reference,
        controller: &controller,
        rigid: &PENDULUM,
        grid: GRID,
        start: None,
    };
    let refused = controlled(plant, &pendulum(), &plan, &Options::default()).unwrap_err();
    assert!(matches!(
        refused,
        SimulateError::Joints {
            what: "plant",
            has: 2,
            needs: 1,
            ..
        }
    ));
}

#[test]
fn joint_without_a_drive_swings_freely_behind_the_driven_one() {
    let model = double_pendulum();
    let mut plant = Plant::ideal(&model, &DOUBLE);
    plant.driven = vec![0];
    plant.drives.truncate(1);
    plant.encoders.truncate(1);
    let swung = run(plant, &swinging());
    assert_eq!((swung.q.len(), swung.motion.q.len()), (1, 2));
    assert!(swung.motion.tau[1].iter().all(|tau| *tau == 0.0));
    // It is moved by the first joint, and by nothing else.
    assert!(swung.motion.q[1].iter().any(|q| q.abs() > 0.1));
}
