//! Expressions of the checked model: types, kinds, domains. Every name is an id and every number stands in coherent units.

use super::{
    BlockId, EventId, FieldId, FunctionId, LetId, LocalId, PairId, ParamId, PathId, RegionId, StateId,
};
use crate::source::Span;
use ansatz_units::Dimension;

/// Number of components of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// 1 component.
    Scalar,
    /// 3 components.
    Vector,
    /// 3x3 components, row by row.
    Tensor,
}

/// Type of an expression.
#[derive(Clone, Debug, PartialEq)]
pub enum Type {
    /// A number, vector or tensor with a dimension.
    Value(Shape, Dimension),
    /// A literal 0 before it met its neighbour: fits every shape and dimension. No expression of a finished model has it.
    Zero,
    /// Truth value of a condition.
    Condition,
    /// A function passed as an argument.
    Law(Vec<Type>, Box<Type>),
    /// Named values, in declaration order.
    Record(Vec<(String, Type)>),
}

/// An expression with its type.
#[derive(Clone, Debug)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Its type.
    pub ty: Type,
    /// Where it stands.
    pub span: Span,
}

/// Arithmetic operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// Sum of equal shapes.
    Add,
    /// Difference of equal shapes.
    Sub,
    /// Scalar times anything; tensor times tensor or vector (contraction of neighbouring indices).
    Mul,
    /// Anything over a scalar.
    Div,
    /// Scalar power; the exponent is a number.
    Pow,
}

/// Comparisons of scalars.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterEqual,
    /// `==`
    Equal,
}

/// Reductions over a domain or over the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Reduction {
    /// Smallest value.
    Min,
    /// Largest value.
    Max,
    /// Integral over the measure, divided by the measure.
    Mean,
    /// Integral.
    Integral,
}

/// Functions the language knows by itself; everything else is written in the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Builtin {
    /// Scalar functions of one argument, by their textbook name.
    Scalar(ScalarFunction),
    /// `min(a, b, ..)` of scalars.
    Min,
    /// `max(a, b, ..)` of scalars.
    Max,
    /// `atan2(y, x)`.
    Atan2,
    /// `det(A)`.
    Det,
    /// `tr(A)`.
    Trace,
    /// `transpose(A)`.
    Transpose,
    /// `inverse(A)`.
    Inverse,
    /// `sym(A)`: symmetric part.
    Sym,
    /// `dev(A) = A - tr(A)/3 I`.
    Dev,
    /// `diag(a, b, c)`.
    Diag,
    /// `dot(a, b)` of vectors.
    Dot,
    /// `inner(A, B) = A_ij B_ij` of tensors.
    Inner,
    /// `outer(a, b) = a_i b_j`.
    Outer,
    /// `cross(a, b)`.
    Cross,
    /// Euclidean or Frobenius norm.
    Norm,
    /// `grad(e)` of a scalar (vector) or vector (tensor, `grad(v)_ij = d v_i / d x_j`), hoop terms included.
    Grad,
    /// `div(v) = tr(grad(v))`.
    Div,
    /// `along(e)`: derivative by the arc length of the reference path, in its direction.
    Along,
    /// `hoop(v) = v_r/r` of a vector, 0 in plane coordinates: what turning about the axis adds to a gradient.
    Hoop,
    /// `perp(v)`: the in-plane part of a vector, turned by a right angle counter-clockwise.
    Perp,
    /// `polar(centre, radius, angle)`: a point.
    Polar,
}

/// Scalar functions of one scalar argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum ScalarFunction {
    Sqrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Abs,
}

/// One arm `< a => x` or `<= a => x` of a `match` on a value.
#[derive(Clone, Debug)]
pub struct Arm {
    /// Whether the bound itself belongs to this arm.
    pub inclusive: bool,
    /// Upper bound of this arm; bounds ascend.
    pub bound: Expr,
    /// Value below the bound.
    pub value: Expr,
}

/// What a `match` promises at its breakpoints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Smoothness {
    /// Continuous (the default).
    C0,
    /// Continuous with its first derivative.
    C1,
    /// Nothing.
    Jumps,
}

