//! Whether inertial values are those of a body. What is not is a warning: the values are estimated
//! anyway, but as prior knowledge they are worth nothing.

use super::super::code;
use super::super::description::UrdfInertial;
use super::super::findings::{Findings, finding};

/// Rounding that CAD programs leave, as a fraction of the largest component.
const ROUNDING: f64 = 1e-6;

/// Reports a mass or an inertia that no body has; `places` are those of mass and inertia.
pub(super) fn check(
    link: &str,
    inertial: &UrdfInertial,
    places: (usize, usize),
    to: &mut Findings,
) {
    let largest = inertial
        .inertia
        .iter()
        .fold(0.0_f64, |most, part| most.max(part.abs()));
    let mass = inertial.mass;
    if mass < 0.0 || (mass == 0.0 && largest > 0.0) {
        let message = format!("link `{link}` has mass {mass}");
        let help = "masses are positive; a link without mass needs no <inertial>";
        to.warn(
            places.0,
            finding(code::MASS_NOT_POSITIVE, message).help(help),
        );
    }
    if largest == 0.0 {
        return;
    }
    let [xx, xy, xz, yy, yz, zz] = inertial.inertia.map(|part| part / largest);
    let why = if !is_positive([xx, xy, xz, yy, yz, zz]) {
        "is not positive semidefinite"
    } else if !is_positive(second_moments([xx, xy, xz, yy, yz, zz])) {
        "violates the triangle inequality: one principal moment exceeds the sum of the others"
    } else {
        return;
    };
    let message = format!("the inertia of link `{link}` {why}");
    let help = "no body has it; check units, signs and the order ixx ixy ixz iyy iyz izz";
    to.warn(
        places.1,
        finding(code::INERTIA_IMPOSSIBLE, message).help(help),
    );
}

/// The integral of r r^T, which is positive semidefinite exactly where the principal moments are
/// positive and obey the triangle inequality: tr(I)/2 - I.
fn second_moments([xx, xy, xz, yy, yz, zz]: [f64; 6]) -> [f64; 6] {
    let half = 0.5 * (xx + yy + zz);
    [half - xx, -xy, -xz, half - yy, -yz, half - zz]
}

/// Whether a symmetric matrix of order one is positive semidefinite: all its principal minors are.
fn is_positive([xx, xy, xz, yy, yz, zz]: [f64; 6]) -> bool {
    let pair = |a: f64, b: f64, c: f64| a * c - b * b;
    let determinant = xx * pair(yy, yz, zz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    let minors = [
        xx,
        yy,
        zz,
        pair(xx, xy, yy),
        pair(xx, xz, zz),
        pair(yy, yz, zz),
        determinant,
    ];
    minors.iter().all(|minor| *minor >= -ROUNDING)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_positive_knows_bodies_from_other_matrices() {
        let box_of_bricks = [2.0, -0.1, 0.2, 3.0, 0.1, 4.0];
        let flat_plate = [1.0, 0.0, 0.0, 1.0, 0.0, 2.0];
        for body in [box_of_bricks, flat_plate] {
            assert!(is_positive(body.map(|part| part / 4.0)));
            assert!(is_positive(second_moments(body.map(|part| part / 4.0))));
        }
        assert!(!is_positive([1.0, 2.0, 0.0, 1.0, 0.0, 1.0]));
        assert!(!is_positive(second_moments([0.1, 0.0, 0.0, 0.1, 0.0, 1.0])));
    }
}
