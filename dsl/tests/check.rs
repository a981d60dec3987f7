//! Checking whole models: the shipped one is right, and mistakes are found where they are made.

use ansatz_dsl::check::check;
use ansatz_dsl::diagnostic::{Diagnostic, Sink, render};
use ansatz_dsl::model::Model;
use ansatz_dsl::resolve::{Loaded, assemble};
use ansatz_dsl::source::SourceMap;
use std::path::Path;

/// The model of a text and what the compiler says about it; other files are looked up beside `folder`.
fn checked(name: &str, text: &str, folder: &Path) -> (Option<Model>, Vec<Diagnostic>, SourceMap) {
    let (mut sources, mut sink) = (SourceMap::new(), Sink::new());
    let id = sources.add(name, text);
    let mut load = |path: &str, _from: &str| {
        let text = std::fs::read_to_string(folder.join(path)).map_err(|error| error.kind().to_string())?;
        Ok(Loaded { name: path.to_owned(), text })
    };
    let program = assemble(id, &mut sources, &mut load, &mut sink);
    let model = check(&program, &sources, &mut sink);
    (model, sink.finish(), sources)
}

fn dry() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/dry/model.ansatz");
    std::fs::read_to_string(path).expect("the shipped model can be read")
}

#[test]
fn the_shipped_model_is_right() {
    let (model, diagnostics, sources) = checked("dry/model.ansatz", &dry(), Path::new("."));
    assert!(diagnostics.is_empty(), "{}", render(&diagnostics, &sources));
    let model = model.expect("no diagnostics, so a model");
    assert_eq!(model.states.len(), 5);
}

#[test]
fn every_mistake_is_explained() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/errors");
    let entries = std::fs::read_dir(&folder).expect("the folder of mistakes");
    let mut files: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    files.sort();
    for path in files {
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).expect("a text");
        let (model, diagnostics, sources) = checked(&format!("{name}.ansatz"), &text, &folder);
        let rendered = render(&diagnostics, &sources);
        if name == "base" {
            assert!(model.is_some() && diagnostics.is_empty(), "{rendered}");
        } else {
            assert!(model.is_none(), "`{name}` is accepted");
            insta::assert_snapshot!(name, rendered);
        }
    }
}
