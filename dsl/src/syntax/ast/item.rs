//! Files and items.

use super::{
    Arg, Bounds, Dotted, Equation, Expr, Geometry, Ident, Output, Path, Physics, Region, Set, Setting,
    Statement, Test, Text, TypeExpr, TypedName, UnitExpr,
};
use crate::source::Span;

/// One parsed text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct File {
    /// The items in order.
    pub items: Vec<Item>,
    /// Names that unreadable parts would have declared, in order.
    pub broken: Vec<Ident>,
}

/// An item with what is written about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// The `///` lines before it, joined by line feeds; empty if there are none.
    pub docs: String,
    /// What it is.
    pub kind: ItemKind,
    /// From its keyword to its end.
    pub span: Span,
}

/// The items.
#[derive(Clone, Debug, PartialEq)]
pub enum ItemKind {
    /// `model NAME;`
    Model(Ident),
    /// `use std::solid::{F, cauchy};`
    Import(Import),
    /// `use "part.ansatz" as N(input: expr);`
    Part(Part),
    /// `extend "file.ansatz";`
    Extend(Text),
    /// `coordinates axisymmetric(r, z);`
    Coordinates(Coordinates),
    /// `units um, s, nN;`
    Units(Vec<Ident>),
    /// `param n: T = expr in RANGE;`
    Param(Param),
    /// `let n: T = expr;`
    Let(Let),
    /// `fn n(a: T) -> T = expr;`
    Fn(Function),
    /// `geometry { .. }` and its other forms.
    Geometry(Geometry),
    /// `mesh { .. }`
    Mesh(Vec<Setting>),
    /// `field n: T in SPACE on D = start;`
    Field(Field),
    /// `state n: T = start in RANGE;`
    State(State),
    /// `local n: T on D = start in RANGE where a == b;`
    Local(Local),
    /// `moving D by ..`
    Moving(Moving),
    /// `physics n { .. }`
    Physics(Physics),
    /// `event n when COND => action;`
    Event(Event),
    /// `solve { .. }`
    Solve(Vec<Setting>),
    /// `output { .. }`
    Output(Vec<Output>),
    /// `sweep n: p in SET => expr;`
    Sweep(Sweep),
    /// `test ".." { .. }`
    Test(Test),
    /// `replace ITEM`
    Replace(Box<Replacement>),
    /// `drop KIND NAME;`
    Drop(Drop),
}

/// The words that name a kind of item, as `drop` uses them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs, reason = "each is the keyword of that name")]
pub enum Keyword {
    Model,
    Use,
    Extend,
    Units,
    Coordinates,
    Param,
    Let,
    Fn,
    Geometry,
    Mesh,
    Field,
    State,
    Local,
    Moving,
    Physics,
    Event,
    Solve,
    Output,
    Sweep,
    Test,
    Path,
    Region,
}

impl Keyword {
    /// The 20 words that lead an item, then `path` and `region`, which lead an item of a geometry.
    pub const ALL: [Keyword; 22] = [
        Self::Model,
        Self::Use,
        Self::Extend,
        Self::Units,
        Self::Coordinates,
        Self::Param,
        Self::Let,
        Self::Fn,
        Self::Geometry,
        Self::Mesh,
        Self::Field,
        Self::State,
        Self::Local,
        Self::Moving,
        Self::Physics,
        Self::Event,
        Self::Solve,
        Self::Output,
        Self::Sweep,
        Self::Test,
        Self::Path,
        Self::Region,
    ];

    /// The word as written.
    pub fn text(self) -> &'static str {
        match self {
            Self::Model => "model",
            Self::Use => "use",
            Self::Extend => "extend",
            Self::Units => "units",
            Self::Coordinates => "coordinates",
            Self::Param => "param",
            Self::Let => "let",
            Self::Fn => "fn",
            Self::Geometry => "geometry",
            Self::Mesh => "mesh",
            Self::Field => "field",
            Self::State => "state",
            Self::Local => "local",
            Self::Moving => "moving",
            Self::Physics => "physics",
            Self::Event => "event",
            Self::Solve => "solve",
            Self::Output => "output",
            Self::Sweep => "sweep",
            Self::Test => "test",
            Self::Path => "path",
            Self::Region => "region",
        }
    }

    /// The keyword written so, if there is one.
    pub fn from_text(text: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|keyword| keyword.text() == text)
    }
}

/// `use a::b::{x, y};`
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    /// The module: `std`, `solid`.
    pub path: Vec<Ident>,
    /// What is taken from it; for `use a::b::x;` the last name, for `use a::{x, y};` the list.
    pub names: Vec<Ident>,
}

/// `use "part.ansatz" as ring(ell: .., tau_max: 30 nN);`
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The part's file.
    pub file: Text,
    /// The name of this instance.
    pub name: Ident,
    /// Its inputs and changed parameters.
    pub inputs: Vec<Arg>,
}

/// `coordinates KIND(r, z, copies: 4);`
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinates {
    /// `cartesian`, `axisymmetric`, ..
    pub kind: Ident,
    /// Coordinate names and settings.
    pub args: Vec<Arg>,
}

