//! The regressor D of an arm, sines and cosines included: ns per sample of the generated function,
//! one sample at a time, in lanes of what the program was compiled for and in vectors as wide as
//! those of the machine, of the module as the identification calls it, and of the interpreter.
//! Rounds alternate between them, and the fastest counts.
//!
//! `cargo bench --bench regressor`; with `RUSTFLAGS="-C target-cpu=native"` for what this machine
//! can do. `benches/side_by_side/regressor.py` times the rigid columns beside other libraries.

use std::array::from_fn;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use idim::interpreted::Interpreter;
use idim::robots;
use idim::runtime::lane::{Arch, Simd, Vector, WithSimd, f64x4};
use idim::runtime::model::{IdentificationModel, Output, States};

/// Samples of one pass, as many as the identification evaluates at once.
const SAMPLES: usize = 384;

/// Samples of an [`f64x4`].
const LANES: usize = 4;

/// Passes in a row that are timed as one, and how often.
const PASSES: usize = 20;
const ROUNDS: usize = 100;

/// What is timed: its name, and one pass over all samples.
type Contender<'a> = (&'static str, Box<dyn FnMut() + 'a>);

fn main() {
    let asked = std::env::args().any(|argument| argument == "--bench");
    let rounds = if asked { ROUNDS } else { 1 };
    ur10e(rounds);
    panda(rounds);
}

macro_rules! arm {
    ($robot:ident) => {
        fn $robot(rounds: usize) {
            use robots::$robot::{JOINTS, Model, NAME, PARAMETERS, State, explicit};
            let series = |phase: f64| -> Vec<f64> {
                let angle = |i: usize| phase + (1.0 + phase) * i as f64;
                (0..JOINTS * SAMPLES)
                    .map(|i| 2.0 * angle(i).sin())
                    .collect()
            };
            let [q, qd, qdd] = [0.1, 0.2, 0.3].map(series);
            let states = States {
                len: SAMPLES,
                q: &q,
                qd: &qd,
                qdd: &qdd,
                slip: &[],
            };
            let one = |series: &[f64], i: usize| -> [f64; JOINTS] {
                from_fn(|joint| series[joint * SAMPLES + i])
            };
            let block = |series: &[f64], i: usize| -> [f64x4; JOINTS] {
                from_fn(|joint| f64x4::from(from_fn(|lane| series[joint * SAMPLES + i + lane])))
            };
            struct Vectors<'a>(&'a States<'a>);
            impl WithSimd for Vectors<'_> {
                type Output = ();
                #[inline(always)]
                fn with_simd<S: Simd>(self, simd: S) {
                    let States { q, qd, qdd, .. } = *self.0;
                    let mut d = [[Vector::splat(simd, 0.0); PARAMETERS]; JOINTS];
                    for i in (0..SAMPLES).step_by(S::F64_LANES) {
                        let mut state = [[d[0][0]; JOINTS]; 3];
                        for (state, series) in state.iter_mut().zip([q, qd, qdd]) {
                            for (joint, lanes) in state.iter_mut().enumerate() {
                                *lanes = Vector::from_slice(simd, &series[joint * SAMPLES + i..]);
                            }
                        }
                        let [q, qd, qdd] = state;
                        explicit(&State::new(q, qd, qdd), &mut d);
                        black_box(&mut d);
                    }
                }
            }
            let mut d = [[0.0; PARAMETERS]; JOINTS];
            let mut lanes = [[f64x4::ZERO; PARAMETERS]; JOINTS];
            let signals = Model.pattern(Output::Explicit).signals;
            let [mut generated, mut tape] = [(); 2].map(|()| vec![0.0; signals * SAMPLES]);
            let Some(interpreter) = interpreter(NAME) else {
                return;
            };
            let contenders: [Contender<'_>; 5] = [
                (
                    "generated, one sample",
                    Box::new(|| {
                        for i in 0..SAMPLES {
                            explicit(&State::new(one(&q, i), one(&qd, i), one(&qdd, i)), &mut d);
                            black_box(&mut d);
                        }
                    }),
                ),
                (
                    "generated, four lanes",
                    Box::new(|| {
                        for i in (0..SAMPLES).step_by(LANES) {
                            let state = State::new(block(&q, i), block(&qd, i), block(&qdd, i));
                            explicit(&state, &mut lanes);
                            black_box(&mut lanes);
                        }
                    }),
                ),
                (
                    "generated, widest vectors",
                    Box::new(|| Arch::new().dispatch(Vectors(&states))),
                ),
                (
                    "generated, as identified with",
                    Box::new(|| {
                        Model.evaluate(Output::Explicit, &states, &mut generated);
                        black_box(&mut generated);
                    }),
                ),
                (
                    "interpreter",
                    Box::new(|| {
                        interpreter.evaluate(Output::Explicit, &states, &mut tape);
                        black_box(&mut tape);
                    }),
                ),
            ];
            println!("{NAME}: {JOINTS} joints, {PARAMETERS} parameters, {signals} signals");
            race(contenders, rounds);
        }
    };
}

arm!(ur10e);
arm!(panda);

fn interpreter(name: &str) -> Option<Interpreter> {
    let file = format!("robots/{name}.toml");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    match idim::codegen::builder::read(&path) {
        Ok(read) => Some(Interpreter::new(&read.robot)),
        Err(error) => {
            eprintln!("{error}");
            None
        }
    }
}

/// Lets the contenders run in turn, and prints the fastest round of each.
fn race<const N: usize>(mut contenders: [Contender<'_>; N], rounds: usize) {
    let mut best = [f64::INFINITY; N];
    for _ in 0..rounds {
        for ((_, pass), best) in contenders.iter_mut().zip(&mut best) {
            let begin = Instant::now();
            (0..PASSES).for_each(|_| pass());
            let samples = (PASSES * SAMPLES) as f64;
            *best = best.min(begin.elapsed().as_secs_f64() * 1e9 / samples);
        }
    }
    for ((name, _), best) in contenders.iter().zip(best) {
        println!("  {name:30} {best:7.1} ns per sample");
    }
}
