//! The ten standard inertial parameters of a link, and how they move with their frame.

use nalgebra::{Matrix3, Vector3};

use super::pose::Pose;
use crate::describe::UrdfInertial;

/// Inertia about the frame's origin (not about the centre of mass), first moments, mass; SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standard {
    /// XX XY XZ YY YZ ZZ as a symmetric matrix, kg m^2.
    pub inertia: Matrix3<f64>,
    /// MX MY MZ, kg m.
    pub moment: Vector3<f64>,
    /// M, kg.
    pub mass: f64,
}

/// Names of the ten parameters in the order of [`Standard::values`].
pub const NAMES: [&str; 10] = ["XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M"];

impl Standard {
    /// A link without mass.
    pub fn zero() -> Standard {
        Standard {
            inertia: Matrix3::zeros(),
            moment: Vector3::zeros(),
            mass: 0.0,
        }
    }

    /// From the ten values in the order of [`NAMES`].
    pub fn from_values(values: [f64; 10]) -> Standard {
        let [xx, xy, xz, yy, yz, zz, mx, my, mz, mass] = values;
        Standard {
            inertia: Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
            moment: Vector3::new(mx, my, mz),
            mass,
        }
    }

    /// From a URDF's values about the centre of mass to the frame of its link
    /// (parallel-axis theorem).
    pub fn from_urdf(inertial: &UrdfInertial) -> Standard {
        let [xx, xy, xz, yy, yz, zz] = inertial.inertia;
        let central = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let about_com = Standard {
            inertia: central,
            moment: Vector3::zeros(),
            mass: inertial.mass,
        };
        about_com.moved(&Pose::from_rpy(&inertial.origin))
    }

    /// The same body expressed in another frame; `pose` leads from the present frame to the new
    /// one's coordinates (x_new = R x + p).
    pub fn moved(&self, pose: &Pose) -> Standard {
        let (r, p) = (&pose.rotation, &pose.translation);
        let moment = r * self.moment;
        // Steiner with first moments: J' = R J R^T + [p]-terms, exact also where the mass is zero.
        let cross = moment * p.transpose() + p * moment.transpose();
        let steiner = Matrix3::identity() * (2.0 * moment.dot(p) + self.mass * p.dot(p))
            - cross
            - self.mass * p * p.transpose();
        Standard {
            inertia: r * self.inertia * r.transpose() + steiner,
            moment: moment + self.mass * p,
            mass: self.mass,
        }
    }

    /// Two bodies as one.
    pub fn plus(&self, other: &Standard) -> Standard {
        Standard {
            inertia: self.inertia + other.inertia,
            moment: self.moment + other.moment,
            mass: self.mass + other.mass,
        }
    }

    /// XX XY XZ YY YZ ZZ MX MY MZ M.
    pub fn values(&self) -> [f64; 10] {
        let (j, m) = (&self.inertia, &self.moment);
        [
            j[(0, 0)],
            j[(0, 1)],
            j[(0, 2)],
            j[(1, 1)],
            j[(1, 2)],
            j[(2, 2)],
            m.x,
            m.y,
            m.z,
            self.mass,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Angle;
    use crate::mechanism::pose::{about_x, about_z};

    #[test]
    fn moved_point_masses_match_their_definition() {
        let points = [
            (1.5, Vector3::new(0.1, -0.2, 0.3)),
            (0.7, Vector3::new(-0.4, 0.05, 0.2)),
        ];
        let pose = Pose {
            rotation: about_z(Angle::radians(0.7)) * about_x(Angle::radians(-1.1)),
            translation: Vector3::new(0.3, -0.1, 0.6),
        };
        let body = |map: &dyn Fn(Vector3<f64>) -> Vector3<f64>| {
            points.iter().fold(Standard::zero(), |sum, &(mass, point)| {
                let x = map(point);
                let inertia = mass * (Matrix3::identity() * x.dot(&x) - x * x.transpose());
                sum.plus(&Standard {
                    inertia,
                    moment: mass * x,
                    mass,
                })
            })
        };
        let direct = body(&|x| pose.rotation * x + pose.translation).values();
        let moved = body(&|x| x).moved(&pose).values();
        for (a, b) in direct.iter().zip(moved) {
            assert!((a - b).abs() < 1e-14);
        }
    }
}
