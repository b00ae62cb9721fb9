//! Order statistics of values that are too many to hold: exact, in four walks along them.

use super::error::Found;

/// Digits of the sort key are this wide, bits.
const DIGIT: u32 = 16;

/// The value that stands at place `rank` (from 0) when all are sorted by `total_cmp`; `walk` shows
/// every value and is called four times. NaN if there are not so many.
///
/// Selection by the digits of a key, the highest first: each walk counts the values that share the
/// digits found so far by their next digit.
pub(super) fn select(rank: usize, walk: impl Fn(&mut dyn FnMut(f64)) -> Found<()>) -> Found<f64> {
    let (mut found, mut rank) = (0_u64, rank as u64);
    let mut counts = vec![0_u64; 1 << DIGIT];
    for shift in [48, 32, 16, 0] {
        counts.fill(0);
        walk(&mut |value| {
            let digits = key(value) >> shift;
            if digits >> DIGIT == found
                && let Some(count) = counts.get_mut((digits & 0xffff) as usize)
            {
                *count += 1;
            }
        })?;
        let digit = counts.iter().position(|&count| {
            let here = rank < count;
            rank = if here { rank } else { rank - count };
            here
        });
        let Some(digit) = digit else {
            return Ok(f64::NAN);
        };
        found = found << DIGIT | digit as u64;
    }
    Ok(value(found))
}

/// An integer that sorts as the value does.
fn key(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits >> 63 == 0 {
        bits | 1 << 63
    } else {
        !bits
    }
}

fn value(key: u64) -> f64 {
    f64::from_bits(if key >> 63 == 1 {
        key & !(1 << 63)
    } else {
        !key
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn value_of_any_rank_is_the_sorted_one() {
        let values: Vec<f64> = (0..1000)
            .map(|k| (f64::from(k) * 0.7).sin() * 10.0_f64.powi(k % 7 - 3))
            .chain([0.0, -0.0, f64::INFINITY, 1.5, 1.5])
            .collect();
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        for rank in [0, 1, 500, 501, 502, 503, 1004] {
            let found = select(rank, |see| {
                values.iter().for_each(|&value| see(value));
                Ok(())
            });
            assert_eq!(found.unwrap().to_bits(), sorted[rank].to_bits());
        }
        assert!(select(0, |_| Ok(())).unwrap().is_nan());
    }
}
