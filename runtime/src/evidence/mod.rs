//! Evidence: logs reduced to small triangular factors that answer every statistical question.
//!
//! For each time block b and each joint j, [`Evidence`] holds the triangular factor R of
//! \\( [W_{jb} | C_{jb} | Y_{jb}] \\): the columns that the joint can see, candidate columns on
//! trial, and the measurements. Because \\( \|Y - W X\| = \|R (-X; 1)\| \\) for every X, estimates
//! ([`Evidence::fit`]), tests of columns ([`Evidence::drop_test`]), prediction errors on data left
//! out ([`Evidence::cross_validate`]) and error bars under correlated residuals
//! ([`Evidence::corrected`], [`Evidence::bootstrap`]) follow without the log. Pieces from several
//! logs, threads or machines merge ([`Evidence::merge`]) and are stored ([`Evidence::save`]).
//!
//! The module knows equations ([`crate::observe`]), not logs, and no robot.
//!
//! Results do not depend on the number of threads: every sum has a fixed order.

mod blocks;
mod bootstrap;
mod bytes;
mod checksum;
mod corrected;
mod covariance;
mod cross;
mod distribution;
mod dropping;
mod error;
mod essential;
mod file;
mod fit;
mod gather;
mod kernel;
mod layout;
mod levels;
mod posterior;
mod question;
mod rank;
mod reduced;
mod scores;
#[cfg(test)]
mod tests;
mod triangle;

pub use blocks::Evidence;
pub use bootstrap::{Bootstrap, Resampling};
pub use covariance::Covariance;
pub use cross::{CrossValidation, HeldOut};
pub use distribution::{f_survival, student_quantile};
pub use dropping::FTest;
pub use error::{EvidenceError, FormatError};
pub use essential::{Dropped, Essential};
pub use file::VERSION;
pub use fit::Fit;
pub use gather::{Candidate, Cut};
pub use layout::Layout;
pub use posterior::Posterior;
pub use question::{Question, Weighting};
pub use triangle::{Fold, Triangle};
