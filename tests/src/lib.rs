//! What tests of whole models share: the compiled models, random but valid data, derivatives by differences.

pub mod differences;
pub mod sample;

use ansatz::generated::Program;

/// Every compiled model of the repository.
pub fn programs() -> Vec<&'static Program> {
    ansatz_models::PROGRAMS.into_iter().chain(ansatz_benches::PROGRAMS).collect()
}
