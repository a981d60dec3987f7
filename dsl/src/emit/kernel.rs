//! Element kernels as Rust: one function per kernel, written for a register of elements.

use super::expression::{Dialect, Names, Printer, number};
use super::ident;
use super::layout::Slots;
use super::tables::Tables;
use crate::kernel::{FieldUse, Flux, Input, Job, Kernel, POINT, PRELUDE, Tangent};
use crate::lower::{FieldInput, Lowering, SymbolKind, input_name};
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
pub const INVOCATION_AS_PRINTED: &str = "vectorize!(
            lanes(batch : & Batch < '_ >, g : & [f64], out : & mut [[f64; BATCH]])
        );";
/// See [`INVOCATION_AS_PRINTED`].
pub const INVOCATION: &str = "vectorize!(lanes(batch: &Batch<'_>, g: &[f64], out: &mut [[f64; BATCH]]));";

/// Variables of every kernel.
const RESERVED: [&str; 20] = [
    "s", "o", "batch", "g", "out", "q", "a", "b", "weight", "x", "point", "map", "residual", "tangent",
    "columns", "total", "node", "v", "zero", "basis",
];

struct Emitter<'a, 'm> {
    kernel: &'a Kernel,
    lowering: &'a Lowering<'m>,
    slots: &'a Slots,
    names: Names,
}

impl Emitter<'_, '_> {
    fn function(&mut self, tables: &mut Tables, place: &str) -> TokenStream {
        let name = ident(&self.kernel.name);
        let doc = format!(" {place}");
        let prelude = self.prelude();
        let coordinates = self.load_geometry();
        let (declare, finish) = (self.declare(), self.finish());
        let point = self.point(tables);
        let points = count(self.kernel.rule.weights.len());
        quote! {
            #[doc = #doc]
            fn #name(batch: &Batch<'_>, g: &[f64], out: &mut [[f64; BATCH]]) {
                #[inline(always)]
                fn lanes<S: Simd>(s: S, o: usize, batch: &Batch<'_>, g: &[f64], out: &mut [[f64; BATCH]]) {
                    let zero = Lane::splat(s, 0.0);
                    #prelude
                    #coordinates
                    #declare
                    for q in 0..#points {
                        #point
                    }
                    #finish
                }
                vectorize!(lanes(batch: &Batch<'_>, g: &[f64], out: &mut [[f64; BATCH]]));
            }
        }
    }

