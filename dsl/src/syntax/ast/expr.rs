//! Expressions, units, types, and the ranges and sets that bound them.

use super::{Dotted, Ident};
use crate::source::Span;

/// A value, a condition or a domain: they share one syntax.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Where it stands, with the parentheses around it.
    pub span: Span,
}

/// The forms of an expression.
#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// `3 um`, `1e-3 [Pa*s]`, `2`.
    Number(Number),
    /// `"film below 50 nm"`.
    Text(String),
    /// `eta`.
    Name(String),
    /// The open place in `Psi(_, G)`.
    Hole,
    /// `u.z`.
    Member {
        /// Left of the dot.
        object: Box<Expr>,
        /// Right of the dot.
        member: Ident,
    },
    /// `f(a, name: b)`, `mean(e on D)`.
    Call {
        /// What is called.
        callee: Box<Expr>,
        /// The arguments in order.
        args: Vec<Arg>,
    },
    /// `e@place`: at a point, a time or an event.
    At {
        /// What is looked at.
        value: Box<Expr>,
        /// A name, a dotted name, an expression in parentheses or a tuple.
        place: Box<Expr>,
    },
    /// `(a, b) [um]`: two or more components with one unit for all.
    Tuple {
        /// The components.
        items: Vec<Expr>,
        /// The unit behind the parentheses.
        unit: Option<UnitExpr>,
    },
    /// `(l1: a, k1: b)`.
    Record(Vec<NamedExpr>),
    /// `-a`, `not a`.
    Unary {
        /// The operator.
        op: UnaryOp,
        /// The operator's own place.
        op_span: Span,
        /// What it applies to.
        operand: Box<Expr>,
    },
    /// `a + b`, `a*b`, `a^b`.
    Binary {
        /// The operator.
        op: BinaryOp,
        /// The operator's own place.
        op_span: Span,
        /// Left operand.
        left: Box<Expr>,
        /// Right operand.
        right: Box<Expr>,
    },
    /// `a < b`, `outcome == completed`; never chained.
    Compare {
        /// The operator.
        op: CompareOp,
        /// The operator's own place.
        op_span: Span,
        /// Left operand.
        left: Box<Expr>,
        /// Right operand.
        right: Box<Expr>,
    },
    /// `a and b`, `a or b`.
    Logic {
        /// The operator.
        op: LogicOp,
        /// The operator's own place.
        op_span: Span,
        /// Left operand.
        left: Box<Expr>,
        /// Right operand.
        right: Box<Expr>,
    },
    /// `condition for 60 s`: it has held that long without a break.
    Lasting {
        /// The condition.
        condition: Box<Expr>,
        /// The time.
        time: Box<Expr>,
    },
    /// `match v { < a => x, else => y } C1`.
    Match(Box<Match>),
}

/// A number literal.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// The value in the written unit; finite.
    pub value: f64,
    /// The digits as written.
    pub text: String,
    /// The unit behind it.
    pub unit: Option<UnitExpr>,
}

/// A unit: a product of powers of unit symbols, parentheses and divisions multiplied out.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitExpr {
    /// As written, brackets included: `um`, `um^2`, `[kg/m^3]`.
    pub text: String,
    /// The factors in the order of writing; empty for `[1]`.
    pub factors: Vec<UnitFactor>,
    /// Where it stands, with the brackets.
    pub span: Span,
}

/// One factor of a unit, `m^-3` in `kg/m^3`.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitFactor {
    /// The symbol, with its prefix.
    pub symbol: Ident,
    /// Its exponent, not zero unless written so.
    pub exponent: i32,
}

/// An argument of a call.
#[derive(Clone, Debug, PartialEq)]
pub struct Arg {
    /// The name before the colon.
    pub name: Option<Ident>,
    /// The value.
    pub value: Expr,
    /// Where a reduction runs: `mean(e on D)`.
    pub on: Option<On>,
    /// The whole argument.
    pub span: Span,
}

/// What a reduction such as `mean(e on ..)` runs over.
#[derive(Clone, Debug, PartialEq)]
pub enum On {
    /// A domain, a run or another named set of places.
    Domain(Expr),
    /// A stretch of time.
    Times(Range),
}

/// `name: value` in a record.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedExpr {
    /// The name.
    pub name: Ident,
    /// The value.
    pub value: Expr,
}

/// Prefix operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryOp {
    /// `-`
    Neg,
    /// `not`
    Not,
}

/// Arithmetic operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOp {
    /// `+`
    Add,
    /// `-`
    Sub,
    /// `*`
    Mul,
    /// `/`
    Div,
    /// `^`, from the right
    Pow,
}

impl BinaryOp {
    /// The operator as written.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Add => "+",
            Self::Sub => "-",
            Self::Mul => "*",
            Self::Div => "/",
            Self::Pow => "^",
        }
    }
}

/// Comparisons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompareOp {
    /// `==`
    Equal,
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterEqual,
}

impl CompareOp {
    /// The operator as written.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Equal => "==",
            Self::Less => "<",
            Self::LessEqual => "<=",
            Self::Greater => ">",
            Self::GreaterEqual => ">=",
        }
    }
}

/// Connectives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogicOp {
    /// `and`
    And,
    /// `or`
    Or,
}

impl LogicOp {
    /// The operator as written.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::And => "and",
            Self::Or => "or",
        }
    }
}

/// A piecewise law or a choice by region.
#[derive(Clone, Debug, PartialEq)]
pub struct Match {
    /// What the arms look at; the name `region` for a choice by region.
    pub scrutinee: Expr,
    /// The arms in order, at least one.
    pub arms: Vec<Arm>,
    /// How smoothly the arms of a piecewise law meet.
    pub smoothness: Smoothness,
}

