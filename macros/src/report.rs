//! Runs the compiler and turns what it says into tokens: the module of the model, or `compile_error!` on the model's own tokens.

use crate::inline::{Input, Refusal};
use ansatz_dsl::compile::{Compilation, Output, compile};
use ansatz_dsl::diagnostic::{Diagnostic, Severity, render};
use ansatz_dsl::resolve::extend::Loaded;
use proc_macro::{Delimiter, Group, Ident, Literal, Punct, Spacing, Span, TokenStream, TokenTree};
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

/// One `compile_error!` for each error of an inline model, on its words; one for all errors of a file.
fn errors(compilation: &Compilation, input: &Input) -> TokenStream {
    let rendered = |diagnostics: &[Diagnostic]| render(diagnostics, &compilation.sources);
    if input.in_file {
        let text = format!("in the model `{}`\n\n{}", input.name, rendered(&compilation.diagnostics));
        return compile_error(&text, Span::call_site());
    }
    let errors = compilation.diagnostics.iter().filter(|d| d.severity == Severity::Error);
    errors
        .map(|error| {
            let text = rendered(std::slice::from_ref(error));
            compile_error_between(&without_frame(&text), words(error, compilation, input))
        })
        .collect()
}

/// The text of one error without what `rustc` says itself: that it is an error, and how many there are.
fn without_frame(text: &str) -> String {
    let text = text.trim_end();
    let text = text.strip_suffix("1 error").unwrap_or(text).trim_end();
    text.strip_prefix("error[").map_or_else(|| text.into(), |rest| rest.replacen("]: ", ": ", 1))
}

/// Spans of the first and the last token that an error points at; those of the macro for an error in another file.
fn words(error: &Diagnostic, compilation: &Compilation, input: &Input) -> [Span; 2] {
    let here = compilation.sources.get(error.primary.source).is_some_and(|source| source.name == input.name);
    let range = error.primary.range();
    let last = range.end.saturating_sub(1).max(range.start);
    if here { [range.start, last].map(|byte| token_at(input, byte)) } else { [Span::call_site(); 2] }
}

/// Span of the last token that starts at or before a byte.
fn token_at(input: &Input, byte: usize) -> Span {
    let before = input.tokens.iter().filter(|(start, _)| *start <= byte);
    before.max_by_key(|(start, _)| *start).map_or_else(Span::call_site, |(_, span)| *span)
}

fn compile_error(message: &str, span: Span) -> TokenStream {
    compile_error_between(message, [span; 2])
}

/// `compile_error! { message }`, underlined from the start of the first span to the end of the second.
fn compile_error_between(message: &str, [first, last]: [Span; 2]) -> TokenStream {
    let text = TokenStream::from(TokenTree::from(Literal::string(message)));
    let (name, mut bang) = (Ident::new("compile_error", first), Punct::new('!', Spacing::Alone));
    let mut arguments = Group::new(Delimiter::Brace, text);
    bang.set_span(first);
    arguments.set_span(last);
    [TokenTree::from(name), TokenTree::from(bang), TokenTree::from(arguments)].into_iter().collect()
}
