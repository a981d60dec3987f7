//! How kernels add up: fluxes times test functions into the residual, their derivatives times both into the tangent.

use super::ident;
use super::kernel::{Emitter, count};
use crate::kernel::entry_name;
use crate::kernel::{FieldUse, Flux, Tangent};
use crate::lower::{FieldInput, input_name};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// Derivative of the flux of a test by a component of the trial node's unknown, and its name.
type Slope = (FieldInput, usize, Ident);

/// A tangent entry: its name, and its formula if it is computed at the place of the sums.
type Entry = (Ident, Option<TokenStream>);

impl Emitter<'_, '_> {
    /// `rows[first + unknown] += flux . basis` for all tests.
    pub(super) fn add_flux(&mut self, flux: &[Flux], rows: &TokenStream, first: usize) -> TokenStream {
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

    /// For every trial node: the derivatives of the fluxes by its unknowns, then their products with the test functions.
    pub(super) fn add_tangent(&mut self, tangent: &Tangent) -> TokenStream {
        let entries = self.entry_names(tangent);
        let computed =
            entries.iter().flatten().flatten().filter_map(|(name, value)| Some((name, value.as_ref()?)));
        let (names, values): (Vec<_>, Vec<_>) = computed.unzip();
        let columns = self.kernel.uses.iter().filter_map(|trial| {
            let (code, slopes) = self.slopes(tangent, &entries, trial);
            if slopes.is_empty() {
                return None;
            }
            let tests =
                self.kernel.uses.iter().filter(|test| !tangent.symmetric || test.first >= trial.first);
            let blocks = tests.map(|test| self.add_blocks(tangent.symmetric, &slopes, test, trial));
            let nodes = count(trial.nodes());
            Some(quote!(for b in 0..#nodes { #code #(#blocks)* }))
        });
        quote!(#(let #names = #values;)* #(#columns)*)
    }

    /// A name for each entry, and its formula unless it is named already: entries above the diagonal of a symmetric matrix are those below.
    fn entry_names(&mut self, tangent: &Tangent) -> Vec<Vec<Option<Entry>>> {
        let model = self.lowering.model;
        let mut rows: Vec<Vec<Option<Entry>>> = Vec::new();
        for (test, row) in tangent.tests.iter().zip(&tangent.entries) {
            let mut names = Vec::new();
            for (trial, entry) in tangent.trials.iter().zip(row) {
                names.push(entry.map(|id| match self.names.statement_name(id) {
                    Some(name) => (name, None),
                    None => {
                        let name = self.names.unused(&entry_name(model, *test, *trial));
                        (name, Some(self.value(id)))
                    }
                }));
            }
            rows.push(names);
        }
        rows
    }

    /// Statements that compute the slopes at trial node `b`, and their names.
    fn slopes(
        &self,
        tangent: &Tangent,
        entries: &[Vec<Option<Entry>>],
        trial: &FieldUse,
    ) -> (TokenStream, Vec<Slope>) {
        let (mut code, mut slopes) = (Vec::new(), Vec::new());
        let first = |test: &FieldInput| {
            self.kernel.uses.iter().find(|one| one.field == test.field).map_or(0, |one| one.first)
        };
        let is_needed = |test: &FieldInput| !tangent.symmetric || first(test) >= trial.first;
        for component in 0..trial.components {
            for (test, row) in tangent.tests.iter().zip(entries).filter(|(test, _)| is_needed(test)) {
                let inputs = tangent.trials.iter().zip(row);
                let of_component =
                    inputs.filter(|(input, _)| input.field == trial.field && input.component == component);
                let mut terms = of_component.filter_map(|(input, entry)| {
                    entry.as_ref().map(|(name, _)| (self.basis(trial, *input, &ident("b")), name))
                });
                let Some((basis, name)) = terms.next() else { continue };
                let sum = terms
                    .fold(quote!(#name * #basis), |sum, (basis, name)| quote!(#name.mul_add(#basis, #sum)));
                let unknown = FieldInput { field: trial.field, component, derivative: None };
                let [test_name, unknown] =
                    [*test, unknown].map(|input| input_name(self.lowering.model, input));
                let slope = format_ident!("slope_{test_name}_{unknown}");
                code.push(quote!(let #slope = #sum;));
                slopes.push((*test, component, slope));
            }
        }
        (quote!(#(#code)*), slopes)
    }

    /// Adds the block of each test node `a` with trial node `b`.
    fn add_blocks(
        &self,
        symmetric: bool,
        slopes: &[Slope],
        test: &FieldUse,
        trial: &FieldUse,
    ) -> TokenStream {
        let nodes = count(test.nodes());
        let all = self.add_block(symmetric, slopes, (test, &ident("a")), trial, &|_, _| true);
        if all.is_empty() {
            return all;
        }
        if !symmetric || test.first != trial.first {
            return quote!(for a in 0..#nodes { #all });
        }
        let lower =
            self.add_block(symmetric, slopes, (test, &ident("b")), trial, &|row, column| column <= row);
        quote!(#lower for a in b + 1..#nodes { #all })
    }

    /// `tangent[row, column] += test . slope` for the components that `wanted` picks.
    fn add_block(
        &self,
        symmetric: bool,
        slopes: &[Slope],
        (test, node): (&FieldUse, &Ident),
        trial: &FieldUse,
        wanted: &dyn Fn(usize, usize) -> bool,
    ) -> TokenStream {
        let mut code = Vec::new();
        for row in 0..test.components {
            let mut sums = Vec::new();
            for column in (0..trial.components).filter(|&column| wanted(row, column)) {
                let of: Vec<&Slope> = slopes
                    .iter()
                    .filter(|(input, c, _)| (input.field, input.component, *c) == (test.field, row, column))
                    .collect();
                let at = if column == 0 {
                    quote!(at)
                } else {
                    let column = count(column);
                    quote!(at + #column)
                };
                let sum =
                    of.iter().fold(quote!(Lane::load(s, &tangent[#at], o)), |sum, (input, _, slope)| {
                        let basis = self.basis(test, *input, node);
                        quote!(#slope.mul_add(#basis, #sum))
                    });
                if !of.is_empty() {
                    sums.push(quote!(#sum.store(&mut tangent[#at], o);));
                }
            }
            let (i, j) = (self.unknown(test, row, node), self.unknown(trial, 0, &ident("b")));
            let n = count(self.kernel.unknowns());
            let position = if symmetric { quote!(lower(#i, #j)) } else { quote!(#n * (#i) + #j) };
            if !sums.is_empty() {
                code.push(quote!(let at = #position; #(#sums)*));
            }
        }
        quote!(#(#code)*)
    }
}
