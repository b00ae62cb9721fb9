//! Inertial values as a URDF: put into one that is there ([`rewrite`]), or a new one of a robot's
//! frames ([`fresh()`]). Friction of the joints goes the same way ([`with_dynamics`]).

mod dynamics;
mod edit;
mod fresh;
mod rewrite;

pub use dynamics::{Dynamics, dynamics, with_dynamics};
pub use fresh::fresh;
pub use rewrite::{UrdfError, rewrite};

use nalgebra::{Matrix3, Vector3};

use crate::describe::{Pose, UrdfInertial};
use crate::mechanism::Standard;

/// Inertial values about the centre of mass, in the axes of the link's frame, as a URDF has them.
/// A body without mass has them about the origin.
pub fn inertial(body: &Standard) -> UrdfInertial {
    let com = match body.mass {
        mass if mass > 0.0 => body.moment / mass,
        _ => Vector3::zeros(),
    };
    let steiner = Matrix3::identity() * com.dot(&com) - com * com.transpose();
    let j = body.inertia - body.mass * steiner;
    UrdfInertial {
        mass: body.mass,
        origin: Pose {
            rpy: [0.0; 3],
            xyz: com.into(),
        },
        inertia: [
            j[(0, 0)],
            j[(0, 1)],
            j[(0, 2)],
            j[(1, 1)],
            j[(1, 2)],
            j[(2, 2)],
        ],
    }
}

/// Names of the attributes of `<inertia>`, in the order of [`UrdfInertial::inertia`].
const INERTIA: [&str; 6] = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];

/// Three numbers as an attribute has them.
fn triple(values: [f64; 3]) -> String {
    let [x, y, z] = values.map(|value| value + 0.0);
    format!("{x} {y} {z}")
}

#[cfg(test)]
mod tests;
