//! `use std::solid::{F, cauchy};`: reads library modules and lists what is taken from them.

use super::{Import, Module, Program};
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::library;
use crate::source::{Source, SourceMap};
use crate::syntax::{self, ast};

/// Adds the names of one `use` item to `program`, reading their module if it is new.
pub(super) fn import(item: &ast::Import, program: &mut Program, sources: &mut SourceMap, sink: &mut Sink) {
    if let Some(found) = taken(item, &mut program.modules, sources, sink) {
        for import in found {
            if !program
                .imports
                .iter()
                .any(|known| known.name.text == import.name.text && known.module == import.module)
            {
                program.imports.push(import);
            }
        }
    }
}

/// The names of a `use` item that exist; `None` if there is no such module.
fn taken(
    item: &ast::Import,
    modules: &mut Vec<Module>,
    sources: &mut SourceMap,
    sink: &mut Sink,
) -> Option<Vec<Import>> {
    let [root, name] = item.path.as_slice() else {
        unknown_module(item, sink);
        return None;
    };
    let Some(found) = (root.text == "std").then(|| library::find(&name.text)).flatten() else {
        unknown_module(item, sink);
        return None;
    };
    let module = read(found, modules, sources, sink);
    let functions: Vec<&str> = modules[module].functions.iter().map(|(_, f)| f.name.text.as_str()).collect();
    let (known, unknown): (Vec<_>, Vec<_>) =
        item.names.iter().partition(|name| functions.contains(&name.text.as_str()));
    for name in unknown {
        let message = format!("`{}` has no function `{}`", modules[module].name, name.text);
        sink.push(
            Diagnostic::error(Code::UnknownName, name.span, message)
                .help_did_you_mean(&name.text, functions.iter().copied())
                .help(format!(
                    "it has {}",
                    functions.iter().map(|f| format!("`{f}`")).collect::<Vec<_>>().join(", ")
                )),
        );
    }
    Some(known.into_iter().map(|name| Import { name: name.clone(), module }).collect())
}

fn unknown_module(item: &ast::Import, sink: &mut Sink) {
    let Some((first, last)) = item.path.first().zip(item.path.last()) else { return };
    let path = item.path.iter().map(|part| part.text.as_str()).collect::<Vec<_>>().join("::");
    let known = library::MODULES.map(|module| format!("`std::{}`", module.name)).join(", ");
    sink.push(
        Diagnostic::error(
            Code::UnknownName,
            first.span.to(last.span),
            format!("there is no module `{path}`"),
        )
        .help_did_you_mean(&last.text, library::MODULES.iter().map(|module| module.name))
        .help(format!("the modules are {known}")),
    );
}

/// Index of a library module, parsed on first use together with those that it uses itself.
fn read(
    found: library::Module,
    modules: &mut Vec<Module>,
    sources: &mut SourceMap,
    sink: &mut Sink,
) -> usize {
    let name = format!("std::{}", found.name);
    if let Some(known) = modules.iter().position(|module| module.name == name) {
        return known;
    }
    let id = sources.add(name.clone(), found.text);
    let file = syntax::parse(&Source { id, name: name.clone(), text: found.text.to_owned() }, sink);
    let index = modules.len();
    modules.push(Module { name, functions: Vec::new(), imports: Vec::new() });
    for item in file.items {
        match item.kind {
            ast::ItemKind::Fn(function) => modules[index].functions.push((item.docs, function)),
            ast::ItemKind::Import(import) => {
                let found = taken(&import, modules, sources, sink).unwrap_or_default();
                modules[index].imports.extend(found);
            }
            _ => sink.push(Diagnostic::error(
                Code::Misplaced,
                item.span,
                "a library module holds functions and `use` items only",
            )),
        }
    }
    index
}
