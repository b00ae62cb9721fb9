//! From samples to equations: states, model, mask of rest, parallel low-pass, decimation.

use super::bank::Bank;
use super::delay::Delay;
use super::state::JointStates;
use super::{OnlineError, Options};
use crate::model::{Entry, IdentificationModel, Output};
use crate::observe::{Equations, ModelKind, Observations, Treatment};
use crate::settings::Velocity;
use crate::signal::butterworth;

/// One filtered equation \\( y = w X \\): of a joint, or of the power balance.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// The columns of X that it can see, ascending.
    pub columns: Vec<usize>,
    /// Its row of W, one value per column of `columns`.
    pub w: Vec<f64>,
    /// The filtered measurement: N m, N, or W for the power balance.
    pub y: f64,
    /// Whether the joint (or, for the power, any joint) moves. At rest dry friction takes any value
    /// and the row tells nothing of it; [`super::Recursion`] and [`super::Watchdog`] leave it out.
    pub moves: bool,
}

/// The equations of one instant.
#[derive(Clone, Copy, Debug)]
pub struct Instant<'a> {
    /// Samples since the start, good or bad, when they came out.
    pub sample: u64,
    /// One per joint, or a single one for the power model.
    pub equations: &'a [Equation],
}

/// What became of a sample.
#[derive(Clone, Copy, Debug)]
pub enum Step<'a> {
    /// It held a value that is not finite: counted, left out, and the filters begin again.
    Skipped,
    /// The windows fill, at the start or after a bad sample.
    Filling,
    /// It went into the filters.
    Between,
    /// It completed an instant that becomes equations.
    Equations(Instant<'a>),
}

/// One term of a model's regressor and its signals at one sample.
#[derive(Clone, Debug)]
struct Term {
    output: Output,
    treatment: Treatment,
    entries: Vec<Entry>,
    /// For each entry, its place in the row of signals that are filtered.
    places: Vec<usize>,
    signals: Vec<f64>,
    /// Only if the model has terms that are differentiated.
    delay: Option<Delay>,
    delayed: Vec<f64>,
}

/// Filters the samples of a control loop into equations. All memory is taken when it is set up; a
/// sample costs the same whatever its values, but for the decimation, whose equations come once in
/// `nd` samples.
#[derive(Clone, Debug)]
pub struct Stream<M> {
    model: M,
    options: Options,
    joints: JointStates,
    terms: Vec<Term>,
    /// `[w | y]` of all equations, one after the other: the signals of the parallel filter.
    row: Vec<f64>,
    /// Measurements and masks, to be delayed with terms that are differentiated.
    measured: Delay,
    now: Vec<f64>,
    bank: Bank,
    equations: Vec<Equation>,
    samples: u64,
    skipped: u64,
    phase: usize,
}

impl<M: IdentificationModel> Stream<M> {
    /// Takes the memory of all filters for a model.
    ///
    /// # Errors
    /// [`OnlineError::Rate`], [`OnlineError::Ratio`], [`OnlineError::Band`],
    /// [`OnlineError::Filter`], [`OnlineError::TooLong`].
    pub fn new(model: M, options: &Options) -> Result<Self, OnlineError> {
        options.check()?;
        let fail = |source| OnlineError::Filter {
            step: "parallel filter",
            source,
        };
        let low_pass = butterworth(options.order, options.fp_hz, options.rate_hz).map_err(fail)?;
        let joints = JointStates::new(&model, options)?;
        let equations = equations(&model, options.model);
        let width = equations.iter().map(|e| e.w.len() + 1).sum();
        Ok(Stream {
            terms: terms(&model, options.model, &equations),
            measured: Delay::new(2 * equations.len()),
            now: vec![0.0; 2 * equations.len()],
            bank: Bank::new(&low_pass, width),
            row: vec![0.0; width],
            options: options.clone(),
            equations,
            joints,
            model,
            samples: 0,
            skipped: 0,
            phase: 0,
        })
    }

    /// The robot.
    pub fn model(&self) -> &M {
        &self.model
    }

    /// The filters.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The equations of an instant, as they were last.
    pub fn equations(&self) -> &[Equation] {
        &self.equations
    }

    /// Samples pushed, good or bad.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Samples left out because a value was not finite.
    pub fn skipped(&self) -> u64 {
        self.skipped
    }

    /// How long, s, an instant lies behind the sample that completes it, the parallel filter's own
    /// delay not counted.
    pub fn lag_s(&self) -> f64 {
        let differences = if self.differentiates() { Delay::LAG } else { 0 };
        (self.joints.lag() + differences) as f64 / self.options.rate_hz
    }

