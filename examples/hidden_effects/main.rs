//! Robots with hidden effects that nobody tuned the diagnosis to: draws cases from a seed, has them
//! diagnosed, and scores what was said (docs/hidden_effects.md).
//!
//! `cargo run --release --example hidden_effects -- --seed S --cases N [--out DIR] [--jobs J]`
//!
//! Further: `--from K` begins with the K-th case, `--only WHAT` draws `one`, `two`, `nothing`,
//! `outside` or a single effect by its name, `--do draw` stops when the cases are written, `--do
//! score` diagnoses those that are in DIR.

mod cases;

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use cases::machine::Failure;
use cases::score::Scored;
use cases::truth::Truth;
use cases::{answer, draw, files, table};

/// What is to be done.
#[derive(Clone, Copy, PartialEq)]
enum Task {
    Draw,
    Score,
    Both,
}

/// What the command line says.
struct Arguments {
    seed: u64,
    cases: usize,
    from: usize,
    out: Option<PathBuf>,
    only: Option<String>,
    jobs: usize,
    task: Task,
}

fn main() -> Result<(), Failure> {
    let arguments = arguments()?;
    let scratch = tempfile::tempdir()?;
    let folder = arguments.out.as_deref().unwrap_or(scratch.path());
    let scored = match arguments.task {
        Task::Score => {
            let truths = files::truths(folder)?;
            let score = |k: usize| score(folder, truths[k].clone()).map(Some);
            in_parallel(0..truths.len(), arguments.jobs, &score)
        }
        task => {
            let numbers = arguments.from..arguments.from + arguments.cases;
            let each = |number: usize| {
                let case = draw::draw(arguments.seed, number, arguments.only.as_deref())?;
                files::write(folder, &case)?;
                match task {
                    Task::Both => score(folder, case.truth).map(Some),
                    _ => Ok(None),
                }
            };
            in_parallel(numbers, arguments.jobs, &each)
        }
    };
    if !scored.is_empty() {
        println!(
            "\n{}\n{}",
            table::confusion(&scored),
            table::summary(&scored)
        );
    }
    Ok(())
}

/// Has a case diagnosed; what diagnoses sees its folder alone.
fn score(folder: &Path, truth: Truth) -> Result<Scored, Failure> {
    let answer = answer::answer(&folder.join("cases").join(&truth.case))?;
    let scored = Scored { truth, answer };
    println!("{}", table::line(&scored));
    Ok(scored)
}

/// Works off numbers with so many threads; what fails is told and left out.
fn in_parallel(
    numbers: std::ops::Range<usize>,
    jobs: usize,
    each: &(dyn Fn(usize) -> Result<Option<Scored>, Failure> + Sync),
) -> Vec<Scored> {
    let next = AtomicUsize::new(numbers.start);
    let all = Mutex::new(Vec::new());
    let work = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= numbers.end {
                return;
            }
            match each(number) {
                Ok(scored) => {
                    if let Ok(mut all) = all.lock() {
                        all.extend(scored);
                    }
                }
                Err(error) => eprintln!("case {number}: {error}"),
            }
        }
    };
    std::thread::scope(|scope| {
        (1..jobs).for_each(|_| {
            scope.spawn(work);
        });
        work();
    });
    all.into_inner().unwrap_or_default()
}

fn arguments() -> Result<Arguments, Failure> {
    let mut found = Arguments {
        seed: 1,
        cases: 20,
        from: 0,
        out: None,
        only: None,
        jobs: 1,
        task: Task::Both,
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
            "--do" if value == "draw" => found.task = Task::Draw,
            "--do" if value == "score" => found.task = Task::Score,
            _ => return Err(format!("{key} {value} is not known").into()),
        }
    }
    if found.task != Task::Both && found.out.is_none() {
        return Err("--do draw and --do score need --out DIR".into());
    }
    Ok(found)
}
