//! One hash-consed expression graph for all outputs of a robot, and its readers.
//!
//! The graph knows no robot: inputs are numbered positions, velocities and accelerations. Its
//! smart constructors fold and share, [`substitute`] finds shorter forms; [`tape`] and the emitters
//! read the same graph.

pub mod angle;
pub mod count;
pub mod derivative;
pub mod fusion;
pub mod graph;
pub mod needs;
pub mod residue;
pub mod rotate;
pub mod schedule;
pub mod substitute;
pub mod tape;

pub use angle::{Angle, AngleSum};
pub use count::Operations;
pub use graph::{Expr, Function, Graph, Input, Node};
