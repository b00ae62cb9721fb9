//! Forward, one effect at a time, then back: remove, exchange.

use rayon::prelude::*;

use super::catalogue::EntryKind;
use super::joined::Joined;
use super::linear::chi_square_survival;
use super::screen::{Candidate, Contender};
use super::state::{Asking, Bench, State};
use super::system::Pair;

/// Effects named at most.
const MOST: usize = 5;

/// Contenders looked at closely in each step.
const CLOSELY: usize = 10;

/// Margin below zero at which a contender is still refined.
const NEARLY: f64 = -15.0;

/// Corrected probability by chance below which a contender without a margin may be named, if another
/// motion settles it. The margin allows for noise that is not as the noise model has it; where two
/// motions agree, this is not needed.
const FAINT: f64 = 3e-3;

/// The same before its shape is refined.
const FAINT_COARSELY: f64 = 0.1;

/// Margin by which another effect must be better to take the place of one.
const BETTER: f64 = 5.0;

/// A second explanation, less than this worse, is the name if it is the simpler one.
const AS_GOOD: f64 = 10.0;

/// What is left of an effect's gain beside another that is indistinguishable from it: at most this,
/// or this share of it.
const LEFT: f64 = 20.0;
const LEFT_SHARE: f64 = 0.05;

/// Without another motion to confirm, this much more margin is asked for.
const UNCONFIRMED: f64 = 20.0;

/// A hypothesis that was looked at and not taken.
#[derive(Clone, Debug)]
pub(super) struct Refused {
    pub number: usize,
    pub why: String,
}

/// Another explanation of what an effect explains.
#[derive(Clone, Debug)]
pub(super) struct Rival {
    pub number: usize,
    pub p_value: f64,
    pub separable: bool,
}

/// An effect that was named, beside the state's own record of it.
#[derive(Clone, Debug)]
pub(super) struct Named {
    pub number: usize,
    pub shape: Vec<f64>,
    pub p_value: f64,
    pub rivals: Vec<Rival>,
}

/// How a hypothesis stood in a step.
#[derive(Clone, Debug)]
pub(super) struct Ranked {
    pub step: usize,
    pub number: usize,
    pub gain: f64,
    pub margin: f64,
    pub p_value: f64,
}

/// What the search ends with.
pub(super) struct Outcome {
    pub state: State,
    pub named: Vec<Named>,
    pub refused: Vec<Refused>,
    /// What came nearest in each step, best first.
    pub ranked: Vec<Ranked>,
}

/// The search and what it has found so far.
pub(super) struct Stepwise<'a> {
    pub bench: Bench<'a>,
    /// Logs of another motion, and the motions of their instruments.
    pub confirm: Option<(&'a Joined, &'a Joined)>,
    /// Candidates of static effects, which never change.
    fixed: Vec<Candidate>,
    dependent: Vec<usize>,
    refused: Vec<Refused>,
    ranked: Vec<Ranked>,
}

impl<'a> Stepwise<'a> {
    /// Prepares the search: columns of all static hypotheses.
    pub fn new(bench: Bench<'a>, confirm: Option<(&'a Joined, &'a Joined)>, null: &State) -> Self {
        let all = 0..bench.hypotheses.len();
        let (fixed, dependent): (Vec<usize>, Vec<usize>) =
            all.partition(|number| bench.kind(*number) == EntryKind::Static);
        Stepwise {
            fixed: bench.candidates(&fixed, &bench.asking(&null.predicted)),
            bench,
            confirm,
            dependent,
            refused: Vec::new(),
            ranked: Vec::new(),
        }
    }

    /// Runs it from the null model.
    pub fn run(mut self, null: State) -> Outcome {
        let mut named: Vec<Named> = Vec::new();
        let mut state = null;
        for _ in 0..2 {
            state = self.forward(state, &mut named);
            let changed = self.back(&mut state, &mut named);
            if !changed {
                break;
            }
        }
        let taken: Vec<usize> = named.iter().map(|n| n.number).collect();
        self.refused
            .retain(|refused| !taken.contains(&refused.number));
        let mut seen = Vec::new();
        self.refused.retain(|refused| {
            let new = !seen.contains(&refused.number);
            seen.push(refused.number);
            new
        });
        Outcome {
            state,
            named,
            refused: self.refused,
            ranked: self.ranked,
        }
    }

