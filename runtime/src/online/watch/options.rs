//! How a watchdog learns and when it barks.

use super::super::OnlineError;

/// Lengths and level of a [`super::Watchdog`].
#[derive(Clone, Debug, PartialEq)]
pub struct WatchOptions {
    /// Length of a block, s of a joint's motion: longer than what residuals remember, best a whole
    /// number of cycles of the task.
    pub block_s: f64,
    /// Blocks that are learned from, twice: first the colour of the noise, then the reference.
    pub reference: usize,
    /// Blocks that are looked back at.
    pub window: usize,
    /// Standard deviations from which on a deviation is an alarm. 6 is passed by chance once in 1e9.
    pub sigma: f64,
}

impl Default for WatchOptions {
    /// Blocks of 10 s; two minutes of learning, the last minute in view; 6 standard deviations.
    fn default() -> Self {
        WatchOptions {
            block_s: 10.0,
            reference: 6,
            window: 6,
            sigma: 6.0,
        }
    }
}

/// Fewest blocks to learn from: fewer cannot tell how blocks differ.
const FEWEST: usize = 4;

impl WatchOptions {
    /// Equations of a joint in a block.
    ///
    /// # Errors
    /// [`OnlineError::Block`], [`OnlineError::Blocks`], [`OnlineError::Level`].
    pub(super) fn rows(&self, per_second: f64, columns: usize) -> Result<usize, OnlineError> {
        let blocks = |blocks, what, needs| match blocks >= needs {
            true => Ok(()),
            false => Err(OnlineError::Blocks {
                blocks,
                what,
                needs,
            }),
        };
        blocks(self.reference, "blocks to learn from", FEWEST)?;
        blocks(self.window, "blocks to look back at", 1)?;
        if !(self.sigma > 0.0 && self.sigma.is_finite()) {
            return Err(OnlineError::Level { sigma: self.sigma });
        }
        let rows = (self.block_s * per_second).round() as usize;
        match rows >= 2 * columns {
            true => Ok(rows),
            false => Err(OnlineError::Block {
                block_s: self.block_s,
                rows,
                columns,
            }),
        }
    }
}
