//! Element kernels as Rust: one function per kernel, written for a register of elements.

use super::expression::{Dialect, Names, Printer, number};
use super::ident;
use super::layout::Slots;
use super::tables::Tables;
use crate::kernel::{FieldUse, Input, Job, Kernel, POINT, PRELUDE};
use crate::lower::{Derivative, FieldInput, Lowering, SymbolKind};
use crate::scalar::schedule::Schedule;
use crate::scalar::{Id, symbols_of};
use ansatz_elements::Cell;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// Emits a kernel.
pub fn kernel(
    kernel: &Kernel,
    lowering: &Lowering<'_>,
    slots: &Slots,
    tables: &mut Tables,
    place: &str,
) -> TokenStream {
    Emitter { kernel, lowering, slots, names: Names::new(&RESERVED) }.function(tables, place)
}

/// The call of a kernel for all registers as the formatter leaves it, since it does not look into macros, and as it should be.
pub const INVOCATION_AS_PRINTED: &str =
    "vectorize!(lanes(batch : & Batch < '_ >, g : & [f64], out : & mut [Row]));";
/// See [`INVOCATION_AS_PRINTED`].
pub const INVOCATION: &str = "vectorize!(lanes(batch: &Batch<'_>, g: &[f64], out: &mut [Row]));";

/// Variables of every kernel.
const RESERVED: [&str; 28] = [
    "s",
    "o",
    "batch",
    "g",
    "out",
    "q",
    "a",
    "b",
    "weight",
    "x",
    "point",
    "map",
    "residual",
    "tangent",
    "columns",
    "total",
    "node",
    "v",
    "zero",
    "basis",
    "nodes",
    "values",
    "rates",
    "straight",
    "measure",
    "at",
    "direction",
    "bend",
];

pub(super) struct Emitter<'a, 'm> {
    pub(super) kernel: &'a Kernel,
    pub(super) lowering: &'a Lowering<'m>,
    slots: &'a Slots,
    pub(super) names: Names,
}

impl Emitter<'_, '_> {
    fn function(&mut self, tables: &mut Tables, place: &str) -> TokenStream {
        let name = ident(&self.kernel.name);
        let doc = format!(" {place}");
        let prelude = self.prelude();
        let (inputs, geometry) = (self.load_unknowns(), self.load_geometry(tables));
        let (declare, finish) = (self.declare(), self.finish());
        let point = self.point(tables);
        let points = count(self.kernel.rule.weights.len());
        let globals = self.symbols().into_iter().any(|kind| self.is_global(kind));
        let g = if globals { quote!(g) } else { quote!(_) };
        quote! {
            #[doc = #doc]
            fn #name(batch: &Batch<'_>, g: &[f64], out: &mut [Row]) {
                #[inline(always)]
                fn lanes<S: Simd>(s: S, o: usize, batch: &Batch<'_>, #g: &[f64], out: &mut [Row]) {
                    let zero = Lane::splat(s, 0.0);
                    #prelude
                    #inputs
                    #geometry
                    #declare
                    for q in 0..#points {
                        #point
                    }
                    #finish
                }
                vectorize!(lanes(batch: &Batch<'_>, g: &[f64], out: &mut [Row]));
            }
        }
    }

