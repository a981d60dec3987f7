//! Stage 6 of 6: forms and kernels become Rust. Input: [`Forms`] and their kernels. Output: the text of a module with `Parameters`,
//! `PROGRAM` and `simulation`, formatted. The only place that names `quote`; emitted code names only `::ansatz::generated`.

mod accumulate;
mod body;
mod expression;
mod fields;
mod geometry;
mod helpers;
mod integral;
mod kernel;
mod layout;
mod outputs;
mod pairs;
mod parameters;
mod program;
mod states;
mod tables;
mod tests;

use crate::diagnostic::Diagnostic;
use crate::form::Forms;
use crate::lower::internal;
use crate::source::{SourceMap, Span};
use proc_macro2::{Ident, Span as TokenSpan, TokenStream};
use quote::quote;

pub use program::Plan;

/// The Rust text of a model.
///
/// # Errors
/// An internal error if the emitted tokens are no Rust.
pub fn rust(forms: &mut Forms<'_>, plan: &Plan, sources: &SourceMap) -> Result<String, Box<Diagnostic>> {
    let tokens = program::module(forms, plan, sources);
    let file: syn::File = syn::parse2(tokens)
        .map_err(|error| internal(Span::default(), &format!("emitted text is no Rust: {error}")))?;
    Ok(prettyplease::unparse(&file).replace(kernel::INVOCATION_AS_PRINTED, kernel::INVOCATION))
}

/// An identifier from a name of the model: one underscore for whatever else stands between letters, one behind words of Rust.
fn ident(name: &str) -> Ident {
    let words = name.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|word| !word.is_empty());
    let mut text = words.collect::<Vec<_>>().join("_");
    if text.starts_with(|c: char| c.is_ascii_digit()) || text.is_empty() {
        text.insert(0, '_');
    }
    if text == "_" || syn::parse_str::<Ident>(&text).is_err() {
        text.push('_');
    }
    Ident::new(&text, TokenSpan::call_site())
}

/// `name:line` of a span.
fn place(sources: &SourceMap, span: Span) -> String {
    match sources.get(span.source) {
        Some(source) => format!("{}:{}", source.name, source.position(span.start).line),
        None => String::from("unknown place"),
    }
}

/// `#[doc = " .."]` lines of a text.
fn docs(text: &str) -> TokenStream {
    let lines = text.lines().map(|line| format!(" {line}"));
    quote!(#(#[doc = #lines])*)
}