    /// Takes a sample: one position (rad or m), one velocity if the stream was set up for measured
    /// ones (otherwise they are not looked at), and one torque (N m or N) per joint.
    ///
    /// # Errors
    /// [`OnlineError::Joints`], [`OnlineError::NoVelocity`]; the stream then is as before.
    pub fn push(
        &mut self,
        q: &[f64],
        qd: Option<&[f64]>,
        tau: &[f64],
    ) -> Result<Step<'_>, OnlineError> {
        let qd = self.velocities(qd)?;
        for (series, values) in [("q", q), ("qd", qd.unwrap_or(q)), ("tau", tau)] {
            let (has, needs) = (values.len(), self.model.joints().len());
            if has != needs {
                return Err(OnlineError::Joints { series, has, needs });
            }
        }
        self.samples += 1;
        let sample = [q, qd.unwrap_or(&[]), tau];
        if sample
            .iter()
            .any(|values| values.iter().any(|x| !x.is_finite()))
        {
            self.skipped += 1;
            self.clear();
            return Ok(Step::Skipped);
        }
        if !(self.joints.push(&self.model, sample) && self.assemble()) {
            return Ok(Step::Filling);
        }
        self.bank.step(&mut self.row);
        self.phase += 1;
        if self.phase < self.options.nd {
            return Ok(Step::Between);
        }
        self.phase = 0;
        self.hand_out();
        Ok(Step::Equations(Instant {
            sample: self.samples,
            equations: &self.equations,
        }))
    }

    /// Forgets the samples in the filters, as after a gap in time.
    pub fn clear(&mut self) {
        self.joints.clear();
        self.measured.clear();
        let delays = self.terms.iter_mut().filter_map(|term| term.delay.as_mut());
        delays.for_each(Delay::clear);
        self.bank.clear();
        self.phase = 0;
    }

    fn velocities<'s>(&self, qd: Option<&'s [f64]>) -> Result<Option<&'s [f64]>, OnlineError> {
        match (self.options.velocity, qd) {
            (Velocity::Derived, _) => Ok(None),
            (Velocity::Measured, Some(qd)) => Ok(Some(qd)),
            (Velocity::Measured, None) => Err(OnlineError::NoVelocity),
        }
    }

    fn differentiates(&self) -> bool {
        self.terms.iter().any(|term| term.delay.is_some())
    }

    /// Puts the unfiltered equations of the present instant into `row`; whether there are any.
    fn assemble(&mut self) -> bool {
        self.measure();
        let states = self.joints.states();
        for term in &mut self.terms {
            self.model.evaluate(term.output, &states, &mut term.signals);
            if let Some(delay) = &mut term.delay {
                delay.push(&term.signals);
                if !delay.full() {
                    continue;
                }
                match term.treatment {
                    Treatment::Value => term.delayed.copy_from_slice(delay.values()),
                    Treatment::Rate => delay.rates(self.options.rate_hz, &mut term.delayed),
                }
            }
        }
        let differentiates = self.differentiates();
        if differentiates {
            self.measured.push(&self.now);
            if !self.measured.full() {
                return false;
            }
            self.now.copy_from_slice(self.measured.values());
        }
        self.row.fill(0.0);
        for term in &self.terms {
            let signals = match differentiates {
                true => &term.delayed,
                false => &term.signals,
            };
            for (entry, place) in term.entries.iter().zip(&term.places) {
                self.row[*place] += signals[entry.signal];
            }
        }
        self.mask();
        true
    }

    /// Measurement and mask of every equation: 1 if its joint moves, or any joint for the power.
    fn measure(&mut self) {
        let moves = |yes: bool| if yes { 1.0 } else { 0.0 };
        match self.options.model {
            ModelKind::Power => {
                let any = self.joints.moves.iter().any(|moves| *moves);
                self.now.copy_from_slice(&[self.joints.power(), moves(any)]);
            }
            ModelKind::Explicit | ModelKind::Implicit => {
                let torques = self.joints.torque().iter().zip(&self.joints.moves);
                for (now, (torque, yes)) in self.now.chunks_exact_mut(2).zip(torques) {
                    now.copy_from_slice(&[*torque, moves(*yes)]);
                }
            }
        }
    }

    /// Takes the equations of joints at rest out, left and right of the sign of equality.
    fn mask(&mut self) {
        let mut row = self.row.as_mut_slice();
        for (equation, now) in self.equations.iter().zip(self.now.chunks_exact(2)) {
            let (own, others) = row.split_at_mut(equation.w.len() + 1);
            if let Some((y, _)) = own.split_last_mut() {
                *y = now[0];
            }
            if now[1] == 0.0 {
                own.fill(0.0);
            }
            row = others;
        }
    }

    fn hand_out(&mut self) {
        let mut row = self.row.as_slice();
        for (equation, now) in self.equations.iter_mut().zip(self.now.chunks_exact(2)) {
            let (own, others) = row.split_at(equation.w.len() + 1);
            if let Some((y, w)) = own.split_last() {
                equation.w.copy_from_slice(w);
                equation.y = *y;
            }
            equation.moves = now[1] != 0.0;
            row = others;
        }
    }
}

/// Empty equations with the columns that each can see in any term of the model.
fn equations(model: &dyn IdentificationModel, kind: ModelKind) -> Vec<Equation> {
    let seen = |block: Equations| Equation {
        w: vec![0.0; block.columns.len()],
        columns: block.columns,
        y: 0.0,
        moves: false,
    };
    let blocks = Observations::none(model, kind).blocks;
    blocks.into_iter().map(seen).collect()
}

fn terms(model: &dyn IdentificationModel, kind: ModelKind, equations: &[Equation]) -> Vec<Term> {
    let starts: Vec<usize> = equations
        .iter()
        .scan(0, |start, equation| {
            let own = *start;
            *start += equation.w.len() + 1;
            Some(own)
        })
        .collect();
    let differentiates = kind.terms().iter().any(|term| term.1 == Treatment::Rate);
    let place = |entry: &Entry| {
        let columns = &equations.get(entry.row)?.columns;
        let own = columns.binary_search(&entry.column).ok()?;
        Some((*entry, starts[entry.row] + own))
    };
    let term = |&(output, treatment): &(Output, Treatment)| {
        let pattern = model.pattern(output);
        let (entries, places) = pattern.entries.iter().filter_map(place).unzip();
        Term {
            output,
            treatment,
            entries,
            places,
            signals: vec![0.0; pattern.signals],
            delay: differentiates.then(|| Delay::new(pattern.signals)),
            delayed: vec![0.0; if differentiates { pattern.signals } else { 0 }],
        }
    };
    kind.terms().iter().map(term).collect()
}
