//! The whole contract between emitted code and the runtime: a compiled model is one `static PROGRAM: Program`, plain data and plain functions.
//! Emitted code names nothing outside this module, so a change of the runtime behind it cannot break a compiled model, and rebuilding a
//! model compiles no generic code of ours or of the linear algebra.
//!
//! All numbers are in the model's coherent units. Every scalar that is the same at all points of space stands in one array, the *globals* `g`,
//! laid out by [`Layout`]; emitted functions read it by fixed indices.

mod pair;

pub use ansatz_geometry::{Geometry, GeometryError, LoopPart, PathBuilder, Region, Turn};

pub use crate::error::Error;
pub use crate::lane::{BATCH, Lane, Row, Simd, rows, rows_mut};
pub use crate::mesh::{MeshSizing, Place, SizeRule};
pub use crate::settings::{named_step, whole};
pub use crate::simulation::Simulation;
pub use crate::simulator::main;
pub use crate::vectorize;
pub use pair::{
    GapSize, Pair, PairForce, PairForceRate, PairGlobalTangent, PairIntegral, PairLoad, PairValue, Sides,
};

/// A simulation of a compiled model; `parameters` are all its parameters' values in its units.
///
/// # Errors
/// See [`Simulation::new`].
pub fn simulation(program: &'static Program, parameters: Vec<f64>) -> Result<Simulation, Error> {
    Simulation::new(program, &parameters)
}

/// Everything the compiler says about a model.
pub struct Program {
    /// Name of the model.
    pub name: &'static str,
    /// First paragraph of its documentation.
    pub doc: &'static str,
    /// SHA-256 of the source text (with all files it uses), hexadecimal.
    pub source_hash: &'static str,
    /// Units: SI value of one internal unit of (length, mass, time, temperature, amount, current).
    pub base_scales: [f64; 6],
    /// Display text of the internal unit of (length, mass, time, ...).
    pub base_units: [&'static str; 6],
    /// Coordinates are axisymmetric: the path `axis` exists and vector fields have no radial component on it.
    pub axisymmetric: bool,
    /// Positions of things in the globals.
    pub layout: Layout,
    /// Parameters, in declaration order; their values are `g[layout.parameters ..]`.
    pub parameters: &'static [Parameter],
    /// Geometry from the parameters (`g` holds parameters only).
    pub geometry: fn(g: &[f64]) -> Result<Geometry, Vec<GeometryError>>,
    /// Mesh sizes from the parameters.
    pub sizing: fn(g: &[f64]) -> MeshSizing,
    /// Measures of domains that formulas use (area, volume), computed once after meshing.
    pub measures: &'static [Measure],
    /// Weight of the reference measure at a point, such as 2 pi r or 1.
    pub weight: fn(x: [f64; 2]) -> f64,
    /// Fills `g[layout.constants ..]` from parameters and measures.
    pub constants: fn(g: &mut [f64]),
    /// Fields.
    pub fields: &'static [Field],
    /// States.
    pub states: &'static [State],
    /// Functionals that equations use: unknown-like scalars z_k = Z_k(fields).
    pub functionals: &'static [Functional],
    /// Names of the physics blocks.
    pub blocks: &'static [&'static str],
    /// Essential conditions.
    pub holds: &'static [Hold],
    /// Unknowns that follow others.
    pub ties: &'static [Tie],
    /// Regions whose shape follows the bodies around them.
    pub moving: &'static [Moving],
    /// Sizes of cells between surfaces.
    pub gap_sizes: &'static [GapSize],
    /// Integrals that contribute to the balance of the fields.
    pub integrals: &'static [Integral],
    /// Contact pairs.
    pub pairs: &'static [Pair],
    /// Energies of the gap.
    pub pair_integrals: &'static [PairIntegral],
    /// Loads on the surfaces of pairs.
    pub pair_loads: &'static [PairLoad],
    /// Loads on functionals: `R += sum_k c_k grad Z_k`.
    pub couplings: Option<Couplings>,
    /// Equations of the states.
    pub state_system: Option<StateSystem>,
    /// Scalars that only outputs and events read, evaluated after a step.
    pub observables: &'static [Observable],
    /// Events.
    pub events: &'static [Event],
    /// Time span, steps, tolerances from the parameters.
    pub solve: fn(g: &[f64]) -> Solve,
    /// Tables.
    pub tables: &'static [Table],
    /// Field frames.
    pub frames: &'static [Frames],
    /// Run-time expectations of the model's tests.
    pub tests: &'static [Test],
}

