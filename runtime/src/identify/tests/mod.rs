//! Published numbers and identities of whole identifications.

mod emps;
mod hand_written;
mod properties;
mod reading;
mod scara;
