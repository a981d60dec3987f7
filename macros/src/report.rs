//! Runs the compiler and turns what it says into tokens: the module of the model, or `compile_error!` on the model's own tokens.

use crate::inline::{Input, Refusal};
use ansatz_dsl::compile::{Compilation, Output, compile};
use ansatz_dsl::diagnostic::{Diagnostic, Severity, render};
use ansatz_dsl::resolve::extend::Loaded;
use proc_macro::{Group, Ident, Literal, Punct, Spacing, Span, TokenStream, TokenTree};
use std::path::{Path, PathBuf};

/// The module of a model, or its errors.
pub fn expand(input: Result<Input, Refusal>) -> TokenStream {
    let input = match input {
        Ok(input) => input,
        Err((message, span)) => return compile_error(&message, span),
    };
    let mut files: Vec<PathBuf> = input.in_file.then(|| input.file.clone()).into_iter().collect();
    let mut load = |path: &str, from: &str| {
        let beside = if from == input.name { input.file.clone() } else { PathBuf::from(from) };
        let file = beside.parent().unwrap_or(Path::new("")).join(path);
        let text = std::fs::read_to_string(&file).map_err(|e| e.to_string())?;
        files.push(file.clone());
        Ok(Loaded { name: file.display().to_string(), text })
    };
    let compilation = compile(&input.name, &input.text, &mut load);
    match &compilation.output {
        Some(output) => module(output, &files),
        None => errors(&compilation, &input),
    }
}

/// `pub mod NAME { .. }`, with the files' bytes named so that cargo watches them.
fn module(output: &Output, files: &[PathBuf]) -> TokenStream {
    let watched =
        files.iter().map(|f| absolute(f)).map(|f| format!("const _: &[u8] = include_bytes!({f:?});\n"));
    let (name, watched) = (&output.name, watched.collect::<String>());
    let text = format!(
        "/// The model `{name}`.\n#[allow(missing_docs)]\npub mod {name} {{\n{watched}{}\n}}",
        output.rust
    );
    text.parse().unwrap_or_else(|e| {
        compile_error(
            &format!("the compiler emitted text that is not Rust ({e}); please report this model"),
            Span::call_site(),
        )
    })
}

fn absolute(file: &Path) -> String {
    file.canonicalize().unwrap_or_else(|_| file.to_path_buf()).display().to_string()
}

/// One `compile_error!` for each error of an inline model, on its token; one for all errors of a file.
fn errors(compilation: &Compilation, input: &Input) -> TokenStream {
    let errors: Vec<&Diagnostic> =
        compilation.diagnostics.iter().filter(|d| d.severity == Severity::Error).collect();
    if input.in_file {
        let text = render(&compilation.diagnostics, &compilation.sources);
        return compile_error(&text, Span::call_site());
    }
    errors
        .into_iter()
        .map(|error| {
            let text = render(std::slice::from_ref(error), &compilation.sources);
            compile_error(&text, token_at(input, error.primary.range().start))
        })
        .collect()
}

/// Span of the last token that starts at or before a byte.
fn token_at(input: &Input, byte: usize) -> Span {
    let before = input.tokens.iter().filter(|(start, _)| *start <= byte);
    before.max_by_key(|(start, _)| *start).map_or_else(Span::call_site, |(_, span)| *span)
}

fn compile_error(message: &str, span: Span) -> TokenStream {
    let mut text = Literal::string(message);
    text.set_span(span);
    let mut arguments = Group::new(proc_macro::Delimiter::Brace, TokenStream::from(TokenTree::from(text)));
    arguments.set_span(span);
    let mut bang = Punct::new('!', Spacing::Alone);
    bang.set_span(span);
    let name = Ident::new("compile_error", span);
    [TokenTree::from(name), TokenTree::from(bang), TokenTree::from(arguments)].into_iter().collect()
}
