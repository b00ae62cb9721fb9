//! The recursion inside a control loop against the batch, on the paper's SCARA and on a 7R arm.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

#[path = "online/moving.rs"]
mod moving;

use idim::codegen::builder;
use idim::interpreted::Interpreter;
use idim::robots;
use idim::runtime::model::IdentificationModel;
use idim::runtime::observe::ModelKind;
use idim::runtime::online::{Equation, OnlineError, Options, Recursion, Solution, Step, Stream};
use idim::runtime::settings::Velocity;
use moving::{Moving, Noise};
use nalgebra::{DMatrix, DVector};

/// Pushes `seconds` of a motion; every instant goes to `take`.
fn run<M: IdentificationModel>(
    stream: &mut Stream<M>,
    moving: &mut Moving<'_>,
    seconds: f64,
    mut take: impl FnMut(idim::runtime::online::Instant<'_>),
) {
    for _ in 0..(seconds * moving.rate_hz) as usize {
        let (q, tau) = moving.sample();
        if let Step::Equations(instant) = stream.push(q, None, tau).unwrap() {
            take(instant);
        }
    }
}

/// Least squares of all rows at once, by a QR decomposition; row `i` of an instant counts
/// `weights[i]` times, and every instant `forgetting` times what the next one does.
fn batch(
    np: usize,
    instants: &[Vec<Equation>],
    weights: &[f64],
    forgetting: f64,
) -> (DVector<f64>, DVector<f64>) {
    let (mut w, mut y) = (Vec::new(), Vec::new());
    for (age, instant) in instants.iter().rev().enumerate() {
        let kept = forgetting.powf(0.5 * age as f64);
        for (equation, weight) in instant.iter().zip(weights).filter(|e| e.0.moves) {
            let mut row = vec![0.0; np];
            for (column, value) in equation.columns.iter().zip(&equation.w) {
                row[*column] = value * weight * kept;
            }
            w.extend(row);
            y.push(equation.y * weight * kept);
        }
    }
    let w = DMatrix::from_row_slice(y.len(), np, &w);
    let y = DVector::from_vec(y);
    let qr = w.clone().qr();
    let x = qr
        .r()
        .solve_upper_triangular(&(qr.q().transpose() * &y))
        .unwrap();
    let square = (&y - &w * &x).norm_squared() / (y.len() - np) as f64;
    let inverse = qr
        .r()
        .solve_upper_triangular(&DMatrix::identity(np, np))
        .unwrap();
    let sigma = (0..np).map(|k| square.sqrt() * inverse.row(k).norm());
    let sigma = DVector::from_iterator(np, sigma);
    (x, sigma)
}

/// The recursion and the batch find the same parameters, to 1e-9 of each parameter or, where it is
/// less certain than that, of its standard deviation.
fn online_is_batch(
    model: &dyn IdentificationModel,
    kind: ModelKind,
    seconds: f64,
    forgetting: f64,
) {
    let np = model.columns().len();
    let options = Options {
        model: kind,
        ..Options::at(1000.0)
    };
    let noise = Noise { q: 1e-6, tau: 0.2 };
    let mut moving = Moving::new(model, 1000.0, noise);
    let mut stream = Stream::new(model, &options).unwrap();
    let equations = 0..stream.equations().len();
    let weights: Vec<f64> = equations.map(|j| 1.0 + 0.3 * j as f64).collect();
    let mut recursion = Recursion::new(&stream, &weights, forgetting).unwrap();
    let mut instants = Vec::new();
    run(&mut stream, &mut moving, seconds, |instant| {
        recursion.update(instant);
        instants.push(instant.equations.to_vec());
    });
    let solution = solved(&mut recursion);
    let (x, sigma) = batch(np, &instants, &weights, forgetting);
    let name = format!("{} {kind:?} {forgetting}", model.name());
    assert_eq!(solution.rank, np, "{name}");
    let mut largest = 0.0f64;
    for k in 0..np {
        let (own, whole) = (solution.value(k).unwrap(), x[k]);
        let far = (own - whole).abs() / whole.abs().max(sigma[k]);
        assert!(far <= 1e-9, "{name} {k}: {own} {whole}");
        largest = largest.max(far);
        if forgetting == 1.0 {
            let far = (solution.sigma[k].unwrap() - sigma[k]).abs();
            assert!(far <= 1e-9 * sigma[k], "{name} {k}");
        }
    }
    println!("{name}: {largest:.1e} apart");
}

fn panda() -> Interpreter {
    let known = |robot: &&robots::Robot| robot.name == robots::panda::NAME;
    let texts = robots::ALL.iter().find(known).unwrap().texts;
    Interpreter::new(&builder::read_texts(texts).unwrap())
}

#[test]
fn scara_online_is_batch() {
    for kind in ModelKind::ALL {
        for forgetting in [1.0, 0.999] {
            online_is_batch(&robots::scara::Model, kind, 20.0, forgetting);
        }
    }
}

#[test]
fn panda_online_is_batch() {
    online_is_batch(&panda(), ModelKind::Explicit, 5.0, 1.0);
    online_is_batch(&robots::panda::Model, ModelKind::Explicit, 10.0, 0.999);
    online_is_batch(&robots::panda::Model, ModelKind::Power, 40.0, 1.0);
}

fn solved(recursion: &mut Recursion) -> Solution {
    let mut solution = recursion.solution();
    recursion.solve(&mut solution).unwrap();
    solution
}

#[test]
fn without_noise_all_three_models_find_the_truth() {
    let model = robots::scara::Model;
    for kind in ModelKind::ALL {
        let mut moving = Moving::new(&model, 1000.0, Noise::NONE);
        let options = Options {
            model: kind,
            ..Options::at(1000.0)
        };
        let mut stream = Stream::new(model, &options).unwrap();
        let weights = vec![1.0; stream.equations().len()];
        let mut recursion = Recursion::new(&stream, &weights, 1.0).unwrap();
        run(&mut stream, &mut moving, 20.0, |i| recursion.update(i));
        let solution = solved(&mut recursion);
        for (k, truth) in moving.truth.iter().enumerate() {
            let value = solution.value(k).unwrap();
            // Dry friction turns round between two samples, which costs some 1e-4.
            assert!(
                (value / truth - 1.0).abs() < 1e-3,
                "{kind:?} {k}: {value} {truth}"
            );
        }
    }
}

#[test]
fn equations_are_exact_from_the_first_one_and_after_a_gap() {
    // Without friction nothing jumps, and what is left is the tail of the prefilter.
    let model = robots::scara::Model;
    for kind in ModelKind::ALL {
        let mut moving = Moving::new(&model, 1000.0, Noise::NONE).without_friction();
        let options = Options {
            model: kind,
            ..Options::at(1000.0)
        };
        let mut stream = Stream::new(model, &options).unwrap();
        let truth = moving.truth.clone();
        let mut largest = 0.0f64;
        let mut count = 0;
        for _ in 0..2 {
            run(&mut stream, &mut moving, 3.0, |instant| {
                for equation in instant.equations {
                    let terms = equation.columns.iter().zip(&equation.w);
                    let product: f64 = terms.map(|(column, w)| truth[*column] * w).sum();
                    largest = largest.max(equation.y.abs());
                    assert!(
                        (equation.y - product).abs() < 1e-5 * (1.0 + largest),
                        "{kind:?}"
                    );
                    count += 1;
                }
            });
            let bad = stream.push(&[f64::NAN, 0.0], None, &[0.0, 0.0]).unwrap();
            assert!(matches!(bad, Step::Skipped));
        }
        assert!(count > 150, "{count}");
        assert_eq!(stream.skipped(), 2);
        assert_eq!(stream.samples(), 6002);
    }
}

#[test]
fn measured_velocities_take_the_place_of_differences() {
    let model = robots::scara::Model;
    let options = Options {
        velocity: Velocity::Measured,
        ..Options::at(1000.0)
    };
    let mut moving = Moving::new(&model, 1000.0, Noise::NONE);
    let mut stream = Stream::new(model, &options).unwrap();
    let mut recursion = Recursion::new(&stream, &[1.0, 1.0], 1.0).unwrap();
    for _ in 0..10_000 {
        moving.sample();
        let (q, qd, tau) = (&moving.q, &moving.qd, &moving.tau);
        if let Step::Equations(instant) = stream.push(q, Some(qd), tau).unwrap() {
            recursion.update(instant);
        }
    }
    let solution = solved(&mut recursion);
    for (k, truth) in moving.truth.iter().enumerate() {
        assert!((solution.values[k] / truth - 1.0).abs() < 1e-3);
    }
    assert_eq!(
        stream.push(&[0.0, 0.0], None, &[0.0, 0.0]).unwrap_err(),
        OnlineError::NoVelocity
    );
}

#[test]
fn parameters_of_a_joint_that_has_not_moved_are_reported_not_guessed() {
    let model = robots::panda::Model;
    let noise = Noise { q: 1e-6, tau: 0.05 };
    let mut moving = Moving::new(&model, 1000.0, noise);
    moving.hold = Some(6);
    let mut stream = Stream::new(model, &Options::at(1000.0)).unwrap();
    let mut recursion = Recursion::new(&stream, &[1.0; 7], 1.0).unwrap();
    run(&mut stream, &mut moving, 20.0, |i| recursion.update(i));
    let before = solved(&mut recursion);
    let own = |name: &str| {
        let columns = model.columns();
        columns.iter().position(|c| c.name == name).unwrap()
    };
    for name in ["FV7", "FS7", "OFF7"] {
        assert_eq!(before.value(own(name)), None, "{name}");
        assert_eq!(before.sigma[own(name)], None);
    }
    for name in ["FV1", "FS1", "FV6", "FS6", "ZZR1"] {
        let k = own(name);
        let far = (before.value(k).unwrap() - moving.truth[k]).abs();
        assert!(far < 6.0 * before.sigma[k].unwrap(), "{name}: {far}");
    }
    assert!(before.rank < model.columns().len());
    // The sine does not begin where the joint stood: a gap in time.
    moving.hold = None;
    stream.clear();
    run(&mut stream, &mut moving, 20.0, |i| recursion.update(i));
    let after = solved(&mut recursion);
    assert_eq!(after.rank, model.columns().len());
    for (k, truth) in moving.truth.iter().enumerate() {
        let far = (after.value(k).unwrap() - truth).abs();
        assert!(far < 6.0 * after.sigma[k].unwrap() + 1e-3, "{k}: {far}");
    }
}

#[test]
fn a_robot_at_rest_makes_nobody_forget() {
    let model = robots::scara::Model;
    let mut moving = Moving::new(&model, 1000.0, Noise::NONE);
    let mut stream = Stream::new(model, &Options::at(1000.0)).unwrap();
    let mut recursion = Recursion::new(&stream, &[1.0; 2], 0.99).unwrap();
    run(&mut stream, &mut moving, 10.0, |i| recursion.update(i));
    // Until the window holds nothing but rest.
    let (q, tau) = (moving.q.clone(), [0.3, -0.05]);
    let mut stand = |recursion: &mut Recursion, samples| {
        for _ in 0..samples {
            if let Step::Equations(instant) = stream.push(&q, None, &tau).unwrap() {
                recursion.update(instant);
            }
        }
    };
    stand(&mut recursion, 1000);
    let before = solved(&mut recursion);
    stand(&mut recursion, 100_000);
    assert_eq!(solved(&mut recursion), before);
}

#[test]
fn what_cannot_be_done_says_so() {
    let model = robots::scara::Model;
    let at = Options::at(1000.0);
    let set_up = |options: Options| Stream::new(model, &options).map(|_| ());
    assert_eq!(
        set_up(Options {
            rate_hz: -1.0,
            ..at.clone()
        }),
        Err(OnlineError::Rate { rate_hz: -1.0 })
    );
    assert!(matches!(
        set_up(Options {
            rate_hz: f64::NAN,
            ..at.clone()
        }),
        Err(OnlineError::Rate { .. })
    ));
    assert_eq!(
        set_up(Options {
            nd: 0,
            ..at.clone()
        }),
        Err(OnlineError::Ratio)
    );
    assert_eq!(
        set_up(Options {
            rest_band: -1.0,
            ..at.clone()
        }),
        Err(OnlineError::Band { band: -1.0 })
    );
    assert!(matches!(
        set_up(Options {
            fp_hz: 800.0,
            ..at.clone()
        }),
        Err(OnlineError::Filter {
            step: "parallel filter",
            ..
        })
    ));
    let mut stream = Stream::new(model, &at).unwrap();
    assert_eq!(
        stream.push(&[0.0; 3], None, &[0.0; 2]).unwrap_err(),
        OnlineError::Joints {
            series: "q",
            has: 3,
            needs: 2
        }
    );
    assert_eq!(
        stream
            .push(&[0.0; 2], None, &[0.0])
            .unwrap_err()
            .to_string(),
        "a sample has 1 values of tau and the robot 2 joints; push one value per joint, in the \
         order of the robot's joints"
    );
    let recursion =
        |weights: &[f64], forgetting| Recursion::new(&stream, weights, forgetting).map(|_| ());
    for factor in [0.0, -1.0, 1.1] {
        assert_eq!(
            recursion(&[1.0; 2], factor),
            Err(OnlineError::Forgetting { factor })
        );
    }
    assert_eq!(
        recursion(&[1.0], 1.0),
        Err(OnlineError::Weights { has: 1, needs: 2 })
    );
    assert_eq!(
        recursion(&[1.0, 0.0], 1.0),
        Err(OnlineError::Weight {
            equation: 2,
            weight: 0.0
        })
    );
    let mut empty = Recursion::new(&stream, &[1.0; 2], 1.0).unwrap();
    let mut solution = empty.solution();
    assert_eq!(empty.solve(&mut solution), Err(OnlineError::NothingMoves));
}
