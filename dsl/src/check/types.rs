//! Written types: `Tensor[Pressure]`, `Energy/Volume`, `fn(Tensor) -> Pressure`, `(l1: Number, k1: 1/Length)`.

use super::{Checked, Checker, Reported};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Shape, Type};
use crate::source::Span;
use crate::syntax::ast::{self, TypeKind};
use ansatz_units::Dimension;

impl Checker<'_> {
    /// The type that is written.
    pub(super) fn ty(&mut self, ty: &ast::TypeExpr) -> Checked<Type> {
        match &ty.kind {
            TypeKind::Named(name) if name == "Condition" => Ok(Type::Condition),
            TypeKind::Shaped { shape, element } => {
                let dimension = match element {
                    Some(element) => self.dimension(element)?,
                    None => Dimension::NUMBER,
                };
                let shape = match shape {
                    ast::Shape::Vector => Shape::Vector,
                    ast::Shape::Tensor => Shape::Tensor,
                };
                Ok(Type::Value(shape, dimension))
            }
            TypeKind::Function { args, result } => {
                let arguments = args.iter().map(|arg| self.ty(arg)).collect::<Vec<_>>();
                let result = self.ty(result)?;
                Ok(Type::Law(arguments.into_iter().collect::<Checked<_>>()?, Box::new(result)))
            }
            TypeKind::Record(members) => {
                let members =
                    members.iter().map(|member| Ok((member.name.text.clone(), self.ty(&member.ty)?)));
                Ok(Type::Record(members.collect::<Checked<_>>()?))
            }
            _ => Ok(Type::Value(Shape::Scalar, self.dimension(ty)?)),
        }
    }

    /// The dimension that is written.
    fn dimension(&mut self, ty: &ast::TypeExpr) -> Checked<Dimension> {
        match &ty.kind {
            TypeKind::One => Ok(Dimension::NUMBER),
            TypeKind::Named(name) => Dimension::named(name).ok_or_else(|| self.unknown_type(name, ty.span)),
            TypeKind::Product(a, b) => Ok(self.dimension(a)? * self.dimension(b)?),
            TypeKind::Quotient(a, b) => Ok(self.dimension(a)? / self.dimension(b)?),
            TypeKind::Power(a, exponent) => Ok(self.dimension(a)?.pow(*exponent)),
            TypeKind::Shaped { .. } | TypeKind::Function { .. } | TypeKind::Record(_) => Err(self.report(
                Diagnostic::error(Code::DeclaredShape, ty.span, "a dimension is needed here")
                    .help("shapes go around dimensions: `Vector[Length/Time]`"),
            )),
        }
    }

    fn unknown_type(&mut self, name: &str, span: Span) -> Reported {
        self.report(
            Diagnostic::error(Code::UnknownName, span, format!("there is no type `{name}`"))
                .help_did_you_mean(name, Dimension::names().chain(["Vector", "Tensor", "Condition"])),
        )
    }
}
