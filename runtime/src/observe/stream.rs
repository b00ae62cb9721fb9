//! The signals of some models on their way through the parallel filter, chunk by chunk.

use std::ops::Range;

use super::course::Course;
use super::equations::{empty_blocks, motor_power};
use super::{ModelKind, Motion, Treatment};
use crate::model::{IdentificationModel, Output, States};
use crate::settings::Derivatives;
use crate::signal::{REACH, Running, derivative};

/// Receives rows: those of a joint (0 for the power balance) in one of the models, planar: the
/// columns that the joint can see, ascending, then the measurements.
pub(crate) type Sink<'a> = dyn FnMut(ModelKind, usize, &[&[f64]]) + 'a;

/// The parts of ascending `ranges` inside `rows`.
pub(super) fn overlaps<'a>(
    rows: &'a Range<usize>,
    ranges: &'a [Range<usize>],
) -> impl Iterator<Item = Range<usize>> + 'a {
    let first = ranges.partition_point(|range| range.end <= rows.start);
    let near = ranges[first..]
        .iter()
        .take_while(|range| range.start < rows.end);
    near.map(|range| range.start.max(rows.start)..range.end.min(rows.end))
        .filter(|range| !range.is_empty())
}

/// The signals of some models on their way through the parallel filter.
pub(super) struct Stream<'a> {
    model: &'a dyn IdentificationModel,
    ratio: usize,
    rate_hz: f64,
    derivatives: Derivatives,
    /// The row that comes out next.
    row: usize,
    channels: Vec<Channel>,
    blocks: Vec<Block>,
    states: [Vec<f64>; 4],
    samples: Vec<f64>,
    rates: Vec<f64>,
}

/// What a channel's signals are made of.
#[derive(Clone, Copy, PartialEq)]
enum Content {
    Regressor(Output, Treatment),
    Torque,
    MotorPower,
}

impl Content {
    /// Samples on either side that are looked at.
    fn reach(self) -> usize {
        match self {
            Content::Regressor(_, Treatment::Rate) => REACH,
            _ => 0,
        }
    }
}

/// Signals of one kind, filtered together.
struct Channel {
    content: Content,
    running: Running,
    /// The rows that came out last, signal by signal.
    out: Vec<f64>,
}

/// Where the columns of a joint's rows come from.
struct Block {
    kind: ModelKind,
    joint: usize,
    /// For each column the signals (channel, signal) that add up to it; the measurement is last.
    columns: Vec<Vec<(usize, usize)>>,
}

impl<'a> Stream<'a> {
    /// Begins at row `row`, which itself is lost.
    pub fn new(
        course: &Course<'_>,
        model: &'a dyn IdentificationModel,
        kinds: &[ModelKind],
        row: usize,
    ) -> Self {
        let mut contents: Vec<Content> = Vec::new();
        for &kind in kinds {
            let terms = kind
                .terms()
                .iter()
                .map(|term| Content::Regressor(term.0, term.1));
            for content in terms.chain([measured(kind)]) {
                if !contents.contains(&content) {
                    contents.push(content);
                }
            }
        }
        let channel = |content: &Content| Channel {
            content: *content,
            running: course.decimator.running(signals(model, *content)),
            out: Vec::new(),
        };
        Stream {
            model,
            ratio: course.decimator.ratio(),
            rate_hz: course.rate_hz(),
            derivatives: course.decimator.derivatives(),
            row: row + 1,
            channels: contents.iter().map(channel).collect(),
            blocks: kinds
                .iter()
                .flat_map(|&kind| blocks(model, kind, &contents))
                .collect(),
            states: Default::default(),
            samples: Vec::new(),
            rates: Vec::new(),
        }
    }

    /// Takes the next `rows` rows of a motion, in which the last row stands [`REACH`] samples after
    /// sample `start`.
    pub fn follow(&mut self, motion: &Motion, start: usize, rows: usize) {
        let inner = rows * self.ratio;
        for channel in &mut self.channels {
            // From the sample after the last row, and what derivatives look at on either side.
            let reach = channel.content.reach();
            let first = start + REACH - reach + 1;
            let samples = first..first + inner + 2 * reach;
            for (to, from) in
                self.states
                    .iter_mut()
                    .zip([&motion.q, &motion.qd, &motion.qdd, &motion.slip])
            {
                to.clear();
                from.iter()
                    .for_each(|joint| to.extend(&joint[samples.clone()]));
            }
            let states = States {
                len: samples.len(),
                q: &self.states[0],
                qd: &self.states[1],
                qdd: &self.states[2],
                slip: &self.states[3],
            };
            let signals = signals(self.model, channel.content);
            self.samples.resize(signals * samples.len(), 0.0);
            fill(
                self.model,
                channel.content,
                &states,
                motion,
                samples.start,
                &mut self.samples,
            );
            if reach == 0 {
                channel.running.take(&self.samples, rows);
                continue;
            }
            self.rates.clear();
            for signal in self.samples.chunks(samples.len()) {
                let rates = derivative(signal, self.rate_hz, self.derivatives);
                self.rates.extend(&rates[reach..reach + inner]);
            }
            channel.running.take(&self.rates, rows);
        }
    }

