//! `extend`, `replace` and `drop`: applies the edits of a variant to the items of its base.
//!
//! `geometry`, `mesh`, `output`, `solve` and `use` of the variant add to those of the base; everything else is new or says `replace`.

use super::{Program, imports};
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::source::{SourceId, SourceMap, Span};
use crate::syntax;
use crate::syntax::ast::{self, GeometryKind, ItemKind, Keyword, Replacement};

/// A text found by a [`Loader`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Loaded {
    /// The name that messages show and that tells two files apart.
    pub name: String,
    /// The whole text.
    pub text: String,
}

/// Finds the file that a text names: gets the path as written and the name of the text that names it; says why if there is none.
pub type Loader<'a> = dyn FnMut(&str, &str) -> Result<Loaded, String> + 'a;

/// The program of the text `main`, with all that it extends and uses.
///
/// Errors (syntax errors, files that cannot be read, circles, edits of nothing) go to `sink`; what could be read is returned all the same.
pub fn assemble(main: SourceId, sources: &mut SourceMap, load: &mut Loader<'_>, sink: &mut Sink) -> Program {
    read(main, &mut Vec::new(), sources, load, sink)
}

fn read(
    id: SourceId,
    chain: &mut Vec<String>,
    sources: &mut SourceMap,
    load: &mut Loader<'_>,
    sink: &mut Sink,
) -> Program {
    let Some(source) = sources.get(id).cloned() else { return Program::default() };
    let file = syntax::parse(&source, sink);
    chain.push(source.name.clone());
    let mut program = base(&file, &source.name, chain, sources, load, sink);
    chain.pop();
    program.broken.extend(file.broken);
    let has_name = file.items.iter().any(|item| matches!(item.kind, ItemKind::Model(_)));
    if !has_name && !sink.has_errors() {
        let start = Span::new(id, 0, 0);
        sink.push(
            Diagnostic::error(Code::Expected, start, "the model has no name")
                .help("write `model NAME;` first"),
        );
    }
    for item in file.items {
        edit(item, &mut program, sources, sink);
    }
    program
}

/// The program that the file extends; an empty one if it extends none.
fn base(
    file: &ast::File,
    from: &str,
    chain: &mut Vec<String>,
    sources: &mut SourceMap,
    load: &mut Loader<'_>,
    sink: &mut Sink,
) -> Program {
    let mut bases = file.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Extend(path) => Some((path, item.span)),
        _ => None,
    });
    let Some((path, _)) = bases.next() else { return Program::default() };
    for (_, span) in bases {
        sink.push(
            Diagnostic::error(Code::DuplicateName, span, "a model extends one other model")
                .label(path.span, "this one"),
        );
    }
    let loaded = match load(&path.value, from) {
        Ok(loaded) => loaded,
        Err(reason) => {
            sink.push(Diagnostic::error(
                Code::UnknownFile,
                path.span,
                format!("cannot read `{}`: {reason}", path.value),
            ));
            return Program::default();
        }
    };
    if chain.contains(&loaded.name) {
        let message = format!("`{}` extends itself", loaded.name);
        sink.push(Diagnostic::error(Code::Cycle, path.span, message).help(format!(
            "{} -> {}",
            chain.join(" -> "),
            loaded.name
        )));
        return Program::default();
    }
    let id = sources.add(loaded.name, loaded.text);
    read(id, chain, sources, load, sink)
}

/// Applies one item of a file to the program.
fn edit(item: ast::Item, program: &mut Program, sources: &mut SourceMap, sink: &mut Sink) {
    let ast::Item { docs, kind, span } = item;
    match kind {
        ItemKind::Model(name) => (program.name, program.docs) = (name.text, docs),
        ItemKind::Extend(_) => {}
        ItemKind::Import(import) => imports::import(&import, program, sources, sink),
        ItemKind::Replace(replacement) => replace(*replacement, docs, span, program, sink),
        ItemKind::Drop(dropped) => drop_item(&dropped, program, sink),
        ItemKind::Coordinates(_) | ItemKind::Units(_) => {
            add_single(ast::Item { docs, kind, span }, program, sink)
        }
        kind => program.items.push(ast::Item { docs, kind, span }),
    }
}

