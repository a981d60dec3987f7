//! Items: declares the names of a program, then elaborates one item after the other.

use super::shape::{settle, value};
use super::{Binding, Checked, Checker, Declared, DeclaredFunction, Env, Meaning, Reported, Signature, Slot, domain, zero};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{
    Block, BlockId, Bounds, Event, EventId, Field, FieldId, Function, Param, ParamId, Shape, Space, Start, State, StateId, Trigger, Type,
};
use crate::resolve::Program;
use crate::resolve::scope::Symbol;
use crate::source::Span;
use crate::syntax::ast::{self, ItemKind};
use ansatz_units::Dimension;

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
                self.blocks.push(Block { name: ast.name.text.clone(), statements: Vec::new(), span: ast.name.span });
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
            ItemKind::Local(ast) => self.unsupported(Some(&ast.name), item.span, "unknowns at quadrature points (`local`)"),
            ItemKind::Moving(ast) => {
                let name = match &ast.motion {
                    ast::Motion::Solved { name, .. } => Some(name),
                    ast::Motion::Given(_) => None,
                };
                self.unsupported(name, item.span, "moving domains");
            }
            ItemKind::Part(ast) => self.unsupported(Some(&ast.name), item.span, "parts (`use \"file\" as name`)"),
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
                ItemKind::Mesh(settings) => self.mesh(settings),
                ItemKind::Solve(settings) => self.solve(settings),
                ItemKind::Output(statements) => self.output(statements),
                ItemKind::Sweep(ast) => self.sweep(ast),
                ItemKind::Test(ast) => self.test(ast),
                _ => {}
            }
        }
    }

    /// A parameter, elaborated when it is first met.
    pub(super) fn param(&mut self, id: ParamId) -> Checked<&Param> {
        if matches!(self.params[id.0].slot, Slot::Waiting) {
            self.params[id.0].slot = Slot::Busy;
            let param = self.new_param(id);
            let broken = matches!(self.params[id.0].slot, Slot::Broken);
            self.params[id.0].slot = param.ok().filter(|_| !broken).map_or(Slot::Broken, Slot::Done);
        }
        if matches!(self.params[id.0].slot, Slot::Busy) {
            self.params[id.0].slot = Slot::Broken;
            let name = &self.params[id.0].ast.name;
            let message = format!("the default of `{}` uses its own value", name.text);
            return Err(self.report(Diagnostic::error(Code::Cycle, name.span, message)));
        }
        match &self.params[id.0].slot {
            Slot::Done(param) => Ok(param),
            _ => Err(Reported),
        }
    }

    fn new_param(&mut self, id: ParamId) -> Checked<Param> {
        let Declared { docs, ast, .. } = self.params[id.0];
        let env = Env::default();
        let declared = ast.ty.as_ref().map(|ty| self.ty(ty)).transpose()?;
        let Some(default) = &ast.value else {
            let message = format!("parameter `{}` has no value", ast.name.text);
            return Err(self.report(
                Diagnostic::error(Code::MissingArgument, ast.name.span, message)
                    .help("only parts have inputs without a value; write `= ..`"),
            ));
        };
        let value = match &declared {
            Some(ty) => self.typed(default, ty, &format!("`{}`", ast.name.text), &env)?,
            None => self.settled(default, &env)?,
        };
        let dimension = self.scalar(&value, "a parameter")?;
        let ty = Type::Value(Shape::Scalar, dimension);
        let bounds = ast.bounds.as_ref().map(|bounds| self.bounds(bounds, &ty, &ast.name)).transpose()?;
        let unit = self.written_unit(default, dimension);
        Ok(Param {
            name: ast.name.text.clone(),
            doc: docs.to_owned(),
            dimension,
            default: value,
            bounds,
            unit,
            span: ast.name.span,
        })
    }

    /// Size in SI and text of the unit in which a default is written.
    fn written_unit(&mut self, default: &ast::Expr, dimension: Dimension) -> (f64, String) {
        let number = match &default.kind {
            ast::ExprKind::Unary { operand, .. } => &operand.kind,
            kind => kind,
        };
        if let ast::ExprKind::Number(ast::Number { unit: Some(written), .. }) = number
            && let Ok(unit) = self.unit(written)
        {
            let text = written.text.trim_start_matches('[').trim_end_matches(']').trim();
            return (unit.factor_to_si(), text.to_owned());
        }
        (self.units.scale(dimension), super::unit::unit_text(&self.units, dimension))
    }

    /// `in a .. b` or `in {a, b}` of a quantity.
    fn bounds(&mut self, bounds: &ast::Bounds, ty: &Type, name: &ast::Ident) -> Checked<Bounds> {
        let what = format!("a bound of `{}`", name.text);
        match bounds {
            ast::Bounds::Range(range) => {
                let (low, high) = self.range(range, ty, &what)?;
                Ok(Bounds::Range(low, high))
            }
            ast::Bounds::Set(set) => Ok(Bounds::Set(self.set(set, ty, &what, &Env::default())?)),
        }
    }

    pub(super) fn range(
        &mut self,
        range: &ast::Range,
        ty: &Type,
        what: &str,
    ) -> Checked<(crate::model::Expr, crate::model::Expr)> {
        let env = Env::default();
        let (low, high) = (self.typed(&range.low, ty, what, &env), self.typed(&range.high, ty, what, &env));
        Ok((low?, high?))
    }

    /// Members of a set, each with the unit behind the set if there is one.
    pub(super) fn set(&mut self, set: &ast::Set, ty: &Type, what: &str, env: &Env) -> Checked<Vec<crate::model::Expr>> {
        let unit = set.unit.as_ref().map(|unit| self.unit(unit)).transpose()?;
        let items = set.items.iter().map(|item| {
            let mut value = self.expr(item, env)?;
            if let Some(unit) = unit {
                self.need_number(&value, "a member of a set with a unit")?;
                value = self.with_unit(settle(value), unit);
            }
            self.expect(value, ty, what)
        });
        let items: Vec<Checked<_>> = items.collect();
        items.into_iter().collect()
    }

    /// What a `let` names.
    pub(super) fn let_meaning(&mut self, at: usize) -> Checked<Meaning> {
        let Declared { docs, ast, .. } = self.lets[at];
        let env = Env::default();
        if let ast::ExprKind::Call { args, .. } = &ast.value.kind
            && domain::is_pair(&ast.value)
        {
            return self.pair(&ast.name, args, ast.value.span).map(Meaning::Pair);
        }
        if self.names_places(&ast.value, &env, 0) {
            return self.domain(&ast.value, &env).map(Meaning::Domain);
        }
        let value = self.let_value_of(ast, &env)?;
        Ok(Meaning::Value(self.value(&ast.name, docs, value)))
    }

    /// The value of a `let`, of the declared type if there is one.
    pub(super) fn let_value_of(&mut self, ast: &ast::Let, env: &Env) -> Checked<crate::model::Expr> {
        match &ast.ty {
            Some(ty) => {
                let ty = self.ty(ty);
                let value = self.expr(&ast.value, env);
                self.expect(value?, &ty?, &format!("`{}`", ast.name.text))
            }
            None => self.settled(&ast.value, env),
        }
    }

    /// Type of a function, elaborated when it is first met.
    pub(super) fn signature(&mut self, at: usize) -> Checked<Signature> {
        if matches!(self.functions[at].signature, Slot::Waiting) {
            let signature = self.new_signature(at);
            self.functions[at].signature = signature.map_or(Slot::Broken, Slot::Done);
        }
        match &self.functions[at].signature {
            Slot::Done(signature) => Ok(signature.clone()),
            _ => Err(Reported),
        }
    }

    fn new_signature(&mut self, at: usize) -> Checked<Signature> {
        let ast = self.functions[at].ast;
        let types: Vec<Checked<Type>> = ast.params.iter().map(|param| self.ty(&param.ty)).collect();
        let result = self.ty(&ast.result);
        let types = types.into_iter().collect::<Checked<Vec<_>>>()?;
        for (k, param) in ast.params.iter().enumerate() {
            if let Some(first) = ast.params[..k].iter().find(|other| other.name.text == param.name.text) {
                let message = format!("`{}` has two arguments `{}`", ast.name.text, param.name.text);
                return Err(self.report(
                    Diagnostic::error(Code::DuplicateName, param.name.span, message).label(first.name.span, "the first"),
                ));
            }
        }
        let arguments = ast.params.iter().zip(types).map(|(param, ty)| (self.local(&param.name.text, ty.clone()), ty));
        Ok(Signature { arguments: arguments.collect(), result: result? })
    }

    /// Elaborates the bodies of all functions in use.
    pub(super) fn functions(&mut self) {
        while self.bodies.len() < self.reached.len() {
            let at = self.reached[self.bodies.len()];
            let body = self.body(at).ok();
            self.bodies.push(body);
        }
    }

    fn body(&mut self, at: usize) -> Checked<Function> {
        let Signature { arguments, result } = self.signature(at)?;
        let DeclaredFunction { docs, ast, module, .. } = self.functions[at];
        let mut env = Env { module, locals: Vec::new() };
        for (param, (id, _)) in ast.params.iter().zip(&arguments) {
            env.bind(&param.name, Binding::Local(*id));
        }
        let mut lets = Vec::new();
        for item in &ast.locals {
            match item {
                ast::BodyItem::Let(item) => match self.let_value_of(item, &env) {
                    Ok(value) => {
                        let id = self.local(&item.name.text, value.ty.clone());
                        lets.push((id, value));
                        env.bind(&item.name, Binding::Local(id));
                    }
                    Err(Reported) => env.bind(&item.name, Binding::Broken),
                },
                ast::BodyItem::Local(item) => {
                    let message = "unknowns at quadrature points (`local`) are not supported";
                    self.sink.push(Diagnostic::error(Code::Unsupported, item.name.span, message));
                    env.bind(&item.name, Binding::Broken);
                }
            }
        }
        let result = self.typed(&ast.value, &result, &format!("the value of `{}`", ast.name.text), &env)?;
        Ok(Function { name: ast.name.text.clone(), doc: docs.to_owned(), arguments, lets, result, span: ast.name.span })
    }

    /// Type of a field; needs its declaration only.
    pub(super) fn field_type(&mut self, id: FieldId) -> Checked<Type> {
        if let Slot::Waiting = self.fields[id.0].slot {
            let ast = self.fields[id.0].ast;
            let ty = self.ty(&ast.ty).and_then(|ty| match ty {
                Type::Value(Shape::Tensor, _) => {
                    Err(self.report(Diagnostic::error(Code::Unsupported, ast.ty.span, "tensor fields are not supported")))
                }
                Type::Value(..) => Ok(ty),
                _ => Err(self.report(Diagnostic::error(Code::DeclaredShape, ast.ty.span, "a field is a scalar or a vector"))),
            });
            self.fields[id.0].slot = ty.map_or(Slot::Broken, Slot::Done);
        }
        match &self.fields[id.0].slot {
            Slot::Done(ty) => Ok(ty.clone()),
            _ => Err(Reported),
        }
    }

    /// Dimension of a state; needs its declaration only.
    pub(super) fn state_dimension(&mut self, id: StateId) -> Checked<Dimension> {
        if let Slot::Waiting = self.states[id.0].slot {
            let ast = self.states[id.0].ast;
            let dimension = self.ty(&ast.ty).and_then(|ty| match ty {
                Type::Value(Shape::Scalar, dimension) => Ok(dimension),
                _ => Err(self.report(Diagnostic::error(Code::DeclaredShape, ast.ty.span, "a state is a scalar"))),
            });
            self.states[id.0].slot = dimension.map_or(Slot::Broken, Slot::Done);
        }
        match self.states[id.0].slot {
            Slot::Done(dimension) => Ok(dimension),
            _ => Err(Reported),
        }
    }

    fn field(&mut self, at: usize) {
        let Declared { docs, ast, .. } = self.fields[at];
        let ty = self.field_type(FieldId(at));
        let domain = self.domain(&ast.domain, &Env::default());
        let start = self.start(ast.start.as_ref(), ty.as_ref().ok(), &ast.name);
        let space = self.space(&ast.space);
        let (shape, dimension) = ty.as_ref().ok().and_then(value).unwrap_or((Shape::Scalar, Dimension::NUMBER));
        let domain = domain.and_then(|domain| match domain::kind(&domain) {
            domain::Kind::Cells => Ok(domain),
            _ => Err(self.report(Diagnostic::error(Code::Unsupported, ast.domain.span, "fields on paths are not supported"))),
        });
        self.rest.fields.push(Field {
            name: ast.name.text.clone(),
            doc: docs.to_owned(),
            shape,
            dimension,
            space: space.unwrap_or(Space::P2),
            domain: domain.unwrap_or(crate::model::Domain { pieces: Vec::new(), span: ast.domain.span }),
            start: start.unwrap_or(Start::Solved),
            span: ast.name.span,
        });
    }

    fn space(&mut self, name: &ast::Ident) -> Checked<Space> {
        match name.text.as_str() {
            "P1" => Ok(Space::P1),
            "P2" => Ok(Space::P2),
            _ => Err(self.report(
                Diagnostic::error(Code::UnknownName, name.span, format!("there is no element space `{}`", name.text))
                    .help("write `P1` (linear) or `P2` (quadratic)"),
            )),
        }
    }

    fn start(&mut self, start: Option<&ast::Start>, ty: Option<&Type>, name: &ast::Ident) -> Checked<Start> {
        let ty = ty.ok_or(Reported)?;
        let what = format!("the start of `{}`", name.text);
        let env = Env::default();
        match start {
            None => Ok(Start::Solved),
            Some(ast::Start::Value(e)) => self.typed(e, ty, &what, &env).map(Start::Value),
            Some(ast::Start::Guess(e)) => self.typed(e, ty, &what, &env).map(Start::Guess),
        }
    }

    fn state(&mut self, at: usize) {
        let Declared { docs, ast, .. } = self.states[at];
        let dimension = self.state_dimension(StateId(at));
        let ty = dimension.ok().map(|dimension| Type::Value(Shape::Scalar, dimension));
        let start = self.start(ast.start.as_ref(), ty.as_ref(), &ast.name);
        let bounds = match (&ast.bounds, &ty) {
            (Some(ast::Bounds::Range(range)), Some(ty)) => {
                self.range(range, ty, &format!("a bound of `{}`", ast.name.text)).ok()
            }
            (Some(ast::Bounds::Set(set)), _) => {
                self.sink.push(Diagnostic::error(Code::Misplaced, set.span, "a state varies in a range, not in a set"));
                None
            }
            _ => None,
        };
        self.rest.states.push(State {
            name: ast.name.text.clone(),
            doc: docs.to_owned(),
            dimension: dimension.unwrap_or(Dimension::NUMBER),
            start: start.unwrap_or(Start::Solved),
            bounds,
            span: ast.name.span,
        });
    }

    /// The parameters, faulty ones as zero.
    pub(super) fn taken_params(&mut self) -> Vec<Param> {
        let taken = self.params.iter().map(|declared| match &declared.slot {
            Slot::Done(param) => param.clone(),
            _ => Param {
                name: declared.ast.name.text.clone(),
                doc: String::new(),
                dimension: Dimension::NUMBER,
                default: zero(declared.ast.name.span),
                bounds: None,
                unit: (1.0, "1".into()),
                span: declared.ast.name.span,
            },
        });
        taken.collect()
    }

    /// The functions in use, faulty ones as zero.
    pub(super) fn taken_functions(&mut self) -> Vec<Function> {
        let bodies = std::mem::take(&mut self.bodies);
        let taken = bodies.into_iter().zip(&self.reached).map(|(body, &at)| {
            body.unwrap_or_else(|| {
                let name = &self.functions[at].ast.name;
                let result = zero(name.span);
                Function { name: name.text.clone(), doc: String::new(), arguments: Vec::new(), lets: Vec::new(), result, span: name.span }
            })
        });
        taken.collect()
    }
}

/// The names in the `coordinates` item.
fn item_coordinates(program: &Program) -> Vec<ast::Ident> {
    let args = program.items.iter().find_map(|item| match &item.kind {
        ItemKind::Coordinates(coordinates) => Some(&coordinates.args),
        _ => None,
    });
    args.into_iter().flatten().filter(|arg| arg.name.is_none()).filter_map(|arg| arg.value.as_name()).collect()
}
