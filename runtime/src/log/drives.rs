//! From the motor's side of the drives to the joint's (Gautier 1996, eq. 13).

use faer::Mat;
use faer::linalg::solvers::DenseSolveCore;

use super::error::{Found, Problem};
use crate::settings::Drives;

/// Joint positions of motor positions: \\( q = C^{-1} q_{motor} \\), one series per joint.
pub(super) fn joint_positions(drives: &Drives, motor: Vec<Vec<f64>>) -> Found<Vec<Vec<f64>>> {
    if drives.coupling.is_empty() {
        return Ok(motor);
    }
    let n = motor.len();
    let c = Mat::from_fn(n, n, |i, j| entry(drives, n, i, j));
    let inverse = c.partial_piv_lu().inverse();
    // A singular matrix gives an inverse that is none, or is not finite.
    let product = &c * &inverse;
    let identity = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
    let exact = |i: usize, j: usize| (product[(i, j)] - identity(i, j)).abs() <= 1e-6;
    if !(0..n).all(|i| (0..n).all(|j| exact(i, j))) {
        return Err(Problem::SingularCoupling);
    }
    Ok(combine(&motor, |i, j| inverse[(i, j)]))
}

/// Joint torques of what the drives report: \\( \tau = C^T (g \cdot i) \\), one series per joint.
pub(super) fn joint_torques(drives: &Drives, reported: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut motor = reported;
    for (series, gain) in motor.iter_mut().zip(drives.gains.iter()) {
        series.iter_mut().for_each(|value| *value *= gain);
    }
    if drives.coupling.is_empty() {
        return motor;
    }
    let n = motor.len();
    combine(&motor, |i, j| entry(drives, n, j, i))
}

fn entry(drives: &Drives, n: usize, row: usize, column: usize) -> f64 {
    drives
        .coupling
        .get(row * n + column)
        .copied()
        .unwrap_or(0.0)
}

/// The product of a matrix with the series; zero entries cost nothing and spoil nothing.
fn combine(series: &[Vec<f64>], matrix: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
    let len = series.first().map_or(0, Vec::len);
    (0..series.len())
        .map(|i| {
            let mut sum = vec![0.0; len];
            for (j, series) in series.iter().enumerate() {
                let factor = matrix(i, j);
                if factor != 0.0 {
                    sum.iter_mut()
                        .zip(series)
                        .for_each(|(sum, value)| *sum += factor * value);
                }
            }
            sum
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The wrist of a Staubli TX40: motor 6 turns with joints 5 and 6.
    fn wrist() -> Drives {
        Drives {
            gains: vec![2.0, 3.0].into(),
            coupling: vec![45.0, 0.0, 32.0, 32.0].into(),
        }
    }

    #[test]
    fn power_of_coupled_drives_is_the_same_on_both_sides() {
        let drives = wrist();
        let (rate, current) = ([0.3, -0.7], [1.5, 4.0]);
        let motor_rate = vec![vec![45.0 * rate[0]], vec![32.0 * rate[0] + 32.0 * rate[1]]];
        let tau = joint_torques(&drives, vec![vec![current[0]], vec![current[1]]]);
        let joint_power = tau[0][0] * rate[0] + tau[1][0] * rate[1];
        let motor_power = 2.0 * current[0] * motor_rate[0][0] + 3.0 * current[1] * motor_rate[1][0];
        assert!((joint_power - motor_power).abs() <= 1e-12 * motor_power.abs());
        let q = joint_positions(&drives, motor_rate).unwrap();
        assert!((q[0][0] - rate[0]).abs() < 1e-14 && (q[1][0] - rate[1]).abs() < 1e-14);
    }

    #[test]
    fn positions_of_singular_drives_are_refused() {
        let drives = Drives {
            coupling: vec![1.0, 2.0, 2.0, 4.0].into(),
            ..Drives::default()
        };
        let found = joint_positions(&drives, vec![vec![0.0], vec![0.0]]);
        assert!(matches!(found, Err(Problem::SingularCoupling)));
    }

    #[test]
    fn series_without_coupling_pass_unchanged() {
        let series = vec![vec![1.0, f64::MIN_POSITIVE]];
        assert_eq!(
            joint_positions(&Drives::default(), series.clone()).unwrap(),
            series
        );
        assert_eq!(joint_torques(&Drives::default(), series.clone()), series);
    }
}