/// Kinds of expressions.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub enum ExprKind {
    /// A number in the model's coherent units; a literal 0 may have any shape and then means all components.
    Number(f64),
    Param(ParamId),
    /// A `let` of the file, of the geometry, or of a block; its value is in [`Model::lets`](super::Model::lets).
    Let(LetId),
    /// Function argument, function-local let, or loop variable of a test.
    Local(LocalId),
    Field(FieldId),
    /// `test(u)`: the test function of a field.
    Test(FieldId),
    State(StateId),
    /// In-plane coordinate 0 or 1 of the reference position.
    Coordinate(usize),
    Time,
    /// The identity tensor `I`.
    Identity,
    /// `(a, b)`: an in-plane vector.
    Tuple(Box<[Expr; 2]>),
    /// `(a, b, c)`: a vector with all three components (tensor index order).
    Triple(Box<[Expr; 3]>),
    Negate(Box<Expr>),
    Arithmetic(Arithmetic, Box<Expr>, Box<Expr>),
    Compare(Relation, Box<Expr>, Box<Expr>),
    And(Box<Expr>, Box<Expr>),
    Or(Box<Expr>, Box<Expr>),
    Not(Box<Expr>),
    /// `condition for duration`.
    Held(Box<Expr>, Box<Expr>),
    /// Component `i` of a vector (tensor index order).
    Component(Box<Expr>, usize),
    /// Component `(i, j)` of a tensor.
    Component2(Box<Expr>, usize, usize),
    /// Member of a record.
    Member(Box<Expr>, usize),
    Record(Vec<Expr>),
    Builtin(Builtin, Vec<Expr>),
    /// A user or library function applied to all its arguments.
    Apply(FunctionId, Vec<Expr>),
    /// A law argument applied: `W(F)`.
    ApplyLocal(LocalId, Vec<Expr>),
    /// `Psi(_, G)`: a law with some arguments fixed (`None` = hole, in order). A bare function name is one with holes only.
    Law(FunctionId, Vec<Option<Expr>>),
    /// `dt(e)`.
    Rate(Box<Expr>),
    /// `diff(e, x)`, x a local or a let: derivative of a scalar (shape of x) or of any shape by a scalar x.
    Diff(Box<Expr>, Box<Expr>),
    /// `frozen(e)`: held in the variation, followed in the tangent.
    Frozen(Box<Expr>),
    MatchValue {
        scrutinee: Box<Expr>,
        arms: Vec<Arm>,
        otherwise: Box<Expr>,
        smoothness: Smoothness,
    },
    /// `match region { core => a, .. }`.
    MatchRegion(Vec<(RegionId, Expr)>, Option<Box<Expr>>),
    /// `mean(e on D)` and the like.
    Reduce(Reduction, Box<Expr>, Domain),
    /// `max(e on run)`, `min(e on a .. b)`: over time; only in tests and sweeps. `None` = the whole run.
    ReduceRun(Reduction, Box<Expr>, Option<(Box<Expr>, Box<Expr>)>),
    /// `area(D)`, `volume(D)`, `length(D)`: the reference measure.
    Measure(Domain),
    /// `force(block, D)`: resultant that a block puts on a surface \[force\].
    Force(BlockId, Domain),
    /// `normal(D)`: unit normal out of regions, on paths.
    Normal(Domain),
    /// `pair.gap`: signed distance, negative when penetrating.
    Gap(PairId),
    /// `pair.normal`: unit normal of the surface that the point is on, out of its body, as it has moved.
    PairNormal(PairId),
    /// `e@(r, z)`: value at a reference point.
    AtPoint(Box<Expr>, Box<Expr>),
    /// `e@(50 s)`.
    AtTime(Box<Expr>, Box<Expr>),
    /// `e@event`; `t@event` is the event's time.
    AtEvent(Box<Expr>, EventId),
    /// `outcome == event`.
    OutcomeIs(EventId),
}

impl Expr {
    /// The direct parts, in the order of writing; domains have none.
    #[must_use]
    pub fn children(&self) -> Vec<&Expr> {
        match &self.kind {
            ExprKind::Number(_)
            | ExprKind::Param(_)
            | ExprKind::Let(_)
            | ExprKind::Local(_)
            | ExprKind::Field(_)
            | ExprKind::Test(_)
            | ExprKind::State(_)
            | ExprKind::Coordinate(_)
            | ExprKind::Time
            | ExprKind::Identity
            | ExprKind::Measure(_)
            | ExprKind::Force(..)
            | ExprKind::Normal(_)
            | ExprKind::Gap(_)
            | ExprKind::PairNormal(_)
            | ExprKind::OutcomeIs(_) => Vec::new(),
            ExprKind::Tuple(items) => items.iter().collect(),
            ExprKind::Triple(items) => items.iter().collect(),
            ExprKind::Negate(a)
            | ExprKind::Not(a)
            | ExprKind::Component(a, _)
            | ExprKind::Component2(a, ..)
            | ExprKind::Member(a, _)
            | ExprKind::Rate(a)
            | ExprKind::Frozen(a)
            | ExprKind::Reduce(_, a, _)
            | ExprKind::AtEvent(a, _) => vec![a],
            ExprKind::Arithmetic(_, a, b)
            | ExprKind::Compare(_, a, b)
            | ExprKind::And(a, b)
            | ExprKind::Or(a, b)
            | ExprKind::Held(a, b)
            | ExprKind::Diff(a, b)
            | ExprKind::AtPoint(a, b)
            | ExprKind::AtTime(a, b) => vec![a, b],
            ExprKind::Record(items)
            | ExprKind::Builtin(_, items)
            | ExprKind::Apply(_, items)
            | ExprKind::ApplyLocal(_, items) => items.iter().collect(),
            ExprKind::Law(_, fixed) => fixed.iter().flatten().collect(),
            ExprKind::MatchValue { scrutinee, arms, otherwise, .. } => std::iter::once(scrutinee.as_ref())
                .chain(arms.iter().flat_map(|arm| [&arm.bound, &arm.value]))
                .chain([otherwise.as_ref()])
                .collect(),
            ExprKind::MatchRegion(arms, otherwise) => {
                arms.iter().map(|(_, value)| value).chain(otherwise.as_deref()).collect()
            }
            ExprKind::ReduceRun(_, a, times) => {
                let times = times.iter().flat_map(|(from, to)| [from.as_ref(), to.as_ref()]);
                std::iter::once(a.as_ref()).chain(times).collect()
            }
        }
    }
}

/// One piece of a domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Piece {
    /// All cells of a region.
    Region(RegionId),
    /// A whole path.
    Path(PathId),
    /// One segment of a path, by position.
    Segment(PathId, usize),
    /// The symmetry axis.
    Axis,
    /// The first point of a path.
    Start(PathId),
    /// The last point of a path.
    End(PathId),
    /// Surfaces of a pair.
    Pair(PairId, Sides),
}

/// Which surfaces of a pair are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum Sides {
    First,
    Second,
    Both,
}

/// Where something holds, is integrated or reduced: a set of pieces of one kind (cells, edges, ends of paths or contact pairs). The
/// domain of a field may have both cells and edges.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Domain {
    /// Pieces without repetition, in ascending order.
    pub pieces: Vec<Piece>,
    /// `current(..)`: measured as it has moved, else in the reference configuration.
    pub current: bool,
    /// Where it stands.
    pub span: Span,
}
