//! Stage 5 to 6: element kernels, still free of any target language. Input: a [`Term`]. Output: a [`Kernel`], a loop over quadrature points
//! whose statements are a schedule of scalar expressions.
//!
//! The form is deliberately small: one loop over the points of one rule, in it the geometry of a 6-node triangle or a 3-node edge, the
//! interpolation of the inputs, the point's statements, and one of four ways to add them up. There are no branches, no calls, no arrays to
//! index freely, no nested loops: what this cannot say, no kernel can do. [`interpret`] runs it, [`cost`] counts it, [`mod@print`] shows it,
//! `emit` turns it into Rust.

pub mod cost;
pub mod interpret;
pub mod print;
#[cfg(test)]
mod tests;

use crate::form::Term;
use crate::lower::{FieldInput, Lowering, Region, SymbolKind, input_name};
use crate::model::{FieldId, Frame, Model, Shape, Space};
use crate::scalar::schedule::{Schedule, Stage};
use crate::scalar::{Id, lower_powers, symbols_of};
use ansatz_elements::{Cell, Element, Quadrature, quadrature};

/// Schedule stage of what is the same at all points of a batch's elements of one region.
pub const PRELUDE: Stage = 0;
/// Schedule stage of what changes from point to point.
pub const POINT: Stage = 1;

/// A kernel: what is computed per element.
#[derive(Debug)]
pub struct Kernel {
    /// Such as `elasticity_energy_tangent`.
    pub name: String,
    /// Triangle or segment.
    pub cell: Cell,
    /// Geometry: the quadratic element on the cell.
    pub geometry: &'static Element,
    /// Whether the measure carries `2 pi r`.
    pub axisymmetric: bool,
    /// Fields, in the order of their local unknowns.
    pub uses: Vec<FieldUse>,
    /// Points and weights.
    pub rule: Quadrature,
    /// Inputs interpolated at each point, ascending.
    pub inputs: Vec<Input>,
    /// Which coordinates of the point are read.
    pub coordinates: [bool; 2],
    /// Which components of the unit tangent of an edge are read.
    pub tangent: [bool; 2],
    /// Which components of its curvature vector are read.
    pub curvature: [bool; 2],
    /// What is added up.
    pub job: Job,
    /// Everything that the job adds up, in the order of [`Job::roots`].
    pub schedule: Schedule,
}

/// A field as the kernel sees it.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct FieldUse {
    pub field: FieldId,
    /// First local unknown.
    pub first: usize,
    pub components: usize,
    pub element: &'static Element,
}

/// A field's scalar that is interpolated at each point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub struct Input {
    pub input: FieldInput,
    pub rate: bool,
}

/// A row of fluxes: what it is tested with, and the flux times [`SymbolKind::Weight`].
pub type Flux = (FieldInput, Id);

/// What a kernel writes. Local unknowns are numbered use by use, node by node, component by component.
#[derive(Clone, Debug)]
pub enum Job {
    /// One row: the sum of a weighted density.
    Value(Id),
    /// A row for each unknown: the sum of `flux_i p_i(unknown)`.
    Residual(Vec<Flux>),
    /// The residual, then its derivatives; only the lower triangle if symmetric.
    Tangent(Vec<Flux>, Tangent),
    /// For each column the rows of a residual.
    Columns(Vec<Vec<Flux>>),
}

/// Derivatives of fluxes, weighted; absent entries are zero.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Tangent {
    pub tests: Vec<FieldInput>,
    pub trials: Vec<FieldInput>,
    pub entries: Vec<Vec<Option<Id>>>,
    pub symmetric: bool,
}

impl Job {
    /// The scalars of the point that are added up.
    pub fn roots(&self) -> Vec<Id> {
        match self {
            Job::Value(density) => vec![*density],
            Job::Residual(flux) => flux.iter().map(|(_, id)| *id).collect(),
            Job::Tangent(flux, tangent) => flux
                .iter()
                .map(|(_, id)| *id)
                .chain(tangent.entries.iter().flatten().flatten().copied())
                .collect(),
            Job::Columns(columns) => columns.iter().flatten().map(|(_, id)| *id).collect(),
        }
    }
}

impl FieldUse {
    /// Number of local unknowns.
    pub fn size(&self) -> usize {
        self.components * self.nodes()
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.element.nodes().len()
    }
}

impl Kernel {
    /// Number of local unknowns.
    pub fn unknowns(&self) -> usize {
        self.uses.iter().map(FieldUse::size).sum()
    }

    /// Number of rows that it writes.
    pub fn rows(&self) -> usize {
        let n = self.unknowns();
        match &self.job {
            Job::Value(_) => 1,
            Job::Residual(_) => n,
            Job::Tangent(_, tangent) if tangent.symmetric => n + n * (n + 1) / 2,
            Job::Tangent(..) => n + n * n,
            Job::Columns(columns) => columns.len() * n,
        }
    }

