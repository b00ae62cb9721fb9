//! Numbers in text, exactly rounded: the value is always the `f64` nearest to the decimals.

/// Powers of ten that an `f64` holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// Integers up to here are `f64`s.
const WHOLE: u64 = 1 << 53;

/// A mantissa of so many digits still fits a `u64`.
const MOST_DIGITS: usize = 19;

/// The plain decimal number at the beginning of `text`, and how many bytes it takes; `None` for
/// anything that is not one (`nan`, nothing, `1.`, ...), which [`field`] may still understand.
///
/// A mantissa below 2^53 and a power of ten up to 22 are both exact, so that one multiplication or
/// division rounds correctly (Clinger 1990); everything else goes to the standard library.
#[inline]
pub(super) fn leading(text: &[u8], comma: bool) -> Option<(f64, usize)> {
    let negative = text.first() == Some(&b'-');
    let start = usize::from(negative || text.first() == Some(&b'+'));
    let (mut mantissa, whole_end) = digits(text, start, 0);
    let mut at = whole_end;
    let mut count = whole_end - start;
    let mut power = 0;
    let point = text.get(at).copied();
    let decimal_comma = comma && point == Some(b',');
    if point == Some(b'.') || decimal_comma {
        let (with_fraction, end) = digits(text, at + 1, mantissa);
        power = -((end - at - 1) as i32);
        count += end - at - 1;
        mantissa = with_fraction;
        at = end;
    }
    if count == 0 {
        return None;
    }
    if matches!(text.get(at), Some(b'e' | b'E')) {
        let (exponent, end) = exponent(text, at + 1)?;
        power += exponent;
        at = end;
    }
    let exact = count <= MOST_DIGITS && mantissa <= WHOLE && (-22..=22).contains(&power);
    if !exact {
        return general(text.get(..at)?, decimal_comma).map(|value| (value, at));
    }
    let size = match POWERS.get(power.unsigned_abs() as usize) {
        Some(scale) if power < 0 => mantissa as f64 / scale,
        Some(scale) => mantissa as f64 * scale,
        None => return None,
    };
    Some((if negative { -size } else { size }, at))
}

/// Digits from `at` on, appended to `value`, and where they end. More than fit wrap around: the
/// caller counts them.
#[inline]
fn digits(text: &[u8], mut at: usize, mut value: u64) -> (u64, usize) {
    while let Some(eight) = text.get(at..at + 8).and_then(|eight| eight.try_into().ok()) {
        let Some(number) = eight_digits(u64::from_le_bytes(eight)) else {
            break;
        };
        value = value.wrapping_mul(100_000_000).wrapping_add(number);
        at += 8;
    }
    while let Some(digit) = text.get(at).map(|byte| byte.wrapping_sub(b'0')) {
        if digit > 9 {
            break;
        }
        value = value.wrapping_mul(10).wrapping_add(u64::from(digit));
        at += 1;
    }
    (value, at)
}

/// The number that eight bytes spell, all at once, if all are digits (Lemire 2018, "Quickly parsing
/// eight digits").
#[inline]
fn eight_digits(bytes: u64) -> Option<u64> {
    const ZEROS: u64 = 0x3030_3030_3030_3030;
    const TENS: u64 = 0xf0f0_f0f0_f0f0_f0f0;
    let high = bytes & TENS;
    let beyond_nine = bytes.wrapping_add(0x0606_0606_0606_0606) & TENS;
    if high != ZEROS || beyond_nine != ZEROS {
        return None;
    }
    let ones = bytes - ZEROS;
    let pairs = ones.wrapping_mul(10).wrapping_add(ones >> 8);
    const MASK: u64 = 0x0000_00ff_0000_00ff;
    let low = (pairs & MASK).wrapping_mul(0x000f_4240_0000_0064);
    let high = ((pairs >> 16) & MASK).wrapping_mul(0x0000_2710_0000_0001);
    Some(low.wrapping_add(high) >> 32)
}

