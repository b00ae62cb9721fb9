//! What no effect explains, as a picture: a tensor spline of two variables of a joint.
//!
//! Hat functions on a grid for each variable, their products as columns, differences of second order
//! along both as the penalty (Eilers and Marx 1996). How much to penalise, which two variables, and
//! how much they explain is decided on blocks that were not fitted.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use rayon::prelude::*;

use super::joined::Joined;
use super::picture::{Variable, residuals, unit, variables};
use super::repeats::find;
use super::state::{Bench, State};
use crate::report::{Change, Smooth, SmoothVariable, hats};

/// Blocks of the training logs, each left out once.
const BLOCKS: usize = 8;

/// Places of a variable, and of a position, along which a torque may ripple.
const PLACES: usize = 9;
const POSITIONS: usize = 17;

/// Part of a variable's range about zero within which a torque may change its sign at once.
const JUMP: f64 = 0.01;

/// Weights of the penalty beside the columns' own squares.
const PENALTIES: [f64; 4] = [1e-4, 1e-3, 1e-2, 1e-1];

/// Rows about a place without which nothing is known there.
const FEWEST: f64 = 2.0;

/// Share that a second pair of variables must explain more to be chosen before an earlier one.
const CLEARLY: f64 = 0.01;

/// Share below which there is no picture.
const LEAST: f64 = 0.05;

/// The shapes of what a state leaves at some joints, shown on the logs that prove it.
pub(super) fn smooths(
    bench: &Bench<'_>,
    state: &State,
    joints: &[usize],
    proof: Option<&Joined>,
) -> Vec<Smooth> {
    let train = residuals(bench, state, bench.train);
    let blocks = blocks(bench.train);
    let proof = proof.map(|on| (on, residuals(bench, state, on)));
    let of_joint = |&joint: &usize| {
        let along = variables(bench, state, joint, bench.train);
        let weights = &bench.train.weights[joint];
        let (places, fitted) = best(&along, &train[joint], (weights, &blocks))?;
        let grids = places.map(|k| grid(&along[k]));
        let smooth = Smooth {
            joint: bench.model.joints()[joint].name.to_string(),
            unit: unit(bench, joint).to_owned(),
            torque: known(&fitted, &grids, places.map(|k| &along[k]), weights),
            variables: [0, 1].map(|k| SmoothVariable {
                name: along[places[k]].name.clone(),
                unit: along[places[k]].unit.clone(),
                at: grids[k].clone(),
            }),
            explained_pct: 100.0 * fitted.share,
            proven_pct: None,
            rmse: Change {
                before: 0.0,
                after: 0.0,
            },
        };
        Some(match &proof {
            Some((on, left)) => {
                let along = variables(bench, state, joint, on);
                let proven = [&along[places[0]], &along[places[1]]];
                shown(smooth, proven, (&left[joint], &on.weights[joint]), true)
            }
            None => {
                let own = places.map(|k| &along[k]);
                shown(smooth, own, (&train[joint], weights), false)
            }
        })
    };
    let all = joints.iter().filter_map(of_joint);
    // A shape that another motion contradicts is none.
    all.filter(|smooth| smooth.proven_pct.is_none_or(|share| share > 0.0))
        .collect()
}

/// The block of each row: a stretch of its log, or of every period of a log that repeats itself.
fn blocks(joined: &Joined) -> Vec<usize> {
    let mut all = Vec::with_capacity(joined.rows());
    for (track, segment) in joined.tracks.iter().zip(&joined.segments) {
        let repeats = find(track, segment.clone());
        let period = repeats.map_or(segment.len(), |repeats| repeats.period);
        all.extend((0..segment.len()).map(|k| k % period * BLOCKS / period));
    }
    all
}

