//! Angles that are meant to be multiples of pi/2.
//!
//! An rpy of 1.57 left as it is costs a third more operations in the generated code and blurs the
//! rank, so what is close to a multiple is taken as the multiple, and reported.

use std::f64::consts::FRAC_PI_2;

/// What is closer than this to a multiple of pi/2 is taken as the multiple, rad.
pub const TOLERANCE: f64 = 1e-3;

/// What is moved by more than this is reported, rad; below it is the rounding of `1.570796`.
pub const REPORTED: f64 = 1e-6;

/// The multiple of pi/2 that an angle stands for, with the number of quarter turns; the angle
/// itself and `None` when it stands for none.
///
/// The multiple is always computed as `k * FRAC_PI_2`, so that equal angles are equal bits.
pub fn snap(angle: f64) -> (f64, Option<i32>) {
    let turns = (angle / FRAC_PI_2).round();
    // Beyond this the angle is no orientation that anybody wrote down.
    if turns.is_nan() || turns.abs() > 1e6 {
        return (angle, None);
    }
    let turns = turns as i32;
    let multiple = f64::from(turns) * FRAC_PI_2;
    if (angle - multiple).abs() <= TOLERANCE {
        (multiple, Some(turns))
    } else {
        (angle, None)
    }
}

/// The name of `turns` quarter turns: `0`, `pi/2`, `-pi`, `3*pi/2`.
pub fn quarter_turns(turns: i32) -> String {
    let sign = if turns < 0 { "-" } else { "" };
    let size = turns.unsigned_abs();
    let (count, half) = if size.is_multiple_of(2) {
        (size / 2, "")
    } else {
        (size, "/2")
    };
    match count {
        0 => "0".to_owned(),
        1 => format!("{sign}pi{half}"),
        _ => format!("{sign}{count}*pi{half}"),
    }
}

/// A unit vector that is close to a coordinate axis, as that axis: index, sign, and the angle
/// between them in rad.
pub fn snap_axis(axis: [f64; 3]) -> Option<(usize, f64, f64)> {
    let longest = (0..3).max_by(|&i, &j| axis[i].abs().total_cmp(&axis[j].abs()))?;
    let across = (0..3).filter(|&i| i != longest);
    if across.clone().any(|i| axis[i].abs() > TOLERANCE) {
        return None;
    }
    let tilt = across.map(|i| axis[i] * axis[i]).sum::<f64>().sqrt();
    Some((
        longest,
        axis[longest].signum(),
        tilt.atan2(axis[longest].abs()),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn snap_close_to_a_multiple_gives_the_exact_multiple() {
        assert_eq!(snap(1.57), (FRAC_PI_2, Some(1)));
        assert_eq!(snap(-1.5705), (-FRAC_PI_2, Some(-1)));
        assert_eq!(snap(3.1412), (PI, Some(2)));
        assert_eq!(snap(-4e-4), (0.0, Some(0)));
        assert!(snap(-4e-4).0.is_sign_positive());
    }

    #[test]
    fn snap_elsewhere_leaves_the_angle() {
        for angle in [0.002, 1.569, 0.785, 1e300, f64::INFINITY] {
            assert_eq!(snap(angle), (angle, None));
        }
        assert_eq!(snap(f64::NAN).1, None);
    }

    #[test]
    fn quarter_turns_are_written_as_people_do() {
        let names: Vec<String> = (-3..=4).map(quarter_turns).collect();
        assert_eq!(
            names,
            [
                "-3*pi/2", "-pi", "-pi/2", "0", "pi/2", "pi", "3*pi/2", "2*pi"
            ]
        );
    }

    #[test]
    fn snap_axis_finds_the_axis_and_its_sign() {
        assert_eq!(snap_axis([0.0, -1.0, 0.0]), Some((1, -1.0, 0.0)));
        let (axis, sign, tilt) = snap_axis([1.0, 0.0, 8e-4]).unwrap();
        assert_eq!((axis, sign), (0, 1.0));
        assert!((tilt - 8e-4).abs() < 1e-9);
        assert_eq!(snap_axis([0.6, 0.8, 0.0]), None);
    }
}
