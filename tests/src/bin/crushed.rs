//! The simulator of `models/crushed.ansatz`, as `ansatz build` makes it.

fn main() -> std::process::ExitCode {
    ansatz::generated::main(&ansatz_tests::models::crushed::PROGRAM)
}
