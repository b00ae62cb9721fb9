//! The Rust that idim generates: `program STATES RESULTS one|lanes|batch`, as `harness.h` has it.

#[path = "robot.rs"]
#[allow(dead_code)]
mod robot;

use std::array::from_fn;
use std::hint::black_box;
use std::time::Instant;

use idim_runtime::lane::{Arch, Simd, Vector, WithSimd};
use idim_runtime::model::{IdentificationModel, Output, States};
use robot::{JOINTS, Model, PARAMETERS, State, explicit};

const SAMPLES: usize = 264;
const PASSES: usize = 20;
const TIMINGS: usize = 20;

type Sample = [[f64; JOINTS]; 3];

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let bytes = std::fs::read(&arguments[1]).unwrap();
    let number = |place: usize| f64::from_le_bytes(bytes[8 * place..][..8].try_into().unwrap());
    let sample = |i: usize| -> Sample { from_fn(|k| from_fn(|j| number((3 * i + k) * JOINTS + j))) };
    let samples: Vec<Sample> = (0..SAMPLES).map(sample).collect();
    let mut results = Vec::new();
    let best = match arguments[3].as_str() {
        "one" => {
            let mut d = [[0.0; PARAMETERS]; JOINTS];
            one(&samples, &mut d, |d| results.extend(d.iter().flatten().copied()));
            fastest(|| one(&samples, &mut d, |d| _ = black_box(d)))
        }
        "lanes" => {
            let series = series(&samples);
            Arch::new().dispatch(Lanes { series: &series, kept: Some(&mut results) });
            fastest(|| Arch::new().dispatch(Lanes { series: &series, kept: None }))
        }
        _ => {
            let series = series(&samples);
            let mut signals = vec![0.0; Model.pattern(Output::Explicit).signals * SAMPLES];
            batch(&series, &mut signals);
            results = dense(&signals);
            fastest(|| batch(&series, black_box(&mut signals)))
        }
    };
    let bytes: Vec<u8> = results.iter().flat_map(|x| x.to_le_bytes()).collect();
    std::fs::write(&arguments[2], bytes).unwrap();
    println!("{best:.2}");
}

/// q, qd, qdd joint by joint.
fn series(samples: &[Sample]) -> [Vec<f64>; 3] {
    from_fn(|k| (0..JOINTS * SAMPLES).map(|at| samples[at % SAMPLES][k][at / SAMPLES]).collect())
}

fn one(samples: &[Sample], d: &mut [[f64; PARAMETERS]; JOINTS], mut each: impl FnMut(&mut [[f64; PARAMETERS]; JOINTS])) {
    for &[q, qd, qdd] in samples {
        explicit(&State::new(q, qd, qdd), d);
        each(d);
    }
}

/// D of all samples, as many at a time as the vectors of the machine hold; keeps, where asked to,
/// what it is of each sample.
struct Lanes<'a> {
    series: &'a [Vec<f64>; 3],
    kept: Option<&'a mut Vec<f64>>,
}

impl WithSimd for Lanes<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let mut d = [[Vector::splat(simd, 0.0); PARAMETERS]; JOINTS];
        for i in (0..SAMPLES).step_by(S::F64_LANES) {
            let mut state = [[d[0][0]; JOINTS]; 3];
            for (state, series) in state.iter_mut().zip(self.series) {
                for (joint, lanes) in state.iter_mut().enumerate() {
                    *lanes = Vector::from_slice(simd, &series[joint * SAMPLES + i..]);
                }
            }
            let [q, qd, qdd] = state;
            explicit(&State::new(q, qd, qdd), &mut d);
            let d = black_box(&mut d);
            let Some(kept) = &mut self.kept else { continue };
            for lane in 0..S::F64_LANES {
                kept.extend(d.iter().flatten().map(|x| x.values()[lane]));
            }
        }
    }
}

/// The signals of D, as the identification asks for them.
fn batch(series: &[Vec<f64>; 3], signals: &mut [f64]) {
    let [q, qd, qdd] = series;
    Model.evaluate(Output::Explicit, &States { len: SAMPLES, q, qd, qdd, slip: &[] }, signals);
}

/// D row by row, sample by sample.
fn dense(signals: &[f64]) -> Vec<f64> {
    let mut d = vec![0.0; SAMPLES * JOINTS * PARAMETERS];
    for entry in Model.pattern(Output::Explicit).entries.iter() {
        for i in 0..SAMPLES {
            d[(i * JOINTS + entry.row) * PARAMETERS + entry.column] = signals[entry.signal * SAMPLES + i];
        }
    }
    d
}

/// ns per sample of the fastest of all timings.
fn fastest(mut pass: impl FnMut()) -> f64 {
    let mut timing = |_| {
        let begin = Instant::now();
        (0..PASSES).for_each(|_| pass());
        begin.elapsed().as_secs_f64() * 1e9 / (PASSES * SAMPLES) as f64
    };
    (0..TIMINGS).map(&mut timing).fold(f64::INFINITY, f64::min)
}
