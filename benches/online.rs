//! The step of a control loop at 1 kHz: a 7R arm (Panda, 69 parameters), filters, recursion and
//! watchdog, in the middle of its work. Before the usual benchmarks, the slowest of a million steps
//! is looked for; the allocations of each are counted (none is shown where there is none).
//!
//! `cargo bench --bench online`

use std::time::Instant;

use divan::{AllocProfiler, Bencher};
use idim::robots;
use idim::runtime::model::{IdentificationModel, Output, States};
use idim::runtime::online::{Options, Recursion, Solution, Step, Stream, WatchOptions, Watchdog};

#[global_allocator]
static ALLOCATIONS: AllocProfiler = AllocProfiler::system();

const STEPS: usize = 1_000_000;

/// Samples of the motion that is run through again and again.
const CYCLE: usize = 20_000;

fn main() {
    if std::env::args().any(|argument| argument == "--bench") {
        slowest();
    }
    divan::main();
}

type Panda = robots::panda::Model;

/// All that runs in the loop, and a motion for it.
struct Loop {
    motion: Vec<[[f64; 7]; 2]>,
    next: usize,
    stream: Stream<Panda>,
    recursion: Recursion,
    watchdog: Watchdog,
}

impl Loop {
    fn new() -> Option<Loop> {
        let model = robots::panda::Model;
        let parameters = vec![1.0; model.columns().len()];
        let stream = Stream::new(model, &Options::at(1000.0)).ok()?;
        let watchdog = Watchdog::new(&stream, &parameters, &WatchOptions::default()).ok()?;
        Some(Loop {
            motion: motion(&parameters),
            next: 0,
            recursion: Recursion::new(&stream, &[1.0; 7], 0.9999).ok()?,
            stream,
            watchdog,
        })
    }

    /// A loop whose windows are full and whose watchdog has learned.
    fn running() -> Option<Loop> {
        let mut own = Loop::new()?;
        (0..200_000).for_each(|_| own.step());
        Some(own)
    }

    fn step(&mut self) {
        let [q, tau] = &self.motion[self.next];
        self.next = (self.next + 1) % CYCLE;
        if let Ok(Step::Equations(instant)) = self.stream.push(q, None, tau) {
            self.recursion.update(instant);
            self.watchdog.update(instant);
        }
    }
}

/// Positions and torques of sines in all joints.
fn motion(parameters: &[f64]) -> Vec<[[f64; 7]; 2]> {
    let model = robots::panda::Model;
    let pattern = model.pattern(Output::Explicit);
    let mut signals = vec![0.0; pattern.signals];
    let sample = |i: usize| {
        let angle = |j: usize| std::f64::consts::TAU * (j + 1) as f64 * i as f64 / CYCLE as f64;
        let omega = |j: usize| std::f64::consts::TAU * (j + 1) as f64 * 1000.0 / CYCLE as f64;
        let q: [f64; 7] = std::array::from_fn(|j| angle(j).sin());
        let qd: [f64; 7] = std::array::from_fn(|j| omega(j) * angle(j).cos());
        let qdd: [f64; 7] = std::array::from_fn(|j| -omega(j).powi(2) * angle(j).sin());
        let states = States {
            len: 1,
            q: &q,
            qd: &qd,
            qdd: &qdd,
            slip: &[],
        };
        model.evaluate(Output::Explicit, &states, &mut signals);
        // Something that no parameters explain.
        let mut tau: [f64; 7] = std::array::from_fn(|j| 0.1 * (7.3 * angle(j)).sin().powi(3));
        for entry in pattern.entries.iter() {
            tau[entry.row] += parameters[entry.column] * signals[entry.signal];
        }
        [q, tau]
    };
    (0..CYCLE).map(sample).collect()
}

/// Times each of a million steps.
fn slowest() {
    let Some(mut own) = Loop::running() else {
        return;
    };
    let mut nanoseconds: Vec<u64> = Vec::with_capacity(STEPS);
    for _ in 0..STEPS {
        let begin = Instant::now();
        own.step();
        nanoseconds.push(begin.elapsed().as_nanos() as u64);
    }
    nanoseconds.sort_unstable();
    let total: u64 = nanoseconds.iter().sum();
    let at = |share: f64| nanoseconds[((STEPS - 1) as f64 * share) as usize] as f64 / 1e3;
    println!(
        "{STEPS} steps of a 7R arm, us: mean {:.2}, median {:.2}, 99 % {:.2}, 99.99 % {:.2}, max {:.2}; \
         {} took more than 50",
        total as f64 / STEPS as f64 / 1e3,
        at(0.5),
        at(0.99),
        at(0.9999),
        at(1.0),
        nanoseconds.iter().filter(|t| **t > 50_000).count(),
    );
}

/// A thousand steps, one in 25 of which updates all factors.
#[divan::bench]
fn thousand_steps(bencher: Bencher<'_, '_>) {
    if let Some(mut own) = Loop::running() {
        bencher.bench_local(|| (0..1000).for_each(|_| own.step()));
    }
}

/// Parameters, standard deviations and what is determined, on demand.
#[divan::bench]
fn solve(bencher: Bencher<'_, '_>) {
    if let Some(mut own) = Loop::running() {
        let mut solution: Solution = own.recursion.solution();
        bencher.bench_local(|| own.recursion.solve(&mut solution));
    }
}

/// The watchdog's comparison of a minute with its reference.
#[divan::bench]
fn check(bencher: Bencher<'_, '_>) {
    if let Some(mut own) = Loop::running() {
        bencher.bench_local(|| own.watchdog.check().len());
    }
}
