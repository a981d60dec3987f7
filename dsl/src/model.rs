//! Stage 3 of 6: the checked model. Input: syntax trees. Output: a `Model` in which every name is an id, every expression has a type
//! (shape and dimension), every number stands in the model's coherent units, and no user error is left except those that need numbers
//! (geometry) or equations counted (states). Knows no mesh and no Rust.
//!
//! Vectors and tensors always have 3 and 3x3 components, in the order of [`Frame::axes`]: (r, theta, z) in axisymmetric models, (x, y, z) in
//! plane ones. A field or point stores only its in-plane components.

mod expr;

pub use expr::{
    Arithmetic, Arm, Builtin, Domain, Expr, ExprKind, Piece, Reduction, Relation, ScalarFunction, Shape,
    Sides, Smoothness, Type,
};

use crate::source::Span;
use ansatz_units::{Dimension, UnitSystem};

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => { $(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub usize);
    )* };
}
ids! {
    /// Index into [`Model::params`].
    ParamId,
    /// Index into [`Model::lets`].
    LetId,
    /// Index into [`Model::functions`].
    FunctionId,
    /// Index into [`Model::fields`].
    FieldId,
    /// Index into [`Model::states`].
    StateId,
    /// Index into [`Geometry::paths`].
    PathId,
    /// Index into [`Geometry::regions`].
    RegionId,
    /// Index into [`Model::pairs`].
    PairId,
    /// Index into [`Model::blocks`].
    BlockId,
    /// Index into [`Model::events`].
    EventId,
    /// A function argument, a `let` of a block, a test's loop variable: unique within the model.
    LocalId,
}

/// How coordinates, hoop terms and measures are to be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// `axisymmetric(r, z)`: components (r, theta, z); measures carry 2 pi r; vector fields have no r component on `axis`.
    Axisymmetric,
    /// `plane_strain(x, y)`: components (x, y, z); all per unit depth.
    PlaneStrain,
}

/// Coordinates of the model.
#[derive(Clone, Debug)]
pub struct Coordinates {
    /// The frame.
    pub frame: Frame,
    /// Names of the two in-plane coordinates, such as `r` and `z`.
    pub names: [String; 2],
}

impl Frame {
    /// Tensor index of in-plane direction 0 and 1.
    #[must_use]
    pub fn axes(self) -> [usize; 2] {
        match self {
            Self::Axisymmetric => [0, 2],
            Self::PlaneStrain => [0, 1],
        }
    }
}

/// A run-time parameter.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Param {
    pub name: String,
    pub doc: String,
    pub dimension: Dimension,
    /// May use parameters declared before it and constant lets.
    pub default: Expr,
    pub bounds: Option<Bounds>,
    /// Unit in which the default was written (factor to SI, text), for `--help`; the coherent unit if the default is an expression.
    pub unit: (f64, String),
    pub span: Span,
}

/// Allowed values.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "a model has few of them")]
pub enum Bounds {
    /// `in a .. b`, both included.
    Range(Expr, Expr),
    /// `in {a, b, c}`.
    Set(Vec<Expr>),
}

/// A named expression.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Let {
    pub name: String,
    pub doc: String,
    pub value: Expr,
    pub span: Span,
}

/// A function of the model or of the library.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Function {
    pub name: String,
    pub doc: String,
    pub arguments: Vec<(LocalId, Type)>,
    /// Lets of its block, in order; each may use those before it.
    pub lets: Vec<(LocalId, Expr)>,
    pub result: Expr,
    pub span: Span,
}

/// Names of locals (for printing and emitted code), by [`LocalId`].
pub type LocalNames = Vec<String>;

/// Turning sense of an arc.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Turn {
    Counterclockwise,
    Clockwise,
}

/// How a segment gets to its end.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub enum SegmentKind {
    Line,
    Arc { about: Expr, turn: Turn },
}

/// One piece of a path.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Segment {
    pub label: Option<String>,
    pub kind: SegmentKind,
    pub to: Expr,
    pub span: Span,
}

