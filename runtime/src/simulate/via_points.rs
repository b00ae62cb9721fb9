//! Motions through points: polynomials of degree five.

use super::options::Grid;
use super::trajectory::Trajectory;
use crate::log::ViaPoints;

/// Position, velocity and acceleration of every joint at the times of a grid; at rest at the end
/// after the last period.
pub(super) fn along(points: &ViaPoints, grid: &Grid) -> Trajectory {
    let row = |joint: usize| {
        let at = |k: usize| at(points, joint, grid.time(k));
        (0..grid.len).map(at).collect::<Vec<[f64; 3]>>()
    };
    let rows: Vec<Vec<[f64; 3]>> = (0..points.q.len()).map(row).collect();
    let gather = |order: usize| -> Vec<Vec<f64>> {
        let series = |row: &Vec<[f64; 3]>| row.iter().map(|at| at[order]).collect();
        rows.iter().map(series).collect()
    };
    Trajectory {
        q: gather(0),
        qd: gather(1),
        qdd: gather(2),
    }
}

fn at(points: &ViaPoints, joint: usize, t: f64) -> [f64; 3] {
    let period = points.period_s();
    let ended = t >= points.periods * period * (1.0 - f64::EPSILON);
    let left = points.times.len().saturating_sub(2);
    let (segment, t) = match ended && points.periods.fract() == 0.0 {
        true => (left, period),
        false => {
            let t = t.min(points.periods * period).rem_euclid(period);
            let passed = points.times.partition_point(|time| *time <= t);
            (passed.saturating_sub(1).min(left), t)
        }
    };
    let [q, qd, qdd] = [&points.q[joint], &points.qd[joint], &points.qdd[joint]];
    let (from, to) = (points.times[segment], points.times[segment + 1]);
    let ends = [segment, segment + 1].map(|point| [q[point], qd[point], qdd[point]]);
    let moving = quintic(ends, (from, to), t);
    match ended {
        true => [moving[0], 0.0, 0.0],
        false => moving,
    }
}

/// The polynomial of degree five with position, velocity and acceleration at two times, and its
/// derivatives at a third.
fn quintic([a, b]: [[f64; 3]; 2], (from, to): (f64, f64), t: f64) -> [f64; 3] {
    let d = to - from;
    let s = (t - from) / d;
    // In units of the interval: q(s) = sum c_k s^k.
    let (v, w) = ([a[1] * d, b[1] * d], [a[2] * d * d, b[2] * d * d]);
    let rise = b[0] - a[0] - v[0] - 0.5 * w[0];
    let (turn, bend) = (v[1] - v[0] - w[0], w[1] - w[0]);
    let c = [
        a[0],
        v[0],
        0.5 * w[0],
        10.0 * rise - 4.0 * turn + 0.5 * bend,
        -15.0 * rise + 7.0 * turn - bend,
        6.0 * rise - 3.0 * turn + 0.5 * bend,
    ];
    let at = |order: usize| {
        let term = |k: usize| {
            let falling: f64 = (0..order).map(|i| (k - i) as f64).product();
            falling * c[k] * s.powi((k - order) as i32)
        };
        (order..6).map(term).sum::<f64>()
    };
    [at(0), at(1) / d, at(2) / (d * d)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::central_difference;

    fn points(periods: f64) -> ViaPoints {
        ViaPoints {
            times: vec![0.0, 1.0, 2.5],
            periods,
            q: vec![vec![0.2, -0.7, 0.2]],
            qd: vec![vec![0.0, 0.4, 0.0]],
            qdd: vec![vec![0.0, -1.5, 0.0]],
        }
    }

    #[test]
    fn motion_has_the_values_of_its_points() {
        let points = points(2.0);
        for (k, time) in points.times.iter().enumerate().take(2) {
            for lap in [0.0, 2.5] {
                let found = at(&points, 0, time + lap);
                let given = [points.q[0][k], points.qd[0][k], points.qdd[0][k]];
                let pairs = found.iter().zip(given);
                assert!(pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 1e-12);
            }
        }
        for after in [5.0, 7.0] {
            let [q, qd, qdd] = at(&points, 0, after);
            assert!((q - 0.2).abs() < 1e-12 && [qd, qdd] == [0.0; 2]);
        }
    }

    #[test]
    fn derivatives_are_those_of_the_positions() {
        let grid = Grid {
            rate_hz: 1e4,
            start: 0.0,
            len: 50_001,
        };
        let motion = along(&points(2.0), &grid);
        let pairs = [(&motion.q, &motion.qd), (&motion.qd, &motion.qdd)];
        for (values, rates) in pairs {
            let found = central_difference(&values[0], grid.rate_hz);
            // A central difference misses at most the change of the rate within a step.
            let change = rates[0].windows(2).map(|pair| (pair[1] - pair[0]).abs());
            let change = change.fold(0.0, f64::max);
            let inner = 1..grid.len - 1;
            let worst = inner.map(|k| (found[k] - rates[0][k]).abs());
            assert!(worst.fold(0.0, f64::max) < change);
        }
    }
}
