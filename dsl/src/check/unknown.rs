//! Fields and states: the unknowns, their domains and starts.

use super::shape::value;
use super::{Checked, Checker, Declared, Env, Reported, Slot};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Domain, Field, FieldId, Shape, Space, Start, State, StateId, Type};
use crate::syntax::ast;
use ansatz_units::Dimension;

impl Checker<'_> {
    /// Type of a field; needs its declaration only.
    pub(super) fn field_type(&mut self, id: FieldId) -> Checked<Type> {
        if let Slot::Waiting = self.fields[id.0].slot {
            let ast = self.fields[id.0].ast;
            let ty = self.ty(&ast.ty).and_then(|ty| match ty {
                Type::Value(Shape::Tensor, _) => Err(self.report(Diagnostic::error(
                    Code::Unsupported,
                    ast.ty.span,
                    "tensor fields are not supported",
                ))),
                Type::Value(..) => Ok(ty),
                _ => Err(self.report(Diagnostic::error(
                    Code::DeclaredShape,
                    ast.ty.span,
                    "a field is a scalar or a vector",
                ))),
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
                _ => Err(self.report(Diagnostic::error(
                    Code::DeclaredShape,
                    ast.ty.span,
                    "a state is a scalar",
                ))),
            });
            self.states[id.0].slot = dimension.map_or(Slot::Broken, Slot::Done);
        }
        match self.states[id.0].slot {
            Slot::Done(dimension) => Ok(dimension),
            _ => Err(Reported),
        }
    }

    pub(super) fn field(&mut self, at: usize) {
        let Declared { docs, ast, .. } = self.fields[at];
        let ty = self.field_type(FieldId(at));
        let domain = self.carrier(&ast.domain);
        let start = self.start(ast.start.as_ref(), ty.as_ref().ok(), &ast.name);
        let space = self.space(&ast.space);
        let (shape, dimension) =
            ty.as_ref().ok().and_then(value).unwrap_or((Shape::Scalar, Dimension::NUMBER));
        self.rest.fields.push(Field {
            name: ast.name.text.clone(),
            doc: docs.to_owned(),
            shape,
            dimension,
            space: space.unwrap_or(Space::P2),
            domain: domain.unwrap_or(Domain { pieces: Vec::new(), current: false, span: ast.domain.span }),
            start: start.unwrap_or(Start::Solved),
            span: ast.name.span,
        });
    }

    fn space(&mut self, name: &ast::Ident) -> Checked<Space> {
        match name.text.as_str() {
            "P1" => Ok(Space::P1),
            "P2" => Ok(Space::P2),
            _ => Err(self.report(
                Diagnostic::error(
                    Code::UnknownName,
                    name.span,
                    format!("there is no element space `{}`", name.text),
                )
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

    pub(super) fn state(&mut self, at: usize) {
        let Declared { docs, ast, .. } = self.states[at];
        let dimension = self.state_dimension(StateId(at));
        let ty = dimension.ok().map(|dimension| Type::Value(Shape::Scalar, dimension));
        let start = self.start(ast.start.as_ref(), ty.as_ref(), &ast.name);
        let bounds = match (&ast.bounds, &ty) {
            (Some(ast::Bounds::Range(range)), Some(ty)) => {
                self.range(range, ty, &format!("a bound of `{}`", ast.name.text)).ok()
            }
            (Some(ast::Bounds::Set(set)), _) => {
                self.sink.push(Diagnostic::error(
                    Code::Misplaced,
                    set.span,
                    "a state varies in a range, not in a set",
                ));
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
}