/// With what is left along rows, without and with it.
fn shown(
    mut smooth: Smooth,
    along: [&Variable; 2],
    (y, weights): (&[f64], &[f64]),
    proves: bool,
) -> Smooth {
    let rows = (0..y.len()).filter(|&t| weights[t] > 0.0);
    let (mut before, mut after, mut count) = (0.0, 0.0, 0.0_f64);
    for t in rows {
        let torque = smooth.torque_at(along.map(|variable| variable.values[t]));
        before += y[t].powi(2);
        after += (y[t] - torque.unwrap_or(0.0)).powi(2);
        count += 1.0;
    }
    let rms = |square: f64| (square / count.max(1.0)).sqrt();
    (smooth.rmse.before, smooth.rmse.after) = (rms(before), rms(after));
    smooth.proven_pct = (proves && before > 0.0).then(|| 100.0 * (1.0 - after / before));
    smooth
}

/// A fitted spline.
struct Fitted {
    coefficients: Vec<f64>,
    /// Of the variance on blocks that were left out.
    share: f64,
}

/// The two variables that explain most of a torque on blocks that were left out, earlier ones
/// first.
fn best(
    along: &[Variable],
    y: &[f64],
    (weights, blocks): (&[f64], &[usize]),
) -> Option<([usize; 2], Fitted)> {
    let pairs: Vec<[usize; 2]> = (0..along.len())
        .flat_map(|i| (i + 1..along.len()).map(move |k| [i, k]))
        .collect();
    let fit = |pair: &[usize; 2]| {
        let fitted = fit(pair.map(|k| &along[k]), y, (weights, blocks))?;
        Some((*pair, fitted))
    };
    let all: Vec<([usize; 2], Fitted)> = pairs.par_iter().filter_map(fit).collect();
    let better = |best: Option<([usize; 2], Fitted)>, next: ([usize; 2], Fitted)| match best {
        Some(best) if next.1.share <= best.1.share + CLEARLY => Some(best),
        _ => Some(next),
    };
    let best = all.into_iter().fold(None, better);
    best.filter(|(_, fitted)| fitted.share > LEAST)
}

/// Sums of products of a block: columns with columns, columns with y.
#[derive(Clone)]
struct Sums {
    gram: Mat<f64>,
    right: Vec<f64>,
}

impl Sums {
    fn none(count: usize) -> Sums {
        Sums {
            gram: Mat::zeros(count, count),
            right: vec![0.0; count],
        }
    }

    /// Adds another times a sign.
    fn plus(&self, sign: f64, other: &Sums) -> Sums {
        let pairs = self.right.iter().zip(&other.right);
        Sums {
            gram: Mat::from_fn(self.gram.nrows(), self.gram.ncols(), |i, k| {
                self.gram[(i, k)] + sign * other.gram[(i, k)]
            }),
            right: pairs.map(|(a, b)| a + sign * b).collect(),
        }
    }

    fn solve(&self, penalty: &Mat<f64>, weight: f64) -> Option<Vec<f64>> {
        let count = self.right.len();
        let scale = (0..count).map(|k| self.gram[(k, k)]).sum::<f64>() / count as f64;
        let matrix = Mat::from_fn(count, count, |i, k| {
            let ridge = if i == k { 1e-8 } else { 0.0 };
            self.gram[(i, k)] + scale * (weight * penalty[(i, k)] + ridge)
        });
        let right = Mat::from_fn(count, 1, |i, _| self.right[i]);
        let found = matrix.llt(Side::Lower).ok()?.solve(&right);
        Some((0..count).map(|k| found[(k, 0)]).collect())
    }
}

/// Columns of a row: places and values.
type Row = [(usize, f64); 4];

