//! Prints how fast rows are folded; asserts only that the result is right.

use std::time::Instant;

use super::super::Fold;
use super::Random;

#[test]
fn folding_speed_is_printed() {
    const WIDTH: usize = 60;
    const CHUNK: usize = 4096;
    let rows = if cfg!(debug_assertions) {
        100_000
    } else {
        1_000_000
    };
    let mut random = Random(1);
    let chunk: Vec<Vec<f64>> = (0..WIDTH).map(|_| random.series(CHUNK)).collect();
    let mut best = f64::INFINITY;
    let mut norm = 0.0;
    for _ in 0..5 {
        let start = Instant::now();
        let mut fold = Fold::new(WIDTH);
        for at in (0..rows).step_by(CHUNK) {
            let len = CHUNK.min(rows - at);
            let part: Vec<&[f64]> = chunk.iter().map(|column| &column[..len]).collect();
            fold.rows(&part);
        }
        norm = fold.finish().column_norm(WIDTH - 1);
        best = best.min(start.elapsed().as_secs_f64());
    }
    let flops = 2.0 * rows as f64 * (WIDTH * WIDTH) as f64;
    println!(
        "fold {rows} x {WIDTH}: {:.1} ms, {:.1} GF/s",
        1e3 * best,
        1e-9 * flops / best
    );
    if !cfg!(debug_assertions) {
        println!("faer, sequential: {:.1} GF/s", faer_speed(&chunk));
    }
    let expected = (rows as f64 / 3.0).sqrt();
    assert!(
        (norm / expected - 1.0).abs() < 0.05,
        "{norm} is not near {expected}"
    );
}

/// The same with one large factorisation by faer, to compare under the same load.
fn faer_speed(chunk: &[Vec<f64>]) -> f64 {
    let (rows, width) = (200_000, chunk.len());
    let matrix = faer::Mat::from_fn(rows, width, |i, k| chunk[k][i % chunk[k].len()]);
    let start = Instant::now();
    let corner = matrix.qr().thin_R()[(0, 0)];
    let flops = 2.0 * rows as f64 * (width * width) as f64;
    assert!(corner != 0.0);
    1e-9 * flops / start.elapsed().as_secs_f64()
}
