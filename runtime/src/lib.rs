//! The runtime of Ansatz: runs compiled models.
//!
//! A model is compiled by `model!` or `include_model!` (or by the `ansatz` command) into one [`generated::Program`]. This crate makes the
//! mesh ([`mesh`]), numbers and assembles the unknowns ([`system`]), finds contact ([`contact`]), solves linear systems ([`solve`]),
//! integrates in time ([`time`]) and writes results ([`output`]). It knows no language and no physics by name.

pub mod contact;
pub mod error;
pub mod generated;
pub mod lane;
pub mod mesh;
pub mod observer;
pub mod output;
pub mod record;
pub mod settings;
pub mod simulation;
pub mod simulator;
pub mod solve;
pub mod system;
pub mod time;

#[cfg(feature = "macros")]
pub use ansatz_macros::{include_model, model};
pub use error::Error;
pub use simulation::Simulation;
