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
fn the_shipped_models_are_right() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let entries = std::fs::read_dir(&folder).expect("the folder of models");
    let folders = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.join("model.ansatz").exists());
    for folder in folders {
        let text = std::fs::read_to_string(folder.join("model.ansatz")).expect("a model");
        let (model, diagnostics, sources) = checked("model.ansatz", &text, &folder);
        assert!(model.is_some() && diagnostics.is_empty(), "{}", render(&diagnostics, &sources));
    }
}

#[test]
fn a_weak_form_a_second_field_and_a_load_on_a_volume_ratio_are_right() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/dry");
    let text = "model poro;  extend \"model.ansatz\";
        param k_n = 1e-2 [um^4/(nN*s)] in 1e-6 [um^4/(nN*s)] .. 10 [um^4/(nN*s)];
        field q: Pressure in P1 on nuc = 0;
        let J = det(F(u));
        let C = transpose(F(u))*F(u);
        physics pores {
            load J with q on nuc;
            residual test(q)*dt(J) + k_n*J*dot(inverse(C)*grad(q), grad(test(q))) on nuc;
            hold q = 0 on nucleus;
        }";
    let (model, diagnostics, sources) = checked("poro.ansatz", text, &folder);
    assert!(model.is_some() && diagnostics.is_empty(), "{}", render(&diagnostics, &sources));
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

/// Length of the unit with which a text starts, its exponent or brackets included; angles do not count.
fn unit_length(text: &str) -> Option<usize> {
    if text.starts_with('[') {
        return text.find(']').map(|end| end + 1);
    }
    let unit: String = text.chars().take_while(char::is_ascii_alphabetic).collect();
    let known = ansatz_units::Unit::find(&unit).filter(|unit| !unit.dimension.is_number())?;
    let exponent = if text[unit.len()..].starts_with('^') { 2 } else { 0 };
    Some(known.symbol.len() + exponent)
}

/// Texts of the shipped model with the unit of one literal replaced, and which.
fn seeded(text: &str) -> Vec<(String, String)> {
    let mut seeds = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let code = line.split("//").next().unwrap_or("");
        for (at, _) in code.match_indices(' ') {
            let behind_number = code[..at].ends_with(|c: char| c.is_ascii_digit() || c == '}');
            if let Some(length) = unit_length(&code[at + 1..]).filter(|_| behind_number) {
                let from = start + at + 1;
                let changed = format!("{}[kg*K]{}", &text[..from], &text[from + length..]);
                seeds.push((line.trim().to_owned(), changed));
            }
        }
        start += line.len();
    }
    seeds
}

#[test]
fn a_wrong_unit_anywhere_in_the_shipped_model_is_refused() {
    let seeds = seeded(&dry());
    assert!(seeds.len() > 60, "{} seeds", seeds.len());
    for (line, text) in seeds {
        let (model, diagnostics, _) = checked("dry/model.ansatz", &text, Path::new("."));
        assert!(model.is_none() && !diagnostics.is_empty(), "accepted: [kg*K] in `{line}`");
    }
}

#[test]
fn a_parameter_of_another_dimension_is_refused() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/dry");
    let (model, _, _) = checked("model.ansatz", &dry(), &folder);
    for param in model.expect("the shipped model is right").params {
        let text = format!("model seeded; extend \"model.ansatz\"; replace param {} = 1 [kg*K];", param.name);
        let (model, diagnostics, _) = checked("seeded.ansatz", &text, &folder);
        assert!(model.is_none() && !diagnostics.is_empty(), "accepted: `{}` as Mass*Temperature", param.name);
    }
}

/// A variant of the small model beside the mistakes.
fn variant(text: &str) -> (Option<Model>, String) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/errors");
    let text = format!("model variant; extend \"base.ansatz\"; {text}");
    let (model, diagnostics, sources) = checked("variant.ansatz", &text, &folder);
    (model, render(&diagnostics, &sources))
}

