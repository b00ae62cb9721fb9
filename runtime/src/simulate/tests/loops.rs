//! Closed loops: tracking, order of convergence, repeatability.

use super::model::{DOUBLE, double_pendulum};
use crate::log::{Controller, Feedforward, Fourier, Law, Reference, Start};
use crate::simulate::{ClosedLoop, Grid, Method, Options, Simulation, closed_loop, ideal, parting};

pub fn reference() -> Reference {
    Reference::Fourier(Fourier {
        f0_hz: 0.5,
        periods: 1.0,
        center: vec![0.3, -0.2],
        sin: vec![vec![0.6, -0.2], vec![-0.4, 0.3]],
        cos: vec![vec![0.1, 0.15], vec![0.5, -0.1]],
    })
}

pub fn controller() -> Controller {
    Controller {
        law: Law::Pd,
        kp: vec![400.0, 150.0],
        kd: vec![25.0, 8.0],
        feedforward: Feedforward::Rigid,
        velocity_filter_hz: Some(80.0),
        torque_limit: Some(vec![50.0, 30.0]),
        start: Start::Reference,
    }
}

const GRID: Grid = Grid {
    rate_hz: 500.0,
    start: 0.0,
    len: 1001,
};

fn run(parameters: &[f64], method: Method) -> Simulation {
    let (reference, controller) = (reference(), controller());
    let plan = ClosedLoop {
        reference: &reference,
        controller: &controller,
        rigid: &DOUBLE,
        grid: GRID,
        start: None,
    };
    let options = Options {
        method,
        ..Options::default()
    };
    closed_loop(&double_pendulum(), parameters, &plan, &options).unwrap()
}

fn rms_distance(one: &Simulation, other: &Simulation) -> f64 {
    let pairs = one.q.iter().flatten().zip(other.q.iter().flatten());
    let sum: f64 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
    (sum / (2 * GRID.len) as f64).sqrt()
}

#[test]
fn closed_loop_converges_with_order_4_when_the_step_is_halved() {
    let mut parameters = DOUBLE;
    parameters[5] = 0.3;
    let exact = run(
        &parameters,
        Method::Adaptive {
            relative: 1e-13,
            absolute: 1e-14,
        },
    );
    let error = |step_s| rms_distance(&run(&parameters, Method::Fixed { step_s }), &exact);
    let (coarse, fine) = (error(2e-3), error(1e-3));
    println!("closed loop, RK4: {coarse:.2e} at 2 ms, {fine:.2e} at 1 ms");
    let order = (coarse / fine).log2();
    assert!((3.7..4.5).contains(&order), "order {order}");
    let motion = ideal(&double_pendulum(), &DOUBLE, &reference(), &GRID).unwrap();
    assert!(parting(&motion.q, &exact.q, &GRID, 0.02).is_none());
}

#[test]
fn closed_loop_with_dry_friction_does_not_depend_on_the_step() {
    let mut parameters = DOUBLE;
    parameters[5..].copy_from_slice(&[0.3, 0.8, 0.5, 0.2]);
    let exact = run(
        &parameters,
        Method::Adaptive {
            relative: 1e-12,
            absolute: 1e-13,
        },
    );
    let error = |step_s| rms_distance(&run(&parameters, Method::Fixed { step_s }), &exact);
    let (coarse, fine) = (error(2e-3), error(1e-3));
    println!("closed loop with dry friction, RK4: {coarse:.2e} at 2 ms, {fine:.2e} at 1 ms");
    assert!(coarse < 1e-7 && fine < 0.2 * coarse, "{coarse:e} {fine:e}");
}

#[test]
fn simulation_repeats_to_the_bit() {
    let method = Method::Fixed { step_s: 1e-3 };
    let mut parameters = DOUBLE;
    parameters[5..].copy_from_slice(&[0.3, 0.8, 0.5, 0.2]);
    assert_eq!(run(&parameters, method), run(&parameters, method));
}