    /// Whether it interpolates rates.
    pub fn reads_rates(&self) -> bool {
        self.inputs.iter().any(|input| input.rate)
    }

    /// The use of a field.
    pub fn use_of(&self, field: FieldId) -> &FieldUse {
        // A kernel's inputs and tests are of the fields that its term uses.
        self.uses.iter().find(|one| one.field == field).unwrap_or(&self.uses[0])
    }

    /// Whether basis functions of a field are read as derivatives.
    pub fn needs_gradients(&self, field: FieldId) -> bool {
        let of = |input: &FieldInput| input.field == field && input.derivative.is_some();
        self.inputs.iter().any(|input| of(&input.input)) || self.arguments().iter().any(of)
    }

    /// Whether basis functions of a field are read as values.
    pub fn needs_values(&self, field: FieldId) -> bool {
        let of = |input: &FieldInput| input.field == field && input.derivative.is_none();
        self.inputs.iter().any(|input| of(&input.input)) || self.arguments().iter().any(of)
    }

    /// Tests and trials of the job.
    fn arguments(&self) -> Vec<FieldInput> {
        match &self.job {
            Job::Value(_) => Vec::new(),
            Job::Residual(flux) => flux.iter().map(|(test, _)| *test).collect(),
            Job::Tangent(_, tangent) => tangent.tests.iter().chain(&tangent.trials).copied().collect(),
            Job::Columns(columns) => columns.iter().flatten().map(|(test, _)| *test).collect(),
        }
    }
}

/// Name of a tangent entry, such as `d_u_r_du_r_dz`.
pub fn entry_name(model: &Model, test: FieldInput, trial: FieldInput) -> String {
    format!("d_{}_{}", input_name(model, test), input_name(model, trial))
}

/// The kernels of one term.
#[derive(Debug)]
pub struct Kernels {
    /// The integral itself.
    pub value: Option<Kernel>,
    /// Its variation; `None` for a plain integral that nothing varies.
    pub residual: Option<Kernel>,
    /// Residual and tangent; `None` if the tangent is zero.
    pub tangent: Option<Kernel>,
    /// Derivatives by states and quantities.
    pub columns: Option<(Vec<SymbolKind>, Kernel)>,
}

impl Kernels {
    /// Those that there are.
    pub fn all(&self) -> impl Iterator<Item = &Kernel> {
        let columns = self.columns.as_ref().map(|(_, kernel)| kernel);
        [self.value.as_ref(), self.residual.as_ref(), self.tangent.as_ref(), columns].into_iter().flatten()
    }
}

/// Builds the kernels of a term, named `name` and what they compute.
pub fn kernels(lowering: &mut Lowering<'_>, term: &Term, name: &str) -> Kernels {
    let weighted = |lowering: &mut Lowering<'_>, ids: &[Id]| -> Vec<Id> {
        let weight = lowering.input(SymbolKind::Weight);
        ids.iter().map(|&id| lowering.pool.mul(weight, id)).collect()
    };
    let make = |lowering: &mut Lowering<'_>, suffix: &str, job: Job| {
        build(lowering, term, format!("{name}_{suffix}"), job)
    };
    let value = term.value.map(|value| {
        let value = weighted(lowering, &[value])[0];
        make(lowering, "value", Job::Value(value))
    });
    if term.tests.is_empty() {
        return Kernels { value, residual: None, tangent: None, columns: None };
    }
    let flux: Vec<Flux> = term.tests.iter().copied().zip(weighted(lowering, &term.flux)).collect();
    let tangent = (!term.trials.is_empty()).then(|| {
        let zero = lowering.pool.zero();
        let rows = term.tangent.iter().map(|row| {
            let row = weighted(lowering, row);
            row.into_iter().map(|id| (id != zero).then_some(id)).collect()
        });
        let entries: Vec<Vec<Option<Id>>> = rows.collect();
        let entries = if term.symmetric { mirrored(&entries) } else { entries };
        let tangent = Tangent {
            tests: term.tests.clone(),
            trials: term.trials.clone(),
            entries,
            symmetric: term.symmetric,
        };
        make(lowering, "tangent", Job::Tangent(flux.clone(), tangent))
    });
    let columns = (!term.globals.is_empty()).then(|| {
        let columns = term
            .globals
            .iter()
            .map(|(_, column)| term.tests.iter().copied().zip(weighted(lowering, column)).collect());
        let columns = columns.collect();
        let kinds = term.globals.iter().map(|(kind, _)| *kind).collect();
        (kinds, make(lowering, "global_tangent", Job::Columns(columns)))
    });
    let residual = Some(make(lowering, "variation", Job::Residual(flux)));
    Kernels { value, residual, tangent, columns }
}

