//! Identification inside a control loop: sample by sample, in bounded time and memory.
//!
//! The way of a sample: [`Stream`] filters it and makes equations y = w X of the explicit, implicit
//! or power model (Gautier 1996, eqs. 5, 7 and 10); [`Recursion`] folds them into a triangular
//! factor, from which parameters are solved whenever they are wanted; [`Watchdog`] says when the
//! running robot leaves the parameters that are stored of it.
//!
//! **Filters.** A loop cannot filter without phase shift, but it can wait. q, its velocity and its
//! acceleration are weighted sums over a window of samples, with the weights of the batch's
//! zero-phase Butterworth low-pass and differences of eighth order; they belong to the middle of the
//! window, and torque is taken from that same sample. So the equation of an instant is the batch's,
//! a fraction of a second late ([`Stream::lag_s`]), and has no error of phase. Columns and
//! measurement of all equations then pass one causal low-pass alike (a Butterworth, forward only,
//! from states of zero). Its output is a sum of past equations with the same weights left and right,
//! hence an equation again, whatever its phase: \\( F[y] = F[w] X \\) holds exactly, from the first
//! sample on. What the batch's least squares finds in the same equations, the recursion finds: to
//! 1e-9 in the tests.
//!
//! **Bounds.** All memory is taken at set-up. [`Stream::push`] and [`Recursion::update`] run a
//! number of operations that depends on the model and the options alone; so does
//! [`Recursion::solve`]. (Models emitted by the generator take no memory either; an interpreter
//! does, for each evaluation.)
//!
//! **Rest.** At rest, dry friction takes any value and sensor noise would be taken for velocity. A
//! joint whose positions stay within [`Options::rest_band`] over the whole window is held where it
//! is, and its equation is taken out before the low-pass, on both sides. Parameters that nothing has
//! excited yet are reported as not determined.

mod bank;
mod delay;
mod error;
mod factor;
mod options;
mod recursion;
mod solve;
mod state;
mod stream;
mod taps;
mod watch;
mod window;

pub use error::OnlineError;
pub use options::Options;
pub use recursion::Recursion;
pub use solve::Solution;
pub use stream::{Equation, Instant, Step, Stream};
pub use watch::{Alarm, Deviation, Health, WatchOptions, Watchdog};
