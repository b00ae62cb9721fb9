//! Errors of the signals to first order, and states that run along the motion.

use idim_runtime::observe::dahl;

use super::arm::{Course, PLAIN, RATE, apart, size, slope, spread, torque};
use crate::catalogue::Effects;
use crate::catalogue::gear::Swing;

#[test]
fn an_eccentric_encoder_moves_the_torque_to_first_order() {
    let robot = PLAIN.robot();
    let mut course = Course::of(&robot);
    let n = 3.0;
    let columns = course.columns(&Effects::new(&robot), "encoder_eccentricity", &[1], &[n]);
    // The displacement and its derivatives, applied to the motion itself.
    let step = 1e-5;
    for i in 0..course.t.len() {
        let (q, qd, qdd) = (course.q[1][i], course.qd[1][i], course.qdd[1][i]);
        let (sin, cos) = (n * q).sin_cos();
        course.q[1][i] += step * sin;
        course.qd[1][i] += step * n * cos * qd;
        course.qdd[1][i] += step * (n * cos * qdd - n * n * sin * qd * qd);
    }
    let expected = slope(&torque(&robot, &course.motion()), &course.tau, step);
    let got = spread(&columns[0], course.t.len());
    assert!(size(&expected) > 1.0 && apart(&got, &expected) < 1e-3 * size(&expected));
    assert_eq!(columns[1].name, "ECC2");
}

#[test]
fn a_torque_that_is_ahead_differs_by_its_rate() {
    let robot = PLAIN.robot();
    let course = Course::of(&robot);
    let columns = course.columns(&Effects::new(&robot), "time_shift", &[], &[]);
    let got = spread(&columns[0], course.t.len());
    // The torque of the motion a moment later, as a function of time: 1e-4 s ahead.
    let ahead = 1e-4;
    let mut later = Course::of(&robot);
    for i in 0..later.t.len() {
        for joint in 0..4 {
            let (qd, qdd) = (course.qd[joint][i], course.qdd[joint][i]);
            // Each joint swings at its own frequency: its jerk is -w^2 qd.
            let w = 2.0 + 0.7 * joint as f64;
            later.q[joint][i] += ahead * qd;
            later.qd[joint][i] += ahead * qdd;
            later.qdd[joint][i] -= ahead * w * w * qd;
        }
    }
    let expected = slope(&torque(&robot, &later.motion()), &course.tau, ahead);
    // Central differences at 200 Hz: (w dt)^2 / 6 of the fastest part of the torque, at the ends
    // one-sided.
    for (got, expected) in got.iter().zip(&expected) {
        let inside = 1..course.t.len() - 1;
        let (got, expected) = (&got[inside.clone()], &expected[inside]);
        let miss = apart(&[got.to_vec()], &[expected.to_vec()]);
        assert!(miss < 0.01 * size(&[expected.to_vec()]).max(1.0), "{miss}");
    }
    assert_eq!((columns.len(), columns[0].name.as_str()), (1, "TSH"));
    let one = course.columns(&Effects::new(&robot), "time_shift", &[2], &[]);
    assert_eq!((one[0].torque.len(), one[0].name.as_str()), (1, "TSH3"));
}

#[test]
fn a_yielding_contact_builds_up_friction_as_dahl_says() {
    // From rest at constant speed: z/zs = 1 - exp(-qd t / zs).
    let (speed, zs) = (0.1, 0.01);
    let state = dahl(&vec![speed; 400], RATE, zs, 0.0);
    for (i, state) in state.iter().enumerate() {
        let expected = -(-speed * i as f64 / RATE / zs).exp_m1();
        assert!((state - expected).abs() < 1e-12);
    }
    let robot = PLAIN.robot();
    let course = Course::of(&robot);
    let columns = course.columns(&Effects::new(&robot), "presliding", &[0], &[zs]);
    let slip = dahl(&course.qd[0], RATE, zs, 0.0);
    let sign = |qd: f64| (qd / 0.05).clamp(-1.0, 1.0);
    for (i, torque) in columns[0].torque[0].1.iter().enumerate() {
        assert!((torque - (slip[i] - sign(course.qd[0][i]))).abs() < 1e-12);
    }
}

#[test]
fn a_resonance_is_exact_along_ramps_and_swings_at_its_frequency() {
    let (w, damping) = (30.0, 0.1);
    let resonance = |input: &[f64], rate: f64| -> Vec<f64> {
        let swing = Swing::new(w, damping, rate);
        let mut state = [input[0], 0.0];
        let mut out = vec![state[0]];
        for pair in input.windows(2) {
            state = swing.next(state, [pair[0], pair[1]]);
            out.push(state[0]);
        }
        out
    };
    // A ramp, at two rates: the same at common times, so that no step is an approximation.
    let ramp = |rate: f64, len: usize| -> Vec<f64> {
        let input: Vec<f64> = (0..len).map(|i| i as f64 / rate).collect();
        resonance(&input, rate)
    };
    let (coarse, fine) = (ramp(50.0, 100), ramp(1000.0, 2000));
    for (i, coarse) in coarse.iter().enumerate() {
        assert!((coarse - fine[20 * i]).abs() < 1e-12);
    }
    // Driven at its frequency it reaches 1 / (2 damping) times the input.
    let input: Vec<f64> = (0..20_000)
        .map(|i| (w * f64::from(i) / 2000.0).sin())
        .collect();
    let driven = resonance(&input, 2000.0);
    let top = driven[10_000..]
        .iter()
        .fold(0.0, |all: f64, y| all.max(y.abs()));
    assert!((top - 5.0).abs() < 1e-3, "{top}");
}

#[test]
fn a_link_with_play_leans_on_its_stops_and_moves_the_torque_as_far_as_they_are_apart() {
    let robot = PLAIN.robot();
    let course = Course::of(&robot);
    let gap = 1e-4;
    let columns = course.columns(&Effects::new(&robot), "backlash", &[1], &[gap]);
    let got = spread(&columns[0], course.t.len());
    // Where the link leans the column is half the stiffness of gravity and motion.
    let mut moved = Course::of(&robot);
    moved.q[1].iter_mut().for_each(|q| *q += 1e-5);
    let stiffness = slope(&torque(&robot, &moved.motion()), &course.tau, 1e-5);
    let top = course.tau[1]
        .iter()
        .fold(0.0, |all: f64, tau| all.max(tau.abs()));
    let mut seen = 0;
    for i in 0..course.t.len() {
        let tau = course.tau[1][i];
        if tau.abs() > 0.4 * top {
            let expected = -0.5 * tau.signum() * stiffness[1][i];
            let off = (got[1][i] - expected).abs();
            assert!(off < 1e-3 * size(&stiffness), "{i}: {off}");
            seen += 1;
        }
    }
    assert!(seen > 50);
}
