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
//! deterministic.
//!
//! **Hidden effects.** [`controlled`] runs a [`Plant`]: drives between command and joint, encoders
//! between joint and controller, and joints that no drive moves, so that a gear that yields or has
//! play is a joint of the model with a spring or two stops. What no column can hold is an
//! [`Influence`]. Static effects are columns of the model, contacts that yield ([`Presliding`]) run
//! their states along. [`closed_loop`] is the case where nothing is hidden.
//!
//! [`Presliding`]: crate::model::Presliding

mod advance;
mod closed_loop;
mod contact;
mod controller;
mod dynamics;
mod error;
mod forces;
mod influence;
mod integrate;
mod inverse;
mod lanes;
mod like;
mod linear;
mod open_loop;
mod options;
mod parameters;
mod parting;
mod plant;
mod relaxed;
mod result;
mod slip;
mod surface;
mod trajectory;
mod via_points;

#[cfg(test)]
mod tests;

pub use closed_loop::{ClosedLoop, Measured, closed_loop, controlled};
pub use dynamics::Dynamics;
pub use error::SimulateError;
pub use influence::{Disturbance, Drift, Influence, LoadFriction, Moment, Weight};
pub use inverse::inverse_dynamics;
pub use like::{beginning, ideal, like};
pub use open_loop::{OpenLoop, free_motion, open_loop};
pub use options::{Grid, Method, Options, State};
pub use parameters::{feedforward_of, in_order, named_values, rigid_only};
pub use parting::{Parting, off_controller, off_reference, parting};
pub use plant::{Drive, Encoder, Plant};
pub(crate) use relaxed::{Relaxed, relaxed};
pub use result::Simulation;
pub use trajectory::Trajectory;
