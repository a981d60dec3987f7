//! Blocks: geometry, settings, physics, output and tests, with the statements inside them.

use super::{Column, Dotted, Equation, Every, Expr, Ident, Let, Range, Set, Text};
use crate::source::Span;

/// `geometry ..`
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// `geometry { .. }`
    Built(Vec<GeometryItem>),
    /// `geometry "cell.msh" { .. }`
    Imported {
        /// The mesh file.
        file: Text,
        /// Its names, and `let`s on them.
        items: Vec<GeometryItem>,
    },
    /// `geometry = revolve(..);`
    Value(Expr),
}

/// An item of a geometry block.
#[derive(Clone, Debug, PartialEq)]
pub struct GeometryItem {
    /// The `///` lines before it, joined by line feeds.
    pub docs: String,
    /// What it is.
    pub kind: GeometryKind,
    /// Where it stands.
    pub span: Span,
}

/// The items of a geometry block.
#[derive(Clone, Debug, PartialEq)]
pub enum GeometryKind {
    /// `let n = expr;`
    Let(Let),
    /// `path n = from P ..;`
    Path(Path),
    /// `region n = loop(..);`
    Region(Region),
    /// `region core, shell;`: regions of an imported mesh.
    Regions(Vec<Dotted>),
    /// `path nucleus.side, cut_x;`: paths of an imported mesh.
    Paths(Vec<Dotted>),
}

/// `path n = from P line label to Q arc about C ccw to R;`
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// The name.
    pub name: Ident,
    /// Where it starts.
    pub start: Expr,
    /// Its segments, at least one.
    pub segments: Vec<Segment>,
}

/// One segment of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// `path.label` names it.
    pub label: Option<Ident>,
    /// Straight or round.
    pub curve: Curve,
    /// Where it ends.
    pub to: Expr,
    /// Where it stands.
    pub span: Span,
}

/// The course of a segment.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// Straight.
    Line,
    /// On a circle.
    Arc {
        /// Its centre.
        about: Expr,
        /// Which way round.
        turn: Turn,
    },
}

/// Which way round an arc runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// `ccw`
    CounterClockwise,
    /// `cw`
    Clockwise,
}

/// `region n = loop(..);`
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// The name.
    pub name: Ident,
    /// What bounds it.
    pub value: Expr,
}

/// `name = value on D;` in `mesh` and `solve`.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// The name.
    pub name: Ident,
    /// The value.
    pub value: SettingValue,
    /// Where it holds.
    pub domain: Option<Expr>,
    /// The whole statement.
    pub span: Span,
}

/// The value of a setting.
#[derive(Clone, Debug, PartialEq)]
pub enum SettingValue {
    /// An expression.
    Expr(Expr),
    /// `0 s .. 250 s`
    Range(Range),
}

/// `physics n { .. }`
#[derive(Clone, Debug, PartialEq)]
pub struct Physics {
    /// The name of the block.
    pub name: Ident,
    /// Its statements in order.
    pub statements: Vec<Statement>,
}

/// A statement of physics.
#[derive(Clone, Debug, PartialEq)]
pub struct Statement {
    /// What it is.
    pub kind: StatementKind,
    /// From its first word to its `;`.
    pub span: Span,
}

/// The statements of physics.
#[derive(Clone, Debug, PartialEq)]
pub enum StatementKind {
    /// `let n = expr;`
    Let(Let),
    /// `energy W on D;`
    Energy {
        /// Energy per measure of the domain, or an energy.
        density: Expr,
        /// Where; lumped if not given.
        domain: Option<Expr>,
    },
    /// `residual R on D;`
    Residual {
        /// The integrand of a weak form, linear in `test(..)`.
        form: Expr,
        /// Where; lumped if not given.
        domain: Option<Expr>,
    },
    /// `load q with f on D;`
    Load {
        /// What the force works on.
        quantity: Expr,
        /// The force.
        force: Expr,
        /// Where; lumped if not given.
        domain: Option<Expr>,
    },
    /// `hold q = g on D;`
    Hold {
        /// What is prescribed.
        quantity: Expr,
        /// To which value.
        value: Expr,
        /// Where.
        domain: Option<Expr>,
    },
    /// `tie a == b on D;`
    Tie {
        /// What is tied.
        equation: Equation,
        /// Where.
        domain: Option<Expr>,
    },
    /// `a == b;`
    Equation(Equation),
}

/// A statement of an output block.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// What it is.
    pub kind: OutputKind,
    /// Where it stands.
    pub span: Span,
}

/// The statements of an output block.
#[derive(Clone, Debug, PartialEq)]
pub enum OutputKind {
    /// `fields on D every TIME: ..;`
    Fields {
        /// Where.
        domain: Expr,
        /// How often.
        every: Every,
        /// What, at least one.
        columns: Vec<Column>,
    },
    /// `table "file" every TIME: ..;`
    Table {
        /// The file.
        file: Text,
        /// How often.
        every: Every,
        /// What, at least one.
        columns: Vec<Column>,
    },
    /// `checkpoint every TIME;`
    Checkpoint {
        /// How often.
        every: Every,
    },
}

/// `test ".." { .. }`
#[derive(Clone, Debug, PartialEq)]
pub struct Test {
    /// What it claims.
    pub title: Text,
    /// How that is checked.
    pub checks: Vec<Check>,
}

/// A statement of a test.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// What it is.
    pub kind: CheckKind,
    /// Where it stands.
    pub span: Span,
}

/// The statements of a test.
#[derive(Clone, Debug, PartialEq)]
pub enum CheckKind {
    /// `let n = expr;`
    Let(Let),
    /// `for x in RANGE by STEP { .. }`
    Each {
        /// The name that runs.
        name: Ident,
        /// What it runs over.
        over: Over,
        /// What is checked each time.
        checks: Vec<Check>,
    },
    /// `expect COND;`
    Expect(Expr),
    /// `expect a ~= b within x %;`
    Near {
        /// What is found.
        left: Expr,
        /// What is expected.
        right: Expr,
        /// How far they may be apart.
        tolerance: Tolerance,
    },
}

/// What a `for` of a test runs over.
#[derive(Clone, Debug, PartialEq)]
pub enum Over {
    /// `in {a, b}`
    Set(Set),
    /// `in low .. high by step`
    Steps {
        /// The ends, both included.
        range: Range,
        /// The step.
        by: Expr,
    },
}

/// How far two values may be apart.
#[derive(Clone, Debug, PartialEq)]
pub enum Tolerance {
    /// `within x`, in the unit of the values.
    Absolute(Expr),
    /// `within x %` of the expected value.
    Percent(Expr),
}