/// Index ranges of the globals: `[start, end)` each. The total length is `length`.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Layout {
    pub parameters: [usize; 2],
    pub measures: [usize; 2],
    pub constants: [usize; 2],
    pub time: usize,
    pub states: [usize; 2],
    /// Time derivatives of the states.
    pub state_rates: [usize; 2],
    pub functionals: [usize; 2],
    /// Time derivatives of the functionals.
    pub functional_rates: [usize; 2],
    pub observables: [usize; 2],
    pub length: usize,
}

/// A parameter as users see it.
pub struct Parameter {
    /// Name in the model.
    pub name: &'static str,
    /// Its documentation.
    pub doc: &'static str,
    /// Exponents of the base dimensions as (numerator, denominator): length, mass, time, temperature, amount, current.
    pub dimension: [(i32, i32); 6],
    /// Unit in which it is shown, such as `um` or `kg/s`.
    pub unit: &'static str,
    /// Internal value of one shown unit.
    pub unit_value: f64,
    /// Default from the parameters before it.
    pub default: fn(g: &[f64]) -> f64,
    /// Allowed range (both ends included), infinite where open.
    pub range: fn(g: &[f64]) -> (f64, f64),
    /// Allowed values, if the model lists them.
    pub choices: fn(g: &[f64]) -> Option<Vec<f64>>,
}

/// Cells of regions, edges of paths or their ends, by name as the mesh knows them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// Cells of these regions.
    Cells(&'static [&'static str]),
    /// Edges of these paths (`nucleus`) or segments (`nucleus.pull`); `axis` for the symmetry axis. Those of a moving region have its name
    /// before them (`cytosol/nucleus`).
    Edges(&'static [&'static str]),
    /// First and last points of paths: `membrane.start`, `membrane.end`.
    Ends(&'static [&'static str]),
}

/// Reference measure of a domain.
#[allow(missing_docs)]
pub struct Measure {
    pub name: &'static str,
    pub domain: Domain,
}

/// Finite element space of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// Linear.
    P1,
    /// Quadratic.
    P2,
}

/// A field: `components` unknowns per node of its space on its domains.
#[allow(missing_docs)]
pub struct Field {
    pub name: &'static str,
    pub components: usize,
    /// Suffix of each component for messages, such as `r`, `z`.
    pub component_names: &'static [&'static str],
    pub space: Space,
    /// Cells and edges on which it lives.
    pub domains: &'static [Domain],
    /// Display unit.
    pub unit: &'static str,
    /// Its rates occur in the equations.
    pub differential: bool,
    /// Start value of each component at a reference point.
    pub start: fn(x: [f64; 2], g: &[f64], out: &mut [f64]),
}

/// A state.
#[allow(missing_docs)]
pub struct State {
    pub name: &'static str,
    pub unit: &'static str,
    /// How it starts.
    pub start: Start,
    /// Its start value or guess (middle of its bounds if the model says nothing).
    pub value: fn(g: &[f64]) -> f64,
    /// Open interval in which it must stay, infinite where unbounded.
    pub bounds: fn(g: &[f64]) -> (f64, f64),
}

/// How a state gets its value at the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Fixed by the model.
    Fixed,
    /// Solved for, from a guess.
    Solved,
}

/// A field's unknowns used by an integral: local unknowns are numbered use by use, node by node, component by component.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Use {
    pub field: usize,
}

/// A batch of [`BATCH`] elements of one region, structure of arrays: one row per scalar quantity. A batch with fewer elements repeats
/// its last one; the runtime ignores those lanes.
pub struct Batch<'a> {
    /// Position of the region in the integral's domain (0 for edges).
    pub region: usize,
    /// Reference coordinates of the geometry nodes: x0, y0, x1, y1, .. (6 nodes of a triangle, 3 of an edge).
    pub nodes: &'a [Row],
    /// All elements are affine: middle nodes lie in the middle of straight edges.
    pub straight: bool,
    /// Local unknowns.
    pub values: &'a [Row],
    /// Their time derivatives, if the integral reads them.
    pub rates: &'a [Row],
    /// d rate / d value of the time integrator [1/time].
    pub alpha: f64,
}

