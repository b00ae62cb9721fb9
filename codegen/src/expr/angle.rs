//! Constant angles that know when they are right angles, and sums of joint angles.

use std::f64::consts::FRAC_PI_2;

/// A constant angle: an exact number of quarter turns plus a remainder.
///
/// Keeping right angles exact lets their sines and cosines fold to 0 and 1 in the graph.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angle {
    /// Quarter turns, 0 to 3.
    quarters: i32,
    /// What is left, rad, in (-pi/4, pi/4].
    rest: f64,
}

impl Angle {
    /// The zero angle.
    pub const ZERO: Angle = Angle {
        quarters: 0,
        rest: 0.0,
    };

    /// Below this distance from a multiple of pi/2 (rad) an angle is that multiple: far above the
    /// rounding of composed rotations, far below what a description can mean.
    const ROUNDING: f64 = 1e-9;

    /// A number of quarter turns.
    pub fn quarters(quarters: i32) -> Angle {
        Angle {
            quarters: quarters.rem_euclid(4),
            rest: 0.0,
        }
    }

    /// An angle in rad.
    pub fn radians(value: f64) -> Angle {
        let quarters = (value / FRAC_PI_2).round();
        let rest = value - quarters * FRAC_PI_2;
        let rest = if rest.abs() < Self::ROUNDING {
            0.0
        } else {
            rest
        };
        Angle {
            quarters: (quarters.rem_euclid(4.0)) as i32,
            rest,
        }
    }

    /// The same angle as a multiple of pi/2 if it is within `tolerance` (rad) of one.
    pub fn snapped(self, tolerance: f64) -> Angle {
        if self.rest.abs() <= tolerance {
            Angle { rest: 0.0, ..self }
        } else {
            self
        }
    }

    /// Distance to the nearest multiple of pi/2, rad.
    pub fn rest(self) -> f64 {
        self.rest
    }

    /// Number of quarter turns (0 to 3) if it is exactly that.
    pub fn right(self) -> Option<i32> {
        (self.rest == 0.0).then_some(self.quarters)
    }

    /// Value in (-pi, pi], rad.
    pub fn value(self) -> f64 {
        let quarters = if self.quarters == 3 {
            -1
        } else {
            self.quarters
        };
        let value = f64::from(quarters) * FRAC_PI_2 + self.rest;
        if value > std::f64::consts::PI {
            value - 4.0 * FRAC_PI_2
        } else {
            value
        }
    }

    /// Whether it is a multiple of a full turn.
    pub fn is_zero(self) -> bool {
        self.right() == Some(0)
    }

    /// Sine and cosine, exact for right angles.
    pub fn sin_cos(self) -> (f64, f64) {
        let (s, c) = if self.rest == 0.0 {
            (0.0, 1.0)
        } else {
            self.rest.sin_cos()
        };
        match self.quarters {
            0 => (s, c),
            1 => (c, -s),
            2 => (-s, -c),
            _ => (-c, s),
        }
    }

    /// Text such as `pi/2`, or the value in rad.
    pub fn text(self) -> String {
        match self.right() {
            Some(0) => "0".into(),
            Some(1) => "pi/2".into(),
            Some(2) => "pi".into(),
            Some(_) => "-pi/2".into(),
            None => format!("{}", self.value()),
        }
    }
}

impl std::ops::Add for Angle {
    type Output = Angle;
    fn add(self, other: Angle) -> Angle {
        let sum = Angle::radians(self.rest + other.rest);
        Angle {
            quarters: (sum.quarters + self.quarters + other.quarters).rem_euclid(4),
            ..sum
        }
    }
}

impl std::ops::Neg for Angle {
    type Output = Angle;
    fn neg(self) -> Angle {
        Angle {
            quarters: (-self.quarters).rem_euclid(4),
            rest: -self.rest,
        }
    }
}

/// A sum of joint angles along parallel axes plus a constant, such as q2 + q3 + pi/2.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleSum {
    /// Joints and the factor of each, 1 or -1 except where a joint follows another at its own
    /// ratio; ordered by joint, none of them 0.
    pub terms: Vec<(usize, f64)>,
    /// The constant.
    pub offset: Angle,
}

impl AngleSum {
    /// The angle of one joint plus a constant.
    pub fn joint(joint: usize, offset: Angle) -> AngleSum {
        AngleSum {
            terms: vec![(joint, 1.0)],
            offset,
        }
    }

    /// Angles of joints, each with its factor, ordered by joint, plus a constant.
    pub fn of(terms: &[(usize, f64)], offset: Angle) -> AngleSum {
        AngleSum {
            terms: terms.to_vec(),
            offset,
        }
    }

    /// A constant.
    pub fn constant(offset: Angle) -> AngleSum {
        AngleSum {
            terms: Vec::new(),
            offset,
        }
    }

    /// The sum of two sums.
    pub fn plus(&self, other: &AngleSum) -> AngleSum {
        let mut terms = self.terms.clone();
        for &(joint, factor) in &other.terms {
            match terms.iter_mut().find(|(known, _)| *known == joint) {
                Some(term) => term.1 += factor,
                None => terms.push((joint, factor)),
            }
        }
        terms.retain(|&(_, factor)| factor.abs() > Angle::ROUNDING);
        terms.sort_by_key(|&(joint, _)| joint);
        AngleSum {
            terms,
            offset: self.offset + other.offset,
        }
    }

    /// The opposite angle.
    pub fn negated(&self) -> AngleSum {
        AngleSum {
            terms: self
                .terms
                .iter()
                .map(|&(joint, factor)| (joint, -factor))
                .collect(),
            offset: -self.offset,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angle_near_a_quarter_turn_is_exact() {
        let angle = Angle::radians(FRAC_PI_2 - 5e-12);
        assert_eq!(angle.right(), Some(1));
        assert_eq!(angle.sin_cos(), (1.0, 0.0));
        assert_eq!(Angle::radians(-FRAC_PI_2).text(), "-pi/2");
    }

    #[test]
    fn angle_sum_and_negation_agree_with_radians() {
        for a in [-3.0, -1.2, 0.3, 1.5, 2.9] {
            for b in [-2.2, 0.0, 0.8, 3.1] {
                let (s, c) = (Angle::radians(a) + -Angle::radians(b)).sin_cos();
                assert!((s - (a - b).sin()).abs() < 1e-15 && (c - (a - b).cos()).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn angle_within_tolerance_snaps() {
        assert_eq!(Angle::radians(1.57).right(), None);
        assert_eq!(Angle::radians(1.57).snapped(1e-3).right(), Some(1));
    }
}
