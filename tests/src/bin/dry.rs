//! The simulator of the dry model, as `ansatz build` makes it.

fn main() -> std::process::ExitCode {
    ansatz::generated::main(&ansatz_models::dry_contact::PROGRAM)
}
