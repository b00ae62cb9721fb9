//! Descent by a quasi-Newton method (limited-memory BFGS: Nocedal 1980) with backtracking.

use std::collections::VecDeque;

/// Pairs of steps and changes of slope that are remembered.
const MEMORY: usize = 12;

/// Longest first step, in the units of the numbers.
const FIRST: f64 = 0.1;

/// Least decrease of a step, as a share of what the slope promises (Armijo 1966).
const DECREASE: f64 = 1e-4;

/// Halvings of a step before it is given up.
const HALVINGS: usize = 20;

/// A function to minimise, `None` where it is not defined.
pub(super) trait Function {
    fn value(&self, z: &[f64]) -> Option<f64>;
    fn slopes(&self, z: &[f64]) -> Option<(f64, Vec<f64>)>;
}

/// From `start` down, in at most `steps` steps; where it arrives. Ends earlier where no step along
/// the slope decreases the function.
pub(super) fn descend(function: &impl Function, start: Vec<f64>, steps: usize) -> Vec<f64> {
    let mut z = start;
    let Some((mut value, mut slopes)) = function.slopes(&z) else {
        return z;
    };
    let mut memory: VecDeque<(Vec<f64>, Vec<f64>)> = VecDeque::new();
    for _ in 0..steps {
        let mut direction = newton(&memory, &slopes);
        let mut descent = dot(&direction, &slopes);
        if descent.is_nan() || descent >= 0.0 {
            memory.clear();
            direction = newton(&memory, &slopes);
            descent = dot(&direction, &slopes);
        }
        let Some(next) = step(function, &z, value, (&direction, descent)) else {
            if memory.is_empty() {
                break;
            }
            memory.clear();
            continue;
        };
        let Some((lower, new)) = function.slopes(&next) else {
            break;
        };
        let moved: Vec<f64> = next.iter().zip(&z).map(|(a, b)| a - b).collect();
        let turned: Vec<f64> = new.iter().zip(&slopes).map(|(a, b)| a - b).collect();
        if dot(&moved, &turned) > 1e-12 * dot(&moved, &moved) {
            memory.push_back((moved, turned));
        }
        if memory.len() > MEMORY {
            memory.pop_front();
        }
        (z, value, slopes) = (next, lower, new);
    }
    z
}

/// The next point along a direction whose descent is negative.
fn step(
    function: &impl Function,
    z: &[f64],
    value: f64,
    (direction, descent): (&[f64], f64),
) -> Option<Vec<f64>> {
    let mut length = 1.0;
    for _ in 0..HALVINGS {
        let pairs = z.iter().zip(direction);
        let next: Vec<f64> = pairs.map(|(z, direction)| z + length * direction).collect();
        let promised = value + DECREASE * length * descent;
        if function.value(&next).is_some_and(|found| found < promised) {
            return Some(next);
        }
        length *= 0.5;
    }
    None
}

/// The direction to go: minus the inverse curvature that is remembered times the slopes.
fn newton(memory: &VecDeque<(Vec<f64>, Vec<f64>)>, slopes: &[f64]) -> Vec<f64> {
    let mut direction: Vec<f64> = slopes.iter().map(|slope| -slope).collect();
    let Some((moved, turned)) = memory.back() else {
        let norm = dot(slopes, slopes).sqrt();
        let short = (FIRST / norm).min(1.0);
        direction.iter_mut().for_each(|value| *value *= short);
        return direction;
    };
    let curvature = dot(moved, turned) / dot(turned, turned);
    let mut shares = Vec::with_capacity(memory.len());
    for (moved, turned) in memory.iter().rev() {
        let share = dot(moved, &direction) / dot(moved, turned);
        add(&mut direction, -share, turned);
        shares.push(share);
    }
    direction.iter_mut().for_each(|value| *value *= curvature);
    for ((moved, turned), share) in memory.iter().zip(shares.iter().rev()) {
        let other = dot(turned, &direction) / dot(moved, turned);
        add(&mut direction, share - other, moved);
    }
    direction
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(to: &mut [f64], factor: f64, from: &[f64]) {
    let pairs = to.iter_mut().zip(from);
    pairs.for_each(|(to, from)| *to += factor * from);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rosenbrock's valley: minimum 0 at (1, 1).
    struct Valley;

    impl Function for Valley {
        fn value(&self, z: &[f64]) -> Option<f64> {
            self.slopes(z).map(|(value, _)| value)
        }
        fn slopes(&self, z: &[f64]) -> Option<(f64, Vec<f64>)> {
            let (a, b) = (1.0 - z[0], z[1] - z[0] * z[0]);
            let value = a * a + 100.0 * b * b;
            Some((value, vec![-2.0 * a - 400.0 * z[0] * b, 200.0 * b]))
        }
    }

    #[test]
    fn descent_finds_the_end_of_a_curved_valley() {
        let found = descend(&Valley, vec![-1.2, 1.0], 100);
        assert!(found.iter().all(|z| (z - 1.0).abs() < 1e-6), "{found:?}");
    }
}