/// Adds `coordinates` or `units`, of which there is one.
fn add_single(item: ast::Item, program: &mut Program, sink: &mut Sink) {
    let Some(word) = keyword(&item.kind) else { return };
    match program.items.iter().find(|known| keyword(&known.kind) == Some(word)) {
        None => program.items.push(item),
        Some(known) => sink.push(
            Diagnostic::error(Code::DuplicateName, item.span, format!("`{}` is given twice", word.text()))
                .label(known.span, "already given here")
                .help(format!("a variant writes `replace {} ..`", word.text())),
        ),
    }
}

fn replace(new: Replacement, docs: String, span: Span, program: &mut Program, sink: &mut Sink) {
    match new {
        Replacement::Path(path) => {
            let name = path.name.clone();
            replace_in_geometry(Keyword::Path, &name, GeometryKind::Path(path), docs, span, program, sink);
        }
        Replacement::Region(region) => {
            let name = region.name.clone();
            replace_in_geometry(
                Keyword::Region,
                &name,
                GeometryKind::Region(region),
                docs,
                span,
                program,
                sink,
            );
        }
        Replacement::Item(kind) => replace_item(ast::Item { docs, kind, span }, program, sink),
    }
}

fn replace_item(item: ast::Item, program: &mut Program, sink: &mut Sink) {
    let Some(word) = keyword(&item.kind) else {
        return sink.push(Diagnostic::error(Code::Misplaced, item.span, "this item cannot be replaced"));
    };
    let name = name(&item.kind);
    let text = name.as_ref().map(|name| name.text.clone());
    let at = program.items.iter().position(|known| is(known, word, text.as_deref()));
    match (at, &item.kind, name) {
        (Some(at), ..) => {
            program.items[at] = item;
            let mut index = 0;
            program.items.retain(|known| {
                index += 1;
                index <= at + 1 || !is(known, word, text.as_deref())
            });
        }
        (None, ItemKind::Let(value), Some(name)) => {
            let kind = GeometryKind::Let(value.clone());
            replace_in_geometry(word, &name, kind, item.docs, item.span, program, sink);
        }
        (None, _, name) => nothing_there(
            word,
            name.as_ref().map_or(item.span, |name| name.span),
            text.as_deref(),
            program,
            sink,
        ),
    }
}

fn replace_in_geometry(
    word: Keyword,
    name: &ast::Ident,
    kind: GeometryKind,
    docs: String,
    span: Span,
    program: &mut Program,
    sink: &mut Sink,
) {
    let known = geometry_items(program).find(|known| geometry_is(known, word, &name.text));
    if let Some(known) = known {
        *known = ast::GeometryItem { docs, kind, span };
        return;
    }
    nothing_there(word, name.span, Some(&name.text), program, sink);
}

fn drop_item(dropped: &ast::Drop, program: &mut Program, sink: &mut Sink) {
    let (text, span) = match &dropped.name {
        ast::DropName::Name(name) => (name.text(), name.span),
        ast::DropName::Text(text) => (text.value.clone(), text.span),
    };
    let before = count(program);
    program.items.retain(|known| !is(known, dropped.kind, Some(&text)));
    for item in &mut program.items {
        if let ItemKind::Geometry(ast::Geometry::Built(items)) = &mut item.kind {
            items.retain(|known| !geometry_is(known, dropped.kind, &text));
        }
    }
    if count(program) == before {
        nothing_there(dropped.kind, span, Some(&text), program, sink);
    } else {
        program.dropped.push(ast::Ident { text, span });
    }
}

fn count(program: &mut Program) -> usize {
    program.items.len() + geometry_items(program).count()
}

fn geometry_items(program: &mut Program) -> impl Iterator<Item = &mut ast::GeometryItem> {
    program
        .items
        .iter_mut()
        .filter_map(|item| match &mut item.kind {
            ItemKind::Geometry(ast::Geometry::Built(items)) => Some(items),
            _ => None,
        })
        .flatten()
}

/// `replace` or `drop` found nothing of this kind and name.
fn nothing_there(word: Keyword, span: Span, name: Option<&str>, program: &mut Program, sink: &mut Sink) {
    let Some(name) = name else {
        let message = format!("there is no `{}` to replace", word.text());
        return sink.push(Diagnostic::error(Code::NothingToReplace, span, message));
    };
    let mut same = Vec::new();
    let mut other = None;
    for (kind, known) in declared(program) {
        if kind == word {
            same.push(known);
        } else if known == name {
            other = Some(kind);
        }
    }
    let message = format!("there is no `{} {name}` to replace or drop", word.text());
    let mut diagnostic = Diagnostic::error(Code::NothingToReplace, span, message);
    if let Some(kind) = other {
        diagnostic = diagnostic.help(format!("`{name}` is a `{}`", kind.text()));
    }
    diagnostic = diagnostic.help_did_you_mean(name, same.iter().map(String::as_str));
    sink.push(diagnostic.help(can_be_changed(word, &same)));
}

