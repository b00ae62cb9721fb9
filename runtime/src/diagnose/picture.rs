//! What a page draws of a diagnosis: torque before and after, and the residual over the variable
//! that explains it.

use std::ops::Range;

use super::joined::Joined;
use super::linear::add_scaled;
use super::state::{Bench, Effect, State};
use super::track::{Predicted, Track};
use crate::model::JointKind;
use crate::report::{GapCurves, Pictures, Signature};
use crate::signal::central_difference;

/// Points of a residual over a variable.
const DOTS: usize = 1500;

/// Steps of a variable within which a torque that depends on it alone is nearly constant.
const STEPS: usize = 40;

/// Steps of time: every torque is nearly constant for a moment, and what changes with time as such
/// changes over the whole log.
const TIME_STEPS: usize = 6;

/// Share of an effect's torque that a variable must explain to be drawn; else it is the effect's
/// own torque.
const EXPLAINED: f64 = 0.75;

/// A variable along the rows of some logs.
pub(super) struct Variable {
    pub name: String,
    pub unit: String,
    pub values: Vec<f64>,
    steps: usize,
}

impl Variable {
    /// One of no unit.
    #[cfg(test)]
    pub fn new(name: &str, values: Vec<f64>) -> Variable {
        Variable {
            name: name.to_owned(),
            unit: String::new(),
            values,
            steps: STEPS,
        }
    }

    /// Whether a torque may jump where it changes its sign.
    pub fn turns(&self) -> bool {
        self.name.starts_with("velocity") || self.name.starts_with("load against")
    }
}

/// What to draw: the places of the effects as they are listed, the joints that are not explained.
pub(super) struct Drawn<'a> {
    pub order: &'a [usize],
    pub lacking: &'a [usize],
}

/// The pictures of a search's outcome along the logs that prove it.
pub(super) fn pictures(
    bench: &Bench<'_>,
    (before, after): (&State, &State),
    drawn: &Drawn<'_>,
    on: &Joined,
) -> Pictures {
    let [old, new] = [before, after].map(|state| residuals(bench, state, on));
    let named = drawn.order.iter().enumerate();
    let mut signatures: Vec<Signature> = named
        .map(|(k, &place)| Signature {
            effect: Some(k),
            ..of_effect(bench, after, place, &new, on)
        })
        .collect();
    let left = drawn.lacking.iter();
    signatures.extend(left.map(|&joint| unexplained(bench, after, joint, &new, on)));
    Pictures {
        signatures,
        torque: torque(bench, (&old, &new), on),
        motion: Vec::new(),
    }
}

/// Measured minus predicted torque of each joint.
pub(super) fn residuals(bench: &Bench<'_>, state: &State, on: &Joined) -> Vec<Vec<f64>> {
    let mut rows = bench.rows(state, on);
    for (joint, predicted) in rows.iter_mut().enumerate() {
        let measured = on.measured(joint);
        predicted
            .iter_mut()
            .zip(measured)
            .for_each(|(p, y)| *p = y - *p);
    }
    rows
}

/// The residual of a joint that nothing explains.
fn unexplained(
    bench: &Bench<'_>,
    state: &State,
    joint: usize,
    residual: &[Vec<f64>],
    on: &Joined,
) -> Signature {
    let train = residuals(bench, state, bench.train);
    let all = variables(bench, state, joint, bench.train);
    let best = best(&all, &train[joint], &bench.train.weights[joint]);
    let shown = &variables(bench, state, joint, on)[best.map_or(0, |(k, _)| k)];
    signature(bench, (joint, shown), (&residual[joint], &[]), on)
}

/// The residual with and without an effect, on the joint where its torque is largest.
fn of_effect(
    bench: &Bench<'_>,
    state: &State,
    place: usize,
    after: &[Vec<f64>],
    on: &Joined,
) -> Signature {
    let own = &state.effects[place];
    let train = bench.train;
    let torque = own_torque(bench, state, own, train);
    let size = |joint: usize| weighted_square(&torque[joint], &train.weights[joint]);
    let largest = (0..torque.len()).max_by(|a, b| size(*a).total_cmp(&size(*b)));
    let joint = largest.unwrap_or(0);
    let others = state.effects.iter().filter(|e| e.number != own.number);
    let others: Vec<(usize, Vec<f64>)> = others.map(|e| (e.number, e.shape.clone())).collect();
    let before = residuals(bench, &bench.settle(&others, &state.predicted), on);
    let joints = &bench.hypotheses[own.number].joints;
    let others = joints.iter().copied().filter(|other| *other != joint);
    let joints: Vec<usize> = [joint].into_iter().chain(others).collect();
    let along = |logs: &Joined| -> Vec<Variable> {
        let all = joints.iter().map(|&j| variables(bench, state, j, logs));
        all.flatten().collect()
    };
    let best = best(&along(train), &torque[joint], &train.weights[joint]);
    let clear = best.filter(|(_, share)| *share > EXPLAINED);
    let shown = clear.and_then(|(k, _)| along(on).into_iter().nth(k));
    let shown = shown.unwrap_or_else(|| Variable {
        name: "torque of the effect".to_owned(),
        unit: unit(bench, joint).to_owned(),
        values: own_torque(bench, state, own, on).swap_remove(joint),
        steps: STEPS,
    });
    let residual = (before[joint].as_slice(), after[joint].as_slice());
    signature(bench, (joint, &shown), residual, on)
}

