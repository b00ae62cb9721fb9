//! Every hypothesis with every shape of its grid as more columns, and what it would gain.

use rayon::prelude::*;

use super::catalogue::EntryKind;
use super::joined::Joined;
use super::state::{Asking, Bench, State};
use super::system::{Gain, Sparse, System};
use super::track::Decimated;

/// What each of the first degrees of freedom costs, how many those are, and what each further one
/// costs: of ten parameters of a body most follow from its mass and where it is, and what chance
/// gains with ten columns is far less than ten times what it gains with one.
const PENALTY: f64 = 10.0;
const FIRST: usize = 4;
const FURTHER: f64 = 3.0;

fn penalty(freedom: usize) -> f64 {
    PENALTY * freedom.min(FIRST) as f64 + FURTHER * freedom.saturating_sub(FIRST) as f64
}

/// Gain beyond the penalty that static, friction-like effects never reach by chance, and that
/// others never reach, which the loop can imitate (reference: simulation of the null for a few
/// hundred candidates).
const PLAIN: f64 = 25.0;
const THROUGH_THE_LOOP: f64 = 30.0;

/// Gain along the instruments, with the shape found along the measured motion, that an effect must
/// have which only the measured motion shows.
const SEEN: f64 = 16.0;

/// A hypothesis with one shape.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub number: usize,
    pub shape: Vec<f64>,
    /// Its columns along the motion of the instruments, or of the log where only that shows it.
    pub columns: Vec<Sparse>,
    /// Shares of the null model's basis in them.
    known: Vec<Vec<f64>>,
    /// The first of its columns along the instruments, where the others are not, and its shares.
    beside: Option<(Sparse, Vec<f64>)>,
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
    pub fn candidates(&self, numbers: &[usize], asking: &Asking<'_>) -> Vec<Candidate> {
        let of_hypothesis = |&number: &usize| -> Vec<Candidate> {
            let grid = &self.hypotheses[number].grid;
            self.candidates_at(number, grid, asking)
        };
        numbers.par_iter().flat_map_iter(of_hypothesis).collect()
    }

    /// The same for given shapes of one.
    pub fn candidates_at(
        &self,
        number: usize,
        shapes: &[Vec<f64>],
        asking: &Asking<'_>,
    ) -> Vec<Candidate> {
        let made = self.instruments_of(number, shapes, asking);
        let beside = self.beside_measured(number, shapes, asking);
        let white = |column: &Decimated| self.train.whiten(&column.torque, self.noise);
        let columns: Vec<Vec<Sparse>> =
            made.iter().map(|c| c.iter().map(white).collect()).collect();
        let beside: Vec<Sparse> = beside.iter().filter_map(|c| c.first().map(white)).collect();
        let all: Vec<&Sparse> = columns.iter().flatten().chain(&beside).collect();
        let mut known = self.null.shares_of(&all);
        let own = all.len() - beside.len();
        let mut beside = beside.into_iter().zip(known.split_off(own));
        let mut known = known.into_iter();
        let candidates = shapes.iter().zip(columns);
        candidates
            .map(|(shape, columns)| Candidate {
                number,
                shape: shape.clone(),
                known: known.by_ref().take(columns.len()).collect(),
                columns,
                beside: beside.next(),
            })
            .collect()
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
            EntryKind::ModelDependent | EntryKind::Memory | EntryKind::Yielding => THROUGH_THE_LOOP,
            _ if entry.hidden_by_parameters => THROUGH_THE_LOOP,
            _ => PLAIN,
        };
        let penalty = penalty(freedom);
        let margin = gain.square - penalty - threshold;
        // Noise in the measured motion looks like a link that yields: some of the gain must be there
        // without it.
        let beside = candidate.beside.as_ref().map(|(column, shares)| {
            let alone = system.gain(std::slice::from_ref(column), std::slice::from_ref(shares));
            let same = gain.values.first().zip(alone.values.first());
            match same {
                Some((Some(a), Some(b))) if a * b > 0.0 => alone.square - SEEN,
                _ => f64::NEG_INFINITY,
            }
        });
        let margin = beside.map_or(margin, |beside| margin.min(beside));
        (gain, freedom, margin)
    }

    /// The best shape of every hypothesis that is worth a closer look, best hypothesis first.
    pub fn ranking(
        &self,
        candidates: &[&Candidate],
        state: &State,
        worth: impl Fn(&Contender) -> bool,
    ) -> Vec<Contender> {
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
        best.retain(|&k| gains[k].0.columns() > 0);
        let contender = |k: usize| {
            let (gain, freedom, margin) = gains[k].clone();
            Contender {
                candidate: candidates[k].clone(),
                gain,
                freedom,
                margin,
            }
        };
        let mut best: Vec<Contender> = best.into_iter().map(contender).filter(worth).collect();
        best.sort_by(|a, b| b.margin.total_cmp(&a.margin));
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
pub(super) fn searched(grid: &[Vec<f64>]) -> Vec<usize> {
    let Some(first) = grid.first() else {
        return Vec::new();
    };
    let varies = |place: &usize| grid.iter().any(|shape| shape[*place] != first[*place]);
    (0..first.len()).filter(varies).collect()
}
