//! Bodies of plain functions: inputs read from their places, statements, results.

use super::expression::{Dialect, Names, Printer};
use super::layout::Slots;
use crate::lower::{Lowering, SymbolKind};
use crate::scalar::schedule::Schedule;
use crate::scalar::{Id, lower_powers, symbols_of};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// Where a function finds what is not in the globals.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sources<'a> {
    /// Field inputs, in the order of `inputs`.
    pub inputs: &'a [SymbolKind],
    /// Code of the position in a table, where the region is known.
    pub region: Option<&'a TokenStream>,
}

/// Statements that compute the roots, and a formula for each.
#[derive(Debug)]
pub struct Body {
    /// `let` statements.
    pub statements: Vec<TokenStream>,
    /// The roots.
    pub results: Vec<TokenStream>,
    /// Whether the globals are read.
    pub reads_globals: bool,
}

/// Prints roots as a function body over `g`, and `x`, `inputs`, `gap`, `normal`, `alpha`, `switches` where the symbols ask for them.
pub fn body(lowering: &mut Lowering<'_>, slots: &Slots, sources: Sources<'_>, roots: &[Id]) -> Body {
    let roots = lower_powers(&mut lowering.pool, roots);
    let schedule = Schedule::new(&lowering.pool, &roots, &|_| 0);
    let mut names =
        Names::new(&["g", "x", "inputs", "gap", "normal", "alpha", "switches", "out", "region", "record"]);
    let mut statements = Vec::new();
    let mut reads_globals = false;
    let mut kinds: Vec<SymbolKind> =
        symbols_of(&lowering.pool, &roots).into_iter().map(|symbol| lowering.symbols.kind(symbol)).collect();
    kinds.sort_unstable();
    for kind in kinds {
        match source(slots, sources, kind) {
            Source::InScope(name) => names.set_symbol(kind, super::ident(name)),
            Source::Read(code) => {
                let name = names.symbol(lowering, kind);
                statements.push(quote!(let #name = #code;));
            }
            Source::Global(code) => {
                reads_globals = true;
                let name = names.symbol(lowering, kind);
                statements.push(quote!(let #name = #code;));
            }
            Source::Switch => {}
        }
    }
    let printer = Printer { lowering, schedule: &schedule, dialect: Dialect::Plain };
    statements.extend(printer.statements(0, &mut names));
    let results = roots.iter().map(|&root| printer.value(root, &names)).collect();
    Body { statements, results, reads_globals }
}

enum Source {
    /// A variable of the function.
    InScope(&'static str),
    /// Read from an argument.
    Read(TokenStream),
    /// Read from the globals.
    Global(TokenStream),
    /// Printed where it is compared.
    Switch,
}

fn source(slots: &Slots, sources: Sources<'_>, kind: SymbolKind) -> Source {
    match kind {
        SymbolKind::Gap(_) => Source::InScope("gap"),
        SymbolKind::Alpha => Source::InScope("alpha"),
        SymbolKind::Switch(_) => Source::Switch,
        SymbolKind::PairNormal(_, axis) => {
            let axis = Literal::usize_unsuffixed(axis);
            Source::Read(quote!(normal[#axis]))
        }
        SymbolKind::Coordinate(axis) => {
            let axis = Literal::usize_unsuffixed(axis);
            Source::Read(quote!(x[#axis]))
        }
        SymbolKind::Run(number) => {
            let number = Literal::usize_unsuffixed(number);
            Source::Read(quote!(run[#number]))
        }
        SymbolKind::Field(_)
        | SymbolKind::FieldRate(_)
        | SymbolKind::Normal(..)
        | SymbolKind::Tangent(_)
        | SymbolKind::Curvature(_) => {
            let position = sources.inputs.iter().position(|input| *input == kind).unwrap_or(0);
            let position = Literal::usize_unsuffixed(position);
            Source::Read(quote!(inputs[#position]))
        }
        SymbolKind::Table(table) => {
            let first = Literal::usize_unsuffixed(slots.table(table));
            let region = sources.region.cloned().unwrap_or_else(|| quote!(0));
            Source::Global(quote!(g[#first + #region]))
        }
        _ => {
            let slot = Literal::usize_unsuffixed(slots.slot(kind));
            Source::Global(quote!(g[#slot]))
        }
    }
}

/// `|g| value`, or `|_| value` where nothing is read.
pub fn closure(lowering: &mut Lowering<'_>, slots: &Slots, root: Id) -> TokenStream {
    let body = body(lowering, slots, Sources::default(), &[root]);
    let argument = if body.reads_globals { quote!(g) } else { quote!(_) };
    let value = block(&body);
    quote!(|#argument| #value)
}

/// The single result, in braces with the statements before it if there are any.
pub fn block(body: &Body) -> TokenStream {
    let (statements, result) = (&body.statements, &body.results[0]);
    if statements.is_empty() { quote!(#result) } else { quote!({ #(#statements)* #result }) }
}

/// `out[0] = ..; out[1] = ..;` after the statements.
pub fn assignments(body: &Body) -> TokenStream {
    let (statements, results) = (&body.statements, &body.results);
    let positions = (0..results.len()).map(Literal::usize_unsuffixed);
    quote!(#(#statements)* #(out[#positions] = #results;)*)
}

/// `|g| shape(values)`, or `|_| ..` where nothing is read.
pub fn list(
    lowering: &mut Lowering<'_>,
    slots: &Slots,
    roots: &[Id],
    shape: &dyn Fn(&[TokenStream]) -> TokenStream,
) -> TokenStream {
    let body = body(lowering, slots, Sources::default(), roots);
    let (statements, value) = (&body.statements, shape(&body.results));
    let argument = if body.reads_globals { quote!(g) } else { quote!(_) };
    if statements.is_empty() {
        quote!(|#argument| #value)
    } else {
        quote!(|#argument| { #(#statements)* #value })
    }
}
