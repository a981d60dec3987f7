//! What tests of whole models share: the compiled models, random but valid data, derivatives by differences, notes of a run.

pub mod differences;
pub mod models;
pub mod notes;
pub mod sample;

use ansatz::generated::Program;

/// Every compiled model of the repository.
pub fn programs() -> Vec<&'static Program> {
    let shipped = ansatz_models::PROGRAMS.into_iter().chain(ansatz_examples::PROGRAMS);
    shipped.chain(ansatz_benches::PROGRAMS).chain(models::PROGRAMS).collect()
}
