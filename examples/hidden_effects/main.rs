//! Robots with hidden effects that nobody tuned the diagnosis to: draws cases from a seed, has them
//! diagnosed, and scores what was said.
//!
//! `cargo run --release --example hidden_effects -- --seed S --cases N [--out DIR] [--only WHAT]
//! [--jobs J]`

mod cases;

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use cases::{Failure, draw, files};

/// What the command line says.
struct Arguments {
    seed: u64,
    cases: usize,
    from: usize,
    out: Option<PathBuf>,
    only: Option<String>,
    jobs: usize,
}

fn main() -> Result<(), Failure> {
    let arguments = arguments()?;
    let next = AtomicUsize::new(arguments.from);
    let end = arguments.from + arguments.cases;
    std::thread::scope(|scope| {
        let work = || {
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                if number >= end {
                    return;
                }
                if let Err(error) = one(&arguments, number) {
                    eprintln!("case {number}: {error}");
                }
            }
        };
        for _ in 1..arguments.jobs {
            scope.spawn(work);
        }
        work();
    });
    Ok(())
}

fn one(arguments: &Arguments, number: usize) -> Result<(), Failure> {
    let begun = Instant::now();
    let case = draw::draw(arguments.seed, number, arguments.only.as_deref())?;
    let truth = &case.truth;
    println!(
        "{} {:8} {:?} ev {:.1} {} {:.2} s",
        truth.case,
        truth.robot,
        truth.category,
        truth.evidence,
        truth
            .effects
            .iter()
            .map(|e| format!("{}@{:?} {:.1}", e.effect, e.joints, e.evidence))
            .collect::<Vec<_>>()
            .join(" + "),
        begun.elapsed().as_secs_f64()
    );
    let ratio = |a: &[f64], b: &[f64]| {
        a.iter()
            .zip(b)
            .map(|(a, b)| format!("{:.2}", a / b))
            .collect::<Vec<_>>()
            .join(" ")
    };
    println!(
        "   null/floor {}   oracle/floor {}",
        ratio(&truth.rmse_null, &truth.rmse_floor),
        ratio(&truth.rmse_oracle, &truth.rmse_floor)
    );
    if let Some(folder) = &arguments.out {
        files::write(folder, &case)?;
    }
    Ok(())
}

fn arguments() -> Result<Arguments, Failure> {
    let mut found = Arguments {
        seed: 1,
        cases: 10,
        from: 0,
        out: None,
        only: None,
        jobs: 1,
    };
    let mut rest = std::env::args().skip(1);
    while let Some(key) = rest.next() {
        let value = rest.next().ok_or(format!("{key} needs a value"))?;
        match key.as_str() {
            "--seed" => found.seed = value.parse()?,
            "--cases" => found.cases = value.parse()?,
            "--from" => found.from = value.parse()?,
            "--jobs" => found.jobs = value.parse()?,
            "--out" => found.out = Some(value.into()),
            "--only" => found.only = Some(value),
            _ => return Err(format!("{key} is not known").into()),
        }
    }
    Ok(found)
}
