//! Tests that read a finished run.

use super::body::{Sources, body, closure};
use super::expression::number;
use super::layout::Slots;
use super::place;
use crate::form::{Expectation, Forms, RunTest};
use crate::lower::{Condition, Lowering, RunValue, SymbolKind};
use crate::model::{Reduction, Relation};
use crate::scalar::Id;
use crate::source::SourceMap;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// The entries of `Program::tests`.
pub fn tests(forms: &mut Forms<'_>, slots: &Slots, sources: &SourceMap) -> TokenStream {
    let tests = forms.tests.clone();
    let entries: Vec<TokenStream> =
        tests.iter().map(|test| one_test(&mut forms.lowering, slots, sources, test)).collect();
    quote!(&[#(#entries),*])
}

/// `fn run_values(record, g)`, if tests read any.
pub fn run_values(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let lowering = &mut forms.lowering;
    if lowering.run_values.is_empty() {
        return TokenStream::new();
    }
    let values = lowering.run_values.clone();
    let values: Vec<TokenStream> = values.iter().map(|value| run_value(lowering, slots, value)).collect();
    let count = Literal::usize_unsuffixed(values.len());
    quote! {
        /// Numbers of the run that the tests read.
        fn run_values(record: &dyn Record, g: &[f64]) -> [f64; #count] {
            let _ = g;
            [#(#values),*]
        }
    }
}

fn run_value(lowering: &mut Lowering<'_>, slots: &Slots, value: &RunValue) -> TokenStream {
    let model = lowering.model;
    match value {
        RunValue::Extreme(reduction, of, range) => {
            let of = closure(lowering, slots, *of);
            let times = range.map(|range| {
                let body = body(lowering, slots, Sources::default(), &range);
                let (statements, from, to) = (&body.statements, &body.results[0], &body.results[1]);
                let time = Literal::usize_unsuffixed(slots.slot(SymbolKind::Time));
                quote!(let (from, to) = { #(#statements)* (#from, #to) }; let inside = |g: &&Vec<f64>| (from..=to).contains(&g[#time]);)
            });
            let filter = times.as_ref().map(|_| quote!(.filter(inside)));
            let (fold, start) = match reduction {
                Reduction::Min => (quote!(f64::min), number(f64::INFINITY)),
                _ => (quote!(f64::max), number(f64::NEG_INFINITY)),
            };
            quote!({ let value: fn(&[f64]) -> f64 = #of; #times record.steps().iter() #filter .map(|g| value(g)).fold(#start, #fold) })
        }
        RunValue::AtTime(of, time) => {
            let (of, body) =
                (closure(lowering, slots, *of), body(lowering, slots, Sources::default(), &[*time]));
            let time = super::body::block(&body);
            quote!({ let value: fn(&[f64]) -> f64 = #of; value(&record.at(#time)) })
        }
        RunValue::AtEvent(of, event) => {
            let (of, name) = (closure(lowering, slots, *of), &model.events[event.0].name);
            quote!({ let value: fn(&[f64]) -> f64 = #of; record.event_time(#name).map_or(f64::NAN, |t| value(&record.at(t))) })
        }
        RunValue::Fired(event) => {
            let name = &model.events[event.0].name;
            quote!(f64::from(u8::from(record.event_time(#name).is_some())))
        }
    }
}

fn one_test(lowering: &mut Lowering<'_>, slots: &Slots, sources: &SourceMap, test: &RunTest) -> TokenStream {
    let title = &test.title;
    let reads_run = !lowering.run_values.is_empty();
    let run = reads_run.then(|| quote!(let run = run_values(record, g);));
    let expectations = test.expectations.iter().map(|(span, expectation)| {
        let (text, place) = (sources.slice(*span).trim(), place(sources, *span));
        let (numbers, holds) = expectation_code(lowering, slots, expectation);
        quote!({ let (numbers, holds) = { #numbers #holds }; Expectation { text: #text, place: #place, numbers, holds } })
    });
    let expectations: Vec<TokenStream> = expectations.collect();
    quote!(Test {
        title: #title,
        evaluate: |record| {
            let Some(g) = record.steps().last() else { return Vec::new() };
            #run
            Vec::from([#(#expectations),*])
        },
    })
}

/// Statements, and `(numbers, holds)`.
fn expectation_code(
    lowering: &mut Lowering<'_>,
    slots: &Slots,
    expectation: &Expectation,
) -> (TokenStream, TokenStream) {
    let roots = expectation.roots();
    let body = body(lowering, slots, Sources::default(), &roots);
    let (statements, results) = (&body.statements, &body.results);
    let code = quote!(#(#statements)*);
    match expectation {
        Expectation::Holds(condition) => {
            let holds = truth(condition, &roots, results);
            (code, quote!((None, #holds)))
        }
        Expectation::Near { percent, .. } => {
            let (value, expected, tolerance) = (&results[0], &results[1], &results[2]);
            let scale = percent.then(|| quote!(*0.01 * expected.abs()));
            let code = quote!(#code let (value, expected): (f64, f64) = (#value, #expected); let tolerance = #tolerance #scale;);
            (code, quote!((Some([value, expected, tolerance]), (value - expected).abs() <= tolerance)))
        }
    }
}

fn truth(condition: &Condition, roots: &[Id], results: &[TokenStream]) -> TokenStream {
    let of =
        |id: &Id| roots.iter().position(|root| root == id).map(|k| results[k].clone()).unwrap_or_default();
    match condition {
        Condition::Constant(truth) => quote!(#truth),
        Condition::Compare(relation, a, b) => {
            let (a, b) = (of(a), of(b));
            let sign = match relation {
                Relation::Less => quote!(<),
                Relation::LessEqual => quote!(<=),
                Relation::Greater => quote!(>),
                Relation::GreaterEqual => quote!(>=),
                Relation::Equal => quote!(==),
            };
            quote!((#a) #sign (#b))
        }
        Condition::And(a, b) => {
            let (a, b) = (truth(a, roots, results), truth(b, roots, results));
            quote!((#a && #b))
        }
        Condition::Or(a, b) => {
            let (a, b) = (truth(a, roots, results), truth(b, roots, results));
            quote!((#a || #b))
        }
        Condition::Not(a) => {
            let a = truth(a, roots, results);
            quote!(!(#a))
        }
    }
}
