//! Diagnostics: what the compiler has to say, with a stable code, the place, labels and help.
//!
//! Every stage builds a [`Diagnostic`] fluently and hands it to a [`Sink`]; nothing is printed on the way. The text
//! that the command line, `rustc` and the editor show is made in one place, [`render`].
//!
//! ```
//! use ansatz_dsl::diagnostic::{Code, Diagnostic, Sink, render};
//! use ansatz_dsl::source::{SourceMap, Span};
//! let mut sources = SourceMap::new();
//! let id = sources.add("cell.ansatz", "param r = 3 um\nparam h = r;\n");
//! let mut sink = Sink::new();
//! sink.push(Diagnostic::error(Code::MissingSemicolon, Span::new(id, 14, 14), "expected `;`").help("write `;` here"));
//! assert!(render(&sink.finish(), &sources).contains("error[P001]: expected `;`"));
//! ```

mod code;
mod render;

pub use code::Code;
pub use render::{Style, render, render_with};

use crate::source::Span;
use ansatz_units::Unit;

/// How much a diagnostic matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The model cannot be compiled.
    Error,
    /// The model compiles but says something doubtful.
    Warning,
    /// Worth knowing.
    Note,
}

/// A second place and what it has to do with the matter.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// A few words shown beside it.
    pub text: String,
}

/// One thing to tell the user.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "a diagnostic says nothing until it is pushed into a sink"]
pub struct Diagnostic {
    /// How much it matters.
    pub severity: Severity,
    /// The stable code.
    pub code: Code,
    /// One sentence, names in back quotes, no full stop.
    pub message: String,
    /// The place that has to change.
    pub primary: Span,
    /// Words beside the primary place; may be empty.
    pub primary_text: String,
    /// Further places.
    pub labels: Vec<Label>,
    /// What to do about it, one line each.
    pub help: Vec<String>,
}

impl Diagnostic {
    /// A diagnostic of any severity.
    pub fn new(severity: Severity, code: Code, primary: Span, message: impl Into<String>) -> Self {
        let message = message.into();
        Self {
            severity,
            code,
            message,
            primary,
            primary_text: String::new(),
            labels: Vec::new(),
            help: Vec::new(),
        }
    }

    /// An error at `primary`.
    pub fn error(code: Code, primary: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, primary, message)
    }

    /// A warning at `primary`.
    pub fn warning(code: Code, primary: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, primary, message)
    }

    /// A note at `primary`.
    pub fn note(code: Code, primary: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Note, code, primary, message)
    }

    /// Words beside the primary place.
    pub fn here(mut self, text: impl Into<String>) -> Self {
        self.primary_text = text.into();
        self
    }

    /// Marks a further place.
    pub fn label(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label { span, text: text.into() });
        self
    }

    /// Adds a line of advice.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help.push(text.into());
        self
    }

    /// Adds "did you mean" advice where a candidate is close to `name`.
    pub fn help_did_you_mean<'a>(self, name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Self {
        match did_you_mean(name, candidates) {
            Some(close) => self.help(format!("did you mean `{close}`?")),
            None => self,
        }
    }

    /// Adds "did you mean" advice where a unit is close to `word`.
    pub fn help_unit(self, word: &str) -> Self {
        match Unit::meant(word) {
            Some(close) => self.help(format!("did you mean `{close}`?")),
            None => self,
        }
    }
}

/// Collects diagnostics in the order in which they are found.
#[derive(Clone, Debug, Default)]
pub struct Sink {
    diagnostics: Vec<Diagnostic>,
}

impl Sink {
    /// An empty sink.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a diagnostic.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// Whether at least one error has been taken.
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(|d| d.severity == Severity::Error)
    }

    /// Whether nothing has been taken.
    pub fn is_empty(&self) -> bool {
        self.diagnostics.is_empty()
    }

    /// What has been taken so far, in the order of arrival.
    pub fn iter(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.iter()
    }

    /// All diagnostics sorted by place (then severity, code and words), each said once.
    #[must_use]
    pub fn finish(mut self) -> Vec<Diagnostic> {
        self.diagnostics.sort_by(|a, b| key(a).cmp(&key(b)));
        self.diagnostics.dedup_by(|a, b| key(a) == key(b));
        self.diagnostics
    }
}

fn key(d: &Diagnostic) -> (Span, Severity, Code, &str) {
    (d.primary, d.severity, d.code, &d.message)
}

/// The candidate closest to `name`, if it is close enough to be a slip of the pen; never `name` itself.
pub fn did_you_mean<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    ansatz_units::nearest(name, candidates.into_iter().filter(|candidate| *candidate != name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{SourceId, SourceMap};

    fn at(start: usize, message: &str) -> Diagnostic {
        Diagnostic::error(Code::Expected, Span::new(SourceId(0), start, start + 1), message)
    }

    #[test]
    fn a_sink_sorts_by_place_and_says_nothing_twice() {
        let mut sink = Sink::new();
        for (start, message) in [(7, "b"), (3, "a"), (7, "b")] {
            sink.push(at(start, message));
        }
        let places: Vec<u32> = sink.finish().iter().map(|d| d.primary.start).collect();
        assert_eq!(places, [3, 7]);
    }

    #[test]
    fn slips_of_the_pen_find_their_word_and_strangers_do_not() {
        let words = ["physics", "param", "path", "eta", "u"];
        assert_eq!(did_you_mean("phyiscs", words), Some("physics"));
        assert_eq!(did_you_mean("parm", words), Some("param"));
        assert_eq!(did_you_mean("Eta", words), Some("eta"));
        assert_eq!(
            did_you_mean("v", words),
            None,
            "a one-letter name is not close to another one-letter name"
        );
        assert_eq!(did_you_mean("banana", words), None);
        assert_eq!(did_you_mean("eta", words), None, "the name itself is no suggestion");
    }

    #[test]
    fn rendering_shows_code_place_labels_help_and_the_count() {
        let mut sources = SourceMap::new();
        let id = sources.add("a.ansatz", "let a = 1\nlet b = 2;\n");
        let diagnostic = Diagnostic::error(Code::MissingSemicolon, Span::new(id, 9, 9), "expected `;`")
            .here("here")
            .label(Span::new(id, 10, 13), "the next item")
            .help("write `;`");
        let text = render(&[diagnostic.clone(), diagnostic], &sources);
        for part in
            ["error[P001]: expected `;`", "a.ansatz:1:10", "the next item", "help: write `;`", "2 errors"]
        {
            assert!(text.contains(part), "{part} is missing in\n{text}");
        }
    }

    #[test]
    fn a_place_outside_every_text_still_renders() {
        let text = render(&[at(400, "lost")], &SourceMap::new());
        assert!(text.contains("lost") && text.contains("1 error"), "{text}");
    }
}
