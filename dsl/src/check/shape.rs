//! Shapes and dimensions of the operators: which types combine, and into what.

use super::{Checked, Checker, Reported, constant};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Arithmetic, Expr, ExprKind, Shape, Type};
use crate::source::Span;
use ansatz_units::Dimension;

/// Shape and dimension of a value; a literal 0 counts as a plain number.
pub(super) fn value(ty: &Type) -> Option<(Shape, Dimension)> {
    match ty {
        Type::Value(shape, dimension) => Some((*shape, *dimension)),
        Type::Zero => Some((Shape::Scalar, Dimension::NUMBER)),
        Type::Condition | Type::Law(..) | Type::Record(_) => None,
    }
}

/// The shape of a product; `None` for two vectors and for a vector before a tensor.
fn product_shape(a: Shape, b: Shape) -> Option<Shape> {
    match (a, b) {
        (Shape::Scalar, other) | (other, Shape::Scalar) => Some(other),
        (Shape::Tensor, Shape::Tensor) => Some(Shape::Tensor),
        (Shape::Tensor, Shape::Vector) => Some(Shape::Vector),
        (Shape::Vector, _) => None,
    }
}

/// Whether `e` still fits several types: a literal 0, or a vector of them.
fn open(e: &Expr) -> bool {
    let zero =
        |item: &Expr| matches!(item.kind, ExprKind::Number(value) if value == 0.0) && item.ty == Type::NUMBER;
    match &e.kind {
        ExprKind::Tuple(items) => items.iter().all(zero),
        ExprKind::Triple(items) => items.iter().all(zero),
        _ => e.ty == Type::Zero,
    }
}

/// Gives a vector of literal zeros the dimension of its neighbour.
fn coerce_zero_vector(e: &mut Expr, ty: &Type) {
    let Type::Value(Shape::Vector, dimension) = ty else { return };
    let component = Type::Value(Shape::Scalar, *dimension);
    match &mut e.kind {
        ExprKind::Tuple(items) => items.iter_mut().for_each(|item| item.ty = component.clone()),
        ExprKind::Triple(items) => items.iter_mut().for_each(|item| item.ty = component.clone()),
        _ => return,
    }
    e.ty = ty.clone();
}

/// Gives every literal 0 in `e` the type that its neighbour has; anything else stays.
pub(super) fn coerce(e: &mut Expr, ty: &Type) {
    if e.ty != Type::Zero {
        if open(e) {
            coerce_zero_vector(e, ty);
        }
        return;
    }
    e.ty = ty.clone();
    match &mut e.kind {
        ExprKind::Negate(a) => coerce(a, ty),
        ExprKind::Arithmetic(_, a, b) => {
            coerce(a, ty);
            coerce(b, ty);
        }
        ExprKind::MatchValue { arms, otherwise, .. } => {
            arms.iter_mut().for_each(|arm| coerce(&mut arm.value, ty));
            coerce(otherwise, ty);
        }
        ExprKind::MatchRegion(arms, otherwise) => {
            arms.iter_mut().for_each(|(_, value)| coerce(value, ty));
            if let Some(value) = otherwise {
                coerce(value, ty);
            }
        }
        ExprKind::Builtin(_, items) => items.iter_mut().for_each(|item| coerce(item, ty)),
        _ => {}
    }
}

/// A literal 0 that met no neighbour is a plain number.
pub(super) fn settle(mut e: Expr) -> Expr {
    if let (ExprKind::Record(items), Type::Record(members)) = (&mut e.kind, &mut e.ty) {
        for (item, (_, ty)) in items.iter_mut().zip(members) {
            coerce(item, &Type::NUMBER);
            *ty = item.ty.clone();
        }
    }
    coerce(&mut e, &Type::NUMBER);
    e
}

/// `a*b` of scalars and anything, types known to fit.
pub(super) fn multiply(a: Expr, b: Expr, span: Span) -> Expr {
    let (a, b) = (settle(a), settle(b));
    let ty = match (value(&a.ty), value(&b.ty)) {
        (Some((s, d)), Some((t, e))) => Type::Value(product_shape(s, t).unwrap_or(s), d * e),
        _ => Type::NUMBER,
    };
    Expr { kind: ExprKind::Arithmetic(Arithmetic::Mul, Box::new(a), Box::new(b)), ty, span }
}

