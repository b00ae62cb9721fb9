//! From text to numbers: a log of six joints at 1 kHz, 200 000 rows of 13 columns, in memory and
//! on disk. The throughput is that of the text, with all checks that a log goes through.
//!
//! `cargo bench --bench log`; `RAYON_NUM_THREADS=1` for one thread.

use std::fmt::Write;
use std::path::Path;

use divan::counter::BytesCount;
use idim::runtime::log::{self, LogSpec, ReadOptions};
use idim::runtime::model::{Joint, JointKind};
use idim::runtime::settings::Drives;

const ROWS: u32 = 200_000;

fn main() {
    divan::main();
}

/// Nine digits each, as loggers print them.
fn text() -> String {
    let mut text = String::from("t,q1,q2,q3,q4,q5,q6,tau1,tau2,tau3,tau4,tau5,tau6\n");
    for row in 0..ROWS {
        let t = f64::from(row) * 1e-3;
        let _ = write!(text, "{t:.3}");
        for joint in 1..=6 {
            let q = (t * 0.7 * f64::from(joint)).sin();
            let _ = write!(text, ",{q:.9}");
        }
        for joint in 1..=6 {
            let tau = 40.0 * (t * 1.3 * f64::from(joint)).cos();
            let _ = write!(text, ",{tau:.7}");
        }
        text.push('\n');
    }
    text
}

fn joints() -> Vec<Joint> {
    let joint = |k| Joint {
        name: format!("joint{k}").into(),
        kind: JointKind::Revolute,
    };
    (1..=6).map(joint).collect()
}

fn run(bencher: divan::Bencher<'_, '_>, read: impl Fn(&LogSpec, &[Joint]) -> usize + Sync) {
    let text = text();
    let Ok(directory) = tempfile::tempdir() else {
        return;
    };
    let path = directory.path().join("log.csv");
    if let Err(error) = std::fs::write(Path::new(&path), &text) {
        println!("skipped: {error}");
        return;
    }
    let (spec, joints) = (LogSpec::from(path), joints());
    bencher
        .counter(BytesCount::new(text.len()))
        .bench(|| read(&spec, &joints));
}

/// Into memory.
#[divan::bench]
fn csv_into_memory(bencher: divan::Bencher<'_, '_>) {
    run(bencher, |spec, joints| {
        let log = log::read(spec, joints, &Drives::default(), &ReadOptions::default());
        log.map_or(0, |(log, _)| log.len)
    });
}

/// Onto disk, for windows.
#[divan::bench]
fn csv_onto_disk(bencher: divan::Bencher<'_, '_>) {
    run(bencher, |spec, joints| {
        let log = log::read_long(spec, joints, &Drives::default(), &ReadOptions::default());
        log.map_or(0, |(log, _)| log.len)
    });
}
