//! Tables, frames and functions at points.

use super::observe::observed;
use super::{Builder, plane};
use crate::derive;
use crate::lower::{FieldInput, Lowered, Lowering, Region, SymbolKind, unsupported};
use crate::model::{Every, FieldId, PairId, Shape, Start, Type};
use crate::scalar::{Id, symbols_of};
use ansatz_units::Dimension;

/// When output is written.
#[derive(Clone, Debug)]
pub enum When {
    /// After every step.
    Step,
    /// At multiples of a time.
    Time(Id),
}

/// A named scalar in a display unit.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Column {
    pub name: String,
    /// Value of one display unit in the model's units, and its text.
    pub unit: (f64, String),
    pub value: Id,
}

/// A table of scalars.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Table {
    pub file: String,
    pub every: When,
    pub columns: Vec<Column>,
}

/// One column of a frame.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct FrameColumn {
    pub name: String,
    pub unit: (f64, String),
    pub components: usize,
    pub offset: usize,
}

/// Fields on regions over time.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Frames {
    pub region: Region,
    pub every: When,
    pub columns: Vec<FrameColumn>,
    pub function: PointForm,
}

/// What a function at a point reads of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub struct PointInput {
    pub input: FieldInput,
    /// Of the time derivative.
    pub rate: bool,
}

impl PointInput {
    /// The symbol's meaning.
    pub fn kind(self) -> SymbolKind {
        if self.rate { SymbolKind::FieldRate(self.input) } else { SymbolKind::Field(self.input) }
    }
}

/// Scalars at a point of a domain: one list for all regions, or one for each.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct PointForm {
    pub region: Region,
    pub inputs: Vec<PointInput>,
    pub outputs: Vec<Vec<Id>>,
}

impl PointForm {
    /// Collects what the outputs read.
    pub(super) fn new(lowering: &mut Lowering<'_>, region: &Region, outputs: Vec<Vec<Id>>) -> PointForm {
        let outputs: Vec<Vec<Id>> = outputs.iter().map(|roots| super::vary::thaw(lowering, roots)).collect();
        let mut inputs: Vec<PointInput> = symbols_of(&lowering.pool, &outputs.concat())
            .into_iter()
            .filter_map(|symbol| match lowering.symbols.kind(symbol) {
                SymbolKind::Field(input) => Some(PointInput { input, rate: false }),
                SymbolKind::FieldRate(input) => Some(PointInput { input, rate: true }),
                _ => None,
            })
            .collect();
        inputs.sort_unstable();
        PointForm { region: region.clone(), inputs, outputs }
    }

    /// From the densities of a quantity, one for all regions or one for each.
    pub fn of_values(lowering: &mut Lowering<'_>, region: &Region, values: &[Id]) -> PointForm {
        PointForm::new(lowering, region, values.iter().map(|&value| vec![value]).collect())
    }

    /// Each output followed by its derivative by each input.
    pub(super) fn with_derivatives(mut self, lowering: &mut Lowering<'_>) -> PointForm {
        let symbols: Vec<_> = self.inputs.iter().map(|input| lowering.symbols.symbol(input.kind())).collect();
        for outputs in &mut self.outputs {
            let value = outputs[0];
            outputs.extend(derive::gradient(&mut lowering.pool, value, &symbols));
        }
        self
    }
}

impl Table {
    /// Scalars to be evaluated.
    pub(super) fn roots(&self) -> Vec<Id> {
        self.columns.iter().map(|column| column.value).chain(self.every.root()).collect()
    }
}

impl Frames {
    /// Scalars to be evaluated.
    pub(super) fn roots(&self) -> Vec<Id> {
        self.function.outputs.iter().flatten().copied().chain(self.every.root()).collect()
    }
}

impl When {
    fn root(&self) -> Option<Id> {
        if let When::Time(time) = self { Some(*time) } else { None }
    }
}

impl<'m> Builder<'m> {
    /// Tables and frames.
    pub(super) fn outputs(&mut self, rows: &[usize]) -> (Vec<Table>, Vec<Frames>) {
        let output = &self.lowering.model.output;
        let tables = output
            .tables
            .iter()
            .filter_map(|table| self.attempt(|lowering| lower_table(lowering, rows, table)))
            .collect();
        let frames = output
            .frames
            .iter()
            .filter_map(|frames| self.attempt(|lowering| lower_frames(lowering, rows, frames)))
            .collect();
        (tables, frames)
    }

    /// Start of each stored component of each field.
    pub(super) fn starts(&mut self) -> Vec<Vec<Id>> {
        let fields = 0..self.lowering.model.fields.len();
        fields
            .map(|f| self.attempt(|lowering| field_start(lowering, FieldId(f))).unwrap_or_default())
            .collect()
    }

