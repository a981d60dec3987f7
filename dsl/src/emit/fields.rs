//! Fields, holds and functions at points.

use super::body::{Sources, assignments, block, body};
use super::layout::Slots;
use super::place;
use crate::form::{Forms, Hold, PointForm};
use crate::lower::{Lowering, Region, SymbolKind, names_for, region_names};
use crate::model::{FieldId, Model, Shape, Space};
use crate::scalar::{Id, symbols_of};
use crate::source::SourceMap;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// `Domain::Cells(..)` or `Domain::Edges(..)` for these fields.
pub fn domain(model: &Model, region: &Region, fields: impl IntoIterator<Item = FieldId>) -> TokenStream {
    let names = names_for(model, region, fields.into_iter());
    match region {
        Region::Cells(_) => quote!(Domain::Cells(&[#(#names),*])),
        Region::Edges(_) => quote!(Domain::Edges(&[#(#names),*])),
        Region::Ends(_) => quote!(Domain::Ends(&[#(#names),*])),
    }
}

/// The entries of `Program::fields`.
pub fn fields(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let (model, starts) = (forms.lowering.model, forms.starts.clone());
    let with_rates = forms.differential_fields();
    let entries = model.fields.iter().zip(&starts).enumerate().map(|(k, (field, start))| {
        let differential = with_rates.contains(&FieldId(k));
        let (name, unit) = (&field.name, model.units.unit_of(field.dimension));
        let names: Vec<&str> = match field.shape {
            Shape::Scalar => vec![""],
            _ => model.coordinates.names.iter().map(String::as_str).collect(),
        };
        let components = Literal::usize_unsuffixed(names.len());
        let space = if field.space == Space::P1 { quote!(Space::P1) } else { quote!(Space::P2) };
        let parts = Region::parts(&field.domain).into_iter().map(|part| domain(model, &part, []));
        let parts: Vec<TokenStream> = parts.collect();
        let start = at_point(&mut forms.lowering, slots, start, true);
        quote!(Field {
            name: #name,
            components: #components,
            component_names: &[#(#names),*],
            space: #space,
            domains: &[#(#parts),*],
            unit: #unit,
            differential: #differential,
            start: #start,
        })
    });
    let entries: Vec<TokenStream> = entries.collect();
    quote!(&[#(#entries),*])
}

/// `|x, g, out| ..` or `|x, g| value`.
fn at_point(lowering: &mut Lowering<'_>, slots: &Slots, roots: &[Id], writes: bool) -> TokenStream {
    let reads_point = reads(lowering, roots, |kind| matches!(kind, SymbolKind::Coordinate(_)));
    let body = body(lowering, slots, Sources::default(), roots);
    let x = if reads_point { quote!(x) } else { quote!(_) };
    let g = if body.reads_globals { quote!(g) } else { quote!(_) };
    if writes {
        let code = assignments(&body);
        quote!(|#x, #g, out| { #code })
    } else {
        let value = block(&body);
        quote!(|#x, #g| #value)
    }
}

/// Whether the roots read a symbol of a kind.
pub fn reads(lowering: &Lowering<'_>, roots: &[Id], wanted: impl Fn(SymbolKind) -> bool) -> bool {
    symbols_of(&lowering.pool, roots).into_iter().any(|symbol| wanted(lowering.symbols.kind(symbol)))
}

/// The entries of `Program::holds`.
pub fn holds(forms: &mut Forms<'_>, slots: &Slots, sources: &SourceMap) -> TokenStream {
    let (model, holds) = (forms.lowering.model, forms.holds.clone());
    let entries: Vec<TokenStream> =
        holds.iter().map(|hold| one_hold(&mut forms.lowering, slots, sources, model, hold)).collect();
    quote!(&[#(#entries),*])
}

fn one_hold(
    lowering: &mut Lowering<'_>,
    slots: &Slots,
    sources: &SourceMap,
    model: &Model,
    hold: &Hold,
) -> TokenStream {
    let [field, component] = [hold.field.0, hold.component].map(Literal::usize_unsuffixed);
    let (domain, place) = (domain(model, &hold.region, [hold.field]), place(sources, hold.span));
    let value = at_point(lowering, slots, &[hold.value], false);
    quote!(Hold { field: #field, component: #component, domain: #domain, place: #place, value: #value })
}

/// The entries of `Program::ties`.
pub fn ties(forms: &Forms<'_>, sources: &SourceMap) -> TokenStream {
    let entries = forms.ties.iter().map(|on| {
        let [field, partner] = [on.tie.field, on.tie.partner].map(|f| Literal::usize_unsuffixed(f.0));
        let (rate, place) = (on.tie.rate, place(sources, on.span));
        let domain = domain(forms.lowering.model, &on.region, [on.tie.field]);
        quote!(Tie { field: #field, partner: #partner, rate: #rate, domain: #domain, place: #place })
    });
    quote!(&[#(#entries),*])
}

/// The entries of `Program::moving`.
pub fn moving(model: &Model) -> TokenStream {
    let entries = model.moving.iter().map(|moving| {
        let region = &model.geometry.regions[moving.region.0].name;
        let displacement = Literal::usize_unsuffixed(moving.by.0);
        quote!(Moving { region: #region, displacement: #displacement })
    });
    quote!(&[#(#entries),*])
}

/// Both components of the normal that the roots read, which stand behind the other inputs.
fn normals(lowering: &Lowering<'_>, roots: &[Id]) -> Vec<SymbolKind> {
    let kinds = symbols_of(&lowering.pool, roots).into_iter().map(|symbol| lowering.symbols.kind(symbol));
    let mut sides =
        kinds.filter_map(|kind| if let SymbolKind::Normal(side, _) = kind { Some(side) } else { None });
    let side = sides.next();
    side.into_iter().flat_map(|side| [0, 1].map(|axis| SymbolKind::Normal(side, axis))).collect()
}

/// What every function at a point finds behind its other inputs.
const SHAPE_OF_PATH: [SymbolKind; 4] =
    [SymbolKind::Tangent(0), SymbolKind::Tangent(1), SymbolKind::Curvature(0), SymbolKind::Curvature(1)];

/// `PointFunction { .. }`.
pub fn point_function(lowering: &mut Lowering<'_>, slots: &Slots, form: &PointForm) -> TokenStream {
    let model = lowering.model;
    let mut kinds: Vec<SymbolKind> = form.inputs.iter().map(|input| input.kind()).collect();
    let inputs = form.inputs.iter().map(|one| {
        let [field, component] = [one.input.field.0, one.input.component].map(Literal::usize_unsuffixed);
        let derivative = match one.input.derivative {
            None => quote!(None),
            Some(crate::lower::Derivative::Along) => quote!(Some(Derivative::Along)),
            Some(crate::lower::Derivative::Coordinate(direction)) => {
                let direction = Literal::usize_unsuffixed(direction);
                quote!(Some(Derivative::Direction(#direction)))
            }
        };
        let rate = one.rate;
        quote!(PointInput { field: #field, component: #component, derivative: #derivative, rate: #rate })
    });
    let all: Vec<Id> = form.outputs.concat();
    kinds.extend(normals(lowering, &all));
    kinds.extend(SHAPE_OF_PATH);
    let reads_point = reads(lowering, &all, |kind| matches!(kind, SymbolKind::Coordinate(_)));
    let reads_table = reads(lowering, &all, |kind| matches!(kind, SymbolKind::Table(_)));
    let regions = match &form.region {
        Region::Cells(_) => region_names(model, &form.region),
        Region::Edges(_) | Region::Ends(_) => Vec::new(),
    };
    let region = quote!(region);
    let sources = Sources { inputs: &kinds, region: Some(&region) };
    let bodies: Vec<_> = form.outputs.iter().map(|outputs| body(lowering, slots, sources, outputs)).collect();
    let reads_globals = bodies.iter().any(|body| body.reads_globals);
    let chooses = bodies.len() > 1 || reads_table;
    let outputs = Literal::usize_unsuffixed(form.outputs.first().map_or(0, Vec::len));
    let code = match bodies.as_slice() {
        [one] => assignments(one),
        many => {
            let arms = many.iter().enumerate().map(|(k, body)| {
                let (k, code) = (Literal::usize_unsuffixed(k), assignments(body));
                let pattern =
                    if k.to_string() == (many.len() - 1).to_string() { quote!(_) } else { quote!(#k) };
                quote!(#pattern => { #code })
            });
            quote!(match region { #(#arms)* })
        }
    };
    let name = |used: bool, name: TokenStream| if used { name } else { quote!(_) };
    let (region, x) = (name(chooses, quote!(region)), name(reads_point, quote!(x)));
    let (values, g) = (
        name(reads(lowering, &all, |kind| kinds.contains(&kind)), quote!(inputs)),
        name(reads_globals, quote!(g)),
    );
    quote!(PointFunction {
        inputs: &[#(#inputs),*],
        outputs: #outputs,
        regions: &[#(#regions),*],
        evaluate: |#region, #x, #values, #g, out| { #code },
    })
}