/// A named curve.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Path {
    pub name: String,
    pub start: Expr,
    pub segments: Vec<Segment>,
    pub span: Span,
}

/// A named area: the inside of a loop of paths (`Piece::Path`, `Piece::Segment`, `Piece::Axis`).
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Region {
    pub name: String,
    pub boundary: Vec<Piece>,
    pub span: Span,
}

/// Paths and regions; expressions use parameters and geometry lets only.
#[derive(Clone, Debug, Default)]
#[allow(missing_docs)]
pub struct Geometry {
    pub paths: Vec<Path>,
    pub regions: Vec<Region>,
}

/// Mesh sizes.
#[derive(Clone, Debug, Default)]
#[allow(missing_docs)]
pub struct MeshSettings {
    /// `None` = everywhere. Where several apply the smallest wins.
    pub sizes: Vec<(Expr, Option<Domain>)>,
    pub growth: Option<Expr>,
    pub quality: Option<Expr>,
}

/// Finite element spaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// Linear.
    P1,
    /// Quadratic.
    P2,
}

/// Start of an unknown.
#[derive(Clone, Debug)]
pub enum Start {
    /// `= e`: its value at the start.
    Value(Expr),
    /// `~ e`: a guess; the value is solved for.
    Guess(Expr),
    /// Neither: solved for.
    Solved,
}

/// A field on regions.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Field {
    pub name: String,
    pub doc: String,
    pub shape: Shape,
    pub dimension: Dimension,
    pub space: Space,
    pub domain: Domain,
    pub start: Start,
    pub span: Span,
}

/// A scalar unknown in time.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct State {
    pub name: String,
    pub doc: String,
    pub dimension: Dimension,
    pub start: Start,
    pub bounds: Option<(Expr, Expr)>,
    pub span: Span,
}

/// Two surfaces that may meet.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Pair {
    pub name: String,
    pub first: Domain,
    pub second: Domain,
    /// Search distance \[length\].
    pub search: Expr,
    pub span: Span,
}

/// `moving D by u;`: a region whose shape follows the bodies around it.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Moving {
    pub region: RegionId,
    /// Displacement of the bodies.
    pub by: FieldId,
    pub span: Span,
}

/// `tie a == b`: a field equals another field, or its rate, and what acts on it acts on the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Tie {
    pub field: FieldId,
    pub partner: FieldId,
    pub rate: bool,
}

/// A statement of a physics block.
#[derive(Clone, Debug)]
pub enum StatementKind {
    /// `energy W on D`; `None` = lumped (an energy of states and functionals).
    Energy(Expr, Option<Domain>),
    /// `residual R on D`, linear in test functions.
    Residual(Expr, Domain),
    /// `load q with f on D`: virtual work f . delta q on the right side; `None` = lumped.
    Load(Expr, Expr, Option<Domain>),
    /// `hold u = g on D`, or one component (tensor index) of it.
    Hold(FieldId, Option<usize>, Expr, Domain),
    /// `tie a == b on D`
    Tie(Tie, Domain),
    /// `a == b;`
    Equation(Expr, Expr),
}

/// A statement and where it stands.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Statement {
    pub kind: StatementKind,
    pub span: Span,
}

/// `physics name { .. }`
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Block {
    pub name: String,
    pub statements: Vec<Statement>,
    pub span: Span,
}

/// What an event does.
#[derive(Clone, Debug)]
pub enum Action {
    /// End the run.
    Stop,
    /// Print and record a message.
    Warn(String),
    /// Give a state a new value.
    Set(StateId, Expr),
    /// Mesh moving regions anew.
    Remesh(Domain),
}

/// When an event fires.
#[derive(Clone, Debug)]
pub enum Trigger {
    /// When its condition turns true.
    When(Expr),
    /// After every step.
    EveryStep,
    /// Every given time.
    Every(Expr),
}

/// A named event.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Event {
    pub name: String,
    pub doc: String,
    pub trigger: Trigger,
    pub actions: Vec<Action>,
    pub span: Span,
}