/// An emitted element kernel: adds nothing, overwrites `out`.
pub type Kernel = fn(batch: &Batch<'_>, g: &[f64], out: &mut [Row]);

/// An integral over cells or edges, as kernels per element. With n local unknowns:
/// `value` writes 1 row; `residual` n rows, the variation; `tangent` the n rows of the residual followed by the tangent
/// d residual / d value + alpha d residual / d rate: lower triangle row by row (n(n+1)/2) when `symmetric`, else all n*n row by row.
pub struct Integral {
    /// What it is, such as `elasticity: energy`.
    pub name: &'static str,
    /// Where it stands, such as `model.ansatz:150`.
    pub place: &'static str,
    /// Physics block, index into [`Program::blocks`].
    pub block: usize,
    /// Domain.
    pub domain: Domain,
    /// Fields whose unknowns it uses.
    pub uses: &'static [Use],
    /// Its kernels read rates.
    pub rates: bool,
    /// The tangent is symmetric.
    pub symmetric: bool,
    /// The integral itself (energies and functionals).
    pub value: Option<Kernel>,
    /// Its variation.
    pub residual: Kernel,
    /// Residual and tangent; `None` if the tangent is zero (a linear functional).
    pub tangent: Option<Kernel>,
    /// Derivative of the residual with respect to states and functionals.
    pub global_tangent: Option<GlobalTangent>,
}

/// Derivative of a residual with respect to some states and functionals.
pub struct GlobalTangent {
    /// Which ones: the states are numbered first, then the functionals.
    pub slots: &'static [usize],
    /// Writes n rows for each of them, its rate included with `alpha`.
    pub kernel: Kernel,
}

/// A scalar Z(fields) that equations use.
pub struct Functional {
    /// Name for messages.
    pub name: &'static str,
    /// Display unit.
    pub unit: &'static str,
    /// What it is.
    pub kind: FunctionalKind,
}

/// Kinds of functionals.
pub enum FunctionalKind {
    /// Sum of integrals.
    Integral(&'static [Integral]),
    /// Value at a reference point, a function of the fields there.
    Point {
        /// The reference point.
        at: fn(g: &[f64]) -> [f64; 2],
        /// Cells or edges, one of which has the point.
        domain: Domain,
        /// `out[0]` value, `out[1 + i]` derivative by input i.
        function: PointFunction,
    },
}

/// A derivative in space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Derivative {
    /// In reference direction 0 or 1.
    Direction(usize),
    /// By the arc length of the path through the point, in its direction.
    Along,
}

/// What a pointwise function reads of a field at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointInput {
    /// Field.
    pub field: usize,
    /// Component of the field.
    pub component: usize,
    /// Derivative; none for the value.
    pub derivative: Option<Derivative>,
    /// Of the time derivative instead of the value.
    pub rate: bool,
}

/// An emitted function of region, reference position, inputs and globals; writes the results. Behind the inputs that it lists stand the normal,
/// where the point is seen from one side, and the tangent and the curvature vector of the path, where it is on one: two numbers each.
pub type PointEvaluation = fn(region: usize, x: [f64; 2], inputs: &[f64], g: &[f64], out: &mut [f64]);

/// A function of position, field values and globals at one point.
pub struct PointFunction {
    /// What it reads.
    pub inputs: &'static [PointInput],
    /// Number of results.
    pub outputs: usize,
    /// Regions in which results may differ (`match region`): `region` is an index into this list.
    pub regions: &'static [&'static str],
    /// Evaluates.
    pub evaluate: PointEvaluation,
}

/// `hold u = g on D`: prescribes one component.
#[allow(missing_docs)]
pub struct Hold {
    pub field: usize,
    pub component: usize,
    pub domain: Domain,
    pub place: &'static str,
    pub value: fn(x: [f64; 2], g: &[f64]) -> f64,
}

