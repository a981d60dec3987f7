//! What the documentation shows is true: its models compile, its fragments parse, its traps are refused with the code it names, and its lists are complete.

use ansatz_dsl::compile::{Compilation, compile};
use ansatz_dsl::diagnostic::{Code, Severity, Sink, render};
use ansatz_dsl::resolve::Loaded;
use ansatz_dsl::source::{Source, SourceMap};
use ansatz_dsl::syntax;
use ansatz_units::{Dimension, Unit};
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the crate lies in the workspace").to_path_buf()
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// The pages of the language and the README, with their text.
fn pages() -> Vec<(String, String)> {
    let folder = fs::read_dir(root().join("docs/language")).expect("the language is documented");
    let names = folder
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".md"));
    let mut names: Vec<String> =
        names.map(|name| format!("docs/language/{name}")).chain(["README.md".to_owned()]).collect();
    names.sort();
    names.into_iter().map(|name| (name.clone(), read(&name))).collect()
}

/// The text between the fences marked `ansatz`.
fn examples(page: &str) -> Vec<&str> {
    page.split("```ansatz\n").skip(1).map(|rest| rest.split("```").next().unwrap_or("")).collect()
}

fn is_model(example: &str) -> bool {
    example.lines().any(|line| line.starts_with("model "))
}

/// A model that may extend those in `docs/language`, compiled.
fn compiled(name: &str, text: &str) -> Compilation {
    let mut load = |path: &str, _: &str| {
        Ok(Loaded { name: path.to_owned(), text: read(&format!("docs/language/{path}")) })
    };
    compile(name, text, &mut load)
}

fn errors(compilation: &Compilation) -> Vec<&'static str> {
    let errors = compilation.diagnostics.iter().filter(|diagnostic| diagnostic.severity == Severity::Error);
    errors.map(|diagnostic| diagnostic.code.id()).collect()
}

fn report(compilation: &Compilation) -> String {
    render(&compilation.diagnostics, &compilation.sources)
}

#[test]
fn every_model_in_the_documentation_compiles() {
    let mut count = 0;
    let mut faults = String::new();
    for (page, text) in pages() {
        for example in examples(&text).into_iter().filter(|example| is_model(example)) {
            let compilation = compiled(&page, example);
            if !compilation.diagnostics.is_empty() {
                faults += &format!("{page}\n{}\n", report(&compilation));
            }
            count += 1;
        }
    }
    assert!(faults.is_empty(), "{faults}");
    assert!(count > 20, "only {count} models were found");
}

#[test]
fn every_fragment_in_the_documentation_parses() {
    for (page, text) in pages() {
        for example in examples(&text).into_iter().filter(|example| !is_model(example)) {
            let (mut sources, mut sink) = (SourceMap::new(), Sink::new());
            let id = sources.add(page.as_str(), example);
            let source: Source = sources.get(id).expect("it was just added").clone();
            syntax::parse(&source, &mut sink);
            assert!(!sink.has_errors(), "{}", render(&sink.finish(), &sources));
        }
    }
}

/// Rows of the tables headed `written | message`: items of a model, and the code that refuses them.
fn traps(page: &str) -> Vec<(String, String)> {
    let table = |rest: &str| -> Vec<(String, String)> {
        let rows = rest.lines().skip(1).take_while(|line| line.starts_with('|'));
        let cells = rows.map(|row| row.trim_matches('|').split(" | ").map(str::trim).collect::<Vec<_>>());
        let quoted = |cell: &str| cell.split('`').nth(1).unwrap_or("").to_owned();
        cells.filter(|cells| cells.len() == 2).map(|cells| (quoted(cells[0]), quoted(cells[1]))).collect()
    };
    page.split("| written | message |\n").skip(1).flat_map(table).collect()
}

#[test]
fn every_trap_is_refused_with_the_code_that_the_page_names() {
    let mut count = 0;
    for (page, text) in pages() {
        for (written, code) in traps(&text) {
            let compilation = compiled(&page, &format!("model trap; extend \"block.ansatz\";\n{written}"));
            let found = errors(&compilation);
            assert!(
                found.contains(&code.as_str()),
                "{page}: `{written}` is {found:?}, not {code}\n{}",
                report(&compilation)
            );
            count += 1;
        }
    }
    assert!(count > 30, "only {count} traps were found");
}

#[test]
fn lists_are_complete() {
    let (units, codes) = (read("docs/language/units.md"), read("docs/language/diagnostics.md"));
    for unit in Unit::ALL {
        assert!(units.contains(&format!("`{}`", unit.symbol)), "units.md lacks {}", unit.symbol);
    }
    for dimension in Dimension::names() {
        assert!(units.contains(&format!("`{dimension}`")), "units.md lacks {dimension}");
    }
    for code in Code::ALL {
        let row = format!("| `{}` | {} |\n", code.id(), code.meaning());
        assert!(codes.contains(&row), "diagnostics.md lacks {row}");
    }
}

#[test]
fn links_lead_somewhere() {
    for (page, text) in pages() {
        let folder = root().join(&page).parent().expect("pages lie in folders").to_path_buf();
        let targets = text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next());
        for target in targets.filter(|target| !target.is_empty() && !target.contains("://")) {
            assert!(folder.join(target).exists(), "{page} links to {target}");
        }
    }
}

#[test]
fn the_readme_shows_the_example_model() {
    let (readme, block) = (read("README.md"), read("docs/language/block.ansatz"));
    assert!(
        examples(&readme).contains(&block.as_str()),
        "the model in README.md differs from docs/language/block.ansatz"
    );
}
