//! `let`s and functions: names for expressions, elaborated when they are first met.

use super::{
    Binding, Checked, Checker, Declared, DeclaredFunction, Env, Meaning, Reported, Signature, Slot, pair,
    zero,
};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Expr, Function, Type};
use crate::source::Span;
use crate::syntax::ast;

impl Checker<'_> {
    /// What a `let` of the file or geometry names.
    pub(super) fn meaning(&mut self, at: usize, span: Span) -> Checked<Meaning> {
        match &self.lets[at].slot {
            Slot::Done(meaning) => return Ok(meaning.clone()),
            Slot::Broken => return Err(Reported),
            Slot::Busy => {
                self.lets[at].slot = Slot::Broken;
                let name = &self.lets[at].ast.name;
                let message = format!("`{}` is defined by itself", name.text);
                return Err(
                    self.report(Diagnostic::error(Code::Cycle, name.span, message).label(span, "used here"))
                );
            }
            Slot::Waiting => {}
        }
        self.lets[at].slot = Slot::Busy;
        let Declared { ast, .. } = self.lets[at];
        let elaborated = self.waited_for(&ast.name, |checker| checker.let_meaning(at));
        if matches!(self.lets[at].slot, Slot::Broken) {
            return Err(Reported);
        }
        self.lets[at].slot = elaborated.as_ref().map_or(Slot::Broken, |meaning| Slot::Done(meaning.clone()));
        elaborated
    }

    /// What a `let` names.
    pub(super) fn let_meaning(&mut self, at: usize) -> Checked<Meaning> {
        let Declared { docs, ast, .. } = self.lets[at];
        let env = Env::default();
        if let ast::ExprKind::Call { args, .. } = &ast.value.kind
            && pair::is_pair(&ast.value)
        {
            return self.pair(&ast.name, args, ast.value.span).map(Meaning::Pair);
        }
        if self.names_places(&ast.value, &env, 0) {
            return self.places(&ast.value, &env).map(Meaning::Domain);
        }
        let value = self.let_value_of(ast, &env)?;
        Ok(Meaning::Value(self.value(&ast.name, docs, value)))
    }

    /// The value of a `let`, of the declared type if there is one.
    pub(super) fn let_value_of(&mut self, ast: &ast::Let, env: &Env) -> Checked<Expr> {
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
                    Diagnostic::error(Code::DuplicateName, param.name.span, message)
                        .label(first.name.span, "the first"),
                ));
            }
        }
        let arguments =
            ast.params.iter().zip(types).map(|(param, ty)| (self.local(&param.name.text, ty.clone()), ty));
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
        Ok(Function {
            name: ast.name.text.clone(),
            doc: docs.to_owned(),
            arguments,
            lets,
            result,
            span: ast.name.span,
        })
    }

    /// The functions in use, faulty ones as zero.
    pub(super) fn taken_functions(&mut self) -> Vec<Function> {
        let bodies = std::mem::take(&mut self.bodies);
        let taken = bodies.into_iter().zip(&self.reached).map(|(body, &at)| {
            body.unwrap_or_else(|| {
                let name = &self.functions[at].ast.name;
                let result = zero(name.span);
                Function {
                    name: name.text.clone(),
                    doc: String::new(),
                    arguments: Vec::new(),
                    lets: Vec::new(),
                    result,
                    span: name.span,
                }
            })
        });
        taken.collect()
    }
}