/// `tie a == b on D` or `tie a == dt(b) on D`: a field follows another one at the nodes of a surface, and what acts on it acts on the other.
#[allow(missing_docs)]
pub struct Tie {
    pub field: usize,
    pub partner: usize,
    /// It equals the rate of its partner, else its value.
    pub rate: bool,
    pub domain: Domain,
    pub place: &'static str,
}

/// `moving D by u`: a region whose surface follows a displacement, with a new mesh after every step.
#[allow(missing_docs)]
pub struct Moving {
    pub region: &'static str,
    /// Displacement field of the bodies around it.
    pub displacement: usize,
}

/// Coefficients of functionals in the balance: virtual work sum_k c_k delta Z_k.
pub struct Couplings {
    /// Physics blocks and coefficient of each: (block, functional, place).
    pub terms: &'static [CouplingTerm],
    /// `out[i]` = coefficient of term i (positive on the left side).
    pub coefficients: fn(g: &[f64], out: &mut [f64]),
    /// Row by row: d coefficient i / d (states, then functionals), rates included with `alpha`.
    pub derivatives: fn(g: &[f64], alpha: f64, out: &mut [f64]),
}

/// One coupling.
#[allow(missing_docs)]
pub struct CouplingTerm {
    pub block: usize,
    pub functional: usize,
    pub place: &'static str,
}

/// Equations r(states, state rates, functionals, functional rates, t) = 0, as many as states. A *switch* is the truth of one comparison
/// inside a `match`; functions take the switches as given, so that a branch can be held.
pub struct StateSystem {
    /// Number of switches.
    pub switches: usize,
    /// Where each equation stands.
    pub places: &'static [&'static str],
    /// Whether the derivative of a state occurs (else it is algebraic).
    pub differential: &'static [bool],
    /// Which equations contain no time derivative (they hold at the start too).
    pub algebraic_equations: &'static [bool],
    /// Truth of each switch at g.
    pub switch: fn(g: &[f64], out: &mut [bool]),
    /// Residuals, each divided by a characteristic size so that 1 is large.
    pub residual: fn(g: &[f64], switches: &[bool], out: &mut [f64]),
    /// d residual / d state + alpha d residual / d state rate, row by row.
    pub jacobian: fn(g: &[f64], switches: &[bool], alpha: f64, out: &mut [f64]),
    /// d residual / d functional + alpha d residual / d functional rate, row by row.
    pub sensitivity: fn(g: &[f64], switches: &[bool], alpha: f64, out: &mut [f64]),
}

/// A scalar for outputs and events.
#[allow(missing_docs)]
pub struct Observable {
    pub name: &'static str,
    pub unit: &'static str,
    pub kind: ObservableKind,
}

/// Kinds of observables. They may read states, functionals and observables before them.
pub enum ObservableKind {
    /// Sum of integrals (only `value` kernels are called).
    Integral(&'static [Integral]),
    /// Integral over the edges of paths (or segments) as seen from the cells of regions; behind its inputs the function reads both components
    /// of the unit normal out of these.
    Side {
        /// Paths.
        paths: &'static [&'static str],
        /// Regions; each edge has one of them on one side.
        regions: &'static [&'static str],
        /// Integrand.
        function: PointFunction,
    },
    /// Smallest value over the nodes of a domain.
    Min(Domain, PointFunction),
    /// Largest value over the nodes of a domain.
    Max(Domain, PointFunction),
    /// Value at a reference point.
    Point(fn(g: &[f64]) -> [f64; 2], Domain, PointFunction),
    /// Smallest value over the quadrature points of a pair's surfaces; `Sides::Both` stands for those that laws act on or other values need, at
    /// least the first. Points without a partner within the search distance count as a gap of that distance.
    PairMin(usize, Sides, PairValue),
    /// Largest, likewise.
    PairMax(usize, Sides, PairValue),
    /// Integral over the points of a pair's surfaces that the other one faces within the search distance.
    #[allow(missing_docs)]
    PairIntegral { pair: usize, sides: Sides, current: bool, function: PairValue },
    /// Component of the resultant that a block puts on the nodes of edges.
    Force {
        /// Physics block.
        block: usize,
        /// Edges.
        domain: Domain,
        /// Field that carries the force.
        field: usize,
        /// Component.
        component: usize,
    },
}