/// The torque of an effect on each joint.
fn own_torque(bench: &Bench<'_>, state: &State, effect: &Effect, on: &Joined) -> Vec<Vec<f64>> {
    let predicted = bench.predicted(on, &state.parameters, &state.effects);
    let along = on.along(bench.catalogue, &predicted);
    let shapes = std::slice::from_ref(&effect.shape);
    let made = on.columns(&along, &bench.hypotheses[effect.number], shapes);
    let mut all = vec![vec![0.0; on.rows()]; on.joints()];
    for (column, value) in made.iter().flatten().zip(&effect.values) {
        for (joint, torque) in &column.torque {
            add_scaled(&mut all[*joint], *value, torque);
        }
    }
    all
}

/// What a torque of a joint may depend on: names and units, of which `{}` is that of a length and
/// `{F}` that of a force.
const KINDS: [(&str, &str); 7] = [
    ("velocity", "{}/s"),
    ("position", "{}"),
    ("load", "{F}"),
    ("load against the motion", "{F}"),
    ("acceleration", "{}/s^2"),
    ("torque rate", "{F}/s"),
    ("time", "s"),
];

/// The variables of a joint along the rows of logs.
pub(super) fn variables(
    bench: &Bench<'_>,
    state: &State,
    joint: usize,
    on: &Joined,
) -> Vec<Variable> {
    let predicted = bench.predicted(on, &state.parameters, &state.effects);
    let about = &bench.model.joints()[joint];
    let length = match about.kind {
        JointKind::Revolute => "rad",
        JointKind::Prismatic => "m",
    };
    let of_kind = |(what, unit): &(&str, &str)| {
        let tracks = on.tracks.iter().zip(&predicted);
        let values = tracks.flat_map(|(track, p)| track.at_rows(&series(what, track, p, joint)));
        Variable {
            name: match *what {
                "time" => "time".to_owned(),
                what => format!("{what} of {}", about.name),
            },
            unit: unit
                .replace("{}", length)
                .replace("{F}", self::unit(bench, joint)),
            values: values.collect(),
            steps: if *what == "time" { TIME_STEPS } else { STEPS },
        }
    };
    KINDS.iter().map(of_kind).collect()
}

/// A variable of [`KINDS`] at the full rate.
fn series(what: &str, track: &Track, predicted: &Predicted, joint: usize) -> Vec<f64> {
    let signals = track.signals(predicted);
    let load = &signals.tau_rigid[joint];
    match what {
        "velocity" => signals.qd[joint].clone(),
        "position" => signals.q[joint].clone(),
        "load" => load.clone(),
        "load against the motion" => {
            let pairs = load.iter().zip(&signals.qd[joint]);
            pairs.map(|(load, qd)| load.abs() * qd.signum()).collect()
        }
        "acceleration" => signals.qdd[joint].clone(),
        "torque rate" => central_difference(&signals.tau_model[joint], signals.rate_hz),
        _ => signals.t.to_vec(),
    }
}

/// The variable that explains most of a torque, and its share. One that comes later must explain
/// clearly more.
fn best(variables: &[Variable], torque: &[f64], weights: &[f64]) -> Option<(usize, f64)> {
    let mut best: Option<(usize, f64)> = None;
    for (k, variable) in variables.iter().enumerate() {
        let share = explained((&variable.values, variable.steps), torque, weights);
        if best.is_none_or(|(_, most)| share > most + 0.02) {
            best = Some((k, share));
        }
    }
    best
}

