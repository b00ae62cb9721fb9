//! That a torque repeats is known once it has repeated: over less than a period, a ripple is one of
//! many torques that depend on the position, and fits most of them (a spring on a crank, a hose).

use std::f64::consts::TAU;

use super::state::Bench;
use super::stepwise::{Named, Outcome};
use crate::model::IdentificationModel;

/// Periods that the motion must pass: a whole one, and a quarter in which it repeats.
const PASSED: f64 = 1.25;

/// An effect that is said to repeat with the position, on a motion that was too short for that.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Unrepeated {
    effect: &'static str,
    joint: usize,
    /// How often it would repeat per turn.
    per_turn: f64,
    /// What the motion passes of the joint's way, rad.
    way: f64,
}

impl Unrepeated {
    /// What is not known, and which motion would tell.
    pub fn sentence(&self, model: &dyn IdentificationModel) -> String {
        format!(
            "The logs pass {:.1} periods of the {} of joint `{}`: until it has repeated, any torque \
             that depends on the position may look like it, so that its name is a hint. Move the \
             joint over {:.2} rad or more ({:.2} so far).",
            periods(self.way, self.per_turn),
            self.effect,
            model.joints()[self.joint].name,
            PASSED * TAU / self.per_turn,
            self.way
        )
    }
}

/// The effects among those found that have not been seen to repeat.
pub(super) fn unrepeated(bench: &Bench<'_>, outcome: &Outcome) -> Vec<Unrepeated> {
    let unrepeated = |named: &Named| {
        let hypothesis = &bench.hypotheses[named.number];
        let per_turn = (bench.catalogue).repeats_per_turn(hypothesis, &named.shape)?;
        let &[joint] = hypothesis.joints.as_slice() else {
            return None;
        };
        let tracks = bench.train.tracks.iter();
        let way = way(tracks.flat_map(|track| &track.motion.q[joint]));
        (periods(way, per_turn) < PASSED).then(|| Unrepeated {
            effect: bench.catalogue.entries()[hypothesis.entry].name,
            joint,
            per_turn,
            way,
        })
    };
    outcome.named.iter().filter_map(unrepeated).collect()
}

/// How much of a period a way is.
fn periods(way: f64, per_turn: f64) -> f64 {
    way * per_turn / TAU
}

/// From the least position to the largest.
fn way<'a>(positions: impl Iterator<Item = &'a f64>) -> f64 {
    let (low, high) = positions.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), q| {
        (low.min(*q), high.max(*q))
    });
    (high - low).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_passes_one_period_of_four_per_turn() {
        let quarter = [0.3, 0.3 - TAU / 8.0, 0.3 + TAU / 8.0];
        assert!((periods(way(quarter.iter()), 4.0) - 1.0).abs() < 1e-15);
        assert_eq!(way([].iter()), 0.0);
    }
}
