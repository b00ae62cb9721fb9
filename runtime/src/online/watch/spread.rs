//! How much the blocks of a healthy robot differ, block by block: a loop has no time for all at once.

use super::super::factor::Factor;
use super::change;

/// How much more blocks of a healthy robot differ than independent errors would make them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    pub parameters: f64,
    pub rest: f64,
    /// Standard deviations between the parameters of all blocks and none.
    pub from_stored: f64,
}

/// The blocks of a reference against its own parameters, as far as they have been compared.
#[derive(Clone, Debug)]
pub(super) struct Comparison {
    solved: Vec<f64>,
    blocks: usize,
    compared: usize,
    level: f64,
    freedom: f64,
    far: f64,
    apart: f64,
}

impl Comparison {
    /// Takes the memory for a reference of `blocks` blocks with rows `[w | e]` of `width` values.
    pub fn new(width: usize, blocks: usize) -> Comparison {
        Comparison {
            solved: vec![0.0; width - 1],
            blocks,
            compared: 0,
            level: 0.0,
            freedom: 0.0,
            far: 0.0,
            apart: 0.0,
        }
    }

    /// Begins with the parameters of the whole reference.
    pub fn begin(&mut self, reference: &Factor) {
        change::solve(reference, &mut self.solved);
        (self.level, self.freedom) = change::variance(reference);
        (self.compared, self.far, self.apart) = (0, 0.0, 0.0);
    }

    /// The next block to compare, 0 for the newest; `None` when all have been.
    pub fn next(&self) -> Option<usize> {
        (self.compared < self.blocks).then_some(self.compared)
    }

    /// Compares a block.
    pub fn take(&mut self, block: &Factor) {
        let count = self.blocks as f64;
        let more = change::square(block, &self.solved) - change::rest(block);
        let rank = change::rank(block);
        self.far += more / rank.max(1.0) / self.level / count;
        let (own, few) = change::variance_of(block, rank);
        self.apart += (own / self.level - 1.0).powi(2) * few / 2.0 / count;
        self.compared += 1;
    }

    /// What the compared blocks say.
    pub fn spread(&self, reference: &Factor) -> Spread {
        // Parameters fitted to all blocks lie nearer to each by this share.
        let share = 1.0 - 1.0 / self.blocks as f64;
        let parameters = (self.far / share).max(1.0);
        let rank = change::rank(reference).max(1.0);
        let f = change::gain(reference) / rank / self.level / parameters;
        Spread {
            parameters,
            rest: (self.apart / share).max(1.0),
            from_stored: change::normal(f, rank, self.freedom),
        }
    }
}
