//! Dry friction: it stops where the closed form says, it holds, it lets go.

use super::model::{DOUBLE, G, double_pendulum, pendulum};
use crate::simulate::{Dynamics, Grid, Method, OpenLoop, Options, State, free_motion, open_loop};

const METHODS: [Method; 2] = [
    Method::Fixed { step_s: 1e-3 },
    Method::Adaptive {
        relative: 1e-10,
        absolute: 1e-12,
    },
];

fn grid(seconds: f64) -> Grid {
    Grid {
        rate_hz: 1000.0,
        start: 0.0,
        len: (seconds * 1000.0) as usize + 1,
    }
}

#[test]
fn joint_thrown_against_coulomb_friction_stops_at_the_closed_form_and_stays() {
    let (zz, fs, speed) = (0.35, 0.8, 1.7);
    for method in METHODS {
        let start = State {
            q: vec![0.2],
            qd: vec![speed],
        };
        let options = Options {
            method,
            ..Options::default()
        };
        let parameters = [zz, 0.0, 0.0, fs];
        let result = free_motion(&pendulum(), &parameters, (&start, grid(2.0)), &options).unwrap();
        let rest = 0.2 + zz * speed * speed / (2.0 * fs);
        let stop = (zz * speed / fs * 1000.0).ceil() as usize;
        for k in stop..result.grid.len {
            assert!(
                (result.q[0][k] - rest).abs() < 1e-12,
                "{}",
                result.q[0][k] - rest
            );
            assert_eq!(result.qd[0][k], 0.0);
        }
        assert!(result.qd[0][stop - 1] > 0.0);
    }
}

#[test]
fn pendulum_under_friction_comes_to_rest_where_friction_can_hold_it() {
    let (zz, mx, fs) = (0.4, 0.6, 0.9);
    for method in METHODS {
        let start = State {
            q: vec![1.3],
            qd: vec![0.0],
        };
        let options = Options {
            method,
            ..Options::default()
        };
        let parameters = [zz, mx, 0.0, fs];
        let result = free_motion(&pendulum(), &parameters, (&start, grid(10.0)), &options).unwrap();
        // Energy lost to friction between two reversals: MX G (cos a - cos b) = FS |a - b|.
        let mut turn = 1.3f64;
        while mx * G * turn.sin().abs() > fs {
            turn = next_reversal(turn, fs / (mx * G));
        }
        let last = result.q[0][result.grid.len - 1];
        assert!((last - turn).abs() < 1e-8, "{last} instead of {turn}");
        assert_eq!(result.qd[0][result.grid.len - 1], 0.0);
    }
}

/// Where a pendulum let go at rest at `from` reverses, by bisection on its energy.
fn next_reversal(from: f64, friction: f64) -> f64 {
    let side = from.signum();
    let rest = |x: f64| x.cos() - from.cos() - friction * (side * (from - x));
    let (mut inside, mut outside) = ((friction * side).asin(), -from);
    for _ in 0..200 {
        let middle = 0.5 * (inside + outside);
        if rest(middle) > 0.0 {
            inside = middle
        } else {
            outside = middle
        }
    }
    0.5 * (inside + outside)
}

#[test]
fn stuck_joint_is_released_when_the_torque_passes_its_friction() {
    let (zz, fs, slope) = (0.5, 1.0, 2.0);
    for method in METHODS {
        let grid = grid(1.5);
        let tau = vec![
            (0..grid.len)
                .map(|k| slope * grid.time(k))
                .collect::<Vec<f64>>(),
        ];
        let start = State {
            q: vec![0.0],
            qd: vec![0.0],
        };
        let plan = OpenLoop {
            tau: &tau,
            grid,
            start: &start,
        };
        let options = Options {
            method,
            ..Options::default()
        };
        let result = open_loop(&pendulum(), &[zz, 0.0, 0.0, fs], &plan, &options).unwrap();
        for k in 0..grid.len {
            let moving = (grid.time(k) - fs / slope).max(0.0);
            let q = slope * moving.powi(3) / (6.0 * zz);
            assert!(
                (result.q[0][k] - q).abs() < 1e-9,
                "{k}: {} {q}",
                result.q[0][k]
            );
        }
    }
}

#[test]
fn friction_forces_at_rest_share_what_holds_a_coupled_wrist() {
    let model = double_pendulum();
    let mut parameters = DOUBLE;
    parameters[6..].copy_from_slice(&[0.3, 0.4, 0.5]);
    let mut dynamics = Dynamics::new(&model, &parameters).unwrap();
    let mut accelerate = |tau: [f64; 2]| {
        let mut qdd = [f64::NAN; 2];
        dynamics
            .acceleration(&[0.0, 0.0], &[0.0, 0.0], &tau, &mut qdd)
            .unwrap();
        qdd
    };
    // Friction can be (f1 + fm, f2 + fm) with |f1| <= 0.3, |f2| <= 0.4, |fm| <= 0.5.
    assert_eq!(accelerate([0.79, 0.89]), [0.0, 0.0]);
    assert_eq!(accelerate([-0.3, 0.39]), [0.0, 0.0]);
    assert_eq!(accelerate([0.1, -0.59]), [0.0, 0.0]);
    // Joint 1 would need fm > 0, joint 2 fm < 0: more than they have together.
    let qdd = accelerate([0.5, -0.6]);
    assert!(qdd[0] >= 0.0 && qdd[1] < 0.0, "{qdd:?}");
    let qdd = accelerate([0.9, 0.95]);
    assert!(qdd[0] + qdd[1] > 0.0, "{qdd:?}");
}

#[test]
fn coupled_wrist_slides_on_its_sum_and_loses_no_energy_at_rest() {
    let model = double_pendulum();
    let mut parameters = DOUBLE;
    parameters[6..].copy_from_slice(&[0.15, 0.1, 0.4]);
    let start = State {
        q: vec![1.0, -0.8],
        qd: vec![0.0, 0.0],
    };
    let mut ends = Vec::new();
    for method in METHODS {
        let options = Options {
            method,
            ..Options::default()
        };
        let result = free_motion(&model, &parameters, (&start, grid(8.0)), &options).unwrap();
        let energy = |k: usize| {
            let at = |series: &[Vec<f64>]| [series[0][k], series[1][k]];
            model.energy(&parameters, &at(&result.q), &at(&result.qd))
        };
        for k in 1..result.grid.len {
            assert!(energy(k) <= energy(k - 1) + 1e-9, "{k}");
        }
        let end = result.grid.len - 1;
        assert_eq!([result.qd[0][end], result.qd[1][end]], [0.0, 0.0]);
        ends.push([result.q[0][end], result.q[1][end]]);
    }
    for (fixed, variable) in ends[0].iter().zip(&ends[1]) {
        assert!((fixed - variable).abs() < 1e-6, "{fixed} {variable}");
    }
}