impl Checker<'_> {
    /// Makes two expressions one type, or says why they are not; `what` completes "cannot .. a Pressure and a Length".
    pub(super) fn same(&mut self, a: &mut Expr, b: &mut Expr, span: Span, what: &str) -> Checked<Type> {
        coerce(a, &b.ty);
        coerce(b, &a.ty);
        if a.ty == b.ty {
            return Ok(a.ty.clone());
        }
        Err(self.mismatch(&[a, b], span, what))
    }

    /// Makes all expressions one type, that of the first that is not a literal 0.
    pub(super) fn all_same(&mut self, items: &mut [Expr], span: Span, what: &str) -> Checked<Type> {
        let decided = items.iter().find(|item| !open(item)).or(items.first());
        let ty = decided.map_or(Type::Zero, |item| item.ty.clone());
        items.iter_mut().for_each(|item| coerce(item, &ty));
        let Some(first) = items.iter().position(|item| item.ty == ty) else { return Ok(ty) };
        match items.iter().position(|item| item.ty != ty) {
            Some(other) => Err(self.mismatch(&[&items[first], &items[other]], span, what)),
            None => Ok(ty),
        }
    }

    fn mismatch(&mut self, [a, b]: &[&Expr; 2], span: Span, what: &str) -> Reported {
        let (code, kind) = match (value(&a.ty), value(&b.ty)) {
            (Some((s, _)), Some((t, _))) if s == t => (Code::DimensionMismatch, "dimensions"),
            _ => (Code::ShapeMismatch, "shapes"),
        };
        let message = format!("cannot {what} different {kind}");
        let mut diagnostic = Diagnostic::error(code, span, message)
            .label(a.span, format!("this is {}", self.words(&a.ty)))
            .label(b.span, format!("this is {}", self.words(&b.ty)));
        if let Some(help) = self.missing_unit(a, b).or_else(|| self.missing_unit(b, a)) {
            diagnostic = diagnostic.help(help);
        }
        let diagnostic = self.replaced_parts(b, self.replaced_parts(a, diagnostic));
        self.report(diagnostic)
    }

    /// Help where `a` is a bare number literal beside a quantity.
    fn missing_unit(&self, a: &Expr, b: &Expr) -> Option<String> {
        let (ExprKind::Number(_), Type::Value(Shape::Scalar, dimension)) = (&a.kind, &b.ty) else {
            return None;
        };
        if a.ty != Type::NUMBER || dimension.is_number() {
            return None;
        }
        let unit = super::unit::unit_text(&self.units, *dimension);
        let written = self.sources.slice(a.span);
        let single = ansatz_units::Unit::find(&unit).is_some();
        Some(if single {
            format!("write the unit behind the number, such as `{written} {unit}`")
        } else {
            format!("write the unit behind the number, such as `{written} [{unit}]`")
        })
    }

    /// `a + b`, `a - b`, `a*b`, `a/b`, `a^b`.
    pub(super) fn arithmetic(
        &mut self,
        op: Arithmetic,
        mut a: Expr,
        mut b: Expr,
        span: Span,
    ) -> Checked<Expr> {
        let ty = match op {
            Arithmetic::Add => self.same(&mut a, &mut b, span, "add")?,
            Arithmetic::Sub => self.same(&mut a, &mut b, span, "subtract")?,
            Arithmetic::Mul | Arithmetic::Div | Arithmetic::Pow => Type::Zero,
        };
        let ty = match op {
            Arithmetic::Add | Arithmetic::Sub => match value(&ty) {
                Some(_) => ty,
                None => return Err(self.no_arithmetic(&a)),
            },
            Arithmetic::Mul => self.product_type(&a, &b, span)?,
            Arithmetic::Div => self.quotient_type(&a, &b)?,
            Arithmetic::Pow => self.power_type(&a, &b)?,
        };
        if !matches!(op, Arithmetic::Add | Arithmetic::Sub) {
            (a, b) = (settle(a), settle(b));
        }
        Ok(Expr { kind: ExprKind::Arithmetic(op, Box::new(a), Box::new(b)), ty, span })
    }

    fn no_arithmetic(&mut self, e: &Expr) -> Reported {
        let message = format!("a {} is no number to compute with", type_word(&e.ty));
        self.report(
            Diagnostic::error(Code::ShapeMismatch, e.span, message)
                .here(format!("this is {}", self.words(&e.ty))),
        )
    }

    /// Shape and dimension of an operand.
    pub(super) fn operand(&mut self, e: &Expr) -> Checked<(Shape, Dimension)> {
        value(&e.ty).ok_or_else(|| self.no_arithmetic(e))
    }

    fn product_type(&mut self, a: &Expr, b: &Expr, span: Span) -> Checked<Type> {
        let ((s, d), (t, e)) = (self.operand(a)?, self.operand(b)?);
        let Some(shape) = product_shape(s, t) else {
            let help = match t {
                Shape::Vector => {
                    "write `dot(a, b)` for a number, `outer(a, b)` for a tensor, `cross(a, b)` for a vector"
                }
                _ => "a tensor stands before the vector: `A*v`, or `transpose(A)*v`",
            };
            return Err(self.report(
                Diagnostic::error(Code::ShapeMismatch, span, "this product has no meaning by itself")
                    .label(a.span, format!("this is {}", self.words(&a.ty)))
                    .label(b.span, format!("this is {}", self.words(&b.ty)))
                    .help(help),
            ));
        };
        Ok(Type::Value(shape, d * e))
    }

    fn quotient_type(&mut self, a: &Expr, b: &Expr) -> Checked<Type> {
        let ((s, d), (t, e)) = (self.operand(a)?, self.operand(b)?);
        if t != Shape::Scalar {
            return Err(self.need_scalar(b, "only scalars divide"));
        }
        Ok(Type::Value(s, d / e))
    }

    fn power_type(&mut self, base: &Expr, exponent: &Expr) -> Checked<Type> {
        let (shape, dimension) = self.operand(base)?;
        if shape != Shape::Scalar {
            return Err(self.need_scalar(base, "only scalars have powers"));
        }
        self.need_number(exponent, "an exponent")?;
        if dimension.is_number() {
            return Ok(Type::NUMBER);
        }
        match constant::exponent(exponent, &|id| self.let_value(id)) {
            Some(power) => Ok(Type::Value(Shape::Scalar, dimension.pow(power))),
            None => Err(self.report(
                Diagnostic::error(
                    Code::ExponentNotConstant,
                    exponent.span,
                    "the exponent must be a constant fraction here",
                )
                .label(base.span, format!("this is {}", self.words(&base.ty)))
                .help("divide the base by a reference value first, then any exponent will do"),
            )),
        }
    }

    pub(super) fn need_scalar(&mut self, e: &Expr, message: &str) -> Reported {
        self.report(
            Diagnostic::error(Code::ScalarNeeded, e.span, message)
                .here(format!("this is {}", self.words(&e.ty))),
        )
    }

    /// Requires a scalar; gives its dimension.
    pub(super) fn scalar(&mut self, e: &Expr, what: &str) -> Checked<Dimension> {
        match self.operand(e)? {
            (Shape::Scalar, dimension) => Ok(dimension),
            _ => Err(self.need_scalar(e, &format!("{what} must be a scalar"))),
        }
    }

    /// Requires a pure number.
    pub(super) fn need_number(&mut self, e: &Expr, what: &str) -> Checked<()> {
        let dimension = self.scalar(e, what)?;
        if dimension.is_number() {
            return Ok(());
        }
        let message = format!("{what} must be a pure number");
        Err(self.report(
            Diagnostic::error(Code::NotANumber, e.span, message)
                .here(format!("this is {}", self.words(&e.ty)))
                .help("divide it by a reference value of the same dimension"),
        ))
    }

    /// Requires a given type, which a literal 0 takes on.
    pub(super) fn expect(&mut self, mut e: Expr, ty: &Type, what: &str) -> Checked<Expr> {
        coerce(&mut e, ty);
        if e.ty == *ty {
            return Ok(e);
        }
        if let (Type::Record(have), Type::Record(want)) = (&e.ty, ty)
            && let Some(sorted) = reorder(&e, have, want)
        {
            return Ok(sorted);
        }
        let same_shape = matches!((value(&e.ty), value(ty)), (Some((s, _)), Some((t, _))) if s == t);
        let code = if same_shape { Code::DeclaredDimension } else { Code::DeclaredShape };
        let message = format!("{what} is {}, not {}", type_text(self, ty), type_text(self, &e.ty));
        let mut diagnostic =
            Diagnostic::error(code, e.span, message).here(format!("this is {}", self.words(&e.ty)));
        let wanted = Expr { ty: ty.clone(), ..e.clone() };
        if let Some(help) = self.missing_unit(&e, &wanted) {
            diagnostic = diagnostic.help(help);
        }
        let diagnostic = self.replaced_parts(&e, diagnostic);
        Err(self.report(diagnostic))
    }

    /// Marks the parameters and `let`s in `e` that a variant of its file has replaced. Variants are read before what they extend.
    fn replaced_parts(&self, e: &Expr, diagnostic: Diagnostic) -> Diagnostic {
        let place = match e.kind {
            ExprKind::Param(id) => Some(self.params[id.0].ast.name.span),
            ExprKind::Let(id) => self.values.get(id.0).map(|item| item.span),
            _ => None,
        };
        match place.filter(|place| place.source < e.span.source) {
            Some(place) => diagnostic.label(place, "replaced here"),
            None => {
                e.children().into_iter().fold(diagnostic, |so_far, child| self.replaced_parts(child, so_far))
            }
        }
    }
}

fn type_text(checker: &Checker<'_>, ty: &Type) -> String {
    checker.words(ty)
}

fn type_word(ty: &Type) -> &'static str {
    match ty {
        Type::Condition => "condition",
        Type::Law(..) => "function",
        Type::Record(_) => "record",
        Type::Value(..) | Type::Zero => "value",
    }
}

/// A record literal with its members in the wanted order, if they are the wanted ones.
fn reorder(e: &Expr, have: &[(String, Type)], want: &[(String, Type)]) -> Option<Expr> {
    let ExprKind::Record(items) = &e.kind else { return None };
    if items.len() != want.len() {
        return None;
    }
    let items = want.iter().map(|(name, ty)| {
        let at = have.iter().position(|(known, _)| known == name)?;
        let mut item = items[at].clone();
        coerce(&mut item, ty);
        (item.ty == *ty).then_some(item)
    });
    let items = items.collect::<Option<Vec<_>>>()?;
    Some(Expr { kind: ExprKind::Record(items), ty: Type::Record(want.to_vec()), span: e.span })
}