/// Takes the lower triangle for the upper one too, so that nothing is computed twice.
fn mirrored(entries: &[Vec<Option<Id>>]) -> Vec<Vec<Option<Id>>> {
    let at = |i: usize, j: usize| entries[i.max(j)][i.min(j)];
    (0..entries.len()).map(|i| (0..entries.len()).map(|j| at(i, j)).collect()).collect()
}

fn build(lowering: &mut Lowering<'_>, term: &Term, name: String, job: Job) -> Kernel {
    let job = with_lowered_powers(lowering, job);
    if let Job::Tangent(_, tangent) = &job {
        hint_entries(lowering, tangent);
    }
    let roots = job.roots();
    let symbols = &lowering.symbols;
    let schedule = Schedule::new(&lowering.pool, &roots, &|symbol| stage_of(symbols.kind(symbol)));
    let mut inputs = Vec::new();
    let (mut coordinates, mut tangent, mut curvature) = ([false; 2], [false; 2], [false; 2]);
    for symbol in symbols_of(&lowering.pool, &roots) {
        match symbols.kind(symbol) {
            SymbolKind::Field(input) => inputs.push(Input { input, rate: false }),
            SymbolKind::FieldRate(input) => inputs.push(Input { input, rate: true }),
            SymbolKind::Coordinate(axis) => coordinates[axis] = true,
            SymbolKind::Tangent(axis) => tangent[axis] = true,
            SymbolKind::Curvature(axis) => curvature[axis] = true,
            _ => {}
        }
    }
    inputs.sort_unstable();
    let axisymmetric = lowering.model.coordinates.frame == Frame::Axisymmetric;
    coordinates[0] |= axisymmetric;
    let cell = if matches!(term.region, Region::Cells(_)) { Cell::Triangle } else { Cell::Segment };
    let geometry = element(cell, Space::P2);
    Kernel {
        name,
        cell,
        geometry,
        axisymmetric,
        uses: uses(lowering, term, cell),
        rule: rule(cell, term.degree),
        inputs,
        coordinates,
        tangent,
        curvature,
        job,
        schedule,
    }
}

/// Names the entries of a tangent, of symmetric ones those below the diagonal.
fn hint_entries(lowering: &mut Lowering<'_>, tangent: &Tangent) {
    for (i, row) in tangent.entries.iter().enumerate() {
        for (j, entry) in row.iter().enumerate().filter(|(j, _)| !tangent.symmetric || *j <= i) {
            if let Some(id) = entry {
                let name = entry_name(lowering.model, tangent.tests[i], tangent.trials[j]);
                lowering.hints.entry(*id).or_insert(name);
            }
        }
    }
}

/// The rule of this degree, or the best there is.
fn rule(cell: Cell, degree: usize) -> Quadrature {
    let best = (0..=degree).rev().find_map(|degree| quadrature(cell, degree));
    best.unwrap_or(Quadrature { points: Vec::new(), weights: Vec::new(), degree: 0, cell })
}

fn element(cell: Cell, space: Space) -> &'static Element {
    let name = match space {
        Space::P1 => "P1",
        Space::P2 => "P2",
    };
    // Both spaces are tabulated on both cells.
    Element::find(name, cell).unwrap_or(Element::P2_TRIANGLE)
}

fn uses(lowering: &Lowering<'_>, term: &Term, cell: Cell) -> Vec<FieldUse> {
    let mut first = 0;
    let fields = term.uses.iter().map(|&field| {
        let definition = &lowering.model.fields[field.0];
        let components = if definition.shape == Shape::Scalar { 1 } else { 2 };
        let one = FieldUse { field, first, components, element: element(cell, definition.space) };
        first += one.size();
        one
    });
    fields.collect()
}

fn stage_of(kind: SymbolKind) -> Stage {
    match kind {
        SymbolKind::Coordinate(_)
        | SymbolKind::Tangent(_)
        | SymbolKind::Curvature(_)
        | SymbolKind::Field(_)
        | SymbolKind::FieldRate(_)
        | SymbolKind::Weight => POINT,
        _ => PRELUDE,
    }
}

fn with_lowered_powers(lowering: &mut Lowering<'_>, mut job: Job) -> Job {
    let mut lowered = lower_powers(&mut lowering.pool, &job.roots()).into_iter();
    let mut next = |id: &mut Id| *id = lowered.next().unwrap_or(*id);
    match &mut job {
        Job::Value(density) => next(density),
        Job::Residual(flux) => flux.iter_mut().for_each(|(_, id)| next(id)),
        Job::Tangent(flux, tangent) => {
            flux.iter_mut().for_each(|(_, id)| next(id));
            tangent.entries.iter_mut().flatten().flatten().for_each(next);
        }
        Job::Columns(columns) => columns.iter_mut().flatten().for_each(|(_, id)| next(id)),
    }
    job
}
