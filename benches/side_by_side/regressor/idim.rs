//! The Rust that idim generates: `program STATES RESULTS one|lanes`, as `harness.h` has it.

#[path = "robot.rs"]
#[allow(dead_code)]
mod robot;

use std::array::from_fn;
use std::hint::black_box;
use std::time::Instant;

use idim_runtime::batch::Block;
use robot::{JOINTS, PARAMETERS, State, explicit};

const SAMPLES: usize = 256;
const PASSES: usize = 20;
const TIMINGS: usize = 20;
const LANES: usize = 4;

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
        _ => {
            let blocks: Vec<[[Block; JOINTS]; 3]> = samples.chunks_exact(LANES).map(block).collect();
            let mut d = [[Block::ZERO; PARAMETERS]; JOINTS];
            lanes(&blocks, &mut d, |d| {
                let values: Vec<[f64; LANES]> = d.iter().flatten().map(|x| x.to_array()).collect();
                (0..LANES).for_each(|lane| results.extend(values.iter().map(|x| x[lane])));
            });
            fastest(|| lanes(&blocks, &mut d, |d| _ = black_box(d)))
        }
    };
    let bytes: Vec<u8> = results.iter().flat_map(|x| x.to_le_bytes()).collect();
    std::fs::write(&arguments[2], bytes).unwrap();
    println!("{best:.2}");
}

fn block(samples: &[Sample]) -> [[Block; JOINTS]; 3] {
    from_fn(|k| from_fn(|joint| Block::from(from_fn(|lane| samples[lane][k][joint]))))
}

fn one(samples: &[Sample], d: &mut [[f64; PARAMETERS]; JOINTS], mut each: impl FnMut(&mut [[f64; PARAMETERS]; JOINTS])) {
    for &[q, qd, qdd] in samples {
        explicit(&State::new(q, qd, qdd), d);
        each(d);
    }
}

fn lanes(blocks: &[[[Block; JOINTS]; 3]], d: &mut [[Block; PARAMETERS]; JOINTS], mut each: impl FnMut(&mut [[Block; PARAMETERS]; JOINTS])) {
    for &[q, qd, qdd] in blocks {
        explicit(&State::new(q, qd, qdd), d);
        each(d);
    }
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
