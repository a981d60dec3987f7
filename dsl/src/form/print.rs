//! Listings of forms, for `ansatz expand` and snapshots: what is varied against what, at which places.

use std::fmt::Write;

use super::{Contact, Forms, FunctionalKind, Term};
use crate::lower::{Lowering, SymbolKind, input_name, region_names, symbol_name};
use crate::model::Sides;
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
    for energy in &forms.gap_energies {
        text += &contact_heading(lowering, sources, &energy.contact);
        let labels = ["energy", "force", "stiffness"].map(String::from);
        text += &formulas(lowering, &labels.into_iter().zip(energy.law).collect::<Vec<_>>());
    }
    for load in &forms.pair_loads {
        text += &contact_heading(lowering, sources, &load.contact);
        let names = &lowering.model.coordinates.names;
        let flux = names.iter().zip(load.flux).map(|(name, flux)| (format!("flux[{name}]"), flux));
        text += &formulas(lowering, &flux.collect::<Vec<_>>());
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

fn contact_heading(lowering: &Lowering<'_>, sources: &SourceMap, contact: &Contact) -> String {
    let pair = &lowering.model.pairs[contact.pair.0].name;
    let side = match contact.sides {
        Sides::First => ".first",
        Sides::Second => ".second",
        Sides::Both => "",
    };
    format!("{} on {pair}{side}, {}\n", contact.name, sources.locate(contact.span))
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
