//! The Cargo project of a simulator: emitted Rust, a manifest that names the runtime, built into an executable.
//!
//! Projects live in the build folder of the workspace, one for each model file, and share its compiled runtime: after the first time
//! only the model itself is compiled.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of the Ansatz sources: where the command was built, unless `ANSATZ_HOME` says otherwise.
fn home() -> PathBuf {
    let built_in = Path::new(env!("CARGO_MANIFEST_DIR")).parent().map(Path::to_path_buf);
    std::env::var_os("ANSATZ_HOME").map(PathBuf::from).or(built_in).unwrap_or_default()
}

/// Where a simulator will run.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Machine {
    /// Here: kernels are compiled for the registers of this machine only, in half the time.
    This,
    /// Anywhere: kernels are compiled for all instruction sets and choose at run time.
    Any,
}

/// Writes the project of a model and builds it; returns the executable.
///
/// `identity` tells models of the same name apart.
pub fn build(name: &str, identity: &str, rust: &str, machine: Machine) -> Result<PathBuf, String> {
    let home = home();
    let runtime = home.join("runtime");
    if !runtime.join("Cargo.toml").exists() {
        let place = runtime.display();
        return Err(format!(
            "error: the runtime is not at `{place}`; set ANSATZ_HOME to the folder of the Ansatz sources"
        ));
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| home.join("target"), PathBuf::from);
    let target = std::path::absolute(&target).unwrap_or(target);
    let package = format!("{}-{identity}", name.replace('_', "-"));
    let folder = target.join("simulators").join(&package);
    write_project(&folder, &package, &runtime, rust)?;
    copy_if_absent(&home.join("Cargo.lock"), &folder.join("Cargo.lock"))?;
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(&cargo)
        .args(["rustc", "--release", "--manifest-path"])
        .arg(folder.join("Cargo.toml"))
        .arg("--target-dir")
        .arg(&target)
        .args(["--", "-C", "lto=off"]) // kernels call nothing across their parts of the program
        .args(lanes(machine))
        .current_dir(&home) // the toolchain that the sources name
        .status()
        .map_err(|e| {
            format!("error: cannot start `cargo`: {e}; a Rust toolchain is needed to build a simulator")
        })?;
    if !status.success() {
        return Err(format!(
            "error: the simulator in `{}` did not build; its errors stand above",
            folder.display()
        ));
    }
    Ok(target.join("release").join(&package))
}

/// What the compiler is told of the registers that kernels are for.
fn lanes(machine: Machine) -> Option<&'static str> {
    match machine {
        Machine::Any => None,
        #[cfg(target_arch = "x86_64")]
        Machine::This if pulp::x86::V4::try_new().is_some() => Some("--cfg=ansatz_lanes=\"avx512\""),
        #[cfg(target_arch = "x86_64")]
        Machine::This if pulp::x86::V3::try_new().is_some() => Some("--cfg=ansatz_lanes=\"avx2\""),
        Machine::This => None,
    }
}

fn write_project(folder: &Path, package: &str, runtime: &Path, rust: &str) -> Result<(), String> {
    fs::create_dir_all(folder.join("src")).map_err(|e| cannot_write(folder, &e))?;
    let runtime = runtime.display().to_string();
    let manifest = format!(
        "[package]\nname = \"{package}\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[dependencies]\n\
         ansatz = {{ path = {runtime:?}, default-features = false }}\n\n[workspace]\n\n[profile.release]\nincremental = true\n"
    );
    let main = format!(
        "{rust}\n\nfn main() -> std::process::ExitCode {{\n    ansatz::generated::main(&PROGRAM)\n}}\n"
    );
    write_if_changed(&folder.join("Cargo.toml"), &manifest)?;
    write_if_changed(&folder.join("src/main.rs"), &main)
}

/// An unchanged file keeps its time stamp, so that cargo has nothing to do.
fn write_if_changed(path: &Path, text: &str) -> Result<(), String> {
    if fs::read_to_string(path).is_ok_and(|old| old == text) {
        return Ok(());
    }
    fs::write(path, text).map_err(|e| cannot_write(path, &e))
}

fn copy_if_absent(from: &Path, to: &Path) -> Result<(), String> {
    if to.exists() || !from.exists() {
        return Ok(());
    }
    fs::copy(from, to).map(|_| ()).map_err(|e| cannot_write(to, &e))
}

fn cannot_write(path: &Path, error: &std::io::Error) -> String {
    format!("error: cannot write `{}`: {error}", path.display())
}