/// Time integrators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// Alexander's two-stage, second-order, L-stable SDIRK.
    Sdirk2,
    /// Backward Euler.
    BackwardEuler,
}

/// `solve { .. }`, missing settings filled with defaults; expressions use parameters only.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Solve {
    /// `None`: a stationary model.
    pub time: Option<(Expr, Expr)>,
    pub integrator: Integrator,
    pub max_step: Option<Expr>,
    pub min_step: Option<Expr>,
    pub step_tolerance: Expr,
    pub newton_tolerance: Expr,
    pub newton_iterations: Expr,
}

/// When output is written.
#[derive(Clone, Debug)]
pub enum Every {
    /// After every step.
    Step,
    /// At multiples of a time.
    Time(Expr),
}

/// A named value in a table or frame.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Column {
    pub name: String,
    pub value: Expr,
    /// Display unit: SI value of one display unit, and its text.
    pub unit: (f64, String),
}

/// `fields on D every T: ..`
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Frames {
    pub domain: Domain,
    pub every: Every,
    pub columns: Vec<Column>,
}

/// `table "file" every T: ..`
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Table {
    pub file: String,
    pub every: Every,
    pub columns: Vec<Column>,
}

/// `output { .. }`
#[derive(Clone, Debug, Default)]
#[allow(missing_docs)]
pub struct Output {
    pub frames: Vec<Frames>,
    pub tables: Vec<Table>,
    pub checkpoint: Option<Every>,
}

/// `sweep name: p in {..}, .. => ..`
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Sweep {
    pub name: String,
    /// Parameters of one axis (several run along tuples) and their values.
    pub axes: Vec<(Vec<ParamId>, Vec<Vec<Expr>>)>,
    /// `None` for the column `outcome`.
    pub columns: Vec<(String, Option<Expr>)>,
    pub span: Span,
}

/// Part of a test.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub enum Check {
    Let(LocalId, Expr),
    /// `for x in a .. b by s { .. }` or over a set.
    Each(LocalId, Values, Vec<Check>),
    /// `expect condition;`
    Holds(Expr, Span),
    /// `expect a ~= b within tolerance [%];`
    Near {
        value: Expr,
        expected: Expr,
        tolerance: Expr,
        percent: bool,
        span: Span,
    },
}

/// Values of a loop.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
#[allow(clippy::large_enum_variant, reason = "a model has few of them")]
pub enum Values {
    Range { from: Expr, to: Expr, by: Expr },
    Set(Vec<Expr>),
}

/// `test "title" { .. }`
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Test {
    pub title: String,
    pub checks: Vec<Check>,
    /// It reads `run`, `outcome`, an event or a time: it needs a finished run.
    pub needs_run: bool,
    pub span: Span,
}

impl Model {
    /// The region whose mesh a field sees on paths, if that moves; a field on bodies sees theirs.
    #[must_use]
    pub fn moving_home(&self, field: FieldId) -> Option<RegionId> {
        let lives = |region| self.fields[field.0].domain.pieces.contains(&Piece::Region(region));
        self.moving.iter().map(|moving| moving.region).find(|&region| lives(region))
    }
}

/// The checked model.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Model {
    pub name: String,
    pub doc: String,
    pub units: UnitSystem,
    pub coordinates: Coordinates,
    pub params: Vec<Param>,
    /// Each uses only those before it.
    pub lets: Vec<Let>,
    pub functions: Vec<Function>,
    pub locals: LocalNames,
    pub geometry: Geometry,
    pub mesh: MeshSettings,
    pub fields: Vec<Field>,
    pub states: Vec<State>,
    pub pairs: Vec<Pair>,
    pub blocks: Vec<Block>,
    pub events: Vec<Event>,
    pub moving: Vec<Moving>,
    pub solve: Solve,
    pub output: Output,
    pub sweeps: Vec<Sweep>,
    pub tests: Vec<Test>,
}
