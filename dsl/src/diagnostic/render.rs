//! Diagnostics as text: the one place that decides how messages look.

use annotate_snippets::renderer::DEFAULT_TERM_WIDTH;
use annotate_snippets::{Annotation, AnnotationKind, Group, Level, Renderer, Snippet};

use super::{Diagnostic, Severity};
use crate::source::{Source, SourceMap, Span};

/// Whether the text carries terminal colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// Characters only: files, tests, `rustc`.
    #[default]
    Plain,
    /// ANSI colours for a terminal.
    Coloured,
}

/// All diagnostics as plain text, ending with the number of errors.
pub fn render(diagnostics: &[Diagnostic], sources: &SourceMap) -> String {
    render_with(diagnostics, sources, Style::Plain)
}

/// All diagnostics as text in the given style, ending with the number of errors.
pub fn render_with(diagnostics: &[Diagnostic], sources: &SourceMap, style: Style) -> String {
    let renderer = match style {
        Style::Plain => Renderer::plain(),
        Style::Coloured => Renderer::styled(),
    }
    .term_width(DEFAULT_TERM_WIDTH);
    let mut text = String::new();
    for diagnostic in diagnostics {
        text.push_str(renderer.render(&[report(diagnostic, sources)]).trim_end());
        text.push_str("\n\n");
    }
    text.push_str(&summary(diagnostics));
    text
}

fn report<'a>(diagnostic: &'a Diagnostic, sources: &'a SourceMap) -> Group<'a> {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Note => Level::NOTE,
    };
    let title = level.primary_title(diagnostic.message.as_str()).id(diagnostic.code.id());
    let mut group = Group::with_title(title);
    for source in places(diagnostic, sources) {
        group = group.element(snippet(diagnostic, source));
    }
    group.elements(diagnostic.help.iter().map(|line| Level::HELP.message(line.as_str())))
}

/// The texts that the diagnostic points into, that of the primary place first.
fn places<'a>(diagnostic: &Diagnostic, sources: &'a SourceMap) -> Vec<&'a Source> {
    let mut ids = vec![diagnostic.primary.source];
    for label in &diagnostic.labels {
        if !ids.contains(&label.span.source) {
            ids.push(label.span.source);
        }
    }
    ids.into_iter().filter_map(|id| sources.get(id)).collect()
}

fn snippet<'a>(diagnostic: &'a Diagnostic, source: &'a Source) -> Snippet<'a, Annotation<'a>> {
    let mut snippet = Snippet::source(source.text.as_str()).path(source.name.as_str());
    if diagnostic.primary.source == source.id {
        let mark = AnnotationKind::Primary.span(fit(diagnostic.primary, source));
        let text = diagnostic.primary_text.as_str();
        snippet = snippet.annotation(if text.is_empty() { mark } else { mark.label(text) });
    }
    let labels = diagnostic.labels.iter().filter(|label| label.span.source == source.id);
    snippet.annotations(
        labels.map(|label| AnnotationKind::Context.span(fit(label.span, source)).label(label.text.as_str())),
    )
}

/// The byte range of `span`, kept inside the text and on character boundaries.
fn fit(span: Span, source: &Source) -> std::ops::Range<usize> {
    let floor = |at: usize| {
        let mut at = at.min(source.text.len());
        while !source.text.is_char_boundary(at) {
            at -= 1;
        }
        at
    };
    let range = span.range();
    floor(range.start)..floor(range.end)
}

fn summary(diagnostics: &[Diagnostic]) -> String {
    let count = |severity| diagnostics.iter().filter(|d| d.severity == severity).count();
    let noun = |n: usize, word: &str| format!("{n} {word}{}", if n == 1 { "" } else { "s" });
    let (errors, warnings) = (count(Severity::Error), count(Severity::Warning));
    match (errors, warnings) {
        (0, 0) => String::new(),
        (_, 0) => format!("{}\n", noun(errors, "error")),
        (0, _) => format!("{}\n", noun(warnings, "warning")),
        _ => format!("{}, {}\n", noun(errors, "error"), noun(warnings, "warning")),
    }
}
