//! What a body's extent says of its parameters.
//!
//! Mass inside of an ellipsoid \\( (x - c)^T A (x - c) \le 1 \\) obeys, with the pseudo-inertia P,
//!
//! \\[ \int \left( 1 - (x - c)^T A (x - c) \right) dm = \mathrm{tr}(P Q) \ge 0, \qquad
//!    Q = \begin{pmatrix} -A & A c \\ c^T A & 1 - c^T A c \end{pmatrix} \\]
//!
//! and for an ellipsoid every P > 0 that does has a density inside of it (Wensing, Kim, Slotine
//! 2018). A box is inside of three slabs, each an ellipsoid without end in two directions; their
//! mean is the condition of the smallest ellipsoid around the box, so that they say more. A cylinder
//! is inside of a slab and of an ellipsoid without end along its axis.

use super::pseudo::{Pseudo, Square};

/// A shape that a body's mass is inside of, in the frame of its link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Its centre, m.
    pub center: [f64; 3],
    /// Its axes, orthonormal.
    pub axes: [[f64; 3]; 3],
    /// Which shape it is.
    pub shape: Shape,
}

/// Shapes, along the axes of an [`Extent`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Half of each edge, m.
    Box([f64; 3]),
    /// Radius about the third axis and half of the length along it, m.
    Cylinder(f64, f64),
    /// Radius, m.
    Sphere(f64),
}

impl Extent {
    /// A box along the axes of the frame, its half edges in m.
    pub fn upright(center: [f64; 3], half: [f64; 3]) -> Extent {
        Extent {
            center,
            axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            shape: Shape::Box(half),
        }
    }

    /// Factors of the ten parameters for each condition: their sum is not negative, kg.
    pub fn conditions(&self) -> Vec<[f64; 10]> {
        self.ellipsoids()
            .iter()
            .map(|a| factors(&self.center, a))
            .collect()
    }

    /// The smallest share of its mass that a condition of a body leaves: 1 where it is all at the
    /// centre, 0 where it just fits, negative where it does not.
    pub fn room(&self, pseudo: &Pseudo) -> f64 {
        let values = pseudo.values();
        let sum = |factors: &[f64; 10]| factors.iter().zip(values).map(|(f, v)| f * v).sum::<f64>();
        let conditions = self.conditions();
        let least = conditions.iter().map(sum).fold(f64::INFINITY, f64::min);
        least / values[9]
    }

    /// Half of the extent in its narrowest direction, m.
    pub fn narrowest(&self) -> f64 {
        match self.shape {
            Shape::Box([x, y, z]) => x.min(y).min(z),
            Shape::Cylinder(radius, half) => radius.min(half),
            Shape::Sphere(radius) => radius,
        }
    }

    /// A of each ellipsoid, 1/m^2.
    fn ellipsoids(&self) -> Vec<[[f64; 3]; 3]> {
        let of = |weights: [f64; 3]| {
            let entry = |i: usize, k: usize| {
                let pairs = self.axes.iter().zip(weights);
                pairs.map(|(axis, w)| w * axis[i] * axis[k]).sum()
            };
            std::array::from_fn(|i| std::array::from_fn(|k| entry(i, k)))
        };
        match self.shape {
            Shape::Box(half) => (0..3)
                .map(|axis| {
                    let mut weights = [0.0; 3];
                    weights[axis] = half[axis].powi(-2);
                    of(weights)
                })
                .collect(),
            Shape::Cylinder(radius, half) => {
                let round = radius.powi(-2);
                vec![of([round, round, 0.0]), of([0.0, 0.0, half.powi(-2)])]
            }
            Shape::Sphere(radius) => vec![of([radius.powi(-2); 3])],
        }
    }
}

/// tr(P Q) by the ten parameters, which P is linear in.
fn factors(center: &[f64; 3], a: &[[f64; 3]; 3]) -> [f64; 10] {
    let ac: [f64; 3] = std::array::from_fn(|i| (0..3).map(|k| a[i][k] * center[k]).sum());
    let cac: f64 = ac.iter().zip(center).map(|(a, c)| a * c).sum();
    let q: Square = std::array::from_fn(|i| {
        std::array::from_fn(|k| match (i, k) {
            (3, 3) => 1.0 - cac,
            (3, at) | (at, 3) => ac[at],
            _ => -a[i][k],
        })
    });
    std::array::from_fn(|place| {
        let mut unit = [0.0; 10];
        unit[place] = 1.0;
        let p = Pseudo::of(&unit).0;
        let pairs = p.iter().flatten().zip(q.iter().flatten());
        pairs.map(|(p, q)| p * q).sum()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Second moments of a homogeneous box about its centre are m l^2/3, l half of an edge.
    #[test]
    fn homogeneous_box_leaves_two_thirds_of_every_slab() {
        let half: [f64; 3] = [0.1, 0.2, 0.3];
        let center: [f64; 3] = [0.5, -0.1, 0.2];
        let mass = 3.0;
        let entry = |i: usize, k: usize| match (i, k) {
            (3, 3) => mass,
            (3, at) | (at, 3) => mass * center[at],
            _ => {
                let own = if i == k { half[i] * half[i] / 3.0 } else { 0.0 };
                mass * (own + center[i] * center[k])
            }
        };
        let square = std::array::from_fn(|i| std::array::from_fn(|k| entry(i, k)));
        let body = Pseudo(square);
        for factors in Extent::upright(center, half).conditions() {
            let sum: f64 = factors.iter().zip(body.values()).map(|(f, v)| f * v).sum();
            assert!((sum / mass - 2.0 / 3.0).abs() < 1e-13);
        }
        // Its corners are outside of it if the box is smaller by the root of a third.
        let small = half.map(|l| 0.57 * l);
        assert!(Extent::upright(center, small).room(&body) < 0.0);
    }

    #[test]
    fn mean_of_the_slabs_is_the_ellipsoid_around_the_box() {
        // Semi-axes of the smallest ellipsoid around a cube are the root of 3 times its half edge.
        let center = [0.1, 0.2, 0.3];
        let ball = Extent {
            shape: Shape::Sphere(0.2 * 3.0_f64.sqrt()),
            ..Extent::upright(center, [0.2; 3])
        };
        let slabs = Extent::upright(center, [0.2; 3]).conditions();
        for (place, ball) in ball.conditions()[0].iter().enumerate() {
            let mean = slabs.iter().map(|slab| slab[place]).sum::<f64>() / 3.0;
            assert!((mean - ball).abs() < 1e-12);
        }
    }

    #[test]
    fn point_on_the_edge_of_a_turned_cylinder_just_fits() {
        let extent = Extent {
            center: [0.3, 0.0, 0.1],
            axes: [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]],
            shape: Shape::Cylinder(0.05, 0.2),
        };
        let at = |x: [f64; 3]| extent.room(&Pseudo::ball(2.0, 0.0, x));
        assert!(at([0.5, 0.0, 0.1]).abs() < 1e-12);
        assert!(at([0.3, 0.03, 0.14]).abs() < 1e-12);
        assert!((at([0.3, 0.0, 0.1]) - 1.0).abs() < 1e-12);
        assert!(at([0.51, 0.0, 0.1]) < 0.0 && at([0.3, 0.06, 0.1]) < 0.0);
    }
}
