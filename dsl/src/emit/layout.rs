//! Where everything stands in the globals.

use crate::form::Forms;
use crate::lower::SymbolKind;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// Positions in the globals.
#[derive(Clone, Debug, Default)]
pub struct Slots {
    parameters: usize,
    measures: [usize; 2],
    tables: Vec<usize>,
    time: usize,
    states: [usize; 2],
    state_rates: [usize; 2],
    functionals: [usize; 2],
    functional_rates: [usize; 2],
    observables: [usize; 2],
    /// Quantity of each functional and observable.
    rows: Vec<usize>,
    looked_at: Vec<usize>,
}

impl Slots {
    /// Lays out the globals of a model.
    pub fn new(forms: &Forms<'_>) -> Slots {
        let lowering = &forms.lowering;
        let mut end = lowering.model.params.len();
        let mut take = |count: usize| {
            end += count;
            [end - count, end]
        };
        let measures = take(lowering.measures.len());
        let tables = lowering.tables.iter().map(|table| take(table.values.len())[0]).collect();
        let rows: Vec<usize> = forms.functionals.iter().map(|functional| functional.quantity).collect();
        let states = lowering.model.states.len();
        Slots {
            parameters: lowering.model.params.len(),
            measures,
            tables,
            time: take(1)[0],
            states: take(states),
            state_rates: take(states),
            functionals: take(rows.len()),
            functional_rates: take(rows.len()),
            observables: take(forms.observables.len()),
            rows,
            looked_at: forms.observables.clone(),
        }
    }

    /// Position of a symbol; symbols that are no globals stand nowhere and give the length.
    pub fn slot(&self, kind: SymbolKind) -> usize {
        match kind {
            SymbolKind::Parameter(param) => param.0,
            SymbolKind::Measure(measure) => self.measures[0] + measure,
            SymbolKind::Time => self.time,
            SymbolKind::State(state) => self.states[0] + state.0,
            SymbolKind::StateRate(state) => self.state_rates[0] + state.0,
            SymbolKind::Quantity(quantity) => match self.functional(quantity) {
                Some(row) => self.functionals[0] + row,
                None => {
                    self.observables[0]
                        + self.looked_at.iter().position(|q| *q == quantity).unwrap_or(self.looked_at.len())
                }
            },
            SymbolKind::QuantityRate(quantity) => {
                self.functional_rates[0] + self.functional(quantity).unwrap_or(self.rows.len())
            }
            _ => self.observables[1],
        }
    }

    /// First position of a table.
    pub fn table(&self, table: usize) -> usize {
        self.tables[table]
    }

    /// Number of a quantity among the functionals.
    pub fn functional(&self, quantity: usize) -> Option<usize> {
        self.rows.iter().position(|q| *q == quantity)
    }

    /// Number among states and functionals.
    pub fn unknown(&self, kind: SymbolKind) -> usize {
        match kind {
            SymbolKind::State(state) => state.0,
            SymbolKind::Quantity(quantity) => {
                self.states[1] - self.states[0] + self.functional(quantity).unwrap_or(0)
            }
            _ => 0,
        }
    }

    /// `Layout { .. }`.
    pub fn tokens(&self) -> TokenStream {
        let range = |[from, to]: [usize; 2]| {
            let (from, to) = (Literal::usize_unsuffixed(from), Literal::usize_unsuffixed(to));
            quote!([#from, #to])
        };
        let (time, length) =
            (Literal::usize_unsuffixed(self.time), Literal::usize_unsuffixed(self.observables[1]));
        let constants = range([self.measures[1], self.time]);
        let [parameters, measures] = [[0, self.parameters], self.measures].map(range);
        let [states, state_rates] = [self.states, self.state_rates].map(range);
        let [functionals, functional_rates] = [self.functionals, self.functional_rates].map(range);
        let observables = range(self.observables);
        quote!(Layout {
            parameters: #parameters,
            measures: #measures,
            constants: #constants,
            time: #time,
            states: #states,
            state_rates: #state_rates,
            functionals: #functionals,
            functional_rates: #functional_rates,
            observables: #observables,
            length: #length,
        })
    }
}
