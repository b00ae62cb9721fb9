//! One equation under watch: learning its noise, then its reference, then comparing.

use super::super::factor::Factor;
use super::change;
use super::colour::{Colour, Past};
use super::spread::{Comparison, Spread};
use super::{Deviation, Health, WatchOptions};
use crate::diagnose::noise::Noise;
use crate::online::Equation;

/// Whitened rows of a stretch of time.
#[derive(Clone, Debug)]
struct Block {
    factor: Factor,
    /// The sample at which it began.
    since: u64,
}

#[derive(Clone, Debug)]
pub(super) struct Watched {
    /// The stored parameters of the columns that the equation sees.
    stored: Vec<f64>,
    places: Vec<usize>,
    /// Equations in a block, and blocks of the two phases.
    rows: usize,
    reference_blocks: usize,
    window: usize,
    past: Past,
    last: u64,
    colour: Colour,
    noise: Option<Noise>,
    white: Vec<f64>,
    block: Block,
    /// Blocks of the reference while it is learned, then the last ones.
    ring: Vec<Block>,
    newest: usize,
    filled: usize,
    reference: Factor,
    /// Under way once the reference is whole.
    comparison: Comparison,
    comparing: bool,
    spread: Option<Spread>,
    new: Factor,
    both: Factor,
}

impl Watched {
    pub fn new(equation: &Equation, parameters: &[f64], rows: usize, o: &WatchOptions) -> Watched {
        let stored: Vec<f64> = equation.columns.iter().map(|c| parameters[*c]).collect();
        let width = stored.len() + 1;
        let block = Block {
            factor: Factor::new(width),
            since: 0,
        };
        Watched {
            places: (0..stored.len()).collect(),
            rows,
            reference_blocks: o.reference,
            window: o.window,
            past: Past::new(width),
            last: 0,
            colour: Colour::default(),
            noise: None,
            white: vec![0.0; width],
            ring: vec![block.clone(); o.reference.max(o.window)],
            newest: 0,
            filled: 0,
            reference: block.factor.clone(),
            comparison: Comparison::new(width, o.reference),
            comparing: false,
            spread: None,
            new: block.factor.clone(),
            both: block.factor.clone(),
            block,
            stored,
        }
    }

    /// Takes the equation of an instant; it follows the last if it comes `nd` samples after it.
    pub fn add(&mut self, equation: &Equation, sample: u64, nd: u64) {
        if sample != self.last + nd || !equation.moves {
            self.past.clear();
        }
        self.last = sample;
        if !equation.moves {
            return;
        }
        let products = equation.w.iter().zip(&self.stored);
        let predicted: f64 = products.map(|(w, x)| w * x).sum();
        let row = self.past.next();
        if let Some((residual, w)) = row.split_last_mut() {
            w.copy_from_slice(&equation.w);
            *residual = equation.y - predicted;
        }
        match &self.noise {
            None => self.learn_noise(),
            Some(noise) => {
                if self.past.whiten(noise, &mut self.white) {
                    self.fold(sample);
                }
            }
        }
    }

    fn learn_noise(&mut self) {
        self.colour.add(&self.past);
        if self.colour.count() >= (self.rows * self.reference_blocks) as f64 {
            self.noise = Some(self.colour.noise());
        }
    }

    fn fold(&mut self, sample: u64) {
        if self.block.factor.rows == 0.0 {
            self.block.since = sample;
        }
        let Some((residual, w)) = self.white.split_last() else {
            return;
        };
        self.block.factor.add(&self.places, w, *residual, 1.0);
        match self.comparing {
            true => self.compare(),
            false if self.spread.is_none() => {
                self.reference.add(&self.places, w, *residual, 1.0);
            }
            false => {}
        }
        if self.block.factor.rows >= self.rows as f64 {
            self.finish_block();
        }
    }

    fn finish_block(&mut self) {
        let places = self.ring.len();
        self.newest = (self.newest + 1) % places;
        std::mem::swap(&mut self.ring[self.newest], &mut self.block);
        self.block.factor.clear();
        self.filled = (self.filled + 1).min(places);
        if self.spread.is_none() && self.filled == self.reference_blocks {
            self.comparison.begin(&self.reference);
            self.comparing = true;
            self.filled = 0;
        }
    }

    /// Compares the next blocks of the reference: as few with each row as are done before the ring
    /// turns.
    fn compare(&mut self) {
        for _ in 0..(self.reference_blocks + 1).div_ceil(self.rows.max(1)) {
            match self.comparison.next() {
                Some(age) => {
                    let place = self.place(age);
                    self.comparison.take(&self.ring[place].factor);
                }
                None => {
                    self.spread = Some(self.comparison.spread(&self.reference));
                    self.comparing = false;
                    return;
                }
            }
        }
    }

    /// Place in the ring of the block `age` blocks before the newest.
    fn place(&self, age: usize) -> usize {
        (self.newest + self.ring.len() - age % self.ring.len()) % self.ring.len()
    }

    /// Compares the last blocks, the newest alone, the newest two, and so on, with the reference.
    pub fn check(&mut self, health: &mut Health) {
        let Some(spread) = self.spread else {
            return;
        };
        health.learned = true;
        health.from_stored = spread.from_stored;
        (health.parameters, health.residuals) = (0.0, 0.0);
        health.largest = None;
        self.new.clear();
        for age in 0..self.filled.min(self.window) {
            let place = self.place(age);
            self.new.merge(&self.ring[place].factor);
            self.both.copy(&self.reference);
            self.both.merge(&self.new);
            let since = self.ring[place].since;
            let new = change::parameters(&self.reference, &self.new, &self.both, spread.parameters);
            let larger = change::residuals(&self.reference, &self.new, spread.rest);
            health.parameters = health.parameters.max(new);
            health.residuals = health.residuals.max(larger);
            for (what, sigma) in [(Deviation::Parameters, new), (Deviation::Residuals, larger)] {
                let most = health.largest.map_or(0.0, |most| most.1);
                if sigma > most {
                    health.largest = Some((what, sigma, since));
                }
            }
        }
    }
}