    /// What is the same for all elements of the batch, first as plain numbers, then spread over the lanes.
    fn prelude(&mut self) -> TokenStream {
        let kernel = self.kernel;
        let roots = kernel.job.roots();
        let mut code = Vec::new();
        let mut spread = Vec::new();
        let mut kinds: Vec<SymbolKind> = symbols_of(&self.lowering.pool, &roots)
            .into_iter()
            .map(|symbol| self.lowering.symbols.kind(symbol))
            .collect();
        kinds.sort_unstable();
        for kind in kinds {
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

    fn global(&self, kind: SymbolKind) -> Option<TokenStream> {
        match kind {
            SymbolKind::Alpha => Some(quote!(batch.alpha)),
            SymbolKind::Table(table) => {
                let first = count(self.slots.table(table));
                Some(quote!(g[#first + batch.region]))
            }
            SymbolKind::Coordinate(_)
            | SymbolKind::Field(_)
            | SymbolKind::FieldRate(_)
            | SymbolKind::Weight => None,
            _ => {
                let slot = count(self.slots.slot(kind));
                Some(quote!(g[#slot]))
            }
        }
    }

    fn load_geometry(&self) -> TokenStream {
        let nodes = count(self.kernel.geometry.nodes().len());
        quote! {
            let mut x = [[zero; 2]; #nodes];
            for a in 0..#nodes {
                x[a] = [Lane::load(s, &batch.nodes[2 * a], o), Lane::load(s, &batch.nodes[2 * a + 1], o)];
            }
        }
    }

    fn declare(&self) -> TokenStream {
        let n = count(self.kernel.unknowns());
        match &self.kernel.job {
            Job::Value(_) => quote!(let mut total = zero;),
            Job::Residual(_) => quote!(let mut residual = [zero; #n];),
            Job::Tangent(..) => {
                let entries = count(self.kernel.rows() - self.kernel.unknowns());
                quote!(let mut residual = [zero; #n]; let mut tangent = [zero; #entries];)
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
            Job::Residual(_) => quote!(for (row, sum) in out.iter_mut().zip(residual) {
                sum.store(row, o);
            }),
            Job::Tangent(..) => {
                quote!(for (row, sum) in out.iter_mut().zip(residual.into_iter().chain(tangent)) {
                    sum.store(row, o);
                })
            }
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

    fn value(&self, id: Id) -> TokenStream {
        Printer { lowering: self.lowering, schedule: &self.kernel.schedule, dialect: Dialect::Lanes }
            .value(id, &self.names)
    }

    /// Position, measure, and the gradients of the bases that are read as derivatives.
    fn map(&mut self, tables: &mut Tables) -> TokenStream {
        let kernel = self.kernel;
        let weights = tables.weights(kernel);
        let gradients = tables.gradients(kernel, kernel.geometry);
        let mut code = Vec::new();
        for (axis, _) in kernel.coordinates.iter().enumerate().filter(|(_, read)| **read) {
            let name = self.names.symbol(self.lowering, SymbolKind::Coordinate(axis));
            let (axis, values) = (count(axis), tables.values(kernel, kernel.geometry));
            code.push(quote!(let #name = coordinate(s, &x, &#values[q], #axis);));
        }
        let measure = match kernel.cell {
            Cell::Triangle if !kernel.uses.iter().any(|one| kernel.needs_gradients(one.field)) => {
                quote!(let (_, measure) = triangle(s, &x, &#gradients[q]);)
            }
            Cell::Triangle => quote!(let (map, measure) = triangle(s, &x, &#gradients[q]);),
            Cell::Segment => quote!(let measure = segment(s, &x, &#gradients[q]);),
        };
        let hoop = kernel.axisymmetric.then(|| {
            let r = self.names.symbol(self.lowering, SymbolKind::Coordinate(0));
            let tau = number(std::f64::consts::TAU);
            quote!(* (Lane::splat(s, #tau) * #r))
        });
        self.names.set_symbol(SymbolKind::Weight, ident("weight"));
        code.push(quote!(#measure let weight = Lane::splat(s, #weights[q]) * measure #hoop;));
        for one in &kernel.uses {
            let field = self.field_name(one);
            if kernel.needs_gradients(one.field) {
                let (gradient, reference) =
                    (format_ident!("grad_{field}"), tables.gradients(kernel, one.element));
                code.push(quote!(let #gradient = pull_back(s, &map, &#reference[q]);));
            }
            if kernel.needs_values(one.field) {
                let (basis, values) = (format_ident!("basis_{field}"), tables.values(kernel, one.element));
                code.push(quote!(let #basis = &#values[q];));
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
            sums.push(quote!(let v = Lane::load(s, &batch.#rows[#row], o); #(#adds)*));
        }
        let nodes = count(one.nodes());
        quote!(#(let mut #names = zero;)* for a in 0..#nodes { #(#sums)* })
    }

    /// Index of a local unknown.
    fn unknown(&self, one: &FieldUse, component: usize, node: &Ident) -> TokenStream {
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
    fn basis(&self, one: &FieldUse, input: FieldInput, node: &Ident) -> TokenStream {
        let field = self.field_name(one);
        match input.derivative {
            None => {
                let basis = format_ident!("basis_{field}");
                quote!(Lane::splat(s, #basis[#node]))
            }
            Some(direction) => {
                let (gradient, direction) = (format_ident!("grad_{field}"), count(direction));
                quote!(#gradient[#node][#direction])
            }
        }
    }

    fn field_name(&self, one: &FieldUse) -> String {
        self.lowering.model.fields[one.field.0].name.clone()
    }

    /// `rows[first + unknown] += flux . basis` for all tests.
    fn add_flux(&mut self, flux: &[Flux], rows: &TokenStream, first: usize) -> TokenStream {
        let mut code = Vec::new();
        for one in &self.kernel.uses {
            let mut sums = Vec::new();
            for component in 0..one.components {
                let of: Vec<&Flux> = flux
                    .iter()
                    .filter(|(test, _)| test.field == one.field && test.component == component)
                    .collect();
                if of.is_empty() {
                    continue;
                }
                let row = self.unknown(
                    &FieldUse { first: one.first + first, ..one.clone() },
                    component,
                    &ident("a"),
                );
                let mut sum = quote!(#rows[#row]);
                for (test, id) in of {
                    let name = self.names.unused(&format!("flux_{}", input_name(self.lowering.model, *test)));
                    let (value, basis) = (self.value(*id), self.basis(one, *test, &ident("a")));
                    code.push(quote!(let #name = #value;));
                    sum = quote!(#name.mul_add(#basis, #sum));
                }
                sums.push(quote!(#rows[#row] = #sum;));
            }
            let nodes = count(one.nodes());
            if !sums.is_empty() {
                code.push(quote!(for a in 0..#nodes { #(#sums)* }));
            }
        }
        quote!(#(#code)*)
    }

    /// For every trial node: the derivative of the fluxes by its unknowns, then the products with the test functions.
    fn add_tangent(&mut self, tangent: &Tangent) -> TokenStream {
        let entries = self.entry_names(tangent);
        let (names, values): (Vec<_>, Vec<_>) =
            entries.iter().flatten().flatten().map(|(name, value)| (name, value)).unzip();
        let mut code = vec![quote!(#(let #names = #values;)*)];
        for trial in &self.kernel.uses {
            let mut columns = Vec::new();
            for component in 0..trial.components {
                columns.push(self.add_column(tangent, &entries, trial, component));
            }
            let nodes = count(trial.nodes());
            code.push(quote!(for b in 0..#nodes { #(#columns)* }));
        }
        quote!(#(#code)*)
    }

    /// A name and value for each entry; equal entries of a symmetric matrix share a name.
    fn entry_names(&mut self, tangent: &Tangent) -> Vec<Vec<Option<(Ident, TokenStream)>>> {
        let model = self.lowering.model;
        let mut rows = Vec::new();
        for (test, row) in tangent.tests.iter().zip(&tangent.entries) {
            let mut names = Vec::new();
            for (trial, entry) in tangent.trials.iter().zip(row) {
                names.push(entry.map(|id| {
                    let name = format!("d_{}_{}", input_name(model, *test), input_name(model, *trial));
                    (self.names.unused(&name), self.value(id))
                }));
            }
            rows.push(names);
        }
        rows
    }

    fn add_column(
        &self,
        tangent: &Tangent,
        entries: &[Vec<Option<(Ident, TokenStream)>>],
        trial: &FieldUse,
        component: usize,
    ) -> TokenStream {
        let mut code = Vec::new();
        let mut slopes: Vec<(FieldInput, Ident)> = Vec::new();
        for (test, row) in tangent.tests.iter().zip(entries) {
            let terms: Vec<(TokenStream, &Ident)> = tangent
                .trials
                .iter()
                .zip(row)
                .filter(|(input, _)| input.field == trial.field && input.component == component)
                .filter_map(|(input, entry)| {
                    entry.as_ref().map(|(name, _)| (self.basis(trial, *input, &ident("b")), name))
                })
                .collect();
            let Some(((basis, name), rest)) = terms.split_first() else { continue };
            let sum = rest
                .iter()
                .fold(quote!(#name * #basis), |sum, (basis, name)| quote!(#name.mul_add(#basis, #sum)));
            let slope = format_ident!("slope_{}", input_name(self.lowering.model, *test));
            code.push(quote!(let #slope = #sum;));
            slopes.push((*test, slope));
        }
        for test in &self.kernel.uses {
            for row in 0..test.components {
                code.push(self.add_block(tangent, &slopes, (test, row), (trial, component)));
            }
        }
        quote!({ #(#code)* })
    }

    /// `tangent[row, column] += test . slope` for all test nodes.
    fn add_block(
        &self,
        tangent: &Tangent,
        slopes: &[(FieldInput, Ident)],
        (test, row): (&FieldUse, usize),
        (trial, column): (&FieldUse, usize),
    ) -> TokenStream {
        let of: Vec<&(FieldInput, Ident)> =
            slopes.iter().filter(|(input, _)| input.field == test.field && input.component == row).collect();
        if of.is_empty() || (tangent.symmetric && test.first < trial.first) {
            return TokenStream::new();
        }
        let (i, j) = (self.unknown(test, row, &ident("a")), self.unknown(trial, column, &ident("b")));
        let n = count(self.kernel.unknowns());
        let position = if tangent.symmetric { quote!(lower(#i, #j)) } else { quote!(#n * (#i) + #j) };
        let first = match tangent.symmetric && test.first == trial.first {
            true if row >= column => quote!(b),
            true => quote!(b + 1),
            false => quote!(0),
        };
        let nodes = count(test.nodes());
        let sum = of.iter().fold(quote!(tangent[at]), |sum, (input, slope)| {
            let basis = self.basis(test, *input, &ident("a"));
            quote!(#slope.mul_add(#basis, #sum))
        });
        quote! {
            for a in #first..#nodes {
                let at = #position;
                tangent[at] = #sum;
            }
        }
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

fn count(value: usize) -> Literal {
    Literal::usize_unsuffixed(value)
}

/// Functions that kernels share; those that none of these kernels needs are left out.
pub fn helpers(kernels: &[&Kernel]) -> TokenStream {
    let any = |needs: &dyn Fn(&Kernel) -> bool| kernels.iter().any(|kernel| needs(kernel));
    let symmetric = |kernel: &Kernel| matches!(&kernel.job, Job::Tangent(_, tangent) if tangent.symmetric);
    let lower = any(&symmetric).then(lower);
    let coordinate = any(&|kernel| kernel.coordinates.contains(&true)).then(coordinate);
    let triangle = any(&|kernel| kernel.cell == Cell::Triangle).then(triangle);
    let segment = any(&|kernel| kernel.cell == Cell::Segment).then(segment);
    let gradients = |kernel: &Kernel| kernel.uses.iter().any(|one| kernel.needs_gradients(one.field));
    let pull_back = any(&gradients).then(pull_back);
    quote!(#lower #coordinate #triangle #segment #pull_back)
}

fn lower() -> TokenStream {
    quote! {
        /// Position of entry (i, j), j <= i, in a lower triangle stored row by row.
        #[inline(always)]
        const fn lower(i: usize, j: usize) -> usize {
            i * (i + 1) / 2 + j
        }
    }
}

fn coordinate() -> TokenStream {
    quote! {
        /// A coordinate of the point.
        #[inline(always)]
        fn coordinate<S: Simd, const N: usize>(s: S, x: &[[Lane<S>; 2]; N], values: &[f64; N], axis: usize) -> Lane<S> {
            let mut sum = Lane::splat(s, 0.0);
            for a in 0..N {
                sum = x[a][axis].mul_add(Lane::splat(s, values[a]), sum);
            }
            sum
        }
    }
}

fn triangle() -> TokenStream {
    quote! {
        /// Inverse transposed Jacobian of a triangle at a point, by rows, and its determinant.
        #[inline(always)]
        fn triangle<S: Simd, const N: usize>(s: S, x: &[[Lane<S>; 2]; N], gradients: &[[f64; 2]; N]) -> ([[Lane<S>; 2]; 2], Lane<S>) {
            let mut j = [[Lane::splat(s, 0.0); 2]; 2];
            for a in 0..N {
                for i in 0..2 {
                    for k in 0..2 {
                        j[i][k] = x[a][i].mul_add(Lane::splat(s, gradients[a][k]), j[i][k]);
                    }
                }
            }
            let determinant = j[0][0] * j[1][1] - j[0][1] * j[1][0];
            let reciprocal = Lane::splat(s, 1.0) / determinant;
            let map = [[j[1][1] * reciprocal, -j[1][0] * reciprocal], [-j[0][1] * reciprocal, j[0][0] * reciprocal]];
            (map, determinant)
        }
    }
}

fn segment() -> TokenStream {
    quote! {
        /// Length of an edge per unit of its parameter at a point.
        #[inline(always)]
        fn segment<S: Simd, const N: usize>(s: S, x: &[[Lane<S>; 2]; N], gradients: &[[f64; 1]; N]) -> Lane<S> {
            let mut t = [Lane::splat(s, 0.0); 2];
            for a in 0..N {
                for i in 0..2 {
                    t[i] = x[a][i].mul_add(Lane::splat(s, gradients[a][0]), t[i]);
                }
            }
            (t[0] * t[0] + t[1] * t[1]).sqrt()
        }
    }
}

fn pull_back() -> TokenStream {
    quote! {
        /// Gradients of basis functions in the coordinates of the model.
        #[inline(always)]
        fn pull_back<S: Simd, const N: usize>(s: S, map: &[[Lane<S>; 2]; 2], reference: &[[f64; 2]; N]) -> [[Lane<S>; 2]; N] {
            let mut gradients = [[Lane::splat(s, 0.0); 2]; N];
            for a in 0..N {
                for i in 0..2 {
                    gradients[a][i] = map[i][0] * Lane::splat(s, reference[a][0]) + map[i][1] * Lane::splat(s, reference[a][1]);
                }
            }
            gradients
        }
    }
}