/// The exponent behind an `e`, and where it ends.
fn exponent(text: &[u8], at: usize) -> Option<(i32, usize)> {
    let negative = text.get(at) == Some(&b'-');
    let start = at + usize::from(negative || text.get(at) == Some(&b'+'));
    let (value, end) = digits(text, start, 0);
    let few = (1..=6).contains(&(end - start));
    let value = i32::try_from(value).ok().filter(|_| few)?;
    Some((if negative { -value } else { value }, end))
}

#[cold]
fn general(text: &[u8], decimal_comma: bool) -> Option<f64> {
    let text = std::str::from_utf8(text).ok()?;
    if decimal_comma {
        text.replace(',', ".").parse().ok()
    } else {
        text.parse().ok()
    }
}

/// The number in a whole field; an empty field is NaN. A decimal comma is understood where `comma`
/// says that it separates nothing.
pub(super) fn field(field: &[u8], comma: bool) -> Option<f64> {
    let text = std::str::from_utf8(field).ok()?.trim();
    if text.is_empty() {
        return Some(f64::NAN);
    }
    let plain = text.parse().ok();
    if comma {
        plain.or_else(|| text.replace(',', ".").parse().ok())
    } else {
        plain
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn number_in_any_spelling_of_a_logger_is_read() {
        assert_eq!(field(b"-1.5e-3", false), Some(-1.5e-3));
        assert_eq!(field(b"  2 ", false), Some(2.0));
        assert_eq!(field(b"0,25", true), Some(0.25));
        assert_eq!(field(b"0,25", false), None);
        assert!(field(b"", false).is_some_and(f64::is_nan));
        assert!(field(b"NaN", false).is_some_and(f64::is_nan));
        assert_eq!(field(b"\xff", false), None);
        assert_eq!(field(b"1.2.3", true), None);
    }

    #[test]
    fn number_that_leads_ends_where_its_digits_end() {
        assert_eq!(leading(b"12.5,3", false), Some((12.5, 4)));
        assert_eq!(leading(b"-12,5;3", true), Some((-12.5, 5)));
        assert_eq!(leading(b"1.e2\n", false), Some((100.0, 4)));
        assert_eq!(leading(b"1e-5", false), Some((1e-5, 4)));
        assert_eq!(leading(b".5", false), Some((0.5, 2)));
        for none in [&b""[..], b"-", b".", b"nan", b"e5", b"1e", b"1e+", b" 1"] {
            assert_eq!(leading(none, false), None);
        }
    }

    /// What the standard library reads, and all of it.
    fn agrees(text: &str) {
        let expected: f64 = text.parse().unwrap();
        let (found, end) = leading(text.as_bytes(), false).unwrap();
        assert_eq!(
            (found.to_bits(), end),
            (expected.to_bits(), text.len()),
            "{text}"
        );
    }

    #[test]
    fn number_is_rounded_exactly_at_the_edges() {
        for text in [
            "9007199254740993",
            "9007199254740992",
            "0.1",
            "1e22",
            "1e23",
            "123456789012345678901234567890",
            "2.2250738585072011e-308",
            "4.9e-324",
            "1.7976931348623157e308",
            "-0.0",
            "00000000000000000000001.5",
            "0.000000000000000000000000000001",
            "9007199254740992e22",
            "18446744073709551616",
            "1e400",
            "5e-5",
        ] {
            agrees(text);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn number_of_any_bits_is_read_as_the_standard_library_does(bits in any::<u64>(), digits in 0..18_usize) {
            let value = f64::from_bits(bits);
            prop_assume!(value.is_finite());
            agrees(&format!("{value}"));
            agrees(&format!("{value:e}"));
            agrees(&format!("{value:.digits$e}"));
            let near = (bits % 100_000) as f64 * 1e-3 + value.fract();
            agrees(&format!("{near:.digits$}"));
        }
    }
}
