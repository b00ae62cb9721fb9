//! Every hypothesis with every shape of its grid as more columns, and what it would gain.

use rayon::prelude::*;

use super::catalogue::{ColumnsAlong, EntryKind};
use super::joined::Joined;
use super::state::{Bench, State};
use super::system::{Gain, Sparse, System};

/// What every degree of freedom costs.
pub(super) const PENALTY: f64 = 10.0;

/// Gain beyond the penalty that static, friction-like effects never reach by chance, and that
/// others never reach, which the loop can imitate (reference: simulation of the null for a few
/// hundred candidates).
const PLAIN: f64 = 25.0;
const THROUGH_THE_LOOP: f64 = 30.0;

/// Evaluations of a shape's refinement in each direction.
const EVALUATIONS: usize = 7;

/// A shape to the scale that it is searched on, or back.
type Map = fn(f64) -> f64;

/// A hypothesis with one shape.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub number: usize,
    pub shape: Vec<f64>,
    /// Its columns along the motion of the instruments.
    pub columns: Vec<Sparse>,
    /// Shares of the null model's basis in them.
    known: Vec<Vec<f64>>,
}

/// What a candidate gains in a state.
#[derive(Clone, Debug)]
pub(super) struct Contender {
    pub candidate: Candidate,
    pub gain: Gain,
    /// Degrees of freedom: columns and shapes searched.
    pub freedom: usize,
    /// Gain less the penalty and the threshold of its family.
    pub margin: f64,
}

