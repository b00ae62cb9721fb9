//! Many starts, each downhill; the best of them.

use rayon::prelude::*;

use super::cost::{Cost, Stage};
use super::descent::{Function, descend};
use super::family::Sampled;
use super::feasible;
use super::random::Random;

/// Random motions of which a start is the best.
const DRAWS: usize = 16;

/// Smoothed condition numbers get sharper and limits harder; share of the steps in each.
const STAGES: [(Stage, f64); 3] = [
    (
        Stage {
            sharpness: 2.0,
            penalty: 3.0,
        },
        0.4,
    ),
    (
        Stage {
            sharpness: 5.0,
            penalty: 30.0,
        },
        0.3,
    ),
    (
        Stage {
            sharpness: 12.0,
            penalty: 300.0,
        },
        0.3,
    ),
];

/// How motions are compared in the end: within limits, sharply.
pub(super) const SHARP: Stage = Stage {
    sharpness: 40.0,
    penalty: 0.0,
};

/// Furthest centre from the middle of a joint's range, as a share of half of it.
const CENTER: f64 = 0.95;

/// How much is searched.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    pub seed: u64,
    pub starts: usize,
    pub steps: usize,
}

/// A motion within limits.
pub(super) struct Found {
    pub z: Vec<f64>,
    /// ln of the criterion.
    pub value: f64,
}

/// A cost at a stage, as a function to descend on.
struct At<'a, 'b>(&'a Cost<'b>, Stage);

impl Function for At<'_, '_> {
    fn value(&self, z: &[f64]) -> Option<f64> {
        self.0.value(z, self.1)
    }
    fn slopes(&self, z: &[f64]) -> Option<(f64, Vec<f64>)> {
        self.0.slopes(z, self.1)
    }
}

/// The best motion of all starts; equal for equal seeds on any number of threads. `done` is called
/// after each stage of each start. The error is that of [`feasible::to_efforts`] if no start has a
/// motion, `None` if every W was singular.
pub(super) fn search(
    cost: &Cost<'_>,
    fine: &Sampled,
    effort: Effort,
    done: &(dyn Fn() + Sync),
) -> Result<Found, Option<(usize, f64)>> {
    let from = |place: usize| start(cost, fine, (effort, place), done);
    let all: Vec<_> = (0..effort.starts).into_par_iter().map(from).collect();
    let mut best: Result<Found, Option<(usize, f64)>> = Err(None);
    for found in all {
        best = match (best, found) {
            (Ok(best), Ok(found)) if found.value < best.value => Ok(found),
            (Ok(best), _) => Ok(best),
            (Err(_), Ok(found)) => Ok(found),
            (Err(first), Err(other)) => Err(first.or(other)),
        };
    }
    best
}

/// Stages of a search, for a bar of progress.
pub(super) fn stages(starts: usize) -> usize {
    starts * STAGES.len()
}

/// One start.
fn start(
    cost: &Cost<'_>,
    fine: &Sampled,
    (effort, place): (Effort, usize),
    done: &(dyn Fn() + Sync),
) -> Result<Found, Option<(usize, f64)>> {
    let mut random = Random::new(effort.seed, place as u64);
    let mut z = first(cost, fine, &mut random);
    for (stage, share) in STAGES {
        let steps = (share * effort.steps as f64).round() as usize;
        z = descend(&At(cost, stage), z, steps);
        done();
    }
    settle(cost, fine, z)
}

/// The motion made to keep to all limits.
fn settle(cost: &Cost<'_>, fine: &Sampled, mut z: Vec<f64>) -> Result<Found, Option<(usize, f64)>> {
    for joint in 0..cost.space.limits.len() {
        cost.space.hold_center(&mut z, joint, CENTER);
    }
    feasible::to_limits(cost.space, &mut z, fine, false);
    if let Some(parameters) = cost.parameters {
        feasible::to_efforts(cost.space, &mut z, fine, (&cost.regressor, parameters))
            .map_err(Some)?;
    }
    let value = cost.value(&z, SHARP).ok_or(None)?;
    Ok(Found { z, value })
}

/// The best of some random motions that touch their limits.
fn first(cost: &Cost<'_>, fine: &Sampled, random: &mut Random) -> Vec<f64> {
    let drawn: Vec<Vec<f64>> = (0..DRAWS).map(|_| draw(cost, fine, random)).collect();
    let (stage, _) = STAGES[0];
    let value = |z: &Vec<f64>| cost.value(z, stage).unwrap_or(f64::INFINITY);
    let best = drawn.into_iter().map(|z| (value(&z), z));
    let best = best.min_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or_else(Vec::new, |(_, z)| z)
}

/// A random motion with every joint at its tightest limit.
fn draw(cost: &Cost<'_>, fine: &Sampled, random: &mut Random) -> Vec<f64> {
    let space = cost.space;
    let mut z: Vec<f64> = (0..space.len()).map(|_| random.symmetric()).collect();
    for joint in 0..space.limits.len() {
        space.hold_center(&mut z, joint, 0.5);
    }
    feasible::to_limits(space, &mut z, fine, true);
    z
}

/// ln of the criterion of random motions within limits, the smallest first: what a search is
/// compared to. Those that no effort allows, or with singular W, are left out.
pub(super) fn by_chance(cost: &Cost<'_>, fine: &Sampled, (seed, count): (u64, usize)) -> Vec<f64> {
    let value = |place: usize| {
        // Other streams than those of the starts.
        let mut random = Random::new(seed ^ 0x5eed, place as u64);
        let z = draw(cost, fine, &mut random);
        settle(cost, fine, z).ok().map(|found| found.value)
    };
    let mut values: Vec<f64> = (0..count).into_par_iter().filter_map(value).collect();
    values.sort_by(f64::total_cmp);
    values
}
