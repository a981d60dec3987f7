//! Contact pairs: their surfaces, the energies of the gap and the loads on them, and values at their points.

use super::body::{Body, Sources, block, body, closure};
use super::fields::reads;
use super::layout::Slots;
use super::place;
use crate::form::{Contact, Forms, GapEnergy, PairLoad};
use crate::lower::{Lowering, Region, SymbolKind, region_names};
use crate::model::Sides;
use crate::scalar::Id;
use crate::source::SourceMap;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// The entries of `Program::pairs`.
pub fn pairs(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let (model, searches) = (forms.lowering.model, forms.settings.searches.clone());
    let entries = model.pairs.iter().zip(&forms.displacements).zip(searches).map(|((pair, displacement), search)| {
        let side = |domain| Region::of(domain).map(|region| region_names(model, &region)).unwrap_or_default();
        let (name, first, second) = (&pair.name, side(&pair.first), side(&pair.second));
        let (displacement, search) = (Literal::usize_unsuffixed(displacement.0), closure(&mut forms.lowering, slots, search));
        quote!(Pair { name: #name, first: &[#(#first),*], second: &[#(#second),*], displacement: #displacement, search: #search })
    });
    let entries: Vec<TokenStream> = entries.collect();
    quote!(&[#(#entries),*])
}

/// `Sides::Both`.
pub fn sides(sides: Sides) -> TokenStream {
    match sides {
        Sides::First => quote!(Sides::First),
        Sides::Second => quote!(Sides::Second),
        Sides::Both => quote!(Sides::Both),
    }
}

/// The entries of `Program::pair_integrals`.
pub fn energies(forms: &mut Forms<'_>, slots: &Slots, sources: &SourceMap) -> TokenStream {
    let energies = forms.gap_energies.clone();
    let entries: Vec<TokenStream> =
        energies.iter().map(|energy| one_energy(&mut forms.lowering, slots, sources, energy)).collect();
    quote!(&[#(#entries),*])
}

fn one_energy(
    lowering: &mut Lowering<'_>,
    slots: &Slots,
    sources: &SourceMap,
    energy: &GapEnergy,
) -> TokenStream {
    let head = head(sources, &energy.contact);
    let body = body(lowering, slots, Sources::default(), &energy.law);
    let [gap, _, x, g] = arguments(lowering, &energy.law, &body);
    let (statements, results) = (&body.statements, &body.results);
    quote!(PairIntegral { #head law: |#gap, #x, #g| { #(#statements)* [#(#results),*] } })
}

/// The entries of `Program::pair_loads`.
pub fn loads(forms: &mut Forms<'_>, slots: &Slots, sources: &SourceMap) -> TokenStream {
    let loads = forms.pair_loads.clone();
    let entries: Vec<TokenStream> =
        loads.iter().map(|load| one_load(&mut forms.lowering, slots, sources, load)).collect();
    quote!(&[#(#entries),*])
}

fn one_load(lowering: &mut Lowering<'_>, slots: &Slots, sources: &SourceMap, load: &PairLoad) -> TokenStream {
    let (head, current) = (head(sources, &load.contact), load.current);
    let law = [load.flux, load.by_gap, load.by_normal[0], load.by_normal[1]].concat();
    let law = vectors(lowering, slots, &law, &TokenStream::new());
    let global_tangent = if load.globals.is_empty() {
        quote!(None)
    } else {
        let unknowns = load.globals.iter().map(|(kind, _)| Literal::usize_unsuffixed(slots.unknown(*kind)));
        let unknowns: Vec<Literal> = unknowns.collect();
        let columns: Vec<Id> = load.globals.iter().flat_map(|(_, by)| *by).collect();
        let reads_alpha = reads(lowering, &columns, |kind| kind == SymbolKind::Alpha);
        let alpha = if reads_alpha { quote!(alpha,) } else { quote!(_,) };
        let law = vectors(lowering, slots, &columns, &alpha);
        quote!(Some(PairGlobalTangent { slots: &[#(#unknowns),*], law: #law }))
    };
    quote!(PairLoad { #head current: #current, law: #law, global_tangent: #global_tangent })
}

/// `|gap, normal, x, g, (alpha,) out| ..`, which writes vectors one after another.
fn vectors(lowering: &mut Lowering<'_>, slots: &Slots, roots: &[Id], alpha: &TokenStream) -> TokenStream {
    let body = body(lowering, slots, Sources::default(), roots);
    let [gap, normal, x, g] = arguments(lowering, roots, &body);
    let statements = &body.statements;
    let vectors = body.results.chunks(2).enumerate().map(|(k, vector)| {
        let k = Literal::usize_unsuffixed(k);
        quote!(out[#k] = [#(#vector),*];)
    });
    quote!(|#gap, #normal, #x, #g, #alpha out| { #(#statements)* #(#vectors)* })
}

/// `|gap, normal, x, g| value` of a scalar at the points of a pair.
pub fn value(lowering: &mut Lowering<'_>, slots: &Slots, root: Id) -> TokenStream {
    let body = body(lowering, slots, Sources::default(), &[root]);
    let [gap, normal, x, g] = arguments(lowering, &[root], &body);
    let value = block(&body);
    quote!(|#gap, #normal, #x, #g| #value)
}

/// `name`, `place`, `block`, `pair` and `sides`.
fn head(sources: &SourceMap, contact: &Contact) -> TokenStream {
    let (name, place, sides) = (&contact.name, place(sources, contact.span), sides(contact.sides));
    let [block, pair] = [contact.block.0, contact.pair.0].map(Literal::usize_unsuffixed);
    quote!(name: #name, place: #place, block: #block, pair: #pair, sides: #sides,)
}

/// `gap`, `normal`, `x` and `g`, or `_` for what is not read.
fn arguments(lowering: &Lowering<'_>, roots: &[Id], body: &Body) -> [TokenStream; 4] {
    let name = |read: bool, name: TokenStream| if read { name } else { quote!(_) };
    [
        name(reads(lowering, roots, |kind| matches!(kind, SymbolKind::Gap(_))), quote!(gap)),
        name(reads(lowering, roots, |kind| matches!(kind, SymbolKind::PairNormal(..))), quote!(normal)),
        name(reads(lowering, roots, |kind| matches!(kind, SymbolKind::Coordinate(_))), quote!(x)),
        name(body.reads_globals, quote!(g)),
    ]
}
