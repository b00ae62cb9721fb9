//! What cannot be simulated is said, and where.

use super::loops::{controller, reference};
use super::model::{DOUBLE, double_pendulum, pendulum};
use crate::log::{Companion, Recording, Start};
use crate::simulate::{
    ClosedLoop, Grid, Options, SimulateError, State, closed_loop, free_motion, like, parting,
};

const GRID: Grid = Grid {
    rate_hz: 500.0,
    start: 0.0,
    len: 501,
};

fn failure(change: impl Fn(&mut ClosedLoop<'_>), options: &Options) -> SimulateError {
    let (reference, controller) = (reference(), controller());
    let mut plan = ClosedLoop {
        reference: &reference,
        controller: &controller,
        rigid: &DOUBLE,
        grid: GRID,
        start: None,
    };
    change(&mut plan);
    closed_loop(&double_pendulum(), &DOUBLE, &plan, options).unwrap_err()
}

#[test]
fn reference_and_controller_of_another_robot_are_refused() {
    let (reference, controller) = (reference(), controller());
    let plan = ClosedLoop {
        reference: &reference,
        controller: &controller,
        rigid: &DOUBLE,
        grid: GRID,
        start: None,
    };
    let error = closed_loop(&pendulum(), &[1.0; 4], &plan, &Options::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the reference is for 2 joints, the robot small has 1"
    );
    let error = failure(|plan| plan.rigid = &[], &Options::default());
    assert_eq!(
        error.to_string(),
        "0 parameters were given and the robot small has 9"
    );
    let error = failure(|plan| plan.grid.rate_hz = 0.0, &Options::default());
    assert!(
        matches!(error, SimulateError::NotPositive { .. }),
        "{error}"
    );
    let error = failure(|plan| plan.grid.len = 0, &Options::default());
    assert_eq!(error, SimulateError::Empty);
}

#[test]
fn loop_that_leaves_its_reference_says_which_joint_and_when() {
    let start = State {
        q: vec![0.0, 0.0],
        qd: vec![0.0, 0.0],
    };
    let mut weak = controller();
    weak.kp = vec![0.0; 2];
    weak.kd = vec![0.0; 2];
    let reference = reference();
    let plan = ClosedLoop {
        reference: &reference,
        controller: &weak,
        rigid: &DOUBLE.map(|x| -20.0 * x),
        grid: GRID,
        start: Some(&start),
    };
    let error = closed_loop(&double_pendulum(), &DOUBLE, &plan, &Options::default()).unwrap_err();
    let SimulateError::Diverged {
        joint,
        what,
        second,
    } = &error
    else {
        panic!("{error}")
    };
    assert!(
        joint.starts_with("joint") && *what == "its reference",
        "{error}"
    );
    assert!(*second > 0.0 && *second < 1.0, "{error}");
}

#[test]
fn motion_without_bound_is_an_error_with_its_second() {
    // Negative viscous friction: qd grows as exp(t FV / ZZ) to 1e6 at 0.138 s.
    let start = State {
        q: vec![0.0],
        qd: vec![1.0],
    };
    let grid = Grid {
        rate_hz: 1000.0,
        start: 0.0,
        len: 2000,
    };
    let parameters = [0.01, 0.0, -1.0, 0.0];
    let error = free_motion(
        &pendulum(),
        &parameters,
        (&start, grid),
        &Options::default(),
    );
    let SimulateError::Diverged { second, .. } = error.unwrap_err() else {
        panic!()
    };
    assert!((second - 0.138).abs() < 0.002, "{second}");
}

#[test]
fn log_that_nothing_drives_is_named() {
    let mut log = recording();
    log.tau = None;
    let run = |log: &Recording| {
        let companion = Companion::default();
        like(
            &double_pendulum(),
            (&DOUBLE, &DOUBLE),
            (log, &companion),
            &Options::default(),
        )
    };
    assert_eq!(
        run(&log),
        Err(SimulateError::Undriven { log: "log".into() })
    );
    log.q.pop();
    assert!(matches!(
        run(&log),
        Err(SimulateError::Joints { what: "log", .. })
    ));
}

#[test]
fn open_loop_begins_in_the_state_of_the_log() {
    let log = recording();
    let companion = Companion::default();
    let drives = (&log, &companion);
    let options = Options::default();
    let result = like(&double_pendulum(), (&DOUBLE, &DOUBLE), drives, &options).unwrap();
    assert!((result.q[0][0] - 0.3).abs() < 1e-10 && (result.qd[1][0] + 0.5).abs() < 1e-9);
}

#[test]
fn log_start_of_a_controller_begins_where_the_log_does() {
    let mut from_log = controller();
    from_log.start = Start::Log;
    let mut companion = Companion::default();
    companion.reference = Some(reference());
    companion.controller = Some(from_log);
    let (log, options) = (recording(), Options::default());
    let result = like(
        &double_pendulum(),
        (&DOUBLE, &DOUBLE),
        (&log, &companion),
        &options,
    )
    .unwrap();
    assert!((result.q[0][0] - 0.3).abs() < 1e-10);
}

#[test]
fn motions_that_part_say_the_first_joint_and_second() {
    let straight = vec![vec![0.0, 1.0, 2.0, 3.0], vec![0.0, 1.0, 2.0, 3.0]];
    let mut bent = straight.clone();
    bent[1][2] = 2.5;
    let grid = Grid {
        rate_hz: 10.0,
        start: 5.0,
        len: 4,
    };
    let part = parting(&straight, &bent, &grid, 0.1).unwrap();
    assert_eq!((part.joint, part.second, part.largest), (1, 5.2, 0.5));
    assert_eq!(parting(&straight, &bent, &grid, 0.2), None);
}

/// A parabola of motion, no torque.
fn recording() -> Recording {
    let len = 100;
    let series = |start: f64, speed: f64| -> Vec<f64> {
        (0..len)
            .map(|k| k as f64 / 500.0)
            .map(|t| start + speed * t + t * t)
            .collect()
    };
    Recording {
        doubtful: vec![],
        name: "log".into(),
        stem: "log".into(),
        rate_hz: 500.0,
        start: 0.0,
        len,
        q: vec![series(0.3, 0.2), series(-0.2, -0.5)],
        qd: None,
        tau: Some(vec![vec![0.0; len]; 2]),
        stamps: vec![],
        warnings: vec![],
    }
}
