//! Published numbers and identities of whole identifications.

mod emps;
mod failures;
pub(crate) mod hand_written;
mod options;
mod prior;
mod properties;
mod reading;
mod report;
mod robustness;
mod scara;
pub(crate) mod synthetic;
mod units;
mod weights;
mod windows;
