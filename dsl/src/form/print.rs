//! Listings of forms, for `ansatz expand` and snapshots: what is varied against what, at which places.

use std::fmt::Write;

use super::{Forms, FunctionalKind, Term};
use crate::lower::{Lowering, SymbolKind, input_name, region_names, symbol_name};
use crate::scalar::print::listing;
use crate::scalar::schedule::Schedule;
use crate::scalar::{Id, lower_powers};
use crate::source::SourceMap;

/// All forms as text.
pub fn forms(forms: &Forms<'_>, sources: &SourceMap) -> String {
    let lowering = &forms.lowering;
    let mut text = String::new();
    // Writing to a string cannot fail.
    for term in &forms.terms {
        text += &heading(lowering, sources, term);
        text += &formulas(lowering, &term_roots(lowering, term));
    }
    for contact in &forms.contacts {
        let pair = &lowering.model.pairs[contact.pair.0].name;
        let _ = writeln!(text, "{} on {pair}, {}", contact.name, sources.locate(contact.span));
        let labels = ["energy", "force", "stiffness"].map(String::from);
        text += &formulas(lowering, &labels.into_iter().zip(contact.law).collect::<Vec<_>>());
    }
    for coupling in &forms.couplings {
        let _ = writeln!(text, "coupling, {}", sources.locate(coupling.span));
        let label = format!("work on {}", symbol_name(lowering, SymbolKind::Quantity(coupling.quantity)));
        text += &formulas(lowering, &[(label, coupling.coefficient)]);
    }
    for equation in &forms.states.equations {
        let _ = writeln!(text, "equation, {}", sources.locate(equation.span));
        text += &formulas(lowering, &[(String::from("residual"), equation.residual)]);
    }
    for functional in &forms.functionals {
        let _ = writeln!(text, "functional {}", lowering.quantities[functional.quantity].name);
        if let FunctionalKind::Integral(terms) = &functional.kind {
            for term in terms {
                text += &heading(lowering, sources, term);
                text += &formulas(lowering, &term_roots(lowering, term));
            }
        }
    }
    let observables: Vec<&str> =
        forms.observables.iter().map(|&q| lowering.quantities[q].name.as_str()).collect();
    let _ = writeln!(text, "observables: {}", observables.join(", "));
    text
}

fn heading(lowering: &Lowering<'_>, sources: &SourceMap, term: &Term) -> String {
    let symmetric = if term.symmetric { ", symmetric" } else { "" };
    let place = region_names(lowering.model, &term.region).join(" + ");
    format!("{} on {place}, degree {}{symmetric}, {}\n", term.name, term.degree, sources.locate(term.span))
}

fn term_roots(lowering: &Lowering<'_>, term: &Term) -> Vec<(String, Id)> {
    let name = |input| input_name(lowering.model, input);
    let value = term.value.map(|value| (String::from("value"), value));
    let flux =
        term.tests.iter().zip(&term.flux).map(|(test, flux)| (format!("flux[{}]", name(*test)), *flux));
    value.into_iter().chain(flux).collect()
}

fn formulas(lowering: &Lowering<'_>, roots: &[(String, Id)]) -> String {
    let mut pool = lowering.pool.clone();
    let ids: Vec<Id> = roots.iter().map(|(_, id)| *id).collect();
    let ids = lower_powers(&mut pool, &ids);
    let schedule = Schedule::new(&pool, &ids, &|_| 0);
    let roots: Vec<(String, Id)> = roots.iter().map(|(label, _)| label.clone()).zip(ids).collect();
    let text =
        listing(&pool, &roots, &schedule, &|symbol| symbol_name(lowering, lowering.symbols.kind(symbol)));
    text.lines().map(|line| format!("  {line}\n")).collect()
}
