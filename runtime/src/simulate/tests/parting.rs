//! References and controllers that are not those of a log are found, with the second; those that
//! are raise no word.

use super::loops::{controller, reference};
use super::model::{DOUBLE, double_pendulum};
use crate::log::{Companion, Controller, Feedforward, Recording, Reference};
use crate::simulate::{Grid, Options, like, off_controller, off_reference, parting};

const GRID: Grid = Grid {
    rate_hz: 500.0,
    start: 3.0,
    len: 1001,
};

fn companion(reference: Reference, controller: Controller) -> Companion {
    let mut companion = Companion::default();
    companion.reference = Some(reference);
    companion.controller = Some(controller);
    companion
}

/// The log that a reference and a controller make, with dry friction in the joints.
fn log(companion: &Companion) -> Recording {
    let still = Recording {
        rate_hz: GRID.rate_hz,
        start: GRID.start,
        len: GRID.len,
        q: vec![vec![0.0; GRID.len]; 2],
        ..Recording::default()
    };
    let mut parameters = DOUBLE;
    parameters[5..].copy_from_slice(&[0.3, 0.8, 0.5, 0.2]);
    let parameters = (parameters.as_slice(), DOUBLE.as_slice());
    let made = like(
        &double_pendulum(),
        parameters,
        (&still, companion),
        &Options::default(),
    )
    .unwrap();
    // An encoder's counts.
    let counts = |q: &Vec<f64>| q.iter().map(|q| (q / 1e-4).round() * 1e-4).collect();
    Recording {
        q: made.q.iter().map(counts).collect(),
        tau: Some(made.tau),
        ..still
    }
}

#[test]
fn reference_and_controller_of_the_log_raise_no_word() {
    let companion = companion(reference(), controller());
    let log = log(&companion);
    let model = double_pendulum();
    assert_eq!(off_reference(&model, &log, &reference()).unwrap(), None);
    assert_eq!(
        off_controller(&model, &DOUBLE, (&log, &companion)).unwrap(),
        None
    );
}

#[test]
fn joint_that_stops_leaves_its_reference_at_that_second() {
    let mut log = log(&companion(reference(), controller()));
    // Where it moves fastest.
    let step = |k: &usize| (log.q[1][k + 1] - log.q[1][*k]).abs();
    let stop = (300..900)
        .max_by(|a, b| step(a).total_cmp(&step(b)))
        .unwrap();
    let (held, speed) = (log.q[1][stop], step(&stop) * GRID.rate_hz);
    log.q[1][stop..].fill(held);
    let model = double_pendulum();
    let part = off_reference(&model, &log, &reference()).unwrap().unwrap();
    assert_eq!(part.joint, 1);
    let late = part.second - GRID.time(stop);
    // A fifth of its range of 1.45 rad at most, at nearly that speed.
    assert!(
        late > 0.0 && late < 1.5 * 0.2 * 1.45 / speed,
        "{late} s after"
    );
    // Rows that cannot be believed anyway are not held against the reference.
    log.doubtful.push(stop..1001);
    assert_eq!(off_reference(&model, &log, &reference()).unwrap(), None);
}

#[test]
fn joint_that_never_moves_leaves_its_reference() {
    let mut log = log(&companion(reference(), controller()));
    let held = log.q[1][0];
    log.q[1].fill(held);
    let part = off_reference(&double_pendulum(), &log, &reference()).unwrap();
    assert_eq!(part.unwrap().joint, 1);
}

#[test]
fn controller_with_other_gains_leaves_the_torque_of_the_log() {
    let log = log(&companion(reference(), controller()));
    let model = double_pendulum();
    let others = [
        Controller {
            feedforward: Feedforward::None,
            ..controller()
        },
        Controller {
            kp: vec![4000.0, 1500.0],
            ..controller()
        },
        Controller {
            torque_limit: Some(vec![3.0, 2.0]),
            ..controller()
        },
    ];
    for other in others {
        let companion = companion(reference(), other.clone());
        let part = off_controller(&model, &DOUBLE, (&log, &companion)).unwrap();
        let part = part.unwrap_or_else(|| panic!("{other:?}"));
        // At the latest where the torque of the log is largest.
        let tau = &log.tau.as_ref().unwrap()[part.joint];
        let largest = tau.iter().map(|tau| tau.abs()).fold(0.0, f64::max);
        let second = tau
            .iter()
            .position(|tau| tau.abs() == largest)
            .map(|k| GRID.time(k));
        assert!(part.second <= second.unwrap(), "{part:?} {second:?}");
    }
}

#[test]
fn motion_under_another_controller_parts_from_the_log() {
    let log = log(&companion(reference(), controller()));
    let soft = Controller {
        kp: vec![10.0, 4.0],
        kd: vec![1.0, 0.4],
        feedforward: Feedforward::None,
        ..controller()
    };
    let parameters = (DOUBLE.as_slice(), DOUBLE.as_slice());
    let simulated = |controller| {
        let companion = companion(reference(), controller);
        let options = Options::default();
        like(&double_pendulum(), parameters, (&log, &companion), &options).unwrap()
    };
    assert_eq!(
        parting(&log.q, &simulated(controller()).q, &GRID, 0.1),
        None
    );
    let part = parting(&log.q, &simulated(soft).q, &GRID, 0.1).unwrap();
    assert!((3.0..4.0).contains(&part.second), "{part:?}");
}