/// Fits a spline of two variables; `None` where nothing varies.
fn fit(
    along: [&Variable; 2],
    y: &[f64],
    (weights, block_of): (&[f64], &[usize]),
) -> Option<Fitted> {
    let grids = along.map(grid);
    let [m, n] = grids.each_ref().map(Vec::len);
    if m < 3 || n < 3 {
        return None;
    }
    let counted: Vec<usize> = (0..y.len()).filter(|&t| weights[t] > 0.0).collect();
    let rows: Vec<Row> = counted
        .iter()
        .map(|&t| row(&grids, [along[0].values[t], along[1].values[t]]))
        .collect();
    let block = |k: usize| block_of[counted[k]];
    let mut blocks = vec![Sums::none(m * n); BLOCKS];
    for (k, row) in rows.iter().enumerate() {
        let (sums, t) = (&mut blocks[block(k)], counted[k]);
        for (i, a) in row {
            sums.right[*i] += weights[t] * a * y[t];
            row.iter()
                .for_each(|(j, b)| sums.gram[(*i, *j)] += weights[t] * a * b);
        }
    }
    let none = Sums::none(m * n);
    let all = blocks.iter().fold(none, |all, block| all.plus(1.0, block));
    let penalty = roughness(&grids);
    let total: f64 = counted.iter().map(|&t| weights[t] * y[t].powi(2)).sum();
    let left = |weight: f64| -> Option<f64> {
        let without = blocks
            .iter()
            .map(|own| all.plus(-1.0, own).solve(&penalty, weight));
        let without: Vec<Vec<f64>> = without.collect::<Option<_>>()?;
        let error = |(k, row): (usize, &Row)| {
            let t = counted[k];
            let torque: f64 = row.iter().map(|(i, a)| a * without[block(k)][*i]).sum();
            weights[t] * (y[t] - torque).powi(2)
        };
        Some(rows.iter().enumerate().map(error).sum())
    };
    let tried = PENALTIES
        .iter()
        .filter_map(|&weight| Some((weight, left(weight)?)));
    let (weight, left) = tried.min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Fitted {
        coefficients: all.solve(&penalty, weight)?,
        share: 1.0 - left / total.max(f64::MIN_POSITIVE),
    })
}

fn row(grids: &[Vec<f64>; 2], values: [f64; 2]) -> Row {
    let [one, other] = [0, 1].map(|k| hats(&grids[k], values[k]));
    let wide = grids[1].len();
    [(0, 0), (0, 1), (1, 0), (1, 1)]
        .map(|(a, b)| (one[a].0 * wide + other[b].0, one[a].1 * other[b].1))
}

/// Places of a variable: as many values between any two of them; close ones on both sides of zero,
/// where signs change.
fn grid(variable: &Variable) -> Vec<f64> {
    let mut sorted = variable.values.clone();
    sorted.retain(|value| value.is_finite());
    sorted.sort_by(f64::total_cmp);
    let (Some(low), Some(high)) = (sorted.first(), sorted.last()) else {
        return Vec::new();
    };
    let (low, range) = (*low, high - low);
    let count = match variable.name.starts_with("position") {
        true => POSITIONS,
        false => PLACES,
    };
    let at = |k: usize| sorted[(sorted.len() - 1) * k / (count - 1)];
    let mut places: Vec<f64> = (0..count).map(at).collect();
    if low < 0.0 && low + range > 0.0 && variable.turns() {
        places.retain(|place| place.abs() > 2.0 * JUMP * range);
        places.extend([-JUMP * range, JUMP * range]);
        places.sort_by(f64::total_cmp);
    }
    places.dedup_by(|next, last| *next - *last < 0.5 * JUMP * range || range <= 0.0);
    places
}

/// Sum of squared second differences along both variables.
fn roughness(grids: &[Vec<f64>; 2]) -> Mat<f64> {
    let [m, n] = grids.each_ref().map(Vec::len);
    let mut sum = Mat::<f64>::zeros(m * n, m * n);
    let mut add = |places: [usize; 3]| {
        for (i, a) in places.into_iter().zip([1.0, -2.0, 1.0]) {
            for (k, b) in places.into_iter().zip([1.0, -2.0, 1.0]) {
                sum[(i, k)] += a * b;
            }
        }
    };
    for i in 0..m {
        for k in 0..n {
            if i + 2 < m && bends(&grids[0], i) {
                add([i, i + 1, i + 2].map(|i| i * n + k));
            }
            if k + 2 < n && bends(&grids[1], k) {
                add([k, k + 1, k + 2].map(|k| i * n + k));
            }
        }
    }
    sum
}

