//! Columns of the instantaneous state against their formulas.

use super::arm::{Course, PLAIN};
use crate::catalogue::Effects;

/// The sign of a velocity outside a dead band of 0.05 and its interpolation inside.
fn sign(v: f64, band: f64) -> f64 {
    (v / band).clamp(-1.0, 1.0)
}

#[test]
fn static_columns_are_their_formulas_and_the_sign_is_interpolated_near_rest() {
    let robot = PLAIN.robot();
    let course = Course::of(&robot);
    let effects = Effects::new(&robot);
    let check =
        |name: &str, shape: &[f64], place: usize, formula: &dyn Fn(f64, f64, f64) -> f64| {
            let columns = course.columns(&effects, name, &[1], shape);
            let (joint, torque) = &columns[place].torque[0];
            assert_eq!((*joint, torque.len()), (1, course.t.len()), "{name}");
            for (i, torque) in torque.iter().enumerate() {
                let expected = formula(course.q[1][i], course.qd[1][i], course.qdd[1][i]);
                assert!(
                    (torque - expected).abs() < 1e-12 * expected.abs().max(1.0),
                    "{name} {i}"
                );
            }
        };
    let s = |qd: f64| sign(qd, 0.05);
    check("torque_offset", &[], 0, &|_, _, _| 1.0);
    check("viscous_asymmetry", &[], 0, &|_, qd, _| qd.abs());
    check("stribeck", &[0.2], 0, &|_, qd, _| {
        s(qd) * (-(qd / 0.2).powi(2)).exp()
    });
    check("nonlinear_viscous", &[1.7], 0, &|_, qd, _| {
        s(qd) * qd.abs().powf(1.7)
    });
    check("position_dependent_friction", &[3.0], 0, &|q, qd, _| {
        (3.0 * q).sin() * s(qd)
    });
    check("position_dependent_friction", &[3.0], 1, &|q, qd, _| {
        (3.0 * q).cos() * s(qd)
    });
    check("torque_ripple", &[7.0], 0, &|q, _, _| (7.0 * q).sin());
    check("torque_ripple", &[7.0], 1, &|q, _, _| (7.0 * q).cos());
    check("spring", &[], 0, &|q, _, _| q);
    check("spring", &[], 1, &|_, _, _| 1.0);
    check("end_stop", &[0.4, 1.0], 0, &|q, _, _| (q - 0.4).max(0.0));
    check("end_stop", &[-0.3, -1.0], 0, &|q, _, _| {
        -(-0.3 - q).max(0.0)
    });
    check("rotor_inertia", &[], 0, &|_, _, qdd| qdd);
}

#[test]
fn a_common_shaft_loads_both_joints_in_its_ratio() {
    let robot = PLAIN.robot();
    let course = Course::of(&robot);
    let columns = course.columns(
        &Effects::new(&robot),
        "transmission_coupling",
        &[2, 3],
        &[-1.0],
    );
    for (column, dry) in columns.iter().zip([true, false]) {
        let [(2, first), (3, second)] = column.torque.as_slice() else {
            panic!("on joints 3 and 4");
        };
        for i in 0..course.t.len() {
            let v = course.qd[2][i] - course.qd[3][i];
            let expected = if dry { sign(v, 0.1) } else { v };
            assert!((first[i] - expected).abs() < 1e-12 && (second[i] + expected).abs() < 1e-12);
        }
    }
    assert_eq!(columns.len(), 2);
}

#[test]
fn friction_under_load_and_the_dead_zone_follow_torque_and_direction() {
    let robot = PLAIN.robot();
    let course = Course::of(&robot);
    let effects = Effects::new(&robot);
    let load = &course.columns(&effects, "load_dependent_friction", &[1], &[])[0].torque[0].1;
    let zone = &course.columns(&effects, "drive_dead_zone", &[1], &[])[0].torque[0].1;
    let beyond = &course.columns(&effects, "drive_saturation", &[1], &[5.0])[0].torque[0].1;
    for (i, tau) in course.tau[1].iter().enumerate() {
        assert!((load[i] - tau.abs() * sign(course.qd[1][i], 0.05)).abs() < 1e-12);
        assert!(tau.abs() < 2.0 || (zone[i] - tau.signum()).abs() < 1e-3);
        assert!((beyond[i] - tau.signum() * (tau.abs() - 5.0).max(0.0)).abs() < 1e-12);
    }
}
