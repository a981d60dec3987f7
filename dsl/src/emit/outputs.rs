//! Functionals, observables, events, tables and frames.

use super::body::{closure, list};
use super::expression::number;
use super::fields::{domain, point_function};
use super::integral::Emitted;
use super::layout::Slots;
use super::pairs;
use super::program::Plan;
use crate::form::{Action, Event, Forms, Frames, FunctionalKind, PointForm, Table, Trigger, When};
use crate::kernel::Kernels;
use crate::lower::{Lowering, QuantityKind, Region, SymbolKind, names_for, region_names};
use crate::model::{FieldId, Reduction};
use crate::scalar::{Id, symbols_of};
use crate::source::SourceMap;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// The entries of `Program::functionals`.
pub fn functionals(
    forms: &mut Forms<'_>,
    plan: &Plan,
    emitted: &mut Emitted,
    slots: &Slots,
    sources: &SourceMap,
) -> TokenStream {
    let functionals = forms.functionals.clone();
    let entries = functionals.iter().zip(&plan.functionals).map(|(functional, kernels)| {
        let quantity = &forms.lowering.quantities[functional.quantity];
        let (name, unit) = (quantity.name.clone(), forms.lowering.model.units.unit_of(quantity.dimension));
        let kind = match &functional.kind {
            FunctionalKind::Integral(terms) => {
                let integrals = terms
                    .iter()
                    .zip(kernels)
                    .map(|(term, kernels)| emitted.integral(&forms.lowering, slots, sources, term, kernels));
                let integrals: Vec<TokenStream> = integrals.collect();
                quote!(FunctionalKind::Integral(&[#(#integrals),*]))
            }
            FunctionalKind::Point(at, form) => {
                let at = list(&mut forms.lowering, slots, at, &|values| quote!([#(#values),*]));
                let function = point_function(&mut forms.lowering, slots, form);
                let fields = form.inputs.iter().map(|one| one.input.field);
                let domain = domain(forms.lowering.model, &form.region, fields);
                quote!(FunctionalKind::Point { at: #at, domain: #domain, function: #function })
            }
        };
        quote!(Functional { name: #name, unit: #unit, kind: #kind })
    });
    let entries: Vec<TokenStream> = entries.collect();
    quote!(&[#(#entries),*])
}

/// The entries of `Program::observables`.
pub fn observables(
    forms: &mut Forms<'_>,
    plan: &Plan,
    emitted: &mut Emitted,
    slots: &Slots,
    sources: &SourceMap,
) -> TokenStream {
    let quantities = forms.observables.clone();
    let entries = quantities.iter().zip(&plan.observables).map(|(&quantity, parts)| {
        let quantity = forms.lowering.quantities[quantity].clone();
        let (name, unit) = (&quantity.name, forms.lowering.model.units.unit_of(quantity.dimension));
        let integrals: Vec<TokenStream> = parts
            .iter()
            .map(|(term, kernels): &(_, Kernels)| {
                emitted.integral(&forms.lowering, slots, sources, term, kernels)
            })
            .collect();
        let kind = observable(&mut forms.lowering, slots, &quantity.kind, &integrals);
        quote!(Observable { name: #name, unit: #unit, kind: #kind })
    });
    let entries: Vec<TokenStream> = entries.collect();
    quote!(&[#(#entries),*])
}

fn observable(
    lowering: &mut Lowering<'_>,
    slots: &Slots,
    kind: &QuantityKind,
    integrals: &[TokenStream],
) -> TokenStream {
    let model = lowering.model;
    match kind {
        QuantityKind::Integral(_) => quote!(ObservableKind::Integral(&[#(#integrals),*])),
        QuantityKind::Extreme(reduction, region, values) => {
            let function = values_at_points(lowering, slots, region, values);
            let domain = domain(model, region, fields_of(lowering, values));
            match reduction {
                Reduction::Min => quote!(ObservableKind::Min(#domain, #function)),
                _ => quote!(ObservableKind::Max(#domain, #function)),
            }
        }
        QuantityKind::Side(pieces, regions, value) => {
            let edges = Region::Edges(pieces.clone());
            let paths = names_for(model, &edges, fields_of(lowering, &[*value]).into_iter());
            let regions = region_names(model, &Region::Cells(regions.clone()));
            let function = values_at_points(lowering, slots, &edges, &[*value]);
            quote!(ObservableKind::Side { paths: &[#(#paths),*], regions: &[#(#regions),*], function: #function })
        }
        QuantityKind::Point(at, region, values) => {
            let at = list(lowering, slots, at, &|values| quote!([#(#values),*]));
            let function = values_at_points(lowering, slots, region, values);
            let domain = domain(model, region, fields_of(lowering, values));
            quote!(ObservableKind::Point(#at, #domain, #function))
        }
        QuantityKind::PairExtreme(reduction, pair, sides, value) => {
            let (pair, sides) = (Literal::usize_unsuffixed(pair.0), pairs::sides(*sides));
            let function = pairs::value(lowering, slots, *value);
            match reduction {
                Reduction::Min => quote!(ObservableKind::PairMin(#pair, #sides, #function)),
                _ => quote!(ObservableKind::PairMax(#pair, #sides, #function)),
            }
        }
        QuantityKind::PairIntegral(pair, sides, current, value) => {
            let (pair, sides) = (Literal::usize_unsuffixed(pair.0), pairs::sides(*sides));
            let function = pairs::value(lowering, slots, *value);
            quote!(ObservableKind::PairIntegral { pair: #pair, sides: #sides, current: #current, function: #function })
        }
        QuantityKind::Force(block, pieces, field, component) => {
            let domain = domain(model, &Region::Edges(pieces.clone()), [*field]);
            let [block, field, component] = [block.0, field.0, *component].map(Literal::usize_unsuffixed);
            quote!(ObservableKind::Force { block: #block, domain: #domain, field: #field, component: #component })
        }
    }
}

/// The fields that scalars read.
fn fields_of(lowering: &Lowering<'_>, roots: &[Id]) -> Vec<FieldId> {
    let symbols = symbols_of(&lowering.pool, roots).into_iter();
    let field = |symbol| match lowering.symbols.kind(symbol) {
        SymbolKind::Field(input) | SymbolKind::FieldRate(input) => Some(input.field),
        _ => None,
    };
    symbols.filter_map(field).collect()
}

fn values_at_points(
    lowering: &mut Lowering<'_>,
    slots: &Slots,
    region: &Region,
    values: &[Id],
) -> TokenStream {
    let form = PointForm::of_values(lowering, region, values);
    point_function(lowering, slots, &form)
}

/// The entries of `Program::events`.
pub fn events(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let events = forms.events.clone();
    let entries: Vec<TokenStream> =
        events.iter().map(|event| one_event(&mut forms.lowering, slots, event)).collect();
    quote!(&[#(#entries),*])
}

fn one_event(lowering: &mut Lowering<'_>, slots: &Slots, event: &Event) -> TokenStream {
    let (name, doc) = (&event.name, &event.doc);
    let trigger = match &event.trigger {
        Trigger::When { condition, duration, also } => {
            let [condition, duration, also] =
                [condition, duration, also].map(|&root| closure(lowering, slots, root));
            quote!(Trigger::When { condition: #condition, duration: #duration, also: #also })
        }
        Trigger::Every(When::Step) => quote!(Trigger::EveryStep),
        Trigger::Every(When::Time(time)) => {
            let time = closure(lowering, slots, *time);
            quote!(Trigger::Every(#time))
        }
    };
    let actions = event.actions.iter().map(|action| match action {
        Action::Stop => quote!(Action::Stop),
        Action::Warn(text) => quote!(Action::Warn(#text)),
        Action::Remesh => quote!(Action::Remesh),
        Action::Set(state, value) => {
            let (state, value) = (Literal::usize_unsuffixed(state.0), closure(lowering, slots, *value));
            quote!(Action::Set(#state, #value))
        }
    });
    let actions: Vec<TokenStream> = actions.collect();
    quote!(Event { name: #name, doc: #doc, trigger: #trigger, actions: &[#(#actions),*] })
}

fn every(lowering: &mut Lowering<'_>, slots: &Slots, when: &When) -> TokenStream {
    match when {
        When::Step => quote!(Every::Step),
        When::Time(time) => {
            let time = closure(lowering, slots, *time);
            quote!(Every::Time(#time))
        }
    }
}

/// The entries of `Program::tables`.
pub fn tables(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let tables = forms.tables.clone();
    let entries: Vec<TokenStream> =
        tables.iter().map(|table| one_table(&mut forms.lowering, slots, table)).collect();
    quote!(&[#(#entries),*])
}

fn one_table(lowering: &mut Lowering<'_>, slots: &Slots, table: &Table) -> TokenStream {
    let (file, every) = (&table.file, every(lowering, slots, &table.every));
    let columns = table.columns.iter().map(|column| {
        let (name, (value, unit)) = (&column.name, &column.unit);
        let (unit_value, value) = (number(*value), closure(lowering, slots, column.value));
        quote!(Column { name: #name, unit: #unit, unit_value: #unit_value, value: #value })
    });
    let columns: Vec<TokenStream> = columns.collect();
    quote!(Table { file: #file, every: #every, columns: &[#(#columns),*] })
}

/// The entries of `Program::frames`.
pub fn frames(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let frames = forms.frames.clone();
    let entries: Vec<TokenStream> =
        frames.iter().map(|frames| one_frames(&mut forms.lowering, slots, frames)).collect();
    quote!(&[#(#entries),*])
}

fn one_frames(lowering: &mut Lowering<'_>, slots: &Slots, frames: &Frames) -> TokenStream {
    let fields = frames.function.inputs.iter().map(|one| one.input.field);
    let domain = domain(lowering.model, &frames.region, fields);
    let every = every(lowering, slots, &frames.every);
    let columns = frames.columns.iter().map(|column| {
        let (name, (value, unit)) = (&column.name, &column.unit);
        let (unit_value, [components, offset]) = (number(*value), [column.components, column.offset].map(Literal::usize_unsuffixed));
        quote!(FrameColumn { name: #name, unit: #unit, unit_value: #unit_value, components: #components, offset: #offset })
    });
    let columns: Vec<TokenStream> = columns.collect();
    let function = point_function(lowering, slots, &frames.function);
    quote!(Frames { domain: #domain, every: #every, columns: &[#(#columns),*], function: #function })
}
