//! Procedural macros of Ansatz: a model becomes a Rust module with a typed struct of parameters and a runnable simulation.
//!
//! Thin by design: the text of the model goes to `ansatz-dsl`, its Rust text comes back. Errors land on the model's own tokens.

mod inline;
mod report;

use proc_macro::TokenStream;

/// Compiles the model in a file, given relative to the file that contains the call, into a module named after the model.
///
/// The module holds `Parameters` (one public field per parameter, in the model's units, with defaults), `PROGRAM`, and
/// `simulation(&Parameters)`. Cargo rebuilds when the model or a file it uses changes.
#[proc_macro]
pub fn include_model(input: TokenStream) -> TokenStream {
    report::expand(inline::included(input))
}

/// Compiles the model written between the braces, as [`include_model!`] does with a file.
#[proc_macro]
pub fn model(input: TokenStream) -> TokenStream {
    report::expand(inline::written(input))
}
