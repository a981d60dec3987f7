//! Models on disk: what a path on the command line means, and how a model's own paths are followed.

use ansatz_dsl::compile::{Compilation, compile};
use ansatz_dsl::resolve::extend::Loaded;
use std::path::{Path, PathBuf};

/// The file of a model: the path itself, or `model.ansatz` in a folder.
pub fn model_file(path: &Path) -> PathBuf {
    if path.is_dir() { path.join("model.ansatz") } else { path.to_path_buf() }
}

/// Reads and compiles a model with everything it extends and uses.
pub fn compile_file(path: &Path) -> Result<Compilation, String> {
    let file = model_file(path);
    let text = std::fs::read_to_string(&file).map_err(|e| {
        format!(
            "error: cannot read the model `{}`: {e}; name a model file or a folder with a `model.ansatz`",
            file.display()
        )
    })?;
    Ok(compile(&file.display().to_string(), &text, &mut load))
}

/// Finds a file that a model names, relative to that model.
fn load(path: &str, from: &str) -> Result<Loaded, String> {
    let file = Path::new(from).parent().unwrap_or(Path::new("")).join(path);
    let text = std::fs::read_to_string(&file).map_err(|e| e.to_string())?;
    Ok(Loaded { name: file.display().to_string(), text })
}
