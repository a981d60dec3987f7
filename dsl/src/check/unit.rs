//! Units: literals into the model's coherent units, and dimensions in words.

use super::{Checked, Checker, Env, Reported};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Expr, ExprKind, Shape, Type};
use crate::source::Span;
use crate::syntax::ast::{self, BinaryOp};
use ansatz_units::{Dimension, Unit, UnitExpr, UnitSystem, convert};

impl Checker<'_> {
    /// A unit as written; an unknown symbol is reported.
    pub(super) fn unit(&mut self, unit: &ast::UnitExpr) -> Checked<UnitExpr> {
        let mut product = Ok(UnitExpr::ONE);
        for factor in &unit.factors {
            match Unit::find(&factor.symbol.text) {
                Some(known) => {
                    product = product.map(|p: UnitExpr| p * UnitExpr::from(known).pow(factor.exponent))
                }
                None => product = Err(self.unknown_unit(&factor.symbol)),
            }
        }
        product
    }

    fn unknown_unit(&mut self, symbol: &ast::Ident) -> Reported {
        let message = format!("`{}` is no unit", symbol.text);
        self.report(Diagnostic::error(Code::UnknownUnit, symbol.span, message).help_unit(&symbol.text))
    }

    /// A number literal in coherent units; 0 without unit fits everything.
    pub(super) fn number(&mut self, number: &ast::Number, span: Span) -> Checked<Expr> {
        let Some(written) = &number.unit else {
            let ty = if number.value == 0.0 { Type::Zero } else { Type::NUMBER };
            return Ok(Expr { kind: ExprKind::Number(number.value), ty, span });
        };
        let unit = self.unit(written)?;
        Ok(self.measured(number.value, unit, span))
    }

    /// `value` units as a literal in coherent units.
    pub(super) fn measured(&self, value: f64, unit: UnitExpr, span: Span) -> Expr {
        let value = convert(value, unit.scale, self.units.exact_scale(unit.dimension));
        Expr { kind: ExprKind::Number(value), ty: Type::Value(Shape::Scalar, unit.dimension), span }
    }

    /// `e` times a unit written behind the parentheses around it.
    pub(super) fn with_unit(&self, e: Expr, unit: UnitExpr) -> Expr {
        match e.kind {
            ExprKind::Number(value) => self.measured(value, unit, e.span),
            _ => {
                let span = e.span;
                let one = self.measured(1.0, unit, span);
                super::shape::multiply(e, one, span)
            }
        }
    }

    /// Reports a unit of several names without brackets: `1000 kg/m^3` with no `m` declared.
    pub(super) fn unbracketed(&mut self, e: &ast::Expr, env: &Env) -> Option<Reported> {
        let (number, written, first) = unbracketed_parts(e)?;
        let known = env.locals.iter().any(|(name, _)| *name == first) || self.symbol(&first, env).is_some();
        if known {
            return None;
        }
        let (text, whole) = (&number.text, self.sources.slice(e.span));
        let verb = if whole.contains('/') { "divided by" } else { "times" };
        let message = format!(
            "`{whole}` means {text} {written} {verb} something called `{first}`, and no `{first}` is declared"
        );
        let unit: String = whole.strip_prefix(text.as_str())?.split_whitespace().collect();
        Some(
            self.report(
                Diagnostic::error(Code::UnitNeedsBrackets, e.span, message)
                    .help(format!("write `{text} [{unit}]`")),
            ),
        )
    }

    /// A type in words: `Pressure (kPa)`, `Vector[Length] (um)`.
    pub(super) fn words(&self, ty: &Type) -> String {
        words(&self.units, ty)
    }
}

/// The number, its unit and the first further name of a product or quotient that reads like one unit.
fn unbracketed_parts(e: &ast::Expr) -> Option<(&ast::Number, &str, String)> {
    let ast::ExprKind::Binary { op: BinaryOp::Mul | BinaryOp::Div, left, right, .. } = &e.kind else {
        return None;
    };
    let name = unit_name(right)?;
    match &left.kind {
        ast::ExprKind::Number(number) => {
            let unit = number.unit.as_ref().filter(|unit| !unit.text.starts_with('['))?;
            Some((number, &unit.text, name))
        }
        _ => unbracketed_parts(left),
    }
}

/// The unit that `e` would be: a name from the list, perhaps with an exponent.
fn unit_name(e: &ast::Expr) -> Option<String> {
    match &e.kind {
        ast::ExprKind::Name(name) => Unit::find(name).map(|_| name.clone()),
        ast::ExprKind::Binary { op: BinaryOp::Pow, left, right, .. } => {
            matches!(right.kind, ast::ExprKind::Number(_)).then(|| unit_name(left)).flatten()
        }
        _ => None,
    }
}

/// A type in words: `Pressure (kPa)`, `Vector[Length] (um)`.
pub(crate) fn words(units: &UnitSystem, ty: &Type) -> String {
    let text = type_text(ty);
    match ty {
        Type::Value(_, dimension) if !dimension.is_number() => {
            format!("{text} ({})", unit_text(units, *dimension))
        }
        _ => text,
    }
}

/// A type as it is written in a model: `Vector[Length]`, `fn(Tensor) -> Pressure`.
pub(crate) fn type_text(ty: &Type) -> String {
    let shaped = |name: &str, dimension: &Dimension| match dimension.is_number() {
        true => name.to_owned(),
        false => format!("{name}[{dimension}]"),
    };
    match ty {
        Type::Value(Shape::Scalar, dimension) => dimension.to_string(),
        Type::Value(Shape::Vector, dimension) => shaped("Vector", dimension),
        Type::Value(Shape::Tensor, dimension) => shaped("Tensor", dimension),
        Type::Zero => "0".into(),
        Type::Condition => "Condition".into(),
        Type::Law(arguments, result) => {
            let arguments = arguments.iter().map(type_text).collect::<Vec<_>>().join(", ");
            format!("fn({arguments}) -> {}", type_text(result))
        }
        Type::Record(members) => {
            let members = members.iter().map(|(name, ty)| format!("{name}: {}", type_text(ty)));
            format!("({})", members.collect::<Vec<_>>().join(", "))
        }
    }
}

/// The coherent unit of a dimension, by its own symbol where it has one (`kPa` for `nN/um^2`); `1` for numbers.
pub(crate) fn unit_text(units: &UnitSystem, dimension: Dimension) -> String {
    let scale = units.exact_scale(dimension);
    let own = Unit::ALL
        .iter()
        .find(|unit| unit.dimension == dimension && unit.scale == scale && !dimension.is_number());
    own.map_or_else(|| units.unit_of(dimension), |unit| unit.symbol.to_owned())
}

impl Type {
    /// A plain number.
    pub const NUMBER: Type = Type::Value(Shape::Scalar, Dimension::NUMBER);
    /// A length.
    pub const LENGTH: Type = Type::Value(Shape::Scalar, Dimension::LENGTH);
    /// A time.
    pub const TIME: Type = Type::Value(Shape::Scalar, Dimension::TIME);
    /// A point or displacement.
    pub const POSITION: Type = Type::Value(Shape::Vector, Dimension::LENGTH);
}