/// What a variant can replace and drop of a kind of items, of which the base has those named.
fn can_be_changed(word: Keyword, names: &[String]) -> String {
    let unnamed = matches!(
        word,
        Keyword::Mesh | Keyword::Solve | Keyword::Output | Keyword::Moving | Keyword::Geometry
    );
    let word = word.text();
    match names {
        [] if unnamed => format!("`{word}` has no name: write `replace {word} ..`"),
        [] => format!("the base has no `{word}`"),
        names => format!("the base has `{word} {}`", names.join(&format!("`, `{word} "))),
    }
}

/// Every named item of the program and of its geometry.
fn declared(program: &mut Program) -> Vec<(Keyword, String)> {
    let mut all: Vec<(Keyword, String)> = program
        .items
        .iter()
        .filter_map(|item| Some((keyword(&item.kind)?, name(&item.kind)?.text)))
        .collect();
    all.extend(geometry_items(program).filter_map(|item| {
        let (word, name) = geometry_name(item)?;
        Some((word, name.to_owned()))
    }));
    all
}

fn is(item: &ast::Item, word: Keyword, text: Option<&str>) -> bool {
    keyword(&item.kind) == Some(word) && name(&item.kind).map(|name| name.text).as_deref() == text
}

fn geometry_is(item: &ast::GeometryItem, word: Keyword, text: &str) -> bool {
    geometry_name(item) == Some((word, text))
}

fn geometry_name(item: &ast::GeometryItem) -> Option<(Keyword, &str)> {
    match &item.kind {
        GeometryKind::Let(item) => Some((Keyword::Let, &item.name.text)),
        GeometryKind::Path(item) => Some((Keyword::Path, &item.name.text)),
        GeometryKind::Region(item) => Some((Keyword::Region, &item.name.text)),
        GeometryKind::Regions(_) | GeometryKind::Paths(_) => None,
    }
}

/// The keyword of an item that can be replaced or dropped.
fn keyword(kind: &ItemKind) -> Option<Keyword> {
    Some(match kind {
        ItemKind::Part(_) => Keyword::Use,
        ItemKind::Coordinates(_) => Keyword::Coordinates,
        ItemKind::Units(_) => Keyword::Units,
        ItemKind::Param(_) => Keyword::Param,
        ItemKind::Let(_) => Keyword::Let,
        ItemKind::Fn(_) => Keyword::Fn,
        ItemKind::Geometry(_) => Keyword::Geometry,
        ItemKind::Mesh(_) => Keyword::Mesh,
        ItemKind::Field(_) => Keyword::Field,
        ItemKind::State(_) => Keyword::State,
        ItemKind::Local(_) => Keyword::Local,
        ItemKind::Moving(_) => Keyword::Moving,
        ItemKind::Physics(_) => Keyword::Physics,
        ItemKind::Event(_) => Keyword::Event,
        ItemKind::Solve(_) => Keyword::Solve,
        ItemKind::Output(_) => Keyword::Output,
        ItemKind::Sweep(_) => Keyword::Sweep,
        ItemKind::Test(_) => Keyword::Test,
        ItemKind::Model(_)
        | ItemKind::Import(_)
        | ItemKind::Extend(_)
        | ItemKind::Replace(_)
        | ItemKind::Drop(_) => return None,
    })
}

/// The name of an item; a test's title. `None` for blocks without one.
fn name(kind: &ItemKind) -> Option<ast::Ident> {
    Some(match kind {
        ItemKind::Part(item) => item.name.clone(),
        ItemKind::Param(item) => item.name.clone(),
        ItemKind::Let(item) => item.name.clone(),
        ItemKind::Fn(item) => item.name.clone(),
        ItemKind::Field(item) => item.name.clone(),
        ItemKind::State(item) => item.name.clone(),
        ItemKind::Local(item) => item.name.clone(),
        ItemKind::Physics(item) => item.name.clone(),
        ItemKind::Event(item) => item.name.clone(),
        ItemKind::Sweep(item) => item.name.clone(),
        ItemKind::Test(item) => ast::Ident { text: item.title.value.clone(), span: item.title.span },
        _ => return None,
    })
}