/// One arm of a [`Match`].
#[derive(Clone, Debug, PartialEq)]
pub struct Arm {
    /// When it applies.
    pub pattern: Pattern,
    /// Its value.
    pub value: Expr,
    /// The whole arm.
    pub span: Span,
}

/// When an arm applies.
#[derive(Clone, Debug, PartialEq)]
pub enum Pattern {
    /// `< bound`
    Less(Expr),
    /// `<= bound`
    LessEqual(Expr),
    /// A region.
    Region(Dotted),
    /// `else`
    Else(Span),
}

/// How smoothly the pieces of a law meet; verified at every bound.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Smoothness {
    /// Nothing written: continuous.
    #[default]
    C0,
    /// `C1`: the derivative too.
    C1,
    /// `jumps`: nothing is verified.
    Jumps,
}

/// `low .. high`.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// Lower end.
    pub low: Expr,
    /// Upper end.
    pub high: Expr,
}

impl Range {
    /// From the lower to the upper end.
    pub fn span(&self) -> Span {
        self.low.span.to(self.high.span)
    }
}

/// `{a, b, c} um`.
#[derive(Clone, Debug, PartialEq)]
pub struct Set {
    /// The members, at least one.
    pub items: Vec<Expr>,
    /// One unit for all.
    pub unit: Option<UnitExpr>,
    /// With braces and unit.
    pub span: Span,
}

/// What follows `in` behind a value.
#[derive(Clone, Debug, PartialEq)]
pub enum Bounds {
    /// `in low .. high`
    Range(Range),
    /// `in {a, b}`
    Set(Set),
}

/// `left == right` as an equation (in conditions, `==` is an [`ExprKind::Compare`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// Left side.
    pub left: Expr,
    /// Right side.
    pub right: Expr,
    /// Both sides.
    pub span: Span,
}

/// A written type.
#[derive(Clone, Debug, PartialEq)]
pub struct TypeExpr {
    /// What it is.
    pub kind: TypeKind,
    /// Where it stands.
    pub span: Span,
}

/// The forms of a type.
#[derive(Clone, Debug, PartialEq)]
pub enum TypeKind {
    /// `1`, as in `1/Area`.
    One,
    /// A named dimension: `Number`, `Pressure`.
    Named(String),
    /// `Vector`, `Tensor[Pressure]`; no element means `Number`.
    Shaped {
        /// The shape.
        shape: Shape,
        /// The dimension of each component.
        element: Option<Box<TypeExpr>>,
    },
    /// `fn(Tensor) -> Pressure`.
    Function {
        /// Argument types, at least one.
        args: Vec<TypeExpr>,
        /// Type of the value.
        result: Box<TypeExpr>,
    },
    /// `(l1: Number, k1: 1/Length)`.
    Record(Vec<TypedName>),
    /// `a*b`
    Product(Box<TypeExpr>, Box<TypeExpr>),
    /// `a/b`
    Quotient(Box<TypeExpr>, Box<TypeExpr>),
    /// `Length^2`
    Power(Box<TypeExpr>, i32),
}

/// Shapes that take a dimension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Three components.
    Vector,
    /// Three by three components.
    Tensor,
}

/// `name: T`.
#[derive(Clone, Debug, PartialEq)]
pub struct TypedName {
    /// The name.
    pub name: Ident,
    /// Its type.
    pub ty: TypeExpr,
}

impl Expr {
    /// The name, where the expression is nothing but a name.
    pub fn as_name(&self) -> Option<Ident> {
        match &self.kind {
            ExprKind::Name(text) => Some(Ident { text: text.clone(), span: self.span }),
            _ => None,
        }
    }

    /// The direct parts, in the order of writing.
    pub fn children(&self) -> Vec<&Expr> {
        match &self.kind {
            ExprKind::Number(_) | ExprKind::Text(_) | ExprKind::Name(_) | ExprKind::Hole => Vec::new(),
            ExprKind::Member { object, .. } => vec![object],
            ExprKind::Call { callee, args } => {
                std::iter::once(callee.as_ref()).chain(args.iter().flat_map(Arg::parts)).collect()
            }
            ExprKind::At { value, place } => vec![value, place],
            ExprKind::Tuple { items, .. } => items.iter().collect(),
            ExprKind::Record(fields) => fields.iter().map(|field| &field.value).collect(),
            ExprKind::Unary { operand, .. } => vec![operand],
            ExprKind::Binary { left, right, .. }
            | ExprKind::Compare { left, right, .. }
            | ExprKind::Logic { left, right, .. } => vec![left, right],
            ExprKind::Lasting { condition, time } => vec![condition, time],
            ExprKind::Match(m) => {
                std::iter::once(&m.scrutinee).chain(m.arms.iter().flat_map(Arm::parts)).collect()
            }
        }
    }
}

impl Arg {
    /// The value and what it runs over.
    pub fn parts(&self) -> Vec<&Expr> {
        match &self.on {
            None => vec![&self.value],
            Some(On::Domain(domain)) => vec![&self.value, domain],
            Some(On::Times(range)) => vec![&self.value, &range.low, &range.high],
        }
    }
}

impl Arm {
    fn parts(&self) -> Vec<&Expr> {
        match &self.pattern {
            Pattern::Less(bound) | Pattern::LessEqual(bound) => vec![bound, &self.value],
            Pattern::Region(_) | Pattern::Else(_) => vec![&self.value],
        }
    }
}
