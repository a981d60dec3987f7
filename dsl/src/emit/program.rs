//! The module of a model, put together.

use super::body::{Sources, body};
use super::integral::Emitted;
use super::layout::Slots;
use super::{docs, fields, geometry, helpers, outputs, pairs, parameters, states, tests};
use crate::form::{Forms, FunctionalKind, Term};
use crate::kernel::{Kernel, Kernels, kernels};
use crate::lower::{QuantityKind, region_names};
use crate::scalar::Id;
use crate::source::SourceMap;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// All kernels of a model, and what identifies its source.
#[derive(Debug)]
#[allow(missing_docs)]
pub struct Plan {
    /// Of each term of the balance.
    pub terms: Vec<Kernels>,
    /// Of each part of each functional.
    pub functionals: Vec<Vec<Kernels>>,
    /// Of each part of each observable, with its term.
    pub observables: Vec<Vec<(Term, Kernels)>>,
    pub source_hash: String,
}

impl Plan {
    /// Builds the kernels.
    pub fn new(forms: &mut Forms<'_>, source_hash: String) -> Plan {
        let mut names = UniqueNames::default();
        let terms = forms.terms.clone();
        let terms =
            terms.iter().map(|term| kernels(&mut forms.lowering, term, &names.next(&term.name))).collect();
        let functionals = forms.functionals.clone();
        let functionals = functionals.iter().map(|functional| match &functional.kind {
            FunctionalKind::Integral(parts) => {
                parts.iter().map(|term| kernels(&mut forms.lowering, term, &names.next(&term.name))).collect()
            }
            FunctionalKind::Point(..) => Vec::new(),
        });
        let functionals = functionals.collect();
        let mut observables = Vec::new();
        for quantity in forms.observables.clone() {
            let mut parts = Vec::new();
            for term in forms.observed_terms(quantity) {
                let kernels = kernels(&mut forms.lowering, &term, &names.next(&term.name));
                parts.push((term, kernels));
            }
            observables.push(parts);
        }
        Plan { terms, functionals, observables, source_hash }
    }

    /// All kernels, in the order in which they are emitted.
    pub fn kernels(&self) -> Vec<&Kernel> {
        let functionals = self.functionals.iter().flatten();
        let observables = self.observables.iter().flatten().map(|(_, kernels)| kernels);
        let all = self.terms.iter().chain(functionals).chain(observables);
        all.flat_map(Kernels::all).collect()
    }
}

/// Names of functions: those of terms, numbered where they repeat.
#[derive(Default)]
struct UniqueNames(std::collections::BTreeMap<String, usize>);

impl UniqueNames {
    fn next(&mut self, name: &str) -> String {
        let name = name.replace(|c: char| !c.is_ascii_alphanumeric(), "_");
        let count = self.0.entry(name.clone()).or_insert(0);
        *count += 1;
        if *count == 1 { name } else { format!("{name}_{count}") }
    }
}

/// The tokens of the module.
pub fn module(forms: &mut Forms<'_>, plan: &Plan, sources: &SourceMap) -> TokenStream {
    let model = forms.lowering.model;
    let about = docs(&format!(
        "A simulation of `{}` with these parameters.\n\n# Errors\nIf the geometry cannot be built or meshed.",
        model.name
    ));
    let structure = parameters::structure(forms);
    let program = program(forms, plan, sources);
    quote! {
        pub use program::PROGRAM;

        #structure

        #about
        pub fn simulation(parameters: &Parameters) -> Result<::ansatz::generated::Simulation, ::ansatz::generated::Error> {
            ::ansatz::generated::simulation(&PROGRAM, parameters.values())
        }

        /// What the compiler says about the model.
        #[allow(non_snake_case, clippy::all)]
        mod program {
            use ::ansatz::generated::*;

            #program
        }
    }
}