    pub fn ready(&self, look_ahead: usize) -> usize {
        self.channels
            .first()
            .map_or(0, |channel| channel.running.ready(look_ahead))
    }

    /// Takes `count` rows out and hands on the believed ones among `rows`.
    pub fn hand_on(
        &mut self,
        count: usize,
        rows: &Range<usize>,
        believed: &[Range<usize>],
        sink: &mut Sink<'_>,
    ) {
        for channel in &mut self.channels {
            channel.running.give(count, &mut channel.out);
        }
        let out = self.row..self.row + count;
        self.row = out.end;
        let wanted = rows.start.max(out.start)..rows.end.min(out.end);
        for part in overlaps(&wanted, believed) {
            let part = part.start - out.start..part.end - out.start;
            for block in &self.blocks {
                block.hand_on(&self.channels, count, &part, sink);
            }
        }
    }
}

impl Block {
    /// Hands on the rows `part` of the `count` rows that came out.
    fn hand_on(
        &self,
        channels: &[Channel],
        count: usize,
        part: &Range<usize>,
        sink: &mut Sink<'_>,
    ) {
        let signal = |&(channel, signal): &(usize, usize)| {
            &channels[channel].out[signal * count..][part.clone()]
        };
        let sum = |sources: &Vec<(usize, usize)>| -> Option<Vec<f64>> {
            let (first, more) = sources.split_first()?;
            let mut sum = signal(first).to_vec();
            for source in more {
                sum.iter_mut()
                    .zip(signal(source))
                    .for_each(|(sum, x)| *sum += x);
            }
            (!more.is_empty()).then_some(sum)
        };
        let sums: Vec<Option<Vec<f64>>> = self.columns.iter().map(sum).collect();
        let columns = self
            .columns
            .iter()
            .zip(&sums)
            .map(|(sources, sum)| match sum {
                Some(sum) => sum.as_slice(),
                None => sources.first().map_or(&[][..], signal),
            });
        sink(self.kind, self.joint, &columns.collect::<Vec<_>>());
    }
}

/// What the rows of a model measure.
fn measured(kind: ModelKind) -> Content {
    match kind {
        ModelKind::Power => Content::MotorPower,
        ModelKind::Explicit | ModelKind::Implicit => Content::Torque,
    }
}

/// Number of signals.
fn signals(model: &dyn IdentificationModel, content: Content) -> usize {
    match content {
        Content::Regressor(output, _) => model.pattern(output).signals,
        Content::Torque => model.joints().len(),
        Content::MotorPower => 1,
    }
}

/// The blocks of a model, their columns traced to the channels of `contents`.
fn blocks(model: &dyn IdentificationModel, kind: ModelKind, contents: &[Content]) -> Vec<Block> {
    let place = |content: Content| contents.iter().position(|c| *c == content).unwrap_or(0);
    let empty = empty_blocks(model, kind, 0);
    let block = |(joint, equations): (usize, &super::Equations)| {
        let sources = |&column: &usize| {
            let of_term = |term: &(Output, Treatment)| {
                let entries = model.pattern(term.0).entries.iter();
                let channel = place(Content::Regressor(term.0, term.1));
                entries
                    .filter(move |e| e.row == joint && e.column == column)
                    .map(move |e| (channel, e.signal))
                    .collect::<Vec<_>>()
            };
            kind.terms().iter().flat_map(of_term).collect()
        };
        let measurement = vec![(place(measured(kind)), joint)];
        Block {
            kind,
            joint,
            columns: equations
                .columns
                .iter()
                .map(sources)
                .chain([measurement])
                .collect(),
        }
    };
    empty.iter().enumerate().map(block).collect()
}

/// Writes the signals of a channel along a chunk that begins at sample `start` of the motion.
fn fill(
    model: &dyn IdentificationModel,
    content: Content,
    states: &States<'_>,
    motion: &Motion,
    start: usize,
    out: &mut [f64],
) {
    let none = Vec::new();
    let tau = motion.tau.as_ref().unwrap_or(&none);
    match content {
        Content::Regressor(output, _) if !out.is_empty() => model.evaluate(output, states, out),
        Content::Regressor(..) => {}
        Content::Torque => {
            for (out, tau) in out.chunks_mut(states.len).zip(tau) {
                out.copy_from_slice(&tau[start..start + states.len]);
            }
        }
        Content::MotorPower => {
            for (i, out) in out.iter_mut().enumerate() {
                *out = motor_power(tau, &motion.qd, start + i);
            }
        }
    }
}
