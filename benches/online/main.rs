//! The step of a control loop at 1 kHz: a 7R arm (Panda, 69 parameters), filters, recursion and
//! watchdog. Before the usual benchmarks, the slowest of a million steps is looked for ([`slowest`]);
//! the allocations of each are counted (none is shown where there is none).
//!
//! `cargo bench --bench online`

mod control;
mod kernel;
mod slowest;

use divan::{AllocProfiler, Bencher};
use idim::runtime::online::Solution;

use control::Loop;

#[global_allocator]
static ALLOCATIONS: AllocProfiler = AllocProfiler::system();

fn main() {
    if std::env::args().any(|argument| argument == "--bench") {
        slowest::print();
    }
    divan::main();
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