fn program(forms: &mut Forms<'_>, plan: &Plan, sources: &SourceMap) -> TokenStream {
    let slots = Slots::new(forms);
    let mut emitted = Emitted::default();
    let model = forms.lowering.model;
    let terms = forms.terms.clone();
    let integrals: Vec<TokenStream> = terms
        .iter()
        .zip(&plan.terms)
        .map(|(term, kernels)| emitted.integral(&forms.lowering, &slots, sources, term, kernels))
        .collect();
    let functionals = outputs::functionals(forms, plan, &mut emitted, &slots, sources);
    let observables = outputs::observables(forms, plan, &mut emitted, &slots, sources);
    let head = head(forms, plan, &slots);
    let measures = measures(forms);
    let (fields, states) = (fields::fields(forms, &slots), states::states(forms, &slots));
    let blocks = model.blocks.iter().map(|block| &block.name);
    let (holds, contact_pairs) = (fields::holds(forms, &slots, sources), pairs::pairs(forms, &slots));
    let pair_integrals = pairs::energies(forms, &slots, sources);
    let pair_loads = pairs::loads(forms, &slots, sources);
    let (ties, moving) = (fields::ties(forms, sources), fields::moving(model));
    let couplings = states::couplings(forms, &slots, sources);
    let system = states::system(forms, &slots, sources);
    let (events, tables) = (outputs::events(forms, &slots), outputs::tables(forms, &slots));
    let (frames, tests) = (outputs::frames(forms, &slots), tests::tests(forms, &slots, sources));
    let (solve, weight) = (geometry::solve(forms, &slots), geometry::weight(model));
    let constants = constants(forms, &slots);
    let (gap_sizes, geometry) = (geometry::gap_sizes(forms, &slots), geometry::geometry(forms, &slots));
    let test_helpers = tests::helpers(forms, &slots);
    let (functions, basis) = (&emitted.functions, emitted.tables.tokens());
    let (helpers, no_variation) = (helpers::helpers(&plan.kernels()), emitted.no_variation());
    quote! {
        pub static PROGRAM: Program = Program {
            #head
            measures: #measures,
            weight: #weight,
            constants: #constants,
            fields: #fields,
            states: #states,
            functionals: #functionals,
            blocks: &[#(#blocks),*],
            holds: #holds,
            ties: #ties,
            moving: #moving,
            gap_sizes: #gap_sizes,
            integrals: &[#(#integrals),*],
            pairs: #contact_pairs,
            pair_integrals: #pair_integrals,
            pair_loads: #pair_loads,
            couplings: #couplings,
            state_system: #system,
            observables: #observables,
            events: #events,
            solve: #solve,
            tables: #tables,
            frames: #frames,
            tests: #tests,
        };
        #geometry
        #test_helpers
        #(#functions)*
        #no_variation
        #helpers
        #basis
    }
}

/// Identity, units, parameters and geometry.
fn head(forms: &mut Forms<'_>, plan: &Plan, slots: &Slots) -> TokenStream {
    let model = forms.lowering.model;
    let (name, hash) = (&model.name, &plan.source_hash);
    let doc = model.doc.split("\n\n").next().unwrap_or_default();
    let (scales, units): (Vec<TokenStream>, Vec<String>) = base_dimensions()
        .map(|dimension| {
            (super::expression::number(model.units.scale(dimension)), model.units.unit_of(dimension))
        })
        .into_iter()
        .unzip();
    let axisymmetric = model.coordinates.frame == crate::model::Frame::Axisymmetric;
    let (layout, parameters) = (slots.tokens(), parameters::table(forms, slots));
    let sizing = geometry::sizing(forms, slots);
    quote! {
        name: #name,
        doc: #doc,
        source_hash: #hash,
        base_scales: [#(#scales),*],
        base_units: [#(#units),*],
        axisymmetric: #axisymmetric,
        layout: #layout,
        parameters: #parameters,
        geometry,
        sizing: #sizing,
    }
}

fn base_dimensions() -> [ansatz_units::Dimension; 6] {
    use ansatz_units::Dimension as D;
    [D::LENGTH, D::MASS, D::TIME, D::TEMPERATURE, D::AMOUNT, D::CURRENT]
}

fn measures(forms: &Forms<'_>) -> TokenStream {
    let model = forms.lowering.model;
    let entries = forms.lowering.measures.iter().map(|region| {
        let (name, domain) = (region_names(model, region).join(" + "), fields::domain(model, region, []));
        quote!(Measure { name: #name, domain: #domain })
    });
    quote!(&[#(#entries),*])
}

/// `|g| g[k] = ..` for the entries of all tables.
fn constants(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let tables = forms.lowering.tables.clone();
    let roots: Vec<Id> = tables.iter().flat_map(|table| table.values.iter().copied()).collect();
    if roots.is_empty() {
        return quote!(|_| {});
    }
    let first = slots.table(0);
    let body = body(&mut forms.lowering, slots, Sources::default(), &roots);
    let (statements, results) = (&body.statements, &body.results);
    let positions = (first..first + roots.len()).map(Literal::usize_unsuffixed);
    quote!(|g| { #(#statements)* #(g[#positions] = #results;)* })
}

impl Forms<'_> {
    /// The parts of an observable that is an integral, as terms without a variation.
    fn observed_terms(&mut self, quantity: usize) -> Vec<Term> {
        let of = self.lowering.quantities[quantity].clone();
        match of.kind {
            QuantityKind::Integral(parts) => {
                parts.into_iter().map(|part| self.plain_term(&of.name, of.span, part)).collect()
            }
            _ => Vec::new(),
        }
    }
}
