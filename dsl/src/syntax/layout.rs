//! The layout of a text, looked at before it is parsed: braces that are never closed, nesting too deep to follow and
//! comments that the language refuses are found here, so that the parser sees sane text only.

use std::ops::Range;

use super::ast::Keyword;
use super::token::{Kind, Token, tokens};
use crate::diagnostic::{Code, Diagnostic};
use crate::source::{Source, Span};

/// Brackets that may stand inside each other. The words `match` and `fn` count as brackets too: what they lead
/// nests without any.
const MAX_DEPTH: usize = 48;

/// Braces left open that are told before the rest of the text is given up.
const MAX_FAULTS: usize = 20;

/// What a look at the text says.
#[derive(Default)]
pub(super) struct Layout {
    /// The stretches that can be parsed, in order: the whole text unless a brace is never closed.
    pub(super) readable: Vec<Range<usize>>,
    /// What is wrong.
    pub(super) faults: Vec<Diagnostic>,
}

/// Looks at comments and brackets.
pub(super) fn check(source: &Source) -> Layout {
    let mut layout = Layout::default();
    let mut start = 0;
    while layout.faults.len() < MAX_FAULTS {
        let mut scan = Scan::new(source, start);
        let stopped = tokens(&source.text, start..source.text.len()).find_map(|token| scan.token(token));
        layout.faults.append(&mut scan.faults);
        if let Some(fault) = stopped {
            layout.faults.push(fault);
            break;
        }
        let Some(brace) = scan.outermost_brace() else {
            layout.readable.push(start..source.text.len());
            break;
        };
        let intruder = scan.intruder;
        layout.faults.push(never_closed(source, brace, intruder));
        layout.readable.push(start..scan.item);
        match intruder {
            Some(next) => start = next,
            None => break,
        }
    }
    layout
}

fn never_closed(source: &Source, brace: usize, next: Option<usize>) -> Diagnostic {
    let span = Span::new(source.id, brace, brace + 1);
    let diagnostic = Diagnostic::error(Code::UnbalancedBracket, span, "this `{` is never closed");
    match next {
        Some(next) => {
            diagnostic.label(Span::new(source.id, next, next + 1), "a `}` is missing before this item")
        }
        None => diagnostic.help("close it with `}`"),
    }
}

/// Brackets and words that nest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Nest {
    Paren,
    Bracket,
    Brace,
    Word,
}

struct Scan<'s> {
    source: &'s Source,
    /// The column at which items start.
    margin: Option<usize>,
    open: Vec<(Nest, usize)>,
    /// Where the last item outside all braces starts.
    item: usize,
    /// The first item that starts at the margin although a brace is open.
    intruder: Option<usize>,
    faults: Vec<Diagnostic>,
}

impl<'s> Scan<'s> {
    fn new(source: &'s Source, start: usize) -> Self {
        let margin = tokens(&source.text, 0..source.text.len()).find(|token| token.kind == Kind::Word);
        let margin = margin.and_then(|token| indent(&source.text, token.start));
        Self { source, margin, open: Vec::new(), item: start, intruder: None, faults: Vec::new() }
    }

    fn outermost_brace(&self) -> Option<usize> {
        self.open.iter().find(|(nest, _)| *nest == Nest::Brace).map(|&(_, at)| at)
    }

    /// Takes a token; a fault that makes the rest unreadable is returned.
    fn token(&mut self, token: Token) -> Option<Diagnostic> {
        let span = Span::new(self.source.id, token.start, token.end);
        match (token.kind, token.text(&self.source.text)) {
            (Kind::RustDoc, _) => {
                let message = "`//!` and `/** */` are no comments of the language";
                let help = "write `//` for a remark, `///` before an item to document it";
                self.faults.push(Diagnostic::error(Code::DocComment, span, message).help(help));
            }
            (Kind::OpenComment, _) => {
                let message = "this comment is never closed, or holds too many others";
                return Some(
                    Diagnostic::error(Code::UnbalancedBracket, span, message).help("close it with `*/`"),
                );
            }
            (Kind::Word, word) => self.word(word, token.start),
            (Kind::Sign, "(") => self.open.push((Nest::Paren, token.start)),
            (Kind::Sign, "[") => self.open.push((Nest::Bracket, token.start)),
            (Kind::Sign, "{") => self.open.push((Nest::Brace, token.start)),
            (Kind::Sign, ")") => self.close(Nest::Paren),
            (Kind::Sign, "]") => self.close(Nest::Bracket),
            (Kind::Sign, "}") => self.close(Nest::Brace),
            (Kind::Sign, ";") => self.close(Nest::Word),
            _ => {}
        }
        (self.open.len() > MAX_DEPTH).then(|| {
            let message = format!("more than {MAX_DEPTH} brackets are open here");
            Diagnostic::error(Code::TooDeep, span, message).help("name inner parts with `let` or `fn`")
        })
    }

    fn word(&mut self, word: &str, at: usize) {
        let leads = Keyword::from_text(word).is_some() || matches!(word, "replace" | "drop");
        if leads && self.margin.is_some() && indent(&self.source.text, at) == self.margin {
            match self.outermost_brace() {
                None => self.item = at,
                Some(_) => self.intruder = self.intruder.or(Some(at)),
            }
        }
        if matches!(word, "match" | "fn") {
            self.open.push((Nest::Word, at));
        }
    }

    /// Closes the matching bracket and everything left open inside it, but nothing outside the innermost brace.
    /// `;` and `}` also end the words in front.
    fn close(&mut self, nest: Nest) {
        let inner =
            |open: &[(Nest, usize)]| open.iter().rposition(|&(n, _)| n == Nest::Brace).map_or(0, |i| i + 1);
        let wall = if nest == Nest::Brace { 0 } else { inner(&self.open) };
        match nest {
            Nest::Word => self.open.truncate(wall),
            _ => {
                if let Some(found) = self.open[wall..].iter().rposition(|&(n, _)| n == nest) {
                    self.open.truncate(wall + found);
                }
            }
        }
        if nest == Nest::Brace && self.open.last().is_some_and(|&(n, _)| n == Nest::Word) {
            self.open.pop();
        }
        if self.outermost_brace().is_none() {
            self.intruder = None;
        }
    }
}

/// Bytes before `at` on its line, if they are white space.
fn indent(text: &str, at: usize) -> Option<usize> {
    let line = text[..at].rfind('\n').map_or(0, |newline| newline + 1);
    text[line..at].trim().is_empty().then_some(at - line)
}
