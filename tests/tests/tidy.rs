//! The shape of the source tree: who may depend on whom, and how long a file may be.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the crate lies in the workspace").to_path_buf()
}

/// Names of our own crates in the `[dependencies]` of a manifest.
fn dependencies(folder: &str) -> Vec<String> {
    let text =
        fs::read_to_string(root().join(folder).join("Cargo.toml")).expect("every crate has a manifest");
    let section = text.split("[dependencies]").nth(1).unwrap_or("");
    let section = section.split("\n[").next().unwrap_or("");
    let names = section.lines().map(|line| line.split(['.', '=', ' ']).next().unwrap_or(""));
    names.filter(|name| name.starts_with("ansatz")).map(String::from).collect()
}

#[test]
fn crates_depend_only_on_those_below_them() {
    let allowed: BTreeMap<&str, &[&str]> = BTreeMap::from([
        ("units", &[][..]),
        ("elements", &[][..]),
        ("geometry", &[][..]),
        ("frontal", &[][..]),
        ("dsl", &["ansatz-units", "ansatz-elements", "ansatz-geometry"][..]),
        ("macros", &["ansatz-dsl"][..]),
        (
            "runtime",
            &["ansatz-units", "ansatz-elements", "ansatz-geometry", "ansatz-frontal", "ansatz-macros"][..],
        ),
        ("models", &["ansatz"][..]),
        ("cli", &["ansatz-dsl"][..]),
    ]);
    for (folder, allowed) in allowed {
        for name in dependencies(folder) {
            assert!(allowed.contains(&name.as_str()), "`{folder}` must not depend on `{name}`");
        }
    }
}

/// Rust files of the workspace, without build folders.
fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("the tree is readable").flatten() {
        let path = entry.path();
        let name = entry.file_name().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && name != "results" && !name.starts_with('.') {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn no_file_holds_two_subjects_worth_of_lines() {
    let mut files = Vec::new();
    rust_files(&root(), &mut files);
    assert!(files.len() > 50, "the walk found the sources");
    for file in files {
        let lines = fs::read_to_string(&file).expect("sources are text").lines().count();
        assert!(lines <= 600, "{} has {lines} lines: look for its second subject", file.display());
    }
}

#[test]
fn every_file_of_a_library_says_what_it_is() {
    let mut files = Vec::new();
    for folder in ["units", "elements", "geometry", "frontal", "dsl", "macros", "runtime", "models", "cli"] {
        rust_files(&root().join(folder).join("src"), &mut files);
    }
    let is_test =
        |file: &Path| file.components().any(|part| part.as_os_str().to_string_lossy().starts_with("tests"));
    for file in files.iter().filter(|file| !is_test(file.strip_prefix(root()).unwrap_or(file))) {
        let text = fs::read_to_string(file).expect("sources are text");
        assert!(text.starts_with("//!"), "{} does not open by placing itself", file.display());
    }
}

#[test]
fn only_the_solvers_name_the_linear_algebra_library() {
    let mut files = Vec::new();
    rust_files(&root().join("runtime/src"), &mut files);
    for file in files.iter().filter(|f| !f.to_string_lossy().contains("/solve/")) {
        let text = fs::read_to_string(file).expect("sources are text");
        assert!(!text.contains("faer::"), "{} names faer", file.display());
    }
}