    fn forward(&mut self, mut state: State, named: &mut Vec<Named>) -> State {
        while named.len() < MOST {
            let asking = self.bench.asking(&state.predicted);
            let ranking = self.ranking(&state, named, &asking);
            let Some((next, found)) = self.choose(ranking, &state, named, &asking) else {
                break;
            };
            drop(asking);
            named.push(found);
            state = next;
        }
        state
    }

    /// All hypotheses that are not named yet, best first.
    fn ranking(&self, state: &State, named: &[Named], asking: &Asking<'_>) -> Vec<Contender> {
        let dependent = self.bench.candidates(&self.dependent, asking);
        let mut candidates: Vec<&Candidate> = self.fixed.iter().chain(&dependent).collect();
        candidates.retain(|candidate| !named.iter().any(|n| n.number == candidate.number));
        self.bench.ranking(&candidates, state, |contender| {
            contender.margin > NEARLY || self.faint(contender, FAINT_COARSELY)
        })
    }

    /// The first contender that nothing speaks against, with those it cannot be told from.
    fn choose(
        &mut self,
        ranking: Vec<Contender>,
        state: &State,
        named: &[Named],
        asking: &Asking<'_>,
    ) -> Option<(State, Named)> {
        let near = ranking.into_par_iter().take(CLOSELY);
        let mut open: Vec<Contender> = near.map(|c| self.bench.refine(c, state, asking)).collect();
        let least = if self.confirm.is_some() {
            0.0
        } else {
            UNCONFIRMED
        };
        open.sort_by(|a, b| b.margin.total_cmp(&a.margin));
        self.rank(&open, named.len());
        open.retain(|contender| contender.margin > least || self.faint(contender, FAINT));
        let (mut plausible, mut refused) = self.plausible(open, least);
        for place in 0..plausible.len() {
            if refused && plausible[place].margin <= least {
                break;
            }
            if let Some(settled) = self.settled(&plausible[place].candidate, state, named) {
                plausible[place] = settled;
            }
            let next = match self.confirmed(&plausible[place], state, named) {
                Ok(next) => next,
                Err(why) => {
                    refused |= plausible[place].margin > least;
                    self.refuse(plausible[place].candidate.number, why);
                    continue;
                }
            };
            let best = plausible.swap_remove(place);
            let (best, next, rivals) = self.simplest(best, next, plausible, state, named);
            let found = Named {
                number: best.candidate.number,
                shape: best.candidate.shape.clone(),
                p_value: self.p_value(&best),
                rivals,
            };
            return Some((next, found));
        }
        None
    }

    /// Contenders of plausible sign and size, and whether one with a margin was refused. Where a clear
    /// explanation is refused, what is left of the gap makes faint ones look true.
    fn plausible(&mut self, open: Vec<Contender>, least: f64) -> (Vec<Contender>, bool) {
        let mut plausible = Vec::new();
        let mut refused = false;
        for contender in open {
            match self.implausible(&contender) {
                Some(why) => {
                    refused |= contender.margin > least;
                    self.refuse(contender.candidate.number, why);
                }
                None => plausible.push(contender),
            }
        }
        (plausible, refused)
    }

    /// Notes what came nearest in a step; a step that is gone through again is noted anew.
    fn rank(&mut self, contenders: &[Contender], step: usize) {
        self.ranked.retain(|ranked| ranked.step < step);
        let noted = contenders.iter().map(|contender| Ranked {
            step,
            number: contender.candidate.number,
            gain: contender.gain.square,
            margin: contender.margin,
            p_value: self.p_value(contender),
        });
        let noted: Vec<Ranked> = noted.collect();
        self.ranked.extend(noted);
    }

    fn refuse(&mut self, number: usize, why: String) {
        self.refused.push(Refused { number, why });
    }

    fn implausible(&self, contender: &Contender) -> Option<String> {
        let Candidate { number, shape, .. } = &contender.candidate;
        let values: Vec<f64> = contender
            .gain
            .values
            .iter()
            .map(|v| v.unwrap_or(0.0))
            .collect();
        let hypothesis = &self.bench.hypotheses[*number];
        if values
            .first()
            .is_some_and(|value| value.abs() < hypothesis.least)
        {
            return Some("it is smaller than what the log itself leaves open".to_owned());
        }
        self.bench.catalogue.implausible(hypothesis, shape, &values)
    }

    /// Whether chance alone hardly gains as much, where another motion can settle the rest. Effects
    /// with a memory and links that yield are made of the noise of the measured motion, too, which
    /// chance does not know.
    fn faint(&self, contender: &Contender, likely: f64) -> bool {
        let kind = self.bench.kind(contender.candidate.number);
        !matches!(kind, EntryKind::Memory | EntryKind::Yielding)
            && self.confirm.is_some()
            && self.p_value(contender) < likely
    }