/// Whether three places of a grid lie on one side of zero, or far apart about it.
fn bends(grid: &[f64], first: usize) -> bool {
    let range = grid[grid.len() - 1] - grid[0];
    let jump =
        |pair: &[f64]| pair[0] < 0.0 && pair[1] > 0.0 && pair[1] - pair[0] < 3.0 * JUMP * range;
    !grid[first..first + 3].windows(2).any(jump)
}

/// The coefficients as a table, without those of places that no row is near.
fn known(
    fitted: &Fitted,
    grids: &[Vec<f64>; 2],
    along: [&Variable; 2],
    weights: &[f64],
) -> Vec<Vec<Option<f64>>> {
    let mut near = vec![0.0; fitted.coefficients.len()];
    for t in (0..weights.len()).filter(|&t| weights[t] > 0.0) {
        let row = row(grids, [along[0].values[t], along[1].values[t]]);
        row.iter().for_each(|(k, a)| near[*k] += a);
    }
    let known = fitted.coefficients.iter().zip(near);
    let known: Vec<Option<f64>> = known
        .map(|(torque, near)| (near >= FEWEST).then_some(*torque))
        .collect();
    known
        .chunks(grids[1].len().max(1))
        .map(<[_]>::to_vec)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variable(name: &str, values: Vec<f64>) -> Variable {
        Variable::new(name, values)
    }

    /// Position, velocity, time of a swing, and something that has nothing to do with it.
    fn swing() -> Vec<Variable> {
        let of = |f: &dyn Fn(f64) -> f64| (0..2400).map(|i| f(0.02 * f64::from(i))).collect();
        vec![
            variable("velocity", of(&|t| (0.9 * t).cos() + 0.4 * (2.3 * t).cos())),
            variable("position", of(&|t| (0.9 * t).sin() + 0.2 * (2.3 * t).sin())),
            variable("load", of(&|t| (1.7 * t * t).sin())),
            variable("time", of(&|t| t)),
        ]
    }

    static ONES: [f64; 2400] = [1.0; 2400];

    fn stretches() -> Vec<usize> {
        (0..2400).map(|k| k * BLOCKS / 2400).collect()
    }

    fn noise(len: usize) -> Vec<f64> {
        let mut state = 7_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        (0..len).map(|_| next()).collect()
    }

    #[test]
    fn the_two_variables_of_a_torque_are_found_with_what_they_explain() {
        let along = swing();
        let noise = noise(2400);
        let torque = |t: usize| {
            let (qd, q) = (along[0].values[t], along[1].values[t]);
            qd.signum() * (1.0 + 0.6 * (2.0 * q).cos())
        };
        // Noise of a hundredth of the variance.
        let size = 0.1 * (1.2_f64 * 12.0).sqrt();
        let y: Vec<f64> = (0..2400).map(|t| torque(t) + size * noise[t]).collect();
        let (pair, fitted) = best(&along, &y, (&ONES, &stretches())).unwrap();
        assert_eq!(pair, [0, 1]);
        assert!((0.95..1.0).contains(&fitted.share), "{}", fitted.share);
    }

    #[test]
    fn noise_is_no_picture() {
        assert!(best(&swing(), &noise(2400), (&ONES, &stretches())).is_none());
    }

    #[test]
    fn a_plane_is_drawn_as_it_is() {
        let along = swing();
        let y: Vec<f64> = (0..2400)
            .map(|t| 2.0 * along[0].values[t] - along[1].values[t])
            .collect();
        let fitted = fit([&along[0], &along[1]], &y, (&ONES, &stretches())).unwrap();
        assert!(fitted.share > 0.999, "{}", fitted.share);
        let grids = [grid(&along[0]), grid(&along[1])];
        let torque = known(&fitted, &grids, [&along[0], &along[1]], &ONES);
        for (qd, row) in grids[0].iter().zip(&torque) {
            for (q, torque) in grids[1].iter().zip(row) {
                let away = torque.map_or(0.0, |torque| torque - (2.0 * qd - q));
                assert!(away.abs() < 0.1, "{qd} {q} {away}");
            }
        }
    }
}
