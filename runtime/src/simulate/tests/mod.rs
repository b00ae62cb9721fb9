//! Tests of the simulation on models written by hand; built-in robots are simulated in the
//! package's own tests.

mod dynamics;
mod energy;
mod friction;
mod loops;
mod model;
mod parting;
mod plant;
mod refused;
mod relaxed;