/// `param n: T = expr in RANGE;`
#[derive(Clone, Debug, PartialEq)]
pub struct Param {
    /// The name.
    pub name: Ident,
    /// The type, where written.
    pub ty: Option<TypeExpr>,
    /// The default; none for an input of a part.
    pub value: Option<Expr>,
    /// What it may be set to.
    pub bounds: Option<Bounds>,
}

/// `let n: T = expr;`
#[derive(Clone, Debug, PartialEq)]
pub struct Let {
    /// The name.
    pub name: Ident,
    /// The type, where written.
    pub ty: Option<TypeExpr>,
    /// The value.
    pub value: Expr,
}

/// `fn n(a: T) -> T = expr;`
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// The name.
    pub name: Ident,
    /// The arguments, at least one.
    pub params: Vec<TypedName>,
    /// The type of the value.
    pub result: TypeExpr,
    /// `let` and `local` before the value; empty unless the body is a block.
    pub locals: Vec<BodyItem>,
    /// The value.
    pub value: Expr,
}

/// What may stand before the value in the body of a function.
#[derive(Clone, Debug, PartialEq)]
pub enum BodyItem {
    /// `let ..;`
    Let(Let),
    /// `local ..;`
    Local(Local),
}

/// How an unknown starts.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// `= value`: it is this at the start.
    Value(Expr),
    /// `~ guess`: solved for, from here.
    Guess(Expr),
}

/// `field n: T in SPACE on D = start;`
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// The name.
    pub name: Ident,
    /// Type of one value.
    pub ty: TypeExpr,
    /// The element space, such as `P2`.
    pub space: Ident,
    /// Where it lives.
    pub domain: Expr,
    /// How it starts; solved for if not given.
    pub start: Option<Start>,
}

/// `state n: T = start in RANGE;`
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// The name.
    pub name: Ident,
    /// Its type.
    pub ty: TypeExpr,
    /// How it starts; solved for if not given.
    pub start: Option<Start>,
    /// Where its values lie.
    pub bounds: Option<Bounds>,
}

/// `local n: T on D = start in RANGE where a == b;`
#[derive(Clone, Debug, PartialEq)]
pub struct Local {
    /// The name.
    pub name: Ident,
    /// Its type.
    pub ty: TypeExpr,
    /// Where it lives; wherever it is used, if not given.
    pub domain: Option<Expr>,
    /// How it starts.
    pub start: Option<Start>,
    /// Where its values lie.
    pub bounds: Option<Bounds>,
    /// What determines it at each point.
    pub equation: Equation,
}

/// `moving D by ..`
#[derive(Clone, Debug, PartialEq)]
pub struct Moving {
    /// What moves.
    pub domain: Expr,
    /// How.
    pub motion: Motion,
}

/// How a domain moves.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// `by n { .. }`: `n` is the displacement, determined by the statements.
    Solved {
        /// The displacement that this declares.
        name: Ident,
        /// What determines it.
        statements: Vec<Statement>,
    },
    /// `by expr;`: the displacement itself.
    Given(Expr),
}

/// `event n when COND => action, ..;`
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// The name.
    pub name: Ident,
    /// When it fires.
    pub trigger: Trigger,
    /// What it does; empty: it is only noted.
    pub actions: Vec<Action>,
}

/// When an event fires.
#[derive(Clone, Debug, PartialEq)]
pub enum Trigger {
    /// `when COND`: as the condition turns true.
    When(Expr),
    /// `every ..`
    Every(Every),
}

/// How often.
#[derive(Clone, Debug, PartialEq)]
pub enum Every {
    /// `every step`
    Step(Span),
    /// `every 0.5 s`
    Time(Expr),
}

/// `stop`, `warn("..")`, `remesh(D, keep: D)`, `set(x: expr)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Action {
    /// Its name.
    pub name: Ident,
    /// Its arguments.
    pub args: Vec<Arg>,
    /// Where it stands.
    pub span: Span,
}

/// `name = expr as [unit]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The heading, where written.
    pub name: Option<Ident>,
    /// The value.
    pub value: Expr,
    /// The unit in which it is shown.
    pub unit: Option<UnitExpr>,
    /// Where it stands.
    pub span: Span,
}

/// `sweep n: p in SET, .. => expr, ..;`
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// The name.
    pub name: Ident,
    /// The axes of the grid, at least one.
    pub axes: Vec<Axis>,
    /// What is recorded of each run, at least one.
    pub columns: Vec<Column>,
}

/// One axis of a sweep: `p in SET` or `(a, b) in {(1, 2), (3, 4)}`.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The parameters that move together, at least one.
    pub names: Vec<Dotted>,
    /// Their values.
    pub values: Set,
    /// Where it stands.
    pub span: Span,
}

/// `replace ITEM`
#[derive(Clone, Debug, PartialEq)]
pub enum Replacement {
    /// An item of the file.
    Item(ItemKind),
    /// A path of the geometry.
    Path(Path),
    /// A region of the geometry.
    Region(Region),
}

/// `drop KIND NAME;`
#[derive(Clone, Debug, PartialEq)]
pub struct Drop {
    /// What kind of item.
    pub kind: Keyword,
    /// Which one.
    pub name: DropName,
}

/// How `drop` names its item.
#[derive(Clone, Debug, PartialEq)]
pub enum DropName {
    /// By its name.
    Name(Dotted),
    /// A test by its title, a part or an extension by its file.
    Text(Text),
}
