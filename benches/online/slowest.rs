//! The slowest of a million steps, and whose time it is: the loop's or the machine's.
//!
//! The same million steps, from the first sample on, are run several times. Work of the loop that
//! is long is long in every run; what the kernel, an interrupt or a hypervisor takes is taken at
//! another step each time. So the fastest run of each step bounds the loop's own time from above,
//! and the slowest of these is its worst step. Where the kernel counts them (Linux), its own changes
//! of the running thread are read before and after every step. A loop that only reads the clock, as
//! long as a run, says what the machine takes of any program.

use std::time::Instant;

use super::control::Loop;
use super::kernel::Kernel;

const STEPS: usize = 1_000_000;
const RUNS: usize = 3;

/// A twentieth of the period of 1 ms.
const SLOW_NS: u64 = 50_000;

/// One run through the motion.
struct Run {
    /// Wall time of every step, ns.
    wall: Vec<u64>,
    /// Steps longer than [`SLOW_NS`], and those of them during which another thread ran.
    slow: usize,
    taken: usize,
}

/// Runs, compares and prints.
pub fn print() {
    let Some(start) = Loop::new() else {
        return;
    };
    let kernel = Kernel::of_this_thread();
    let runs: Vec<Run> = (0..RUNS).map(|_| run(start.clone(), &kernel)).collect();
    println!("{STEPS} steps of a 7R arm from the first on, {RUNS} times, us:");
    for run in &runs {
        println!("  {}", row(&run.wall));
        let whose = match kernel.counters() {
            Some(_) => format!("during {} of them other threads ran", run.taken),
            None => "nothing is known of other threads here".to_owned(),
        };
        println!("    {} took more than 50; {whose}", run.slow);
    }
    let idle = idle(runs.iter().map(|run| run.wall.iter().sum()).max());
    let (longest, times) = (idle.iter().max(), idle.len());
    let longest = longest.map_or(0.0, |gap| *gap as f64 / 1e3);
    println!("  a loop that does nothing, as long: more than 50 {times} times, worst {longest:.2}");
    let own: Vec<u64> = (0..STEPS)
        .filter_map(|i| runs.iter().map(|run| run.wall[i]).min())
        .collect();
    let worst = own.iter().enumerate().max_by_key(|(_, time)| **time);
    println!("  {}: the fastest of each step", row(&own));
    if let Some((step, _)) = worst {
        let times = runs.iter().map(|run| run.wall[step] as f64 / 1e3);
        println!("    worst step {step}: {:.2?}", times.collect::<Vec<_>>());
    }
}

fn run(mut own: Loop, kernel: &Kernel) -> Run {
    let mut run = Run {
        wall: Vec::with_capacity(STEPS),
        slow: 0,
        taken: 0,
    };
    for _ in 0..STEPS {
        let before = kernel.counters();
        let begin = Instant::now();
        own.step();
        let wall = begin.elapsed().as_nanos() as u64;
        run.wall.push(wall);
        if wall > SLOW_NS {
            run.slow += 1;
            run.taken += usize::from(kernel.counters() != before);
        }
    }
    run
}

/// Gaps longer than [`SLOW_NS`] between two readings of the clock, ns, in a loop of so many ns.
fn idle(length: Option<u64>) -> Vec<u64> {
    let begin = Instant::now();
    let (mut last, mut gaps) = (0, Vec::new());
    while last < length.unwrap_or(0) {
        let now = begin.elapsed().as_nanos() as u64;
        if now - last > SLOW_NS {
            gaps.push(now - last);
        }
        last = now;
    }
    gaps
}

fn row(nanoseconds: &[u64]) -> String {
    let mut sorted = nanoseconds.to_vec();
    sorted.sort_unstable();
    let total: u64 = sorted.iter().sum();
    let at = |share: f64| sorted[((STEPS - 1) as f64 * share) as usize] as f64 / 1e3;
    format!(
        "mean {:.2}, median {:.2}, 99 % {:.2}, 99.99 % {:.2}, worst {:.2}",
        total as f64 / STEPS as f64 / 1e3,
        at(0.5),
        at(0.99),
        at(0.9999),
        at(1.0),
    )
}