    /// What is the same for all elements of the batch, first as plain numbers, then spread over the lanes.
    fn prelude(&mut self) -> TokenStream {
        let kernel = self.kernel;
        let roots = kernel.job.roots();
        let mut code = Vec::new();
        let mut spread = Vec::new();
        for kind in self.symbols() {
            if let Some(source) = self.global(kind) {
                let name = self.names.symbol(self.lowering, kind);
                code.push(quote!(let #name = #source;));
                spread.push(name);
            }
        }
        let printer =
            Printer { lowering: self.lowering, schedule: &kernel.schedule, dialect: Dialect::Plain };
        code.extend(printer.statements(PRELUDE, &mut self.names));
        spread.extend(
            kernel.schedule.statements(PRELUDE).iter().filter_map(|&id| self.names.statement_name(id)),
        );
        let used = used_at_points(self.lowering, &kernel.schedule, &roots, &self.names);
        let spread = spread.into_iter().filter(|name| used.contains(&name.to_string()));
        quote!(#(#code)* #(let #spread = Lane::splat(s, #spread);)*)
    }

    /// What the kernel's scalars depend on, in order.
    fn symbols(&self) -> Vec<SymbolKind> {
        let symbols = symbols_of(&self.lowering.pool, &self.kernel.job.roots());
        let mut kinds: Vec<SymbolKind> =
            symbols.into_iter().map(|symbol| self.lowering.symbols.kind(symbol)).collect();
        kinds.sort_unstable();
        kinds
    }

    /// Whether a symbol is read from the globals.
    fn is_global(&self, kind: SymbolKind) -> bool {
        !matches!(
            kind,
            SymbolKind::Coordinate(_)
                | SymbolKind::Tangent(_)
                | SymbolKind::Curvature(_)
                | SymbolKind::Field(_)
                | SymbolKind::FieldRate(_)
                | SymbolKind::Weight
                | SymbolKind::Alpha
        )
    }

    /// Where a symbol that is the same at all points is read.
    fn global(&self, kind: SymbolKind) -> Option<TokenStream> {
        match kind {
            SymbolKind::Alpha => Some(quote!(batch.alpha)),
            SymbolKind::Table(table) => {
                let first = count(self.slots.table(table));
                Some(quote!(g[#first + batch.region]))
            }
            _ if self.is_global(kind) => {
                let slot = count(self.slots.slot(kind));
                Some(quote!(g[#slot]))
            }
            _ => None,
        }
    }

    /// The rows of the local unknowns and their rates that the kernel reads.
    fn load_unknowns(&self) -> TokenStream {
        let n = count(self.kernel.unknowns());
        let reads = |rate: bool| self.kernel.inputs.iter().any(|input| input.rate == rate);
        let values = reads(false).then(|| quote!(let values = rows::<#n>(batch.values);));
        let rates = reads(true).then(|| quote!(let rates = rows::<#n>(batch.rates);));
        quote!(#values #rates)
    }

    /// Coordinates of the nodes, and the map of straight elements, which is the same at all points.
    fn load_geometry(&self, tables: &mut Tables) -> TokenStream {
        let nodes = self.kernel.geometry.nodes().len();
        let (nodes, rows) = (count(nodes), count(2 * nodes));
        let map = self.map_at(tables, &quote!(0));
        quote! {
            let nodes = rows::<#rows>(batch.nodes);
            let mut x = [[zero; 2]; #nodes];
            for a in 0..#nodes {
                x[a] = [Lane::load(s, &nodes[2 * a], o), Lane::load(s, &nodes[2 * a + 1], o)];
            }
            let straight = if batch.straight { Some(#map) } else { None };
        }
    }

    /// The element's map at a point: inverse transposed Jacobian and determinant of a triangle, length of an edge.
    fn map_at(&self, tables: &mut Tables, point: &TokenStream) -> TokenStream {
        let gradients = tables.gradients(self.kernel, self.kernel.geometry);
        let function = ident(if self.kernel.cell == Cell::Triangle { "triangle" } else { "segment" });
        quote!(#function(s, &x, &#gradients[#point]))
    }

    fn declare(&self) -> TokenStream {
        let n = count(self.kernel.unknowns());
        match &self.kernel.job {
            Job::Value(_) => quote!(let mut total = zero;),
            Job::Residual(_) => quote!(let mut residual = [zero; #n];),
            Job::Tangent(..) => {
                let entries = count(self.kernel.rows() - self.kernel.unknowns());
                quote! {
                    let mut residual = [zero; #n];
                    let tangent = rows_mut::<#entries>(&mut out[#n..]);
                    for row in tangent.iter_mut() {
                        zero.store(row, o);
                    }
                }
            }
            Job::Columns(_) => {
                let rows = count(self.kernel.rows());
                quote!(let mut columns = [zero; #rows];)
            }
        }
    }

    fn finish(&self) -> TokenStream {
        match &self.kernel.job {
            Job::Value(_) => quote!(total.store(&mut out[0], o);),
            Job::Residual(_) | Job::Tangent(..) => quote!(for (row, sum) in out.iter_mut().zip(residual) {
                sum.store(row, o);
            }),
            Job::Columns(_) => quote!(for (row, sum) in out.iter_mut().zip(columns) {
                sum.store(row, o);
            }),
        }
    }

    /// One quadrature point.
    fn point(&mut self, tables: &mut Tables) -> TokenStream {
        let map = self.map(tables);
        let interpolation = self.interpolation();
        let printer =
            Printer { lowering: self.lowering, schedule: &self.kernel.schedule, dialect: Dialect::Lanes };
        let statements = printer.statements(POINT, &mut self.names);
        let sums = match &self.kernel.job {
            Job::Value(density) => {
                let density = self.value(*density);
                quote!(total += #density;)
            }
            Job::Residual(flux) => self.add_flux(flux, &quote!(residual), 0),
            Job::Columns(columns) => {
                let n = self.kernel.unknowns();
                let columns = columns
                    .iter()
                    .enumerate()
                    .map(|(k, column)| self.add_flux(column, &quote!(columns), k * n));
                let columns: Vec<TokenStream> = columns.collect();
                quote!(#(#columns)*)
            }
            Job::Tangent(flux, tangent) => {
                let residual = self.add_flux(flux, &quote!(residual), 0);
                let tangent = self.add_tangent(tangent);
                quote!(#residual #tangent)
            }
        };
        quote!(#map #interpolation #(#statements)* #sums)
    }

    pub(super) fn value(&self, id: Id) -> TokenStream {
        Printer { lowering: self.lowering, schedule: &self.kernel.schedule, dialect: Dialect::Lanes }
            .value(id, &self.names)
    }

    /// Position, measure, and the gradients of the bases that are read as derivatives.
    fn map(&mut self, tables: &mut Tables) -> TokenStream {
        let kernel = self.kernel;
        let weights = tables.weights(kernel);
        let mut code = Vec::new();
        for (axis, _) in kernel.coordinates.iter().enumerate().filter(|(_, read)| **read) {
            let name = self.names.symbol(self.lowering, SymbolKind::Coordinate(axis));
            let (axis, values) = (count(axis), tables.values(kernel, kernel.geometry));
            code.push(quote!(let #name = coordinate(s, &x, &#values[q], #axis);));
        }
        let gradients_read = kernel.uses.iter().any(|one| kernel.needs_gradients(one.field));
        let names = match (kernel.cell, gradients_read) {
            (Cell::Segment, _) => quote!(measure),
            (Cell::Triangle, false) => quote!((_, measure)),
            (Cell::Triangle, true) => quote!((map, measure)),
        };
        let map = self.map_at(tables, &quote!(q));
        code.push(quote!(let #names = match straight { Some(same) => same, None => #map };));
        code.push(self.shape_of_path(tables));
        let hoop = kernel.axisymmetric.then(|| {
            let r = self.names.symbol(self.lowering, SymbolKind::Coordinate(0));
            let tau = number(std::f64::consts::TAU);
            quote!(* (Lane::splat(s, #tau) * #r))
        });
        self.names.set_symbol(SymbolKind::Weight, ident("weight"));
        code.push(quote!(let weight = Lane::splat(s, #weights[q]) * measure #hoop;));
        for one in &kernel.uses {
            let field = self.field_name(one);
            if kernel.needs_gradients(one.field) {
                let reference = tables.gradients(kernel, one.element);
                code.push(match kernel.cell {
                    Cell::Triangle => {
                        let gradient = format_ident!("grad_{field}");
                        quote!(let #gradient = pull_back(s, &map, &#reference[q]);)
                    }
                    Cell::Segment => {
                        let slope = format_ident!("along_{field}");
                        quote!(let #slope = edge_slopes(s, measure, &#reference[q]);)
                    }
                });
            }
            if kernel.needs_values(one.field) {
                let (basis, values) = (format_ident!("basis_{field}"), tables.values(kernel, one.element));
                code.push(quote!(let #basis = &#values[q];));
            }
        }
        quote!(#(#code)*)
    }

    /// Tangent and curvature of an edge, as far as they are read.
    fn shape_of_path(&mut self, tables: &mut Tables) -> TokenStream {
        let kernel = self.kernel;
        let bends = kernel.curvature.contains(&true);
        if !bends && !kernel.tangent.contains(&true) {
            return TokenStream::new();
        }
        let gradients = tables.gradients(kernel, kernel.geometry);
        let mut code = vec![quote!(let direction = edge_tangent(s, &x, &#gradients[q], measure);)];
        if bends {
            code.push(quote!(let bend = edge_curvature(s, &x, direction, measure);));
        }
        for axis in 0..2 {
            let at = count(axis);
            if kernel.tangent[axis] {
                let name = self.names.symbol(self.lowering, SymbolKind::Tangent(axis));
                code.push(quote!(let #name = direction[#at];));
            }
            if kernel.curvature[axis] {
                let name = self.names.symbol(self.lowering, SymbolKind::Curvature(axis));
                code.push(quote!(let #name = bend[#at];));
            }
        }
        quote!(#(#code)*)
    }

    /// Fields at the point.
    fn interpolation(&mut self) -> TokenStream {
        let mut code = Vec::new();
        for one in &self.kernel.uses {
            for rate in [false, true] {
                let inputs: Vec<Input> = self
                    .kernel
                    .inputs
                    .iter()
                    .filter(|i| i.rate == rate && i.input.field == one.field)
                    .copied()
                    .collect();
                if !inputs.is_empty() {
                    code.push(self.interpolate(one, rate, &inputs));
                }
            }
        }
        quote!(#(#code)*)
    }

    fn interpolate(&mut self, one: &FieldUse, rate: bool, inputs: &[Input]) -> TokenStream {
        let kind = |input: &Input| {
            if rate { SymbolKind::FieldRate(input.input) } else { SymbolKind::Field(input.input) }
        };
        let names: Vec<Ident> =
            inputs.iter().map(|input| self.names.symbol(self.lowering, kind(input))).collect();
        let rows = if rate { quote!(rates) } else { quote!(values) };
        let mut sums = Vec::new();
        for component in 0..one.components {
            let of: Vec<usize> =
                (0..inputs.len()).filter(|&k| inputs[k].input.component == component).collect();
            if of.is_empty() {
                continue;
            }
            let row = self.unknown(one, component, &ident("a"));
            let adds = of.iter().map(|&k| {
                let (name, basis) = (&names[k], self.basis(one, inputs[k].input, &ident("a")));
                quote!(#name = v.mul_add(#basis, #name);)
            });
            sums.push(quote!(let v = Lane::load(s, &#rows[#row], o); #(#adds)*));
        }
        let nodes = count(one.nodes());
        quote!(#(let mut #names = zero;)* for a in 0..#nodes { #(#sums)* })
    }

    /// Index of a local unknown.
    pub(super) fn unknown(&self, one: &FieldUse, component: usize, node: &Ident) -> TokenStream {
        let offset = count(one.first + component);
        match (one.components, one.first + component) {
            (1, 0) => quote!(#node),
            (1, _) => quote!(#node + #offset),
            (components, 0) => {
                let components = count(components);
                quote!(#components * #node)
            }
            (components, _) => {
                let components = count(components);
                quote!(#components * #node + #offset)
            }
        }
    }

    /// Value or derivative of the basis function of a node.
    pub(super) fn basis(&self, one: &FieldUse, input: FieldInput, node: &Ident) -> TokenStream {
        let field = self.field_name(one);
        match input.derivative {
            None => {
                let basis = format_ident!("basis_{field}");
                quote!(Lane::splat(s, #basis[#node]))
            }
            Some(Derivative::Along) => {
                let slope = format_ident!("along_{field}");
                quote!(#slope[#node])
            }
            Some(Derivative::Coordinate(direction)) => {
                let (gradient, direction) = (format_ident!("grad_{field}"), count(direction));
                quote!(#gradient[#node][#direction])
            }
        }
    }

    fn field_name(&self, one: &FieldUse) -> String {
        self.lowering.model.fields[one.field.0].name.clone()
    }
}

/// Names of prelude values that are read at points.
fn used_at_points(
    lowering: &Lowering<'_>,
    schedule: &Schedule,
    roots: &[Id],
    names: &Names,
) -> std::collections::BTreeSet<String> {
    let at_points =
        crate::scalar::reachable(&lowering.pool, roots).into_iter().filter(|&id| schedule.stage(id) == POINT);
    let mut read: Vec<Id> =
        at_points.flat_map(|id| lowering.pool.node(id).arguments().collect::<Vec<_>>()).collect();
    read.extend(roots);
    read.into_iter().filter_map(|id| names.name_of(lowering, id)).map(|name| name.to_string()).collect()
}

pub(super) fn count(value: usize) -> Literal {
    Literal::usize_unsuffixed(value)
}
