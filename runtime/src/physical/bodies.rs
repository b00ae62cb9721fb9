//! The divergence of bodies from described ones, and bodies moved in coordinates of their own.

use super::pseudo::{Pseudo, Square};

/// A described body as the divergence needs it: the inverse of P_0 and log det P_0.
pub(super) type Described = (Square, f64);

/// Coordinates in which a body is the unit: with \\( P = L L^T \\), \\( P + dP = L (1 + S) L^T \\) for
/// symmetric S, whose ten orthonormal coordinates are those of a diagonal entry or of a pair.
/// There the second derivative of -log det is the identity, however thin the body is.
pub(super) struct Local {
    root: Square,
    /// What one unit of each coordinate adds to the ten values.
    pub values: [[f64; 10]; 10],
    /// The gradient of the divergence.
    pub gradient: [f64; 10],
}

/// A step leaves at least this share of a body in every direction: what has all but vanished could
/// only be doubled by each further step.
pub(super) const LEFT: f64 = 0.1;

/// Rows and columns of the ten coordinates.
const PLACES: [(usize, usize); 10] = [
    (0, 0),
    (0, 1),
    (0, 2),
    (0, 3),
    (1, 1),
    (1, 2),
    (1, 3),
    (2, 2),
    (2, 3),
    (3, 3),
];

/// \\( \mathrm{tr}(P_0^{-1} P) - \log\det(P_0^{-1} P) - 4 \\); `None` where P is no body.
pub(super) fn divergence(pseudo: &Pseudo, described: &Described) -> Option<f64> {
    let root = pseudo.cholesky()?;
    let log_det = 2.0 * (0..4).map(|i| root[i][i].ln()).sum::<f64>();
    let (inverse, log_det_described) = described;
    Some(trace(inverse, &pseudo.0) - (log_det - log_det_described) - 4.0)
}

impl Local {
    /// Around a body, with coordinates that leave it symmetric about the planes through the origin
    /// with these normals; `None` if it is none.
    ///
    /// Where P is symmetric, so is L, and \\( L (1 + S) L^T \\) stays so without the entries of S that
    /// pair a normal with anything else: these coordinates move nothing.
    pub fn of(pseudo: &Pseudo, described: &Described, normals: &[usize]) -> Option<Local> {
        let root = pseudo.cholesky()?;
        let held = PLACES.map(|(a, b)| normals.iter().any(|n| (a == *n) != (b == *n)));
        let moved = std::array::from_fn(|i| match held[i] {
            true => [[0.0; 4]; 4],
            false => stretched(&root, &unit(PLACES[i])),
        });
        Some(Local {
            values: moved.map(|moved| Pseudo(moved).values()),
            gradient: std::array::from_fn(|i| {
                let (a, b) = PLACES[i];
                let own = if a == b { 1.0 } else { 0.0 };
                trace(&described.0, &moved[i]) - own
            }),
            root,
        })
    }

    /// The body at these coordinates; `None` where it would lose more than [`LEFT`] in a direction.
    pub fn at(&self, coordinates: &[f64]) -> Option<Pseudo> {
        let mut inside = [[0.0; 4]; 4];
        for (i, row) in inside.iter_mut().enumerate() {
            row[i] = 1.0;
        }
        for (place, x) in PLACES.iter().zip(coordinates) {
            let unit = unit(*place);
            for (row, unit) in inside.iter_mut().zip(unit) {
                row.iter_mut().zip(unit).for_each(|(s, u)| *s += x * u);
            }
        }
        let mut above = inside;
        for (i, row) in above.iter_mut().enumerate() {
            row[i] -= LEFT;
        }
        let stays = Pseudo(above).exists();
        stays.then(|| Pseudo(stretched(&self.root, &inside)))
    }
}

/// A symmetric matrix of norm one.
fn unit((a, b): (usize, usize)) -> Square {
    let mut unit = [[0.0; 4]; 4];
    let size = if a == b { 1.0 } else { 0.5_f64.sqrt() };
    unit[a][b] = size;
    unit[b][a] = size;
    unit
}

/// L S L^T.
fn stretched(root: &Square, inside: &Square) -> Square {
    let half: Square = std::array::from_fn(|i| {
        std::array::from_fn(|k| (0..=i).map(|j| root[i][j] * inside[j][k]).sum())
    });
    std::array::from_fn(|i| {
        std::array::from_fn(|k| {
            let (i, k) = (i.max(k), i.min(k));
            (0..=k).map(|j| half[i][j] * root[k][j]).sum()
        })
    })
}

fn trace(a: &Square, b: &Square) -> f64 {
    let row = |i: usize| (0..4).map(|k| a[i][k] * b[k][i]).sum::<f64>();
    (0..4).map(row).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradient_is_that_of_the_divergence_and_its_curvature_is_one() {
        let described = Pseudo::ball(2.0, 0.1, [0.1, 0.0, 0.3]).inverse().unwrap();
        let pseudo = Pseudo::ball(1.7, 0.003, [0.12, 0.01, 0.28]);
        let local = Local::of(&pseudo, &described, &[]).unwrap();
        let value = |i: usize, by: f64| {
            let mut at = [0.0; 10];
            at[i] = by;
            divergence(&local.at(&at).unwrap(), &described).unwrap()
        };
        let here = divergence(&pseudo, &described).unwrap();
        for i in 0..10 {
            let step = 1e-4;
            let (up, down) = (value(i, step), value(i, -step));
            let slope = (up - down) / (2.0 * step);
            assert!((slope - local.gradient[i]).abs() < 1e-6 * (1.0 + slope.abs()));
            // A wider step: the differences of second order are small against the value.
            let wide = 3e-3;
            let curve = (value(i, wide) + value(i, -wide) - 2.0 * here) / (wide * wide);
            assert!((curve - 1.0).abs() < 1e-4, "{curve}");
            let values = local.at(&std::array::from_fn::<f64, 10, _>(|k| {
                f64::from(u8::from(i == k)) * step
            }));
            for (k, (a, b)) in values
                .unwrap()
                .values()
                .iter()
                .zip(pseudo.values())
                .enumerate()
            {
                assert!((a - b - step * local.values[i][k]).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn divergence_vanishes_at_the_description_alone() {
        let described = Pseudo::ball(2.0, 0.1, [0.1, 0.0, 0.3]);
        let inverse = described.inverse().unwrap();
        assert!(divergence(&described, &inverse).unwrap().abs() < 1e-12);
        let gradient = Local::of(&described, &inverse, &[]).unwrap().gradient;
        assert!(gradient.iter().all(|g| g.abs() < 1e-9));
        assert!(divergence(&Pseudo::ball(2.1, 0.1, [0.1, 0.0, 0.3]), &inverse).unwrap() > 1e-3);
        let none = Pseudo::of(&[0.5, 0.0, 0.0, 0.2, 0.0, 0.2, 0.0, 0.0, 0.0, 1.0]);
        assert_eq!(divergence(&none, &inverse), None);
    }
}