    /// Displacement field of each pair.
    pub(super) fn displacements(&mut self) -> Vec<FieldId> {
        let pairs = 0..self.lowering.model.pairs.len();
        pairs.filter_map(|pair| self.attempt(|lowering| lowering.displacement_of(PairId(pair)))).collect()
    }
}

/// Lowers the time between outputs.
pub(super) fn lower_when<'m>(lowering: &mut Lowering<'m>, every: &'m Every) -> Lowered<When> {
    Ok(match every {
        Every::Step => When::Step,
        Every::Time(time) => When::Time(lowering.global_scalar(time)?),
    })
}

fn lower_table<'m>(
    lowering: &mut Lowering<'m>,
    rows: &[usize],
    table: &'m crate::model::Table,
) -> Lowered<Table> {
    let mut columns = Vec::new();
    for column in &table.columns {
        lowering.name_after(&column.name);
        let value = lowering.global_scalar(&column.value)?;
        let value = observed(lowering, rows, value)?;
        columns.push(Column { name: column.name.clone(), unit: display_unit(lowering, column), value });
    }
    Ok(Table { file: table.file.clone(), every: lower_when(lowering, &table.every)?, columns })
}

/// Value of a column's display unit in the model's units, and its text.
fn display_unit(lowering: &Lowering<'_>, column: &crate::model::Column) -> (f64, String) {
    let dimension =
        if let Type::Value(_, dimension) = column.value.ty { dimension } else { Dimension::NUMBER };
    (lowering.model.units.to_internal(column.unit.0, dimension), column.unit.1.clone())
}

fn lower_frames<'m>(
    lowering: &mut Lowering<'m>,
    rows: &[usize],
    frames: &'m crate::model::Frames,
) -> Lowered<Frames> {
    let span = frames.domain.span;
    let region = Region::of(&frames.domain)
        .ok_or_else(|| unsupported(span, "`fields` are written on regions or on paths"))?;
    let parts = lowering.on_parts(&region, |lowering| {
        let mut columns = Vec::new();
        for column in &frames.columns {
            lowering.name_after(&column.name);
            let mut components = lowering.components_here(&column.value)?;
            for component in &mut components {
                *component = observed(lowering, rows, *component)?;
            }
            columns.push(components);
        }
        Ok(columns)
    })?;
    let mut offset = 0;
    let sizes = parts[0].1.iter().map(Vec::len);
    let columns = frames.columns.iter().zip(sizes).map(|(column, components)| {
        offset += components;
        FrameColumn {
            name: column.name.clone(),
            unit: display_unit(lowering, column),
            components,
            offset: offset - components,
        }
    });
    let columns = columns.collect();
    let outputs = parts.into_iter().map(|(_, columns)| columns.concat()).collect();
    let function = PointForm::new(lowering, &region, outputs);
    Ok(Frames { region, every: lower_when(lowering, &frames.every)?, columns, function })
}

fn field_start(lowering: &mut Lowering<'_>, field: FieldId) -> Lowered<Vec<Id>> {
    let model = lowering.model;
    let definition = &model.fields[field.0];
    let stored: Vec<usize> = match definition.shape {
        Shape::Scalar => vec![0],
        _ => model.coordinates.frame.axes().to_vec(),
    };
    let (Start::Value(value) | Start::Guess(value)) = &definition.start else {
        return Ok(vec![lowering.pool.zero(); stored.len()]);
    };
    let span = value.span;
    let mut parts = Vec::new();
    for region in Region::parts(&definition.domain) {
        parts.extend(lowering.on_parts(&region, |lowering| lowering.components_here(value))?);
    }
    let components = match parts.as_slice() {
        [(_, components), rest @ ..]
            if rest.iter().all(|(_, others)| others == components)
                && components.iter().all(|&c| same_everywhere(lowering, c)) =>
        {
            components.clone()
        }
        _ => return Err(unsupported(span, "a start value cannot depend on the region or on unknowns")),
    };
    plane::field(lowering, (field, None), &components, span)?;
    Ok(stored.iter().map(|&axis| components.get(axis).copied().unwrap_or(components[0])).collect())
}

fn same_everywhere(lowering: &Lowering<'_>, root: Id) -> bool {
    symbols_of(&lowering.pool, &[root]).into_iter().all(|symbol| {
        matches!(
            lowering.symbols.kind(symbol),
            SymbolKind::Parameter(_) | SymbolKind::Measure(_) | SymbolKind::Coordinate(_)
        )
    })
}
