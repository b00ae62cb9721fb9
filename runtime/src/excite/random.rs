//! Numbers that look random and are the same everywhere, from a seed.

/// SplitMix64 (Steele, Lea and Flood 2014): small, and any two seeds are far apart.
pub(super) struct Random(u64);

impl Random {
    /// The stream of a seed and a place, such as that of a start.
    pub fn new(seed: u64, place: u64) -> Random {
        let mut random = Random(seed);
        let start = random.next() ^ place.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        Random(start)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform between -1 and 1.
    pub fn symmetric(&mut self) -> f64 {
        // The 53 upper bits, as a fraction of 2^53.
        (self.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_uniform_and_streams_differ() {
        let mut random = Random::new(3, 1);
        let values: Vec<f64> = (0..10_000).map(|_| random.symmetric()).collect();
        let mean = values.iter().sum::<f64>() / 1e4;
        let square = values.iter().map(|x| x * x).sum::<f64>() / 1e4;
        // Standard deviations of mean and mean square: 1/sqrt(3e4), sqrt(4/45)/100.
        assert!(mean.abs() < 4.0 * 0.006 && (square - 1.0 / 3.0).abs() < 4.0 * 0.003);
        assert!(values.iter().all(|x| x.abs() <= 1.0));
        assert_ne!(Random::new(3, 2).symmetric(), Random::new(3, 1).symmetric());
    }
}
