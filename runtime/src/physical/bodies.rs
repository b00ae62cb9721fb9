//! The divergence of bodies from described ones, with its first and second derivatives.

use super::pseudo::{Pseudo, Square};

/// Places of the ten values in the pseudo-inertia: how each entry changes with value `i`, as
/// (row, column, factor) of the symmetric matrix.
fn basis(i: usize) -> Vec<(usize, usize, f64)> {
    let diagonal = |own: usize| -> Vec<(usize, usize, f64)> {
        (0..3)
            .map(|k| (k, k, if k == own { -0.5 } else { 0.5 }))
            .collect()
    };
    let pair = |a: usize, b: usize, factor: f64| vec![(a, b, factor), (b, a, factor)];
    match i {
        0 => diagonal(0),
        1 => pair(0, 1, -1.0),
        2 => pair(0, 2, -1.0),
        3 => diagonal(1),
        4 => pair(1, 2, -1.0),
        5 => diagonal(2),
        6..=8 => pair(i - 6, 3, 1.0),
        _ => vec![(3, 3, 1.0)],
    }
}

/// Gradient and Hessian by the ten values.
pub(super) struct Divergence {
    pub gradient: [f64; 10],
    pub hessian: [[f64; 10]; 10],
}

/// \\( \mathrm{tr}(P_0^{-1} P) - \log\det(P_0^{-1} P) - 4 \\); `None` where the values are no body.
pub(super) fn value(values: &[f64; 10], described: &(Square, f64)) -> Option<f64> {
    let (_, log_det) = Pseudo::of(values).inverse()?;
    let (inverse, log_det_described) = described;
    // Both are inverses' partners: log det of P_0 is minus that of its inverse.
    Some(trace(inverse, &Pseudo::of(values).0) - (log_det - log_det_described) - 4.0)
}

/// Its derivatives. `described` is the inverse of P_0 and the logarithm of its
/// determinant.
pub(super) fn divergence(values: &[f64; 10], described: &(Square, f64)) -> Option<Divergence> {
    let pseudo = Pseudo::of(values);
    let (inverse, _) = pseudo.inverse()?;
    let bases: Vec<Vec<(usize, usize, f64)>> = (0..10).map(basis).collect();
    let along = |matrix: &Square, basis: &[(usize, usize, f64)]| -> f64 {
        basis.iter().map(|(r, c, f)| f * matrix[*r][*c]).sum()
    };
    // P^-1 E_i P^-1, and its trace with E_k.
    let turned = |basis: &[(usize, usize, f64)]| -> Square {
        std::array::from_fn(|a| {
            std::array::from_fn(|b| {
                let terms = basis
                    .iter()
                    .map(|(r, c, f)| f * inverse[a][*r] * inverse[*c][b]);
                terms.sum()
            })
        })
    };
    let mut hessian = [[0.0; 10]; 10];
    for (row, basis) in hessian.iter_mut().zip(&bases) {
        let turned = turned(basis);
        for (entry, other) in row.iter_mut().zip(&bases) {
            *entry = along(&turned, other);
        }
    }
    Some(Divergence {
        gradient: std::array::from_fn(|i| {
            along(&described.0, &bases[i]) - along(&inverse, &bases[i])
        }),
        hessian,
    })
}

fn trace(a: &Square, b: &Square) -> f64 {
    (0..4)
        .map(|i| (0..4).map(|k| a[i][k] * b[k][i]).sum::<f64>())
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_value_and_vanish_at_the_description() {
        let described = Pseudo::ball(2.0, 0.1, [0.1, 0.0, 0.3]);
        let inverse = described.inverse().unwrap();
        let at = divergence(&described.values(), &inverse).unwrap();
        let own = value(&described.values(), &inverse).unwrap();
        assert!(own.abs() < 1e-12);
        assert!(at.gradient.iter().all(|g| g.abs() < 1e-9));

        let values = Pseudo::ball(1.7, 0.12, [0.12, 0.01, 0.28]).values();
        let at = divergence(&values, &inverse).unwrap();
        assert!(value(&values, &inverse).unwrap() > 0.0);
        for i in 0..10 {
            let step = 1e-6;
            let moved = |by: f64| {
                let mut values = values;
                values[i] += by;
                values
            };
            let (up, down) = (moved(step), moved(-step));
            let slope =
                (value(&up, &inverse).unwrap() - value(&down, &inverse).unwrap()) / (2.0 * step);
            assert!((slope - at.gradient[i]).abs() < 1e-6 * (1.0 + slope.abs()));
            let (up, down) = (divergence(&up, &inverse), divergence(&down, &inverse));
            let (up, down) = (up.unwrap().gradient, down.unwrap().gradient);
            for k in 0..10 {
                let curve = (up[k] - down[k]) / (2.0 * step);
                assert!((curve - at.hessian[i][k]).abs() < 1e-5 * (1.0 + curve.abs()));
            }
        }
    }
}
