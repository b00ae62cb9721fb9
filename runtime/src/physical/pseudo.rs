//! The pseudo-inertia of a body: the second moments of its mass, (x, y, z, 1)(x, y, z, 1)^T dm.

use faer::{Mat, Side};

/// A symmetric 4 x 4 matrix by rows.
pub type Square = [[f64; 4]; 4];

/// Radius that a described body has at least about its centre of mass, m, and as a share of its
/// largest one: rods and points are no bodies.
const LEAST_RADIUS: f64 = 0.003;
const LEAST_SHARE: f64 = 0.05;

/// Pseudo-inertia of a body about the origin of its link's frame (Wensing, Kim, Slotine 2018):
/// with \\( \Sigma = \tfrac12 \mathrm{tr}(J) 1 - J \\), first moments l and mass m,
/// \\( P = [\Sigma, l; l^T, m] \\). kg m^2, kg m, kg. A body exists where it is positive definite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pseudo(pub Square);

/// A described body that exists, and whether its description had to be mended for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Positive definite.
    pub pseudo: Pseudo,
    /// Whether the description is no body, or too thin for one.
    pub mended: bool,
}

impl Pseudo {
    /// From XX XY XZ YY YZ ZZ MX MY MZ M about the origin.
    pub fn of(values: &[f64; 10]) -> Pseudo {
        let [xx, xy, xz, yy, yz, zz, mx, my, mz, m] = *values;
        let half = 0.5 * (xx + yy + zz);
        Pseudo([
            [half - xx, -xy, -xz, mx],
            [-xy, half - yy, -yz, my],
            [-xz, -yz, half - zz, mz],
            [mx, my, mz, m],
        ])
    }

    /// XX XY XZ YY YZ ZZ MX MY MZ M.
    pub fn values(&self) -> [f64; 10] {
        let p = &self.0;
        let trace = p[0][0] + p[1][1] + p[2][2];
        [
            trace - p[0][0],
            -p[0][1],
            -p[0][2],
            trace - p[1][1],
            -p[1][2],
            trace - p[2][2],
            p[0][3],
            p[1][3],
            p[2][3],
            p[3][3],
        ]
    }

    /// A ball of a mass, kg, and a radius of gyration along each axis, m, about a centre, m.
    pub fn ball(mass: f64, radius: f64, center: [f64; 3]) -> Pseudo {
        let entry = |i: usize, k: usize| match (i, k) {
            (3, 3) => mass,
            (3, at) | (at, 3) => mass * center[at],
            _ => {
                let own = if i == k { radius * radius } else { 0.0 };
                mass * (own + center[i] * center[k])
            }
        };
        Pseudo(std::array::from_fn(|i| {
            std::array::from_fn(|k| entry(i, k))
        }))
    }

    /// The mean of a body and its image in the plane through the origin that is square to an axis:
    /// no products with that axis, no first moment along it.
    pub fn mirrored(&self, normal: usize) -> Pseudo {
        let entry = |i: usize, k: usize| match (i == normal) != (k == normal) {
            true => 0.0,
            false => self.0[i][k],
        };
        Pseudo(std::array::from_fn(|i| {
            std::array::from_fn(|k| entry(i, k))
        }))
    }

    /// Lower triangular L with P = L L^T; `None` where P is not positive definite.
    pub fn cholesky(&self) -> Option<Square> {
        let mut l = [[0.0; 4]; 4];
        for i in 0..4 {
            for k in 0..=i {
                let sum: f64 = (0..k).map(|j| l[i][j] * l[k][j]).sum();
                let rest = self.0[i][k] - sum;
                l[i][k] = match i == k {
                    true if rest > 0.0 => rest.sqrt(),
                    true => return None,
                    false => rest / l[k][k],
                };
            }
        }
        Some(l)
    }

    /// Whether a body has it.
    pub fn exists(&self) -> bool {
        self.cholesky().is_some()
    }

    /// Inverse and logarithm of the determinant; `None` where it is not positive definite.
    pub fn inverse(&self) -> Option<(Square, f64)> {
        let l = self.cholesky()?;
        let mut inverse = [[0.0; 4]; 4];
        for column in 0..4 {
            let mut x = [0.0; 4];
            for i in 0..4 {
                let unit = if i == column { 1.0 } else { 0.0 };
                let sum: f64 = (0..i).map(|j| l[i][j] * x[j]).sum();
                x[i] = (unit - sum) / l[i][i];
            }
            for i in (0..4).rev() {
                let sum: f64 = (i + 1..4).map(|j| l[j][i] * x[j]).sum();
                x[i] = (x[i] - sum) / l[i][i];
            }
            for (row, x) in inverse.iter_mut().zip(x) {
                row[column] = x;
            }
        }
        let log_det = 2.0 * (0..4).map(|i| l[i][i].ln()).sum::<f64>();
        Some((inverse, log_det))
    }
}

