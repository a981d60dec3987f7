//! The operator table of the scalar stage: name, value and cost of every operator.
//!
//! Derivatives are in `crate::derive::rules`, one per operator; the tests of both walk `ALL`.

/// Cost of one division or square root, in additions.
pub const DIVISION: u32 = 8;
/// Cost of one transcendental function, in additions.
pub const TRANSCENDENTAL: u32 = 24;

/// An operator with one argument. Angles are in radians.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum Unary {
    Neg,
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

impl Unary {
    /// Every unary operator.
    pub const ALL: [Unary; 14] = [
        Unary::Neg,
        Unary::Sqrt,
        Unary::Exp,
        Unary::Ln,
        Unary::Sin,
        Unary::Cos,
        Unary::Tan,
        Unary::Asin,
        Unary::Acos,
        Unary::Atan,
        Unary::Sinh,
        Unary::Cosh,
        Unary::Tanh,
        Unary::Abs,
    ];

    /// Name: that of the `f64` method, `neg` for the sign.
    pub fn name(self) -> &'static str {
        match self {
            Unary::Neg => "neg",
            Unary::Sqrt => "sqrt",
            Unary::Exp => "exp",
            Unary::Ln => "ln",
            Unary::Sin => "sin",
            Unary::Cos => "cos",
            Unary::Tan => "tan",
            Unary::Asin => "asin",
            Unary::Acos => "acos",
            Unary::Atan => "atan",
            Unary::Sinh => "sinh",
            Unary::Cosh => "cosh",
            Unary::Tanh => "tanh",
            Unary::Abs => "abs",
        }
    }

    /// Value at `x`; NaN outside the domain.
    pub fn value(self, x: f64) -> f64 {
        match self {
            Unary::Neg => -x,
            Unary::Sqrt => x.sqrt(),
            Unary::Exp => x.exp(),
            Unary::Ln => x.ln(),
            Unary::Sin => x.sin(),
            Unary::Cos => x.cos(),
            Unary::Tan => x.tan(),
            Unary::Asin => x.asin(),
            Unary::Acos => x.acos(),
            Unary::Atan => x.atan(),
            Unary::Sinh => x.sinh(),
            Unary::Cosh => x.cosh(),
            Unary::Tanh => x.tanh(),
            Unary::Abs => x.abs(),
        }
    }

    /// Whether `f(-x) = f(x)`, `f(-x) = -f(x)`, or neither.
    pub fn parity(self) -> Parity {
        match self {
            Unary::Cos | Unary::Cosh | Unary::Abs => Parity::Even,
            Unary::Neg | Unary::Sin | Unary::Tan | Unary::Asin => Parity::Odd,
            Unary::Atan | Unary::Sinh | Unary::Tanh => Parity::Odd,
            Unary::Sqrt | Unary::Exp | Unary::Ln | Unary::Acos => Parity::Neither,
        }
    }

    /// Cost in additions.
    pub fn cost(self) -> u32 {
        match self {
            Unary::Neg | Unary::Abs => 1,
            Unary::Sqrt => DIVISION,
            _ => TRANSCENDENTAL,
        }
    }
}

/// Behaviour of a function when the sign of its argument changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Parity {
    Even,
    Odd,
    Neither,
}

/// An operator with two arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Binary {
    /// `x + y`
    Add,
    /// `x - y`
    Sub,
    /// `x y`
    Mul,
    /// `x / y`; in a [`Pool`](super::Pool) `x` is always 1: quotients share the reciprocal.
    Div,
    /// `x^y` with an exponent that is not a rational constant; NaN for negative `x` and fractional `y`.
    Pow,
    /// The smaller.
    Min,
    /// The larger.
    Max,
    /// `atan2(x, y)`: the angle of the point with ordinate `x` and abscissa `y`.
    Atan2,
}

impl Binary {
    /// Every binary operator.
    pub const ALL: [Binary; 8] = [
        Binary::Add,
        Binary::Sub,
        Binary::Mul,
        Binary::Div,
        Binary::Pow,
        Binary::Min,
        Binary::Max,
        Binary::Atan2,
    ];

    /// Name, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Binary::Add => "add",
            Binary::Sub => "sub",
            Binary::Mul => "mul",
            Binary::Div => "div",
            Binary::Pow => "pow",
            Binary::Min => "min",
            Binary::Max => "max",
            Binary::Atan2 => "atan2",
        }
    }

    /// Value at `(x, y)`; NaN outside the domain.
    pub fn value(self, x: f64, y: f64) -> f64 {
        match self {
            Binary::Add => x + y,
            Binary::Sub => x - y,
            Binary::Mul => x * y,
            Binary::Div => x / y,
            Binary::Pow => x.powf(y),
            Binary::Min => x.min(y),
            Binary::Max => x.max(y),
            Binary::Atan2 => x.atan2(y),
        }
    }

    /// Whether the arguments may change places.
    pub fn commutes(self) -> bool {
        matches!(self, Binary::Add | Binary::Mul | Binary::Min | Binary::Max)
    }

    /// Cost in additions.
    pub fn cost(self) -> u32 {
        match self {
            Binary::Add | Binary::Sub | Binary::Mul | Binary::Min | Binary::Max => 1,
            Binary::Div => DIVISION,
            Binary::Pow => 2 * TRANSCENDENTAL,
            Binary::Atan2 => TRANSCENDENTAL,
        }
    }
}

/// The comparison of a `Select`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Relation {
    /// `x < y`
    Less,
    /// `x <= y`
    LessEqual,
}

impl Relation {
    /// Both relations.
    pub const ALL: [Relation; 2] = [Relation::Less, Relation::LessEqual];

    /// Whether the relation holds; false when either side is NaN.
    pub fn holds(self, x: f64, y: f64) -> bool {
        match self {
            Relation::Less => x < y,
            Relation::LessEqual => x <= y,
        }
    }

    /// Sign in Rust and in listings.
    pub fn sign(self) -> &'static str {
        match self {
            Relation::Less => "<",
            Relation::LessEqual => "<=",
        }
    }
}
