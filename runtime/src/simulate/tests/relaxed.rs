//! A closed loop as a fixed point over whole motions is the closed loop that is integrated.

use super::loops::{controller, reference};
use super::model::{DOUBLE, double_pendulum};
use crate::simulate::{
    ClosedLoop, Grid, Method, Options, Relaxed, Trajectory, closed_loop, inverse_dynamics, relaxed,
};

/// Root mean square of the distance to an accurate integration, rad.
fn apart(rate_hz: f64) -> f64 {
    let model = double_pendulum();
    let mut parameters = DOUBLE;
    parameters[5] = 0.8;
    let (reference, controller) = (reference(), controller());
    let grid = Grid {
        rate_hz,
        start: 0.0,
        len: (4.0 * rate_hz) as usize + 1,
    };
    let plan = ClosedLoop {
        reference: &reference,
        controller: &controller,
        rigid: &DOUBLE,
        grid,
        start: None,
    };
    let options = Options {
        method: Method::Adaptive {
            relative: 1e-12,
            absolute: 1e-13,
        },
        ..Options::default()
    };
    let exact = closed_loop(&model, &parameters, &plan, &options).unwrap();
    let needed = |motion: &Trajectory| inverse_dynamics(&model, &parameters, motion).unwrap();
    let plan = Relaxed {
        model: &model,
        parameters: &parameters,
        rigid: &DOUBLE,
        reference: &reference,
        controller: &controller,
        friction: &[(1.0, 0.0), (1.0, 0.0)],
        grid,
        start: None,
    };
    let found = relaxed(&plan, &needed).unwrap();
    let pairs = found.q.iter().flatten().zip(exact.q.iter().flatten());
    let squares: f64 = pairs.map(|(a, b)| (a - b).powi(2)).sum();
    (squares / (2 * grid.len) as f64).sqrt()
}

#[test]
fn rounds_over_a_motion_end_where_integration_does() {
    // Viscous friction that the feedforward does not know: 2e-3 rad off the reference.
    let (coarse, fine) = (apart(500.0), apart(1000.0));
    println!("relaxed against integrated: {coarse:.2e} rad at 500 Hz, {fine:.2e} at 1 kHz");
    assert!(fine < 2e-6, "{fine}");
    assert!(coarse < 8e-6, "{coarse}");
}