impl Prior {
    /// A described body. Where it is none, its second moments about the centre of mass are made
    /// as large as the smallest that a body of its mass may have.
    ///
    /// `None` without a mass.
    pub fn of(values: &[f64; 10]) -> Option<Prior> {
        let pseudo = Pseudo::of(values);
        let p = &pseudo.0;
        let mass = p[3][3];
        let finite = values.iter().all(|value| value.is_finite());
        if !finite || mass <= 0.0 {
            return None;
        }
        let center: [f64; 3] = std::array::from_fn(|i| p[i][3] / mass);
        let about = |i: usize, k: usize| p[i][k] / mass - center[i] * center[k];
        let about = Mat::from_fn(3, 3, about);
        let eigen = about.self_adjoint_eigen(Side::Lower).ok()?;
        let squares = eigen.S().column_vector();
        let largest = squares.iter().copied().fold(0.0, f64::max);
        let least = (LEAST_RADIUS * LEAST_RADIUS).max(LEAST_SHARE * LEAST_SHARE * largest);
        let mended = squares.iter().any(|square| *square < least);
        if !mended {
            return Some(Prior { pseudo, mended });
        }
        let axes = eigen.U();
        let entry = |i: usize, k: usize| match (i, k) {
            (3, 3) => mass,
            (3, at) | (at, 3) => mass * center[at],
            _ => {
                let own: f64 = (0..3)
                    .map(|e| axes[(i, e)] * axes[(k, e)] * squares[e].max(least))
                    .sum();
                mass * (own + center[i] * center[k])
            }
        };
        let square = std::array::from_fn(|i| std::array::from_fn(|k| entry(i, k)));
        Some(Prior {
            pseudo: Pseudo(square),
            mended,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_values_come_back_and_a_ball_is_a_body() {
        let values = [0.3, 0.01, -0.02, 0.4, 0.03, 0.25, 0.1, -0.2, 0.3, 2.0];
        for (a, b) in Pseudo::of(&values).values().iter().zip(values) {
            assert!((a - b).abs() < 1e-15);
        }
        let ball = Pseudo::ball(2.0, 0.1, [0.3, 0.0, -0.2]);
        assert!(ball.exists());
        // J = 2 m r^2 + m d^2 about an axis at the distance d.
        let inertia = ball.values();
        assert!((inertia[0] - 2.0 * (2.0 * 0.01 + 0.04)).abs() < 1e-15);
        assert!((inertia[3] - 2.0 * (2.0 * 0.01 + 0.13)).abs() < 1e-15);
    }

    #[test]
    fn inverse_is_one_and_triangle_inequality_is_what_exists_asks() {
        let ball = Pseudo::ball(1.5, 0.2, [0.1, 0.2, -0.3]);
        let (inverse, log_det) = ball.inverse().unwrap();
        let product =
            |i: usize, k: usize| (0..4).map(|j| ball.0[i][j] * inverse[j][k]).sum::<f64>();
        for place in 0..16 {
            let (i, k) = (place / 4, place % 4);
            assert!((product(i, k) - f64::from(u8::from(i == k))).abs() < 1e-12);
        }
        // About the centre of mass: m (m r^2)^3.
        assert!((log_det - (1.5_f64 * (1.5 * 0.04_f64).powi(3)).ln()).abs() < 1e-12);
        // XX > YY + ZZ: positive definite as a tensor, but no body has it.
        let none = [0.5, 0.0, 0.0, 0.2, 0.0, 0.2, 0.0, 0.0, 0.0, 1.0];
        assert!(!Pseudo::of(&none).exists());
    }

    #[test]
    fn described_rod_is_mended_and_a_body_is_left_alone() {
        let ball = Pseudo::ball(1.0, 0.1, [0.0, 0.5, 0.0]);
        assert_eq!(
            Prior::of(&ball.values()).map(|prior| prior.mended),
            Some(false)
        );
        let rod = [0.1, 0.0, 0.0, 0.0, 0.0, 0.1, 0.0, 0.5, 0.0, 1.0];
        let mended = Prior::of(&rod).unwrap();
        assert!(mended.mended && mended.pseudo.exists());
        assert_eq!(mended.pseudo.values()[9], 1.0);
        assert!((mended.pseudo.values()[7] - 0.5).abs() < 1e-15);
        assert_eq!(Prior::of(&[0.0; 10]), None);
    }
}