#[test]
fn a_variant_adds_replaces_and_drops() {
    let (model, words) = variant(
        "replace param a = 3 um;  replace path floor = from (0, 0) line left to (a/2, 0) line right to (a, 0);
         replace let all = upper;  replace fn spring(e: Length) -> Force = 2*k*e;  drop event far;
         mesh { size = 0.1 um on floor.right; }  output { table \"y.csv\" every step: x; }",
    );
    let model = model.unwrap_or_else(|| panic!("{words}"));
    assert_eq!(model.name, "variant");
    assert!(model.params[0].bounds.is_none(), "the new parameter has no bounds");
    assert_eq!(model.geometry.paths[0].segments.len(), 2);
    assert_eq!((model.mesh.sizes.len(), model.output.tables.len(), model.events.len()), (2, 2, 0));
}

#[test]
fn replacing_a_block_swaps_all_of_it() {
    let (model, words) = variant(
        "output { table \"y.csv\" every step: x; }  replace output { checkpoint every 1 s; }
         replace mesh { size = 1 um; }",
    );
    let model = model.unwrap_or_else(|| panic!("{words}"));
    assert_eq!((model.output.tables.len(), model.mesh.sizes.len()), (0, 1));
    assert!(model.output.checkpoint.is_some());
}

#[test]
fn circles_of_files_and_missing_files_are_reported() {
    let mut sources = SourceMap::new();
    let mut sink = Sink::new();
    let id = sources.add("a", "model a; extend \"b\";");
    let mut load = |path: &str, _: &str| match path {
        "b" => Ok(Loaded { name: "b".into(), text: "model b; extend \"a\";".into() }),
        "a" => Ok(Loaded { name: "a".into(), text: "model a; extend \"b\";".into() }),
        _ => Err("not found".into()),
    };
    assemble(id, &mut sources, &mut load, &mut sink);
    let other = sources.add("c", "model c; extend \"d\";");
    assemble(other, &mut sources, &mut load, &mut sink);
    let ids: Vec<&str> = sink.finish().iter().map(|d| d.code.id()).collect();
    assert_eq!(ids, ["N004", "N010"]);
}

#[test]
fn every_function_of_the_library_is_right() {
    for module in ansatz_dsl::library::MODULES {
        let names: Vec<&str> =
            module.text.lines().filter_map(|line| line.strip_prefix("fn ")?.split('(').next()).collect();
        let lets: String = names.iter().map(|name| format!("let used_{name} = {name};\n")).collect();
        let text = format!("model all; use std::{}::{{{}}};\n{lets}", module.name, names.join(", "));
        let (model, diagnostics, sources) = checked("all.ansatz", &text, Path::new("."));
        assert!(diagnostics.is_empty(), "{}", render(&diagnostics, &sources));
        assert!(model.is_some_and(|model| model.functions.len() >= names.len()));
    }
}

#[test]
fn a_state_without_an_equation_is_balanced_by_the_energies_in_which_it_occurs() {
    use ansatz_dsl::check::dae::{Owner, owners};
    let (model, words) =
        variant("state d: Length = 0;  physics beam { energy k/2*d^2; load d with force_0; }");
    let model = model.unwrap_or_else(|| panic!("{words}"));
    let d = model.states.iter().position(|state| state.name == "d").expect("the new state");
    let owners = owners(&model);
    assert_eq!(owners[d], Owner::Energy);
    assert_eq!(owners.iter().filter(|owner| **owner == Owner::Energy).count(), 1);
}

#[test]
fn a_checked_model_can_be_read() {
    let (model, words) =
        variant("test \"law\" { for d in {1, 2} um { expect spring(d) ~= k*d within 1 %; } }");
    let model = model.unwrap_or_else(|| panic!("{words}"));
    insta::assert_snapshot!("model_listing", model.print());
}

#[test]
fn an_equation_that_is_left_out_of_the_shipped_model_is_missed() {
    let without = dry().replace("    tau     == hill(eta, v_f);", "");
    let (model, diagnostics, sources) = checked("dry/model.ansatz", &without, Path::new("."));
    assert!(model.is_none());
    let words = render(&diagnostics, &sources);
    assert!(words.contains("error[E201]: 5 states, 4 equations: nothing determines `v_f`"), "{words}");
}

#[test]
fn a_missing_semicolon_is_one_error() {
    let text = dry();
    let ends: Vec<usize> = text.match_indices(";\n").map(|(at, _)| at).collect();
    for at in ends {
        let broken = format!("{}{}", &text[..at], &text[at + 1..]);
        let (_, diagnostics, sources) = checked("dry/model.ansatz", &broken, Path::new("."));
        assert_eq!(diagnostics.len(), 1, "{}", render(&diagnostics, &sources));
    }
}

#[test]
fn no_text_makes_the_checker_panic() {
    let text = dry();
    let tokens: Vec<(usize, &str)> = text.match_indices(|c: char| !c.is_whitespace()).collect();
    for (at, token) in tokens.into_iter().step_by(7) {
        let shorter = format!("{}{}", &text[..at], &text[at + token.len()..]);
        let _ = checked("dry/model.ansatz", &shorter, Path::new("."));
    }
}