    /// Probability that chance gains as much, corrected for the number of hypotheses tried.
    fn p_value(&self, contender: &Contender) -> f64 {
        self.by_chance(contender.gain.square, contender.freedom)
    }

    /// The same of any gain.
    pub(super) fn by_chance(&self, gain: f64, freedom: usize) -> f64 {
        let tried = self.bench.hypotheses.len() as f64;
        (tried * chi_square_survival(gain, freedom)).min(1.0)
    }

    /// Of the explanations that cannot be told from the best, the simplest; and its rivals.
    fn simplest(
        &self,
        best: Contender,
        next: State,
        others: Vec<Contender>,
        state: &State,
        named: &[Named],
    ) -> (Contender, State, Vec<Rival>) {
        let (same, apart): (Vec<Contender>, Vec<Contender>) = others
            .into_iter()
            .partition(|other| self.same(&best, other, state));
        let simpler = same
            .iter()
            .find(|other| other.freedom < best.freedom && other.margin > best.margin - AS_GOOD);
        let simpler = simpler.and_then(|other| {
            let next = self.confirmed(other, state, named).ok()?;
            Some((other.clone(), next))
        });
        let swapped = simpler.is_some();
        let (first, next) = simpler.unwrap_or((best.clone(), next));
        let rival = |contender: &Contender, separable: bool| Rival {
            number: contender.candidate.number,
            p_value: self.p_value(contender),
            separable,
        };
        let mut rivals = Vec::new();
        if swapped {
            rivals.push(rival(&best, false));
        }
        let others = same
            .iter()
            .filter(|c| c.candidate.number != first.candidate.number);
        rivals.extend(others.map(|contender| rival(contender, false)));
        rivals.extend(apart.iter().take(2).map(|contender| rival(contender, true)));
        (first, next, rivals)
    }

    /// Whether hardly anything is left of one explanation once another is in the model.
    fn same(&self, one: &Contender, other: &Contender, state: &State) -> bool {
        let columns = other.candidate.columns.iter();
        let pairs: Vec<Pair> = columns.map(|z| (z.clone(), z.clone())).collect();
        let with = state.system.with(&pairs);
        let left = self.bench.contend(one.candidate.clone(), &with).gain.square;
        left < LEFT.max(LEFT_SHARE * one.gain.square)
    }

    /// Tries to remove each effect, and to exchange it for another; whether anything changed.
    fn back(&mut self, state: &mut State, named: &mut Vec<Named>) -> bool {
        if named.len() < 2 {
            return false;
        }
        let mut changed = false;
        for place in (0..named.len()).rev() {
            let mut others = named.clone();
            let own = others.remove(place);
            let chosen: Vec<(usize, Vec<f64>)> =
                others.iter().map(|n| (n.number, n.shape.clone())).collect();
            let without = self.bench.settle(&chosen, &state.predicted);
            let asking = self.bench.asking(&without.predicted);
            let ranking = self.ranking(&without, &others, &asking);
            let stands = ranking
                .iter()
                .find(|c| c.candidate.number == own.number)
                .map(|c| self.bench.refine(c.clone(), &without, &asking))
                .filter(|c| c.margin > 0.0 || self.faint(c, FAINT));
            let Some(stands) = stands else {
                drop(asking);
                self.refuse(
                    own.number,
                    "beside the other effects nothing is left of it".into(),
                );
                (*state, *named, changed) = (without, others, true);
                continue;
            };
            let better = ranking.first().is_some_and(|c| {
                c.candidate.number != own.number && c.margin > stands.margin.max(0.0) + BETTER
            });
            if !better {
                continue;
            }
            // What came nearest is that of the search forward.
            let noted = std::mem::take(&mut self.ranked);
            let chosen = self.choose(ranking, &without, &others, &asking);
            self.ranked = noted;
            let Some((next, found)) = chosen.filter(|(_, found)| found.number != own.number) else {
                continue;
            };
            self.refuse(own.number, "another effect explains the same better".into());
            others.insert(place.min(others.len()), found);
            // The order of the effects is that of the states' columns.
            let chosen: Vec<(usize, Vec<f64>)> =
                others.iter().map(|n| (n.number, n.shape.clone())).collect();
            *state = self.bench.settle(&chosen, &next.predicted);
            (*named, changed) = (others, true);
        }
        changed
    }
}
