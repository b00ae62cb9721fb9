//! Evidence itself: factors by time block and joint, and how they are merged and chosen.

use super::{EvidenceError, Fold, Layout, Triangle};

/// All that the estimates and their statistics need to know of logs: for each time block b and
/// each joint j the triangular factor of \\( [W_{jb} | C_{jb} | Y_{jb}] \\), the columns that the
/// joint can see, the candidates and the measurements.
///
/// Memory: `blocks x joints` factors of `n (n + 1) / 2` numbers each, whatever the logs' length.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    pub(super) layout: Layout,
    /// Factors of each time block, by joint.
    pub(super) blocks: Vec<Vec<Triangle>>,
}

impl Evidence {
    /// Evidence of nothing, to merge into or to add blocks to.
    pub fn empty(layout: Layout) -> Self {
        Evidence {
            layout,
            blocks: Vec::new(),
        }
    }

    /// What the columns stand for.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Number of time blocks.
    pub fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// Factors of time block `block`, by joint; empty if there is no such block.
    pub fn factors(&self, block: usize) -> &[Triangle] {
        self.blocks.get(block).map_or(&[], Vec::as_slice)
    }

    /// Number of equations of each joint.
    pub fn joint_rows(&self) -> Vec<usize> {
        let rows = |joint: usize| self.blocks.iter().map(|b| b[joint].rows()).sum();
        (0..self.layout.joints.len()).map(rows).collect()
    }

    /// Number of equations.
    pub fn rows(&self) -> usize {
        self.joint_rows().iter().sum()
    }

    /// Adds a time block, one factor per joint: the way to gather evidence from rows as they come
    /// ([`Fold`]), when a log does not fit in memory.
    ///
    /// # Errors
    /// [`EvidenceError::Shape`] if the factors do not fit the layout.
    pub fn push(&mut self, factors: Vec<Triangle>) -> Result<(), EvidenceError> {
        let (what, found, expected) = (
            "joints of a time block",
            factors.len(),
            self.layout.joints.len(),
        );
        if found != expected {
            return Err(EvidenceError::Shape {
                what,
                found,
                expected,
            });
        }
        for (joint, factor) in factors.iter().enumerate() {
            let (what, found) = ("columns of a factor", factor.width());
            let expected = self.layout.width(joint);
            if found != expected {
                return Err(EvidenceError::Shape {
                    what,
                    found,
                    expected,
                });
            }
        }
        self.blocks.push(factors);
        Ok(())
    }

    /// Adds the evidence of another log, another part of the log or another machine. What is
    /// asked afterwards is answered as if all had been gathered together.
    ///
    /// # Errors
    /// [`EvidenceError::Different`] if robot, model, columns or description differ.
    pub fn merge(&mut self, other: &Evidence) -> Result<(), EvidenceError> {
        self.layout.check_same(&other.layout)?;
        self.blocks.extend(other.blocks.iter().cloned());
        Ok(())
    }

    /// Evidence of some blocks, in the order given; a block may come several times.
    ///
    /// # Errors
    /// [`EvidenceError::NoSuchBlock`].
    pub fn select(&self, blocks: &[usize]) -> Result<Evidence, EvidenceError> {
        let pick = |&block: &usize| {
            let blocks = self.blocks();
            self.blocks
                .get(block)
                .cloned()
                .ok_or(EvidenceError::NoSuchBlock { block, blocks })
        };
        let blocks = blocks.iter().map(pick).collect::<Result<_, _>>()?;
        Ok(Evidence {
            layout: self.layout.clone(),
            blocks,
        })
    }

    /// The same evidence in at most `blocks` blocks, neighbours merged: for fewer bytes, or for
    /// longer blocks than were cut.
    pub fn coarsened(&self, blocks: usize) -> Evidence {
        let ranges = super::Cut::Blocks(blocks).ranges(self.blocks());
        let merged = |range: std::ops::Range<usize>| {
            let joints = 0..self.layout.joints.len();
            joints
                .map(|joint| self.joint_factor(joint, range.clone()))
                .collect()
        };
        Evidence {
            layout: self.layout.clone(),
            blocks: ranges.into_iter().map(merged).collect(),
        }
    }

    /// Square of the residual \\( \|Y_{jb} - W_{jb} X\|^2 \\) of each block, by joint. `x` has a
    /// value for each column of the layout; units of the measurements, squared.
    pub fn residual_squares(&self, x: &[f64]) -> Vec<Vec<f64>> {
        let square = |(joint, factor): (usize, &Triangle)| {
            let residual = factor.residual(&self.seen(joint, x));
            residual.iter().map(|rho| rho * rho).sum()
        };
        let of_block = |b: &Vec<Triangle>| b.iter().enumerate().map(square).collect();
        self.blocks.iter().map(of_block).collect()
    }

    /// The values of `x` that joint `joint` can see.
    pub(super) fn seen(&self, joint: usize, x: &[f64]) -> Vec<f64> {
        let columns = &self.layout.joints[joint];
        columns
            .iter()
            .map(|c| x.get(*c).copied().unwrap_or(0.0))
            .collect()
    }

    /// The factor of joint `joint` over a range of blocks.
    fn joint_factor(&self, joint: usize, blocks: std::ops::Range<usize>) -> Triangle {
        let width = self.layout.width(joint);
        let places: Vec<Option<usize>> = (0..width).map(Some).collect();
        let mut fold = Fold::new(width);
        for factors in &self.blocks[blocks] {
            fold.factor(&factors[joint], &places, 1.0);
        }
        fold.finish()
    }

    /// The factors of all blocks together, by joint.
    pub fn totals(&self) -> Vec<Triangle> {
        let joints = 0..self.layout.joints.len();
        joints
            .map(|joint| self.joint_factor(joint, 0..self.blocks()))
            .collect()
    }
}
