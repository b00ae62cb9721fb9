//! One causal filter over many signals side by side, a sample at a time.

use crate::signal::{Cascade, Section};

/// States smaller than this are zero: what a joint's rest leaves of its last motion must not fade
/// into numbers so small that the processor slows down over them.
const FADED: f64 = 1e-140;

/// A chain of second-order sections and its states for `signals` signals, direct form II
/// transposed. It begins with states of zero: then what goes out is a weighted sum of what came
/// in, with the same weights for every signal, and an equation among signals stays one.
#[derive(Clone, Debug)]
pub(super) struct Bank {
    sections: Vec<Section>,
    /// Both states of every signal, section by section.
    states: Vec<[Vec<f64>; 2]>,
}

impl Bank {
    pub fn new(cascade: &Cascade, signals: usize) -> Bank {
        let sections = cascade.sections().to_vec();
        let none = || [vec![0.0; signals], vec![0.0; signals]];
        Bank {
            states: sections.iter().map(|_| none()).collect(),
            sections,
        }
    }

    /// Filters one sample of all signals in place.
    pub fn step(&mut self, sample: &mut [f64]) {
        for (section, [first, second]) in self.sections.iter().zip(&mut self.states) {
            let Section { b, a } = *section;
            let states = first.iter_mut().zip(second);
            for (x, (s1, s2)) in sample.iter_mut().zip(states) {
                let y = b[0] * *x + *s1;
                *s1 = audible(b[1] * *x - a[0] * y + *s2);
                *s2 = audible(b[2] * *x - a[1] * y);
                *x = y;
            }
        }
    }

    /// Forgets all that came in.
    pub fn clear(&mut self) {
        self.states.iter_mut().flatten().for_each(|s| s.fill(0.0));
    }
}

fn audible(state: f64) -> f64 {
    if state.abs() < FADED { 0.0 } else { state }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::butterworth;

    #[test]
    fn what_fades_away_is_zero_and_never_slows_the_loop_down() {
        let mut bank = Bank::new(&butterworth(4, 16.0, 1000.0).unwrap(), 2);
        bank.step(&mut [1.0, -3.0]);
        // The slowest pole fades by exp(-38 t): to 1e-140 in 8.4 s, to what is no normal number in 19 s.
        for _ in 0..10_000 {
            let mut sample = [0.0; 2];
            bank.step(&mut sample);
            assert!(sample.iter().all(|x| *x == 0.0 || x.is_normal()));
        }
        let states = bank.states.iter().flatten().flatten();
        assert!(states.copied().all(|state| state == 0.0));
    }

    #[test]
    fn a_constant_passes_and_an_equation_holds_from_the_first_sample_on() {
        let mut bank = Bank::new(&butterworth(4, 16.0, 1000.0).unwrap(), 3);
        for i in 0..2000 {
            let x = (f64::from(i) * 0.01).sin();
            let mut sample = [1.0, x, 3.0 - 2.0 * x];
            bank.step(&mut sample);
            assert!((sample[2] - (3.0 * sample[0] - 2.0 * sample[1])).abs() < 1e-12);
            if i == 1999 {
                assert!((sample[0] - 1.0).abs() < 1e-12);
            }
        }
    }
}
