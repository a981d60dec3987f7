//! States, their equations, and loads on functionals.

use super::body::{Sources, assignments, body, closure, list};
use super::layout::Slots;
use super::place;
use crate::form::Forms;
use crate::lower::{Lowering, SymbolKind};
use crate::model::StateId;
use crate::scalar::{Id, Relation, symbols_of};
use crate::source::SourceMap;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// The entries of `Program::states`.
pub fn states(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let (model, settings) = (forms.lowering.model, forms.settings.states.clone());
    let entries = model.states.iter().zip(&settings).map(|(state, setting)| {
        let (name, unit) = (&state.name, model.units.unit_of(state.dimension));
        let start = if setting.fixed { quote!(Start::Fixed) } else { quote!(Start::Solved) };
        let value = closure(&mut forms.lowering, slots, setting.start);
        let bounds = match &setting.bounds {
            Some(bounds) => list(&mut forms.lowering, slots, bounds, &|values| quote!((#(#values),*))),
            None => quote!(|_| (f64::NEG_INFINITY, f64::INFINITY)),
        };
        quote!(State { name: #name, unit: #unit, start: #start, value: #value, bounds: #bounds })
    });
    let entries: Vec<TokenStream> = entries.collect();
    quote!(&[#(#entries),*])
}

/// Derivatives by one state or functional, rates included with alpha.
fn columns(forms: &mut Forms<'_>, roots: &[Id], unknowns: &[SymbolKind]) -> Vec<Id> {
    let columns: Vec<Vec<Id>> =
        unknowns.iter().map(|&kind| forms.derivatives_with_rate(roots, kind)).collect();
    (0..roots.len()).flat_map(|row| columns.iter().map(move |column| column[row])).collect()
}

fn state_kinds(forms: &Forms<'_>) -> Vec<SymbolKind> {
    (0..forms.lowering.model.states.len()).map(|s| SymbolKind::State(StateId(s))).collect()
}

fn functional_kinds(forms: &Forms<'_>) -> Vec<SymbolKind> {
    forms.functionals.iter().map(|functional| SymbolKind::Quantity(functional.quantity)).collect()
}

/// `Option<StateSystem>`.
pub fn system(forms: &mut Forms<'_>, slots: &Slots, sources: &SourceMap) -> TokenStream {
    if forms.states.equations.is_empty() {
        return quote!(None);
    }
    let residuals = forms.states.residuals();
    let places: Vec<String> =
        forms.states.equations.iter().map(|equation| place(sources, equation.span)).collect();
    let differential: Vec<bool> = (0..forms.lowering.model.states.len())
        .map(|s| forms.states.is_differential(&forms.lowering, StateId(s)))
        .collect();
    let algebraic: Vec<bool> =
        residuals.iter().map(|&residual| !has_rates(&forms.lowering, residual)).collect();
    let by_states = columns(forms, &residuals, &state_kinds(forms));
    let by_functionals = columns(forms, &residuals, &functional_kinds(forms));
    let count = Literal::usize_unsuffixed(forms.states.switches.len());
    let switch = switches(forms, slots);
    let residual = function(&mut forms.lowering, slots, &residuals, false);
    let jacobian = function(&mut forms.lowering, slots, &by_states, true);
    let sensitivity = function(&mut forms.lowering, slots, &by_functionals, true);
    quote!(Some(StateSystem {
        switches: #count,
        places: &[#(#places),*],
        differential: &[#(#differential),*],
        algebraic_equations: &[#(#algebraic),*],
        switch: #switch,
        residual: #residual,
        jacobian: #jacobian,
        sensitivity: #sensitivity,
    }))
}

fn has_rates(lowering: &Lowering<'_>, root: Id) -> bool {
    symbols_of(&lowering.pool, &[root]).into_iter().any(|symbol| {
        matches!(lowering.symbols.kind(symbol), SymbolKind::StateRate(_) | SymbolKind::QuantityRate(_))
    })
}

/// `|g, switches, (alpha,) out| ..`.
fn function(lowering: &mut Lowering<'_>, slots: &Slots, roots: &[Id], has_alpha: bool) -> TokenStream {
    let kinds: Vec<SymbolKind> =
        symbols_of(&lowering.pool, roots).into_iter().map(|symbol| lowering.symbols.kind(symbol)).collect();
    let body = body(lowering, slots, Sources::default(), roots);
    let code = assignments(&body);
    let name = |used: bool, name: TokenStream| if used { name } else { quote!(_) };
    let g = name(body.reads_globals, quote!(g));
    let switches = name(kinds.iter().any(|kind| matches!(kind, SymbolKind::Switch(_))), quote!(switches));
    let alpha = name(kinds.contains(&SymbolKind::Alpha), quote!(alpha));
    let out = name(!roots.is_empty(), quote!(out));
    if has_alpha {
        quote!(|#g, #switches, #alpha, #out| { #code })
    } else {
        quote!(|#g, #switches, #out| { #code })
    }
}

/// `|g, out| out[k] = a < b`.
fn switches(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let comparisons = forms.states.switches.clone();
    let roots: Vec<Id> = comparisons.iter().flat_map(|&(_, a, b)| [a, b]).collect();
    let body = body(&mut forms.lowering, slots, Sources::default(), &roots);
    let (statements, g) = (&body.statements, if body.reads_globals { quote!(g) } else { quote!(_) });
    let truths =
        comparisons.iter().zip(body.results.chunks(2)).enumerate().map(|(k, ((relation, ..), sides))| {
            let (k, a, b) = (Literal::usize_unsuffixed(k), &sides[0], &sides[1]);
            let sign = if *relation == Relation::Less { quote!(<) } else { quote!(<=) };
            quote!(out[#k] = #a #sign #b;)
        });
    let out = if comparisons.is_empty() { quote!(_) } else { quote!(out) };
    quote!(|#g, #out| { #(#statements)* #(#truths)* })
}

/// `Option<Couplings>`.
pub fn couplings(forms: &mut Forms<'_>, slots: &Slots, sources: &SourceMap) -> TokenStream {
    if forms.couplings.is_empty() {
        return quote!(None);
    }
    let couplings = forms.couplings.clone();
    let terms = couplings.iter().map(|coupling| {
        let block = Literal::usize_unsuffixed(coupling.block.0);
        let functional = Literal::usize_unsuffixed(slots.functional(coupling.quantity).unwrap_or(0));
        let place = place(sources, coupling.span);
        quote!(CouplingTerm { block: #block, functional: #functional, place: #place })
    });
    let terms: Vec<TokenStream> = terms.collect();
    let coefficients: Vec<Id> = couplings.iter().map(|coupling| coupling.coefficient).collect();
    let unknowns = [state_kinds(forms), functional_kinds(forms)].concat();
    let derivatives = columns(forms, &coefficients, &unknowns);
    let lowering = &mut forms.lowering;
    let has_alpha = symbols_of(&lowering.pool, &derivatives)
        .into_iter()
        .any(|s| lowering.symbols.kind(s) == SymbolKind::Alpha);
    let alpha = if has_alpha { quote!(alpha) } else { quote!(_) };
    let mut written = |roots: &[Id]| {
        let body = body(lowering, slots, Sources::default(), roots);
        (if body.reads_globals { quote!(g) } else { quote!(_) }, assignments(&body))
    };
    let (g, code) = written(&coefficients);
    let (g_of_derivatives, code_of_derivatives) = written(&derivatives);
    quote!(Some(Couplings {
        terms: &[#(#terms),*],
        coefficients: |#g, out| { #code },
        derivatives: |#g_of_derivatives, #alpha, out| { #code_of_derivatives },
    }))
}
