//! What runs in the loop, and a motion for it.

use std::sync::Arc;

use idim::robots;
use idim::runtime::model::{IdentificationModel, Output, States};
use idim::runtime::online::{Options, Recursion, Step, Stream, WatchOptions, Watchdog};

type Panda = robots::panda::Model;

/// Samples of the motion that is run through again and again, the second half of it at rest.
const CYCLE: usize = 80_000;
const MOVING: usize = 40_000;

/// One motion's samples: positions and torques.
type Sample = [[f64; 7]; 2];

/// Filters, recursion and watchdog of a 7R arm, and where in its motion it is.
#[derive(Clone)]
pub struct Loop {
    motion: Arc<[Sample]>,
    next: usize,
    stream: Stream<Panda>,
    pub recursion: Recursion,
    pub watchdog: Watchdog,
}

impl Loop {
    /// A loop before its first sample.
    pub fn new() -> Option<Loop> {
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
    pub fn running() -> Option<Loop> {
        let mut own = Loop::new()?;
        (0..300_000).for_each(|_| own.step());
        Some(own)
    }

    /// One millisecond.
    pub fn step(&mut self) {
        let [q, tau] = &self.motion[self.next];
        self.next = (self.next + 1) % CYCLE;
        if let Ok(Step::Equations(instant)) = self.stream.push(q, None, tau) {
            self.recursion.update(instant);
            self.watchdog.update(instant);
        }
    }
}

/// Positions and torques of sines in all joints, then rest.
fn motion(parameters: &[f64]) -> Arc<[Sample]> {
    let model = robots::panda::Model;
    let pattern = model.pattern(Output::Explicit);
    let mut signals = vec![0.0; pattern.signals];
    let tau = std::f64::consts::TAU;
    let sample = |i: usize| {
        let moving = if i < MOVING { 1.0 } else { 0.0 };
        let angle = |j: usize| tau * (j + 1) as f64 * i.min(MOVING) as f64 / 20_000.0;
        let omega = |j: usize| tau * (j + 1) as f64 / 20.0;
        let q: [f64; 7] = std::array::from_fn(|j| angle(j).sin());
        let qd: [f64; 7] = std::array::from_fn(|j| moving * omega(j) * angle(j).cos());
        let qdd: [f64; 7] = std::array::from_fn(|j| -moving * omega(j).powi(2) * angle(j).sin());
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
