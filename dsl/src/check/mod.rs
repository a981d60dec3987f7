//! Stage 3 of 6: gives every name an id and every expression a type. Input: a [`Program`]. Output: a [`Model`], or diagnostics.
//!
//! Items may stand in any order: what a name stands for is elaborated when it is first met (`Slot`). A faulty item is reported once and its
//! name says nothing afterwards (`Reported`). Two passes over the finished model follow: `place` asks whether values exist where they
//! are used, [`dae`] counts equations.

mod builtin;
mod call;
mod constant;
mod context;
mod cover;
pub mod dae;
mod domain;
mod expr;
mod form;
mod frame;
mod function;
mod geometry;
mod item;
mod load;
mod matching;
mod moving;
mod output;
mod pair;
mod param;
mod physics;
mod place;
mod print;
mod reduce;
mod repeat;
mod settings;
mod shape;
mod test;
mod types;
pub(crate) mod unit;
mod unknown;
pub(crate) mod walk;
mod work;

use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::model::{
    Block, Coordinates, Event, Expr, Geometry, Let, LetId, LocalId, Model, Pair, PairId, Type,
};
use crate::resolve::Program;
use crate::resolve::scope::{Scope, Symbol};
use crate::source::SourceMap;
use crate::syntax::ast;
use ansatz_units::{Dimension, UnitSystem};

/// Something was wrong and has been said.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reported;

/// A result whose error has been reported.
pub(crate) type Checked<T> = Result<T, Reported>;

/// Checks a program. Everything that is wrong goes to `sink`; the model is returned if nothing is.
///
/// `sources` holds the texts of the program, from which columns without a name take theirs.
pub fn check(program: &Program, sources: &SourceMap, sink: &mut Sink) -> Option<Model> {
    let mut checker = Checker::new(program, sources, sink);
    checker.declare(program);
    checker.items(program);
    checker.functions();
    let model = checker.finish(program);
    place::check(&model, sink);
    load::check(&model, sources, sink);
    if !sink.has_errors() {
        form::check(&model, sink);
        moving::check(&model, sources, sink);
        repeat::check(&model, sink);
        work::check(&model, sink);
        dae::check(&model, sources, sink);
    }
    (!sink.has_errors()).then_some(model)
}

/// How far the elaboration of a declaration has come.
#[derive(Clone, Debug)]
pub(crate) enum Slot<T> {
    /// Not looked at.
    Waiting,
    /// Under elaboration: meeting it again is a circle.
    Busy,
    /// Done.
    Done(T),
    /// Faulty, reported.
    Broken,
}

/// What a `let` names.
#[derive(Clone, Debug)]
pub(crate) enum Meaning {
    /// A value.
    Value(LetId),
    /// Places.
    Domain(crate::model::Domain),
    /// Two surfaces.
    Pair(PairId),
}

/// A declaration, its docs and its elaboration.
pub(crate) struct Declared<'a, A, T> {
    pub(crate) docs: &'a str,
    pub(crate) ast: &'a A,
    pub(crate) slot: Slot<T>,
}

/// A function, the text that it stands in, and its type.
pub(crate) struct DeclaredFunction<'a> {
    pub(crate) docs: &'a str,
    pub(crate) ast: &'a ast::Function,
    pub(crate) module: usize,
    pub(crate) signature: Slot<Signature>,
}

/// Arguments and result of a function.
#[derive(Clone, Debug)]
pub(crate) struct Signature {
    pub(crate) arguments: Vec<(LocalId, Type)>,
    pub(crate) result: Type,
}

/// What a name of an enclosing block stands for.
#[derive(Clone, Debug)]
pub(crate) enum Binding {
    /// An argument, a `let` of a function, a loop variable.
    Local(LocalId),
    /// A `let` of a physics block.
    Let(LetId),
    /// Its declaration is wrong.
    Broken,
}

/// The names around an expression beyond those of the file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Env {
    /// Which text: 0 is the model, `1 + m` is library module `m`.
    pub(crate) module: usize,
    /// Later ones hide earlier ones.
    pub(crate) locals: Vec<(String, Binding)>,
}

impl Env {
    pub(crate) fn bind(&mut self, name: &ast::Ident, binding: Binding) {
        self.locals.push((name.text.clone(), binding));
    }
}

