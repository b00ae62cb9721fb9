//! Why evidence cannot be gathered, merged, read or asked.

use std::path::PathBuf;

use crate::estimate::EstimateError;

/// Why evidence cannot be gathered, merged, read or asked.
#[derive(Debug, thiserror::Error)]
pub enum EvidenceError {
    /// The equations cannot be used or solved.
    #[error(transparent)]
    Estimate(#[from] EstimateError),
    /// The equations, candidates and the model do not fit together.
    #[error("{what}: found {found}, expected {expected}; equations and model must be of one robot")]
    Shape {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// Two pieces of evidence about different things.
    #[error(
        "evidence of {what} {left} cannot be merged with evidence of {what} {right}; \
         gather both with the same robot description, model and candidates"
    )]
    Different {
        /// What differs.
        what: &'static str,
        /// On the one side.
        left: String,
        /// On the other.
        right: String,
    },
    /// A time block that is not there.
    #[error("time block {block} was asked for, but there are only {blocks}")]
    NoSuchBlock {
        /// Counted from 0.
        block: usize,
        /// How many there are.
        blocks: usize,
    },
    /// A column that is not there.
    #[error("column {column} was asked for, but there are only {columns}")]
    NoSuchColumn {
        /// Counted from 0.
        column: usize,
        /// Parameters and candidates together.
        columns: usize,
    },
    /// Too few time blocks for what was asked.
    #[error(
        "{purpose} needs at least {needs} time blocks and there are {blocks}; \
         use longer logs or shorter blocks"
    )]
    TooFewBlocks {
        /// What was asked.
        purpose: &'static str,
        /// Blocks needed.
        needs: usize,
        /// Blocks there are.
        blocks: usize,
    },
    /// Error levels of the joints that cannot divide.
    #[error("error levels must be one positive number per joint; joint {joint} has none")]
    Weights {
        /// Counted from 1.
        joint: usize,
    },
    /// The file cannot be read or written.
    #[error("{path}: {source}", path = path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Bytes that are no evidence, or evidence that cannot be trusted.
    #[error("{name}: {source}")]
    File {
        /// The file, or `evidence` for bytes in memory.
        name: String,
        /// What is wrong with it.
        source: FormatError,
    },
}

/// What is wrong with the bytes of an evidence file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FormatError {
    /// Something else, or changed by a transfer as text.
    #[error("this is not an evidence file")]
    NotEvidence,
    /// Written by another version.
    #[error(
        "the file has format version {found} and this program reads version {known}; \
         use the program that wrote it, or gather the evidence again"
    )]
    Version {
        /// In the file.
        found: u32,
        /// The one that is understood.
        known: u32,
    },
    /// Shorter than it says.
    #[error("the file is cut off: it has {has} bytes and should have {needs}; copy it again")]
    Cut {
        /// Bytes there are.
        has: u64,
        /// Bytes there should be.
        needs: u64,
    },
    /// Longer than it says.
    #[error("{extra} bytes follow the end of the evidence; copy the file again")]
    Trailing {
        /// How many.
        extra: u64,
    },
    /// The checksum does not fit.
    #[error("the checksum does not fit: the file was damaged; copy it again")]
    Damaged,
    /// The checksum fits, but the content contradicts itself.
    #[error("the file contradicts itself: {what}")]
    Malformed {
        /// What is inconsistent.
        what: &'static str,
    },
}
