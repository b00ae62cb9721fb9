//! Forward dynamics against the inverse dynamics and the textbook.

use super::model::{DOUBLE, double_pendulum, pendulum};
use crate::simulate::{Dynamics, SimulateError, Trajectory, inverse_dynamics};

#[test]
fn acceleration_is_inverted_by_the_explicit_model() {
    let model = double_pendulum();
    let mut parameters = DOUBLE;
    parameters[5..].copy_from_slice(&[0.2, 0.3, 0.1, 0.25]);
    let mut dynamics = Dynamics::new(&model, &parameters).unwrap();
    let (q, qd, tau) = ([0.4, -1.9], [1.1, -0.3], [2.5, -0.7]);
    let mut qdd = [0.0; 2];
    dynamics.acceleration(&q, &qd, &tau, &mut qdd).unwrap();
    let series = |values: [f64; 2]| values.map(|value| vec![value]).to_vec();
    let point = Trajectory {
        q: series(q),
        qd: series(qd),
        qdd: series(qdd),
    };
    let again = inverse_dynamics(&model, &parameters, &point).unwrap();
    for (tau, again) in tau.iter().zip(again) {
        assert!((tau - again[0]).abs() < 1e-14);
    }
}

#[test]
fn mass_matrix_is_that_of_the_textbook() {
    let model = double_pendulum();
    let mut dynamics = Dynamics::new(&model, &DOUBLE).unwrap();
    let [zzr1, _, zz2, lmx2, ..] = DOUBLE;
    let c = 0.7f64.cos();
    let off = zz2 + lmx2 * c;
    let expected = [zzr1 + zz2 + 2.0 * lmx2 * c, off, off, zz2];
    for (m, expected) in dynamics.mass(&[0.3, 0.7]).unwrap().iter().zip(expected) {
        assert!((m - expected).abs() < 1e-15);
    }
}

#[test]
fn bias_leaves_dry_friction_out() {
    let model = pendulum();
    let mut dynamics = Dynamics::new(&model, &[0.4, 0.0, 0.3, 5.0]).unwrap();
    assert_eq!(dynamics.bias(&[0.1], &[2.0]).unwrap(), [0.6]);
}

#[test]
fn parameters_of_no_robot_are_named_by_joint() {
    let model = double_pendulum();
    let mut parameters = DOUBLE;
    parameters[2] = 0.01;
    let mut dynamics = Dynamics::new(&model, &parameters).unwrap();
    let mut qdd = [0.0; 2];
    let error = dynamics
        .acceleration(&[0.0; 2], &[0.0; 2], &[0.0; 2], &mut qdd)
        .unwrap_err();
    assert!(
        matches!(&error, SimulateError::NotPositiveDefinite { joint, .. } if joint == "joint 2"),
        "{error}"
    );
}