/// The elaboration of one program.
pub(crate) struct Checker<'a> {
    pub(crate) program: &'a Program,
    pub(crate) sink: &'a mut Sink,
    pub(crate) sources: &'a SourceMap,
    pub(crate) units: UnitSystem,
    pub(crate) coordinates: Coordinates,
    pub(crate) scopes: Vec<Scope>,
    pub(crate) params: Vec<Declared<'a, ast::Param, crate::model::Param>>,
    pub(crate) lets: Vec<Declared<'a, ast::Let, Meaning>>,
    pub(crate) functions: Vec<DeclaredFunction<'a>>,
    /// Positions of the functions in use; a `FunctionId` is an index into this.
    pub(crate) reached: Vec<usize>,
    pub(crate) bodies: Vec<Option<crate::model::Function>>,
    pub(crate) fields: Vec<Declared<'a, ast::Field, Type>>,
    pub(crate) states: Vec<Declared<'a, ast::State, Dimension>>,
    pub(crate) values: Vec<Let>,
    pub(crate) locals: Vec<(String, Type)>,
    pub(crate) geometry: Geometry,
    pub(crate) pairs: Vec<Pair>,
    pub(crate) blocks: Vec<Block>,
    pub(crate) events: Vec<Event>,
    pub(crate) rest: frame::Rest,
    /// Definitions under elaboration, each of which waits for the next.
    waiting: usize,
}

/// Definitions that may wait for one another, where each uses one that stands behind it.
const MAX_WAITING: usize = 100;

impl<'a> Checker<'a> {
    fn new(program: &'a Program, sources: &'a SourceMap, sink: &'a mut Sink) -> Self {
        let units = frame::units(program, sink);
        let coordinates = frame::coordinates(program, sink);
        Self {
            program,
            sink,
            sources,
            units,
            coordinates,
            scopes: vec![Scope::default(); 1 + program.modules.len()],
            params: Vec::new(),
            lets: Vec::new(),
            functions: Vec::new(),
            reached: Vec::new(),
            bodies: Vec::new(),
            fields: Vec::new(),
            states: Vec::new(),
            values: Vec::new(),
            locals: Vec::new(),
            geometry: Geometry::default(),
            pairs: Vec::new(),
            blocks: Vec::new(),
            events: Vec::new(),
            rest: frame::Rest::default(),
            waiting: 0,
        }
    }

    /// Takes a diagnostic and says that it did.
    pub(crate) fn report(&mut self, diagnostic: Diagnostic) -> Reported {
        self.sink.push(diagnostic);
        Reported
    }

    /// Elaborates a definition for which others may wait; a chain of too many that do is reported once.
    pub(crate) fn waited_for<T>(
        &mut self,
        name: &ast::Ident,
        elaborate: impl FnOnce(&mut Self) -> Checked<T>,
    ) -> Checked<T> {
        if self.waiting == MAX_WAITING {
            if !self.sink.iter().any(|diagnostic| diagnostic.code == Code::TooDeep) {
                let message = format!("more than {MAX_WAITING} definitions wait for that of `{}`", name.text);
                self.sink.push(
                    Diagnostic::error(Code::TooDeep, name.span, message)
                        .help("declare what others use before them"),
                );
            }
            return Err(Reported);
        }
        self.waiting += 1;
        let elaborated = elaborate(self);
        self.waiting -= 1;
        elaborated
    }

    /// A new local name.
    pub(crate) fn local(&mut self, name: &str, ty: Type) -> LocalId {
        self.locals.push((name.to_owned(), ty));
        LocalId(self.locals.len() - 1)
    }

    /// A new value under a name.
    pub(crate) fn value(&mut self, name: &ast::Ident, docs: &str, value: Expr) -> LetId {
        self.values.push(Let { name: name.text.clone(), doc: docs.to_owned(), value, span: name.span });
        LetId(self.values.len() - 1)
    }

    /// The value of a `let`.
    pub(crate) fn let_value(&self, id: LetId) -> Option<&Expr> {
        self.values.get(id.0).map(|item| &item.value)
    }

    /// What a name stands for in a text; block names are looked up by the caller first.
    pub(crate) fn symbol(&self, name: &str, env: &Env) -> Option<Symbol> {
        self.scopes.get(env.module).and_then(|scope| scope.get(name))
    }

    fn finish(self, program: &Program) -> Model {
        frame::assemble(self, program)
    }
}

/// Placeholders that keep ids in step where an item is faulty; no finished model holds one.
pub(crate) fn zero(span: crate::source::Span) -> Expr {
    Expr {
        kind: crate::model::ExprKind::Number(0.0),
        ty: Type::Value(crate::model::Shape::Scalar, Dimension::NUMBER),
        span,
    }
}

#[cfg(test)]
mod tests;
