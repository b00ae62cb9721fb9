//! Units that columns of a log may be given in, and what they are in SI.

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// Stamps, s.
    Time,
    /// rad, or m.
    Position,
    /// rad/s, or m/s.
    Velocity,
    /// N m, or N.
    Torque,
    /// What a drive reports: current or voltage; the drive gain makes it a torque.
    Drive,
}

use Quantity::{Drive, Position, Time, Torque, Velocity};

const DEGREE: f64 = std::f64::consts::PI / 180.0;
const TURN: f64 = std::f64::consts::TAU;

/// Spelling, what it measures, factor to SI. Angles and lengths are not told apart: which one a
/// column holds follows from its joint.
const UNITS: [(&str, Quantity, f64); 33] = [
    ("s", Time, 1.0),
    ("ms", Time, 1e-3),
    ("us", Time, 1e-6),
    ("ns", Time, 1e-9),
    ("min", Time, 60.0),
    ("rad", Position, 1.0),
    ("mrad", Position, 1e-3),
    ("deg", Position, DEGREE),
    ("rev", Position, TURN),
    ("m", Position, 1.0),
    ("cm", Position, 1e-2),
    ("mm", Position, 1e-3),
    ("um", Position, 1e-6),
    ("rad/s", Velocity, 1.0),
    ("mrad/s", Velocity, 1e-3),
    ("deg/s", Velocity, DEGREE),
    ("rpm", Velocity, TURN / 60.0),
    ("rev/s", Velocity, TURN),
    ("m/s", Velocity, 1.0),
    ("cm/s", Velocity, 1e-2),
    ("mm/s", Velocity, 1e-3),
    ("N.m", Torque, 1.0),
    ("N m", Torque, 1.0),
    ("Nm", Torque, 1.0),
    ("mN.m", Torque, 1e-3),
    ("mNm", Torque, 1e-3),
    ("kN.m", Torque, 1e3),
    ("N", Torque, 1.0),
    ("kN", Torque, 1e3),
    ("A", Drive, 1.0),
    ("mA", Drive, 1e-3),
    ("V", Drive, 1.0),
    ("mV", Drive, 1e-3),
];

/// The factor from `unit` to SI for a column of this quantity.
///
/// # Errors
/// The message says which units would do.
pub(super) fn factor(unit: &str, quantity: Quantity) -> Result<f64, String> {
    let fits = |of: Quantity| of == quantity;
    match UNITS.iter().find(|(name, ..)| *name == unit) {
        Some(&(_, of, factor)) if fits(of) => Ok(factor),
        known => {
            let allowed: Vec<&str> = UNITS
                .iter()
                .filter(|u| fits(u.1))
                .map(|(name, ..)| *name)
                .collect();
            let what = if known.is_some() {
                "does not fit this column"
            } else {
                "is not known"
            };
            Err(format!(
                "unit `{unit}` {what}; one of {}",
                allowed.join(", ")
            ))
        }
    }
}

/// A column's name without its unit, and the unit: `q1` and `deg` for `q1 [deg]`, `q1 (\u{b0})`.
pub(super) fn split(column: &str) -> (&str, Option<String>) {
    let unit = |open: char, close: char| {
        let (name, unit) = column.strip_suffix(close)?.rsplit_once(open)?;
        let (name, unit) = (name.trim(), unit.trim());
        (!name.is_empty() && !unit.is_empty()).then_some((name, unit))
    };
    let Some((name, unit)) = unit('[', ']').or_else(|| unit('(', ')')) else {
        return (column, None);
    };
    let mut unit = unit
        .replace('\u{b0}', "deg")
        .replace(['\u{b5}', '\u{3bc}'], "u")
        .replace(['\u{b7}', '\u{22c5}', '*'], ".");
    // A number without a unit.
    if unit == "-" {
        unit.clear();
    }
    (name, Some(unit).filter(|unit| !unit.is_empty()))
}

/// Whether a unit of position or velocity turns (`true`) or translates; `None` for other units.
pub(super) fn is_angular(unit: &str) -> Option<bool> {
    let base = unit.trim_end_matches("/s");
    match base {
        "rad" | "mrad" | "deg" | "rev" | "rpm" => Some(true),
        "m" | "cm" | "mm" | "um" => Some(false),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factor_of_a_known_unit_leads_to_si() {
        assert_eq!(factor("deg", Position), Ok(DEGREE));
        assert_eq!(factor("mm", Position), Ok(1e-3));
        assert_eq!(factor("us", Time), Ok(1e-6));
        assert!((factor("rpm", Velocity).unwrap() * 60.0 - std::f64::consts::TAU).abs() < 1e-12);
    }

    #[test]
    fn unit_in_a_header_is_split_off() {
        for (column, name, unit) in [
            ("q1 [deg]", "q1", Some("deg")),
            ("q1(\u{b0}/s)", "q1", Some("deg/s")),
            ("t [\u{b5}s]", "t", Some("us")),
            ("tau1 [N\u{b7}m]", "tau1", Some("N.m")),
            ("q1 [-]", "q1", None),
            ("q1", "q1", None),
            ("[deg]", "[deg]", None),
            ("q[1]", "q", Some("1")),
        ] {
            assert_eq!(split(column), (name, unit.map(String::from)), "{column}");
        }
    }

    #[test]
    fn factor_of_a_wrong_unit_names_those_that_fit() {
        let message = factor("deg", Velocity).unwrap_err();
        assert!(
            message.contains("does not fit") && message.contains("deg/s"),
            "{message}"
        );
        let message = factor("minutes", Time).unwrap_err();
        assert!(
            message.contains("not known") && message.contains("min"),
            "{message}"
        );
    }
}
