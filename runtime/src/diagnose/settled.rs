//! Shapes of effects of the model's own torque.
//!
//! A drive that saturates bends the parameters that are fitted without it, and with them the torque
//! that the level is looked for in: the best level in the bent torque is another one. Each shape is
//! therefore judged with the parameters that belong to it.

use super::catalogue::EntryKind;
use super::linear::dot;
use super::screen::{Candidate, Contender, searched};
use super::shape::{largest, neighbours};
use super::state::State;
use super::stepwise::{Named, Stepwise};

/// Turns of parameters and torque for each shape at most, and the share of what is left below which
/// nothing moves any more.
const TURNS: usize = 4;
const RESTED: f64 = 1e-3;

/// A shape with the parameters that belong to it.
struct Settled {
    shape: Vec<f64>,
    state: State,
    /// What is left of the whitened rows, squared.
    left: f64,
}

impl Stepwise<'_> {
    /// A candidate with the shape that leaves least once everything is fitted with it; `None` where
    /// that is nothing new.
    pub(super) fn settled(
        &self,
        candidate: &Candidate,
        state: &State,
        named: &[Named],
    ) -> Option<Contender> {
        let number = candidate.number;
        let hypothesis = &self.bench.hypotheses[number];
        let &[place] = &searched(&hypothesis.grid)[..] else {
            return None;
        };
        if self.bench.kind(number) != EntryKind::ModelDependent {
            return None;
        }
        neighbours(hypothesis, place, candidate.shape[place])?;
        let at = |shape: Vec<f64>| self.with_shape((number, shape), state, named);
        let all = hypothesis.grid.iter().cloned().map(at);
        let best = all.min_by(|a, b| a.left.total_cmp(&b.left))?;
        let ends = neighbours(hypothesis, place, best.shape[place])?;
        let between = |x: f64| {
            let mut shape = best.shape.clone();
            shape[place] = x;
            Some(at(shape))
        };
        let found = largest(ends, between, |settled| -settled.left)?;
        let found = if found.left < best.left { found } else { best };
        let asking = self.bench.asking(&found.state.predicted);
        let made = self.bench.candidates_at(number, &[found.shape], &asking);
        let candidate = made.into_iter().next()?;
        Some(self.bench.contend(candidate, &state.system))
    }

    fn with_shape(
        &self,
        (number, shape): (usize, Vec<f64>),
        before: &State,
        named: &[Named],
    ) -> Settled {
        let mut chosen: Vec<(usize, Vec<f64>)> =
            named.iter().map(|n| (n.number, n.shape.clone())).collect();
        chosen.push((number, shape.clone()));
        let mut state = self.bench.settle(&chosen, &before.predicted);
        let mut left = self.left(&state);
        for _ in 0..TURNS {
            let next = self.bench.settle(&chosen, &state.predicted);
            let change = left - self.left(&next);
            (state, left) = (next, left - change);
            if change.abs() < RESTED * left {
                break;
            }
        }
        Settled { shape, state, left }
    }

    /// What is left of the whitened rows, squared.
    fn left(&self, state: &State) -> f64 {
        let of_joint = |joint: usize| {
            let residual = state.system.residual(joint);
            dot(residual, residual)
        };
        (0..self.bench.train.joints()).map(of_joint).sum()
    }
}
