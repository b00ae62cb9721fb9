//! The shapes of hypotheses: searched between the places of their grids.

use super::catalogue::Hypothesis;
use super::screen::{Contender, searched};
use super::state::{Asking, Bench, State};

/// Evaluations of a shape's refinement in each direction.
const EVALUATIONS: usize = 7;

/// Share of the way to its neighbours within which a shape is searched once more.
const CLOSER: f64 = 0.2;

/// The scale that a shape is searched on.
#[derive(Clone, Copy, Debug)]
enum Scale {
    Linear,
    Logarithmic,
}

impl Scale {
    /// Logarithmic between values that are factors apart.
    fn of((low, high): (f64, f64)) -> Scale {
        match low > 0.0 && high / low > 1.5 {
            true => Scale::Logarithmic,
            false => Scale::Linear,
        }
    }

    fn forth(self, x: f64) -> f64 {
        match self {
            Scale::Linear => x,
            Scale::Logarithmic => x.ln(),
        }
    }

    fn back(self, x: f64) -> f64 {
        match self {
            Scale::Linear => x,
            Scale::Logarithmic => x.exp(),
        }
    }

    /// The ends, on the scale, and drawn in by a share towards a value between them.
    fn closer(self, (low, high): (f64, f64), around: f64, share: f64) -> (f64, f64) {
        let middle = self.forth(around);
        let towards = |end: f64| middle + share * (self.forth(end) - middle);
        (towards(low), towards(high))
    }
}

impl Bench<'_> {
    /// Improves the shape of a contender between the neighbours on its grid.
    pub fn refine(&self, contender: Contender, state: &State, asking: &Asking<'_>) -> Contender {
        let mut best = contender;
        let hypothesis = &self.hypotheses[best.candidate.number];
        let places = searched(&hypothesis.grid);
        // Shapes that depend on each other are gone through once more, closer.
        let rounds = if places.len() > 1 { 2 } else { 1 };
        for (round, place) in (0..rounds).flat_map(|r| places.iter().map(move |p| (r, *p))) {
            let around = best.candidate.shape[place];
            let Some(ends) = neighbours(hypothesis, place, around) else {
                continue;
            };
            let scale = Scale::of(ends);
            let ends = scale.closer(ends, around, CLOSER.powi(round));
            let shape = best.candidate.shape.clone();
            let at = |x: f64| {
                let mut shape = shape.clone();
                shape[place] = scale.back(x);
                let made = self.candidates_at(best.candidate.number, &[shape], asking);
                made.into_iter()
                    .next()
                    .map(|candidate| self.contend(candidate, &state.system))
            };
            let found = golden(ends, at);
            if let Some(found) = found.filter(|found| found.gain.square > best.gain.square) {
                best = found;
            }
        }
        best
    }
}

/// The values of a shape's place around `value` on the grid; `None` for whole numbers, which are
/// counts and sides.
pub(super) fn neighbours(hypothesis: &Hypothesis, place: usize, value: f64) -> Option<(f64, f64)> {
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
fn golden(ends: (f64, f64), at: impl Fn(f64) -> Option<Contender>) -> Option<Contender> {
    largest(ends, at, |contender| contender.gain.square)
}

/// Golden-section search for what is worth most between two ends.
pub(super) fn largest<T>(
    (mut low, mut high): (f64, f64),
    at: impl Fn(f64) -> Option<T>,
    worth: impl Fn(&T) -> f64,
) -> Option<T> {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let mut left = high - ratio * (high - low);
    let mut right = low + ratio * (high - low);
    let (mut at_left, mut at_right) = (at(left)?, at(right)?);
    for _ in 0..EVALUATIONS {
        if worth(&at_left) > worth(&at_right) {
            (high, right) = (right, left);
            left = high - ratio * (high - low);
            at_right = std::mem::replace(&mut at_left, at(left)?);
        } else {
            (low, left) = (left, right);
            right = low + ratio * (high - low);
            at_left = std::mem::replace(&mut at_right, at(right)?);
        }
    }
    Some(if worth(&at_left) > worth(&at_right) {
        at_left
    } else {
        at_right
    })
}