/// A named event.
pub struct Event {
    /// Name.
    pub name: &'static str,
    /// Documentation (the outcome's text).
    pub doc: &'static str,
    /// When it is looked at.
    pub trigger: Trigger,
    /// What it does.
    pub actions: &'static [Action],
}

/// When an event fires.
pub enum Trigger {
    /// When `condition` turns positive and has stayed so for `duration(g)` (0 = at once), while `also` is positive.
    When {
        /// Positive = true, continuous where possible, for root finding.
        condition: fn(g: &[f64]) -> f64,
        /// How long it must have held.
        duration: fn(g: &[f64]) -> f64,
        /// Further condition at the moment of firing (positive = true).
        also: fn(g: &[f64]) -> f64,
    },
    /// After every step.
    EveryStep,
    /// At multiples of a time.
    Every(fn(g: &[f64]) -> f64),
}

/// What an event does.
pub enum Action {
    /// End the run.
    Stop,
    /// Record a message.
    Warn(&'static str),
    /// Give a state a new value.
    Set(usize, fn(g: &[f64]) -> f64),
    /// Make the meshes of moving regions anew.
    Remesh,
}

/// Time integrators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// Alexander's two-stage L-stable SDIRK of order 2.
    Sdirk2,
    /// Backward Euler.
    BackwardEuler,
}

/// Settings of the solution.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Solve {
    /// Start and end; `None` for a stationary model (one solve).
    pub time: Option<(f64, f64)>,
    pub integrator: Integrator,
    pub max_step: f64,
    pub min_step: f64,
    pub step_tolerance: f64,
    pub newton_tolerance: f64,
    pub newton_iterations: usize,
}

/// When output is written.
pub enum Every {
    /// After every step.
    Step,
    /// At multiples of a time.
    Time(fn(g: &[f64]) -> f64),
}

/// A named value.
pub struct Column {
    /// Name.
    pub name: &'static str,
    /// Display unit.
    pub unit: &'static str,
    /// Internal value of one display unit.
    pub unit_value: f64,
    /// Value from the globals (internal units).
    pub value: fn(g: &[f64]) -> f64,
}

/// A table of scalars over time.
#[allow(missing_docs)]
pub struct Table {
    pub file: &'static str,
    pub every: Every,
    pub columns: &'static [Column],
}

/// Fields on regions or paths over time; values at nodes, averaged between cells of one region's side where they jump.
pub struct Frames {
    /// Cells or edges.
    pub domain: Domain,
    /// When.
    pub every: Every,
    /// Columns: name, unit, internal value of one unit, number of components (1, 3 or 9).
    pub columns: &'static [FrameColumn],
    /// All columns' components after each other.
    pub function: PointFunction,
}

/// A field column of a frame.
#[allow(missing_docs)]
pub struct FrameColumn {
    pub name: &'static str,
    pub unit: &'static str,
    pub unit_value: f64,
    pub components: usize,
    /// First output of the point function.
    pub offset: usize,
}

/// What a finished run offers to the expectations of tests and sweeps.
pub trait Record {
    /// Time at which an event fired first [internal units].
    fn event_time(&self, name: &str) -> Option<f64>;
    /// Globals at every accepted step, in time order.
    fn steps(&self) -> &[Vec<f64>];
    /// Globals at a time (interpolated).
    fn at(&self, time: f64) -> Vec<f64>;
    /// How the run ended, in one word: see [`RunRecord::outcome`](crate::record::RunRecord::outcome).
    fn outcome(&self) -> &str;
}

/// Result of one expectation.
#[derive(Clone, Debug, PartialEq)]
pub struct Expectation {
    /// Its text, as written.
    pub text: &'static str,
    /// Where it stands.
    pub place: &'static str,
    /// Value found, value expected, tolerance (None for plain conditions) [internal units].
    pub numbers: Option<[f64; 3]>,
    /// Internal unit of the numbers.
    pub unit: &'static str,
    /// Whether it holds.
    pub holds: bool,
}

/// A test that reads the run.
#[allow(missing_docs)]
pub struct Test {
    pub title: &'static str,
    pub evaluate: fn(record: &dyn Record) -> Vec<Expectation>,
}
