//! Forward dynamics and simulation from the identified model itself.
//!
//! [`Dynamics`] turns an [`crate::model::IdentificationModel`] and its parameters X around:
//! the mass matrix comes from the momentum, \\( M(q) e_j = P(q, e_j) X \\), since P is linear in
//! the velocity; everything else from the explicit model, \\( N(q, \dot q) = D(q, \dot q, 0) X \\);
//! then \\( \ddot q = M^{-1} (\tau - N) \\) by Cholesky. So a simulation is exactly as good as the
//! identification, and an effect that the model has is in the simulation without another line.
//!
//! **Dry friction.** The runtime does not know which columns are Coulomb friction. When a
//! [`Dynamics`] is set up, it looks for *switching surfaces*: directions a for which
//! D(q, 0+, 0) - D(q, 0-, 0), the two sides of \\( a^T \dot q = 0 \\), is not zero; a is every joint
//! axis and the sum and difference of every two joints (wrist couplings). On a surface the friction
//! is any torque between the two sides: it sticks as long as one of them holds
//! \\( a^T \ddot q = 0 \\), and it is released when none does (Filippov's solution, unique by
//! Gauss's principle of least constraint). Crossings and releases are located within a step, so
//! that every step sees a smooth motion and keeps its order.
//!
//! [`closed_loop`] runs a log's reference and controller, [`open_loop`] its torque, [`like`]
//! whichever a log has; [`ideal`] is the torque that the reference itself needs. All are
//! deterministic. Effects with memory are not simulated here: no column of a model has one.

mod advance;
mod closed_loop;
mod contact;
mod controller;
mod dynamics;
mod error;
mod forces;
mod integrate;
mod inverse;
mod lanes;
mod like;
mod linear;
mod open_loop;
mod options;
mod parameters;
mod parting;
mod result;
mod surface;
mod trajectory;

#[cfg(test)]
mod tests;

pub use closed_loop::{ClosedLoop, closed_loop};
pub use dynamics::Dynamics;
pub use error::SimulateError;
pub use inverse::inverse_dynamics;
pub use like::{ideal, like};
pub use open_loop::{OpenLoop, free_motion, open_loop};
pub use options::{Grid, Method, Options, State};
pub use parameters::{in_order, named_values, rigid_only};
pub use parting::{Parting, off_controller, off_reference, parting};
pub use result::Simulation;
pub use trajectory::Trajectory;
