//! What tests of whole models share: the compiled models, random but valid data, derivatives by differences, notes of a run.

pub mod differences;
pub mod models;
pub mod notes;
pub mod sample;

use ansatz::generated::Program;
use ansatz::system::System;

/// Every compiled model of the repository.
pub fn programs() -> Vec<&'static Program> {
    let shipped = ansatz_models::PROGRAMS.into_iter().chain(ansatz_examples::PROGRAMS);
    shipped.chain(ansatz_benches::PROGRAMS).chain(models::PROGRAMS).collect()
}

/// A model on its own mesh, some parameters set.
///
/// # Panics
/// If a parameter is not valid or there is no mesh.
pub fn system(program: &'static Program, set: &[(&str, &str)]) -> System {
    let set: Vec<_> = set.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect();
    let values = ansatz::settings::resolve(program, &set).expect("valid parameters");
    ansatz::Simulation::new(program, &values).expect("a system").into_system()
}
