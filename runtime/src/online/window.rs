//! The last samples of every joint, in one piece.

/// The last `len` samples of several signals. Every sample is kept twice, so that the window of a
/// signal always lies in one piece, oldest first.
#[derive(Clone, Debug)]
pub(super) struct Window {
    len: usize,
    next: usize,
    filled: usize,
    values: Vec<f64>,
}

impl Window {
    pub fn new(signals: usize, len: usize) -> Window {
        Window {
            len,
            next: 0,
            filled: 0,
            values: vec![0.0; 2 * len * signals],
        }
    }

    /// Adds a sample, one value per signal.
    pub fn push(&mut self, sample: &[f64]) {
        for (signal, value) in self.values.chunks_exact_mut(2 * self.len).zip(sample) {
            signal[self.next] = *value;
            signal[self.next + self.len] = *value;
        }
        self.next = (self.next + 1) % self.len;
        self.filled = (self.filled + 1).min(self.len);
    }

    /// Begins again.
    pub fn clear(&mut self) {
        self.filled = 0;
    }

    pub fn full(&self) -> bool {
        self.filled == self.len
    }

    /// The window of a signal, oldest sample first; of no meaning before it is full.
    pub fn of(&self, signal: usize) -> &[f64] {
        let start = 2 * self.len * signal + self.next;
        &self.values[start..start + self.len]
    }
}

/// Sums over a window with two or three sets of weights at once, in eight lanes, so that they run
/// as fast as the memory.
pub(super) fn sums<const N: usize>(window: &[f64], weights: [&[f64]; N]) -> [f64; N] {
    const LANES: usize = 8;
    let whole = window.len() / LANES * LANES;
    let mut lanes = [[0.0; LANES]; N];
    let mut at = 0;
    while at < whole {
        let values = &window[at..at + LANES];
        for (lanes, weights) in lanes.iter_mut().zip(&weights) {
            let weights = &weights[at..at + LANES];
            for ((sum, value), weight) in lanes.iter_mut().zip(values).zip(weights) {
                *sum += value * weight;
            }
        }
        at += LANES;
    }
    std::array::from_fn(|set| {
        let rest = window[whole..].iter().zip(&weights[set][whole..]);
        lanes[set].iter().sum::<f64>() + rest.map(|(value, weight)| value * weight).sum::<f64>()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_holds_the_last_samples_oldest_first() {
        let mut window = Window::new(2, 3);
        for i in 0..7 {
            assert_eq!(window.full(), i >= 3);
            window.push(&[f64::from(i), -f64::from(i)]);
        }
        assert_eq!(window.of(0), [4.0, 5.0, 6.0]);
        assert_eq!(window.of(1), [-4.0, -5.0, -6.0]);
        assert_eq!(sums(window.of(0), [&[1.0, 0.0, 2.0]]), [16.0]);
        window.clear();
        assert!(!window.full());
    }
}
