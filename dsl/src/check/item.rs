//! Items: declares the names of a program, then elaborates one item after the other.

use super::{Checker, Declared, DeclaredFunction, Slot};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Block, BlockId, Event, EventId, FieldId, ParamId, StateId, Trigger};
use crate::resolve::Program;
use crate::resolve::scope::Symbol;
use crate::source::Span;
use crate::syntax::ast::{self, ItemKind};

impl<'a> Checker<'a> {
    /// Gives every name of the program its meaning.
    pub(super) fn declare(&mut self, program: &'a Program) {
        self.declare_library(program);
        for (at, name) in item_coordinates(program).into_iter().take(2).enumerate() {
            self.name_symbol(&name, Symbol::Coordinate(at));
        }
        for item in &program.items {
            self.declare_item(item);
        }
        self.reached = (0..self.functions.len()).filter(|&at| self.functions[at].module == 0).collect();
        for name in &program.broken {
            if self.scopes[0].get(&name.text).is_none() {
                self.scopes[0].set(name, Symbol::Broken);
            }
        }
    }

    fn name_symbol(&mut self, name: &ast::Ident, symbol: Symbol) {
        self.scopes[0].declare(name, symbol, self.sink);
    }

    fn declare_library(&mut self, program: &'a Program) {
        for (m, module) in program.modules.iter().enumerate() {
            for (docs, ast) in &module.functions {
                let symbol = Symbol::Function(self.add_function(docs, ast, m + 1));
                self.scopes[m + 1].declare(&ast.name, symbol, self.sink);
            }
        }
        for (m, module) in program.modules.iter().enumerate() {
            for import in &module.imports {
                self.import(import, m + 1);
            }
        }
        for import in &program.imports {
            self.import(import, 0);
        }
    }

    fn import(&mut self, import: &crate::resolve::Import, into: usize) {
        let symbol = self.scopes[import.module + 1].get(&import.name.text).unwrap_or(Symbol::Broken);
        self.scopes[into].declare(&import.name, symbol, self.sink);
    }

    fn add_function(&mut self, docs: &'a str, ast: &'a ast::Function, module: usize) -> usize {
        self.functions.push(DeclaredFunction { docs, ast, module, signature: Slot::Waiting });
        self.functions.len() - 1
    }

    pub(super) fn declare_let(&mut self, docs: &'a str, ast: &'a ast::Let) {
        self.name_symbol(&ast.name, Symbol::Let(self.lets.len()));
        self.lets.push(Declared { docs, ast, slot: Slot::Waiting });
    }

    fn declare_item(&mut self, item: &'a ast::Item) {
        let docs = item.docs.as_str();
        match &item.kind {
            ItemKind::Param(ast) => {
                self.name_symbol(&ast.name, Symbol::Param(ParamId(self.params.len())));
                self.params.push(Declared { docs, ast, slot: Slot::Waiting });
            }
            ItemKind::Let(ast) => self.declare_let(docs, ast),
            ItemKind::Fn(ast) => {
                let at = self.add_function(docs, ast, 0);
                self.name_symbol(&ast.name, Symbol::Function(at));
            }
            ItemKind::Geometry(geometry) => self.declare_geometry(geometry, item.span),
            ItemKind::Field(ast) => {
                self.name_symbol(&ast.name, Symbol::Field(FieldId(self.fields.len())));
                self.fields.push(Declared { docs, ast, slot: Slot::Waiting });
            }
            ItemKind::State(ast) => {
                self.name_symbol(&ast.name, Symbol::State(StateId(self.states.len())));
                self.states.push(Declared { docs, ast, slot: Slot::Waiting });
            }
            ItemKind::Physics(ast) => {
                self.name_symbol(&ast.name, Symbol::Block(BlockId(self.blocks.len())));
                self.blocks.push(Block {
                    name: ast.name.text.clone(),
                    statements: Vec::new(),
                    span: ast.name.span,
                });
            }
            ItemKind::Event(ast) => {
                self.name_symbol(&ast.name, Symbol::Event(EventId(self.events.len())));
                self.events.push(Event {
                    name: ast.name.text.clone(),
                    doc: docs.to_owned(),
                    trigger: Trigger::EveryStep,
                    actions: Vec::new(),
                    span: ast.name.span,
                });
            }
            ItemKind::Local(ast) => {
                self.unsupported(Some(&ast.name), item.span, "unknowns at quadrature points (`local`)")
            }
            ItemKind::Moving(ast) => {
                if let ast::Motion::Solved { name, .. } = &ast.motion {
                    self.name_symbol(name, Symbol::Broken);
                }
            }
            ItemKind::Part(ast) => {
                self.unsupported(Some(&ast.name), item.span, "parts (`use \"file\" as name`)")
            }
            _ => {}
        }
    }

    /// Reports a construct that the compiler does not know yet; the name that it declares says nothing afterwards.
    pub(super) fn unsupported(&mut self, name: Option<&ast::Ident>, span: Span, what: &str) {
        if let Some(name) = name {
            self.name_symbol(name, Symbol::Broken);
        }
        self.sink.push(Diagnostic::error(Code::Unsupported, span, format!("{what} are not supported")));
    }

    /// Elaborates every item in order. What others refer to may have been elaborated before.
    pub(super) fn items(&mut self, program: &'a Program) {
        for at in 0..self.params.len() {
            let _ = self.param(ParamId(at));
        }
        self.geometry(program);
        for at in 0..self.lets.len() {
            let span = self.lets[at].ast.name.span;
            let _ = self.meaning(at, span);
        }
        for at in 0..self.fields.len() {
            self.field(at);
        }
        for at in 0..self.states.len() {
            self.state(at);
        }
        let (mut block, mut event) = (0, 0);
        for item in &program.items {
            match &item.kind {
                ItemKind::Physics(ast) => {
                    self.physics(BlockId(block), ast);
                    block += 1;
                }
                ItemKind::Event(ast) => {
                    self.event_item(EventId(event), ast);
                    event += 1;
                }
                ItemKind::Moving(ast) => self.moving(ast, item.span),
                ItemKind::Mesh(settings) => self.mesh(settings),
                ItemKind::Solve(settings) => self.solve(settings),
                ItemKind::Output(statements) => self.output(statements),
                ItemKind::Sweep(ast) => self.sweep(ast),
                ItemKind::Test(ast) => self.test(ast),
                _ => {}
            }
        }
    }
}

/// The names in the `coordinates` item.
fn item_coordinates(program: &Program) -> Vec<ast::Ident> {
    let args = program.items.iter().find_map(|item| match &item.kind {
        ItemKind::Coordinates(coordinates) => Some(&coordinates.args),
        _ => None,
    });
    args.into_iter()
        .flatten()
        .filter(|arg| arg.name.is_none())
        .filter_map(|arg| arg.value.as_name())
        .collect()
}