impl Bench<'_> {
    /// Columns of hypotheses over their grids.
    pub fn candidates(&self, numbers: &[usize], along: &[ColumnsAlong<'_>]) -> Vec<Candidate> {
        let of_hypothesis = |&number: &usize| -> Vec<Candidate> {
            let grid = &self.hypotheses[number].grid;
            self.candidates_at(number, grid, along)
        };
        numbers.par_iter().flat_map_iter(of_hypothesis).collect()
    }

    fn candidates_at(
        &self,
        number: usize,
        shapes: &[Vec<f64>],
        along: &[ColumnsAlong<'_>],
    ) -> Vec<Candidate> {
        let made = self
            .instruments
            .columns(along, &self.hypotheses[number], shapes);
        let candidate = |(shape, columns): (&Vec<f64>, Vec<super::track::Decimated>)| {
            let white =
                |column: &super::track::Decimated| self.train.whiten(&column.torque, self.noise);
            let columns: Vec<Sparse> = columns.iter().map(white).collect();
            let known = columns.iter().map(|column| self.null.shares(column, 0));
            Candidate {
                number,
                shape: shape.clone(),
                known: known.collect(),
                columns,
            }
        };
        shapes.iter().zip(made).map(candidate).collect()
    }

    /// What a candidate gains in a system that grew from the null model.
    pub fn contend(&self, candidate: Candidate, system: &System) -> Contender {
        let (gain, freedom, margin) = self.gain(&candidate, system);
        Contender {
            candidate,
            gain,
            freedom,
            margin,
        }
    }

    /// Gain, degrees of freedom, margin.
    fn gain(&self, candidate: &Candidate, system: &System) -> (Gain, usize, f64) {
        let gain = system.gain(&candidate.columns, &candidate.known);
        let freedom = gain.columns() + searched(&self.hypotheses[candidate.number].grid).len();
        let entry = &self.catalogue.entries()[self.hypotheses[candidate.number].entry];
        let threshold = match entry.kind {
            EntryKind::ModelDependent | EntryKind::Memory => THROUGH_THE_LOOP,
            _ if entry.hidden_by_parameters => THROUGH_THE_LOOP,
            _ => PLAIN,
        };
        let margin = gain.square - PENALTY * freedom as f64 - threshold;
        (gain, freedom, margin)
    }

    /// The best shape of every hypothesis with a margin above `least`, best hypothesis first.
    pub fn ranking(&self, candidates: &[&Candidate], state: &State, least: f64) -> Vec<Contender> {
        let gains = candidates.par_iter().map(|c| self.gain(c, &state.system));
        let gains: Vec<(Gain, usize, f64)> = gains.collect();
        let mut best: Vec<usize> = Vec::new();
        for (k, candidate) in candidates.iter().enumerate() {
            match best.last_mut() {
                Some(last) if candidates[*last].number == candidate.number => {
                    if gains[k].0.square > gains[*last].0.square {
                        *last = k;
                    }
                }
                _ => best.push(k),
            }
        }
        best.retain(|&k| gains[k].0.columns() > 0 && gains[k].2 > least);
        best.sort_by(|a, b| gains[*b].2.total_cmp(&gains[*a].2));
        let contender = |k: usize| {
            let (gain, freedom, margin) = gains[k].clone();
            Contender {
                candidate: candidates[k].clone(),
                gain,
                freedom,
                margin,
            }
        };
        best.into_iter().map(contender).collect()
    }

    /// Improves the shape of a contender between the neighbours on its grid.
    pub fn refine(
        &self,
        contender: Contender,
        state: &State,
        along: &[ColumnsAlong<'_>],
    ) -> Contender {
        let mut best = contender;
        let hypothesis = &self.hypotheses[best.candidate.number];
        for place in searched(&hypothesis.grid) {
            let Some((low, high)) = neighbours(hypothesis, place, best.candidate.shape[place])
            else {
                continue;
            };
            let logarithmic = low > 0.0 && high / low > 1.5;
            let (forth, back): (Map, Map) = if logarithmic {
                (f64::ln, f64::exp)
            } else {
                (|x| x, |x| x)
            };
            let shape = best.candidate.shape.clone();
            let at = |x: f64| {
                let mut shape = shape.clone();
                shape[place] = back(x);
                let made = self.candidates_at(best.candidate.number, &[shape], along);
                made.into_iter()
                    .next()
                    .map(|candidate| self.contend(candidate, &state.system))
            };
            let found = golden((forth(low), forth(high)), at);
            if let Some(found) = found.filter(|found| found.gain.square > best.gain.square) {
                best = found;
            }
        }
        best
    }

    /// Whitened difference of two predictions along logs, summed: its product with a residual, and
    /// its own square.
    pub fn difference(
        &self,
        joined: &Joined,
        (before, after): (&[Vec<f64>], &[Vec<f64>]),
    ) -> (f64, f64) {
        let (mut along, mut square) = (0.0, 0.0);
        for joint in 0..joined.joints() {
            let pairs = |a: &[f64], b: &[f64]| -> Vec<f64> {
                a.iter().zip(b).map(|(a, b)| a - b).collect()
            };
            let left = pairs(&joined.measured(joint), &before[joint]);
            let change = pairs(&after[joint], &before[joint]);
            let left = joined.whiten(&[(joint, left)], self.noise);
            let change = joined.whiten(&[(joint, change)], self.noise);
            along += left.dot(&change);
            square += change.dot(&change);
        }
        (along, square)
    }
}

/// Places of a shape that the grid varies.
fn searched(grid: &[Vec<f64>]) -> Vec<usize> {
    let Some(first) = grid.first() else {
        return Vec::new();
    };
    let varies = |place: &usize| grid.iter().any(|shape| shape[*place] != first[*place]);
    (0..first.len()).filter(varies).collect()
}

/// The values of a shape's place around `value` on the grid; `None` for whole numbers, which are
/// counts and sides.
fn neighbours(hypothesis: &super::Hypothesis, place: usize, value: f64) -> Option<(f64, f64)> {
    let values = || hypothesis.grid.iter().map(|shape| shape[place]);
    if values().all(|value| value == value.round()) {
        return None;
    }
    let bounds = hypothesis
        .bounds
        .get(place)
        .cloned()
        .unwrap_or(value..value);
    if bounds.start >= bounds.end {
        return None;
    }
    let below = values()
        .filter(|v| *v < value)
        .fold(f64::NEG_INFINITY, f64::max);
    let above = values()
        .filter(|v| *v > value)
        .fold(f64::INFINITY, f64::min);
    let low = if below.is_finite() {
        below
    } else {
        bounds.start.min(value)
    };
    let high = if above.is_finite() {
        above
    } else {
        bounds.end.max(value)
    };
    (high > low).then_some((low, high))
}

/// Golden-section search for the largest gain.
fn golden(
    (mut low, mut high): (f64, f64),
    at: impl Fn(f64) -> Option<Contender>,
) -> Option<Contender> {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let mut left = high - ratio * (high - low);
    let mut right = low + ratio * (high - low);
    let (mut at_left, mut at_right) = (at(left)?, at(right)?);
    for _ in 0..EVALUATIONS {
        if at_left.gain.square > at_right.gain.square {
            (high, right) = (right, left);
            left = high - ratio * (high - low);
            at_right = std::mem::replace(&mut at_left, at(left)?);
        } else {
            (low, left) = (left, right);
            right = low + ratio * (high - low);
            at_left = std::mem::replace(&mut at_right, at(right)?);
        }
    }
    Some(if at_left.gain.square > at_right.gain.square {
        at_left
    } else {
        at_right
    })
}