/// Share of the variance of `y` that lies between `count` steps of `x`, less what chance puts
/// there. Steps hold equally many values and none on both sides of zero, where signs change.
fn explained((x, count): (&[f64], usize), y: &[f64], weights: &[f64]) -> f64 {
    let mut counted: Vec<usize> = (0..y.len()).filter(|&i| weights[i] > 0.0).collect();
    counted.sort_by(|&a, &b| x[a].total_cmp(&x[b]));
    let mean = |of: &[usize]| of.iter().map(|&i| y[i]).sum::<f64>() / of.len().max(1) as f64;
    let square = |of: &[usize]| -> f64 {
        let mean = mean(of);
        of.iter().map(|&i| (y[i] - mean).powi(2)).sum()
    };
    let (total, many) = (square(&counted), counted.len());
    if total <= 0.0 || many < 2 * count {
        return 0.0;
    }
    let (below, above) = counted.split_at(counted.partition_point(|&i| x[i] < 0.0));
    let size = many.div_ceil(count);
    let steps = || below.chunks(size).chain(above.chunks(size));
    let within: f64 = steps().map(square).sum();
    let freedom = many.saturating_sub(steps().count()).max(1) as f64;
    1.0 - within / total * (many as f64 - 1.0) / freedom
}

fn weighted_square(values: &[f64], weights: &[f64]) -> f64 {
    let pairs = values.iter().zip(weights);
    pairs.map(|(value, weight)| weight * value * value).sum()
}

/// Dots of a residual, evenly along the rows that count.
fn signature(
    bench: &Bench<'_>,
    (joint, variable): (usize, &Variable),
    (before, after): (&[f64], &[f64]),
    on: &Joined,
) -> Signature {
    let counted = 0..before.len();
    let counted: Vec<usize> = counted.filter(|&i| on.weights[joint][i] > 0.0).collect();
    let every = counted.len().div_ceil(DOTS).max(1);
    let dots: Vec<usize> = counted.into_iter().step_by(every).collect();
    let at = |values: &[f64]| -> Vec<f32> {
        let inside = dots.iter().filter_map(|&i| values.get(i));
        inside.map(|&value| value as f32).collect()
    };
    Signature {
        effect: None,
        joint: bench.model.joints()[joint].name.to_string(),
        unit: unit(bench, joint).to_owned(),
        variable: variable.name.clone(),
        variable_unit: variable.unit.clone(),
        x: at(&variable.values),
        before: at(before),
        after: at(after),
    }
}

/// Torque along the first log that rows count of.
fn torque(
    bench: &Bench<'_>,
    (before, after): (&[Vec<f64>], &[Vec<f64>]),
    on: &Joined,
) -> Vec<GapCurves> {
    let Some((track, rows)) = first(on) else {
        return Vec::new();
    };
    let start = on.segments[track].start;
    let steps = rows.clone().map(|row| (row - start) as f64);
    let t: Vec<f64> = steps
        .map(|k| on.tracks[track].row_time(k as usize))
        .collect();
    let of_joint = |joint: usize| {
        let measured = on.measured(joint)[rows.clone()].to_vec();
        let model = |residual: &[f64]| -> Vec<f64> {
            let pairs = measured.iter().zip(&residual[rows.clone()]);
            pairs.map(|(y, r)| y - r).collect()
        };
        let (old, new) = (model(&before[joint]), model(&after[joint]));
        let about = (
            bench.model.joints()[joint].name.as_ref(),
            unit(bench, joint),
        );
        GapCurves::new(about, &t, [&measured, &old, &new])
    };
    (0..on.joints()).map(of_joint).collect()
}

/// The first log with rows that count, and the stretch of its rows from the first of them to the
/// last.
fn first(on: &Joined) -> Option<(usize, Range<usize>)> {
    let counts = |row: &usize| on.weights.iter().any(|weights| weights[*row] > 0.0);
    on.segments.iter().enumerate().find_map(|(k, segment)| {
        let first = segment.clone().find(counts)?;
        let last = segment.clone().rev().find(counts)?;
        Some((k, first..last + 1))
    })
}

pub(super) fn unit(bench: &Bench<'_>, joint: usize) -> &'static str {
    match bench.model.joints()[joint].kind {
        JointKind::Revolute => "N m",
        JointKind::Prismatic => "N",
    }
}

#[cfg(test)]
mod tests {
    use super::explained;

    #[test]
    fn a_function_of_a_variable_is_explained_by_it_and_noise_is_not() {
        let x: Vec<f64> = (0..3000).map(|i| (f64::from(i) * 0.37).sin()).collect();
        let y: Vec<f64> = x.iter().map(|x| x * x - 0.3 * x).collect();
        let other: Vec<f64> = (0..3000)
            .map(|i| (f64::from(i * i) * 0.731).cos())
            .collect();
        let weights = vec![1.0; 3000];
        assert!(explained((&x, 60), &y, &weights) > 0.99);
        assert!(explained((&other, 60), &y, &weights).abs() < 0.05);
        assert!(explained((&x, 60), &vec![1.0; 3000], &weights) == 0.0);
    }
}
