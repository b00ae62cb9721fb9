//! Numbers and units as people read them.

use super::scale::minus;
use crate::report::table::{shorten, significant};

/// A number with that many significant digits.
pub(super) fn number(x: f64, digits: usize) -> String {
    minus(&significant(x, digits)).replace("e-", "e\u{2212}")
}

/// A percentage with three significant digits, but none after the point from a hundred on.
pub(super) fn percent(x: f64) -> String {
    match x {
        x if !x.is_finite() => "\u{2013}".to_owned(),
        x if x.abs() >= 999.5 => format!("{x:.0} %"),
        x if x.abs() < 0.001 && x != 0.0 => "< 0.001 %".to_owned(),
        x => format!("{} %", number(x, if x.abs() < 0.1 { 2 } else { 3 })),
    }
}

/// A value and its 2 sigma, both to the digit where 2 sigma has its second one.
pub(super) fn plus_minus(value: f64, sigma: f64) -> String {
    let spread = 2.0 * sigma;
    if !(spread > 0.0 && spread.is_finite() && value.is_finite()) {
        return number(value, 5);
    }
    let decimals = 1 - spread.log10().floor() as i32;
    match decimals {
        // Too long a row of digits either way.
        8.. | ..=-3 => format!("{} \u{b1} {}", number(value, 5), number(spread, 2)),
        decimals => {
            let decimals = decimals.max(0) as usize;
            let value = minus(&format!("{value:.decimals$}"));
            format!("{value} \u{b1} {spread:.decimals$}")
        }
    }
}

/// A unit with raised exponents: `kg m^2` as kg m\u{b2}.
pub(super) fn unit(unit: &str) -> String {
    unit.replace("^2", "\u{b2}")
        .replace("^3", "\u{b3}")
        .replace("^4", "\u{2074}")
}

/// `1 joint`, `2 joints`.
pub(super) fn count(n: usize, thing: &str) -> String {
    match n {
        1 => format!("1 {thing}"),
        n => format!("{n} {thing}s"),
    }
}

/// A list for a sentence, of the first few and how many more.
pub(super) fn list(items: &[String], most: usize) -> String {
    let more = items.len().saturating_sub(most);
    let first = items[..items.len() - more].join(", ");
    match more {
        0 => first,
        more => format!("{first} and {more} more"),
    }
}

/// A name that has to fit beside a drawing; the full one belongs in a `title`.
pub(super) fn short(name: &str, most: usize) -> String {
    shorten(name, most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_stop_where_their_sigma_does() {
        assert_eq!(plus_minus(95.1089, 0.1085), "95.11 \u{b1} 0.22");
        assert_eq!(plus_minus(-3.16, 0.5), "\u{2212}3.2 \u{b1} 1.0");
        assert_eq!(plus_minus(203.5, 11.0), "204 \u{b1} 22");
        assert_eq!(plus_minus(1.5, 0.0), "1.5000");
        assert_eq!(plus_minus(1.5, 1e-12), "1.5000 \u{b1} 2.0e\u{2212}12");
    }

    #[test]
    fn percentages_are_short() {
        let texts = [12.345, 0.01234, 1234.5, 1e-9, f64::NAN].map(percent);
        assert_eq!(
            texts,
            ["12.3 %", "0.012 %", "1234 %", "< 0.001 %", "\u{2013}"]
        );
    }

    #[test]
    fn lists_and_units_read_well() {
        let items = ["a", "b", "c"].map(str::to_owned);
        assert_eq!(list(&items, 2), "a, b and 1 more");
        assert_eq!(list(&items, 3), "a, b, c");
        assert_eq!(unit("kg m^2"), "kg m\u{b2}");
        assert_eq!(
            (count(1, "joint"), count(2, "joint")),
            ("1 joint".into(), "2 joints".into())
        );
    }
}
