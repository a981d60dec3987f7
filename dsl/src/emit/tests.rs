//! Tests that read a finished run.

use super::body::{Sources, block, body, closure};
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

/// Functions that the tests share, if there are any: their verdicts, and the numbers of the run that they read.
pub fn helpers(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let expectations =
        || forms.tests.iter().flat_map(|test| &test.expectations).map(|(_, expectation)| expectation);
    let holds = expectations().any(|one| matches!(one, Expectation::Holds(_))).then(|| {
        quote! {
            /// Verdict on a condition.
            fn holds(text: &'static str, place: &'static str, holds: bool) -> Expectation {
                Expectation { text, place, numbers: None, unit: "1", holds }
            }
        }
    });
    let near = expectations().any(|one| matches!(one, Expectation::Near { .. })).then(|| {
        quote! {
            /// Verdict on a value, the value expected and the tolerance.
            fn near(text: &'static str, place: &'static str, unit: &'static str, numbers: [f64; 3]) -> Expectation {
                let [value, expected, tolerance] = numbers;
                let holds = (value - expected).abs() <= tolerance;
                Expectation { text, place, numbers: Some(numbers), unit, holds }
            }
        }
    });
    let run_values = run_values(&mut forms.lowering, slots);
    quote!(#holds #near #run_values)
}

fn run_values(lowering: &mut Lowering<'_>, slots: &Slots) -> TokenStream {
    if lowering.run_values.is_empty() {
        return TokenStream::new();
    }
    let values = lowering.run_values.clone();
    let (values, reads): (Vec<TokenStream>, Vec<bool>) =
        values.iter().map(|value| run_value(lowering, slots, value)).unzip();
    let count = Literal::usize_unsuffixed(values.len());
    let g = if reads.contains(&true) { quote!(g) } else { quote!(_) };
    quote! {
        /// Numbers of the run that the tests read.
        fn run_values(record: &dyn Record, #g: &[f64]) -> [f64; #count] {
            [#(#values),*]
        }
    }
}

/// The code of a number, and whether it reads the globals `g`.
fn run_value(lowering: &mut Lowering<'_>, slots: &Slots, value: &RunValue) -> (TokenStream, bool) {
    let model = lowering.model;
    let function = |of: TokenStream| quote!(let value: fn(&[f64]) -> f64 = #of;);
    match value {
        RunValue::Extreme(reduction, of, range) => {
            let value = function(closure(lowering, slots, *of));
            let range = range.map(|range| body(lowering, slots, Sources::default(), &range));
            let reads = range.as_ref().is_some_and(|range| range.reads_globals);
            let inside = range.map(|body| {
                let (statements, from, to) = (&body.statements, &body.results[0], &body.results[1]);
                let time = Literal::usize_unsuffixed(slots.slot(SymbolKind::Time));
                (
                    quote!(#(#statements)* let range = #from..=#to;),
                    quote!(.filter(|g| range.contains(&g[#time]))),
                )
            });
            let (range, filter) = inside.unzip();
            let (fold, start) = match reduction {
                Reduction::Min => (quote!(f64::min), number(f64::INFINITY)),
                _ => (quote!(f64::max), number(f64::NEG_INFINITY)),
            };
            (
                quote!({ #value #range record.steps().iter() #filter .map(|g| value(g)).fold(#start, #fold) }),
                reads,
            )
        }
        RunValue::AtTime(of, time) => {
            let value = function(closure(lowering, slots, *of));
            let body = body(lowering, slots, Sources::default(), &[*time]);
            let time = block(&body);
            (quote!({ #value value(&record.at(#time)) }), body.reads_globals)
        }
        RunValue::AtEvent(of, event) => {
            let (value, name) = (function(closure(lowering, slots, *of)), &model.events[event.0].name);
            (quote!({ #value record.event_time(#name).map_or(f64::NAN, |t| value(&record.at(t))) }), false)
        }
        RunValue::Outcome(event) => {
            let name = &model.events[event.0].name;
            (quote!(f64::from(u8::from(record.outcome() == #name))), false)
        }
    }
}

fn one_test(lowering: &mut Lowering<'_>, slots: &Slots, sources: &SourceMap, test: &RunTest) -> TokenStream {
    let title = &test.title;
    let run = (!lowering.run_values.is_empty()).then(|| quote!(let run = run_values(record, g);));
    let expectations = test.expectations.iter().map(|(span, expectation)| {
        let (text, place) = (sources.slice(*span).trim(), place(sources, *span));
        let roots = expectation.roots();
        let body = body(lowering, slots, Sources::default(), &roots);
        let (statements, results) = (&body.statements, &body.results);
        let verdict = match expectation {
            Expectation::Holds(condition) => {
                let truth = truth(condition, &roots, results);
                quote!(holds(#text, #place, #truth))
            }
            Expectation::Near { unit, .. } => quote!(near(#text, #place, #unit, [#(#results),*])),
        };
        if statements.is_empty() { verdict } else { quote!({ #(#statements)* #verdict }) }
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
