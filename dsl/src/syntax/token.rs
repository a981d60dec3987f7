//! A lexer that never fails: it finds where words, numbers, texts and signs start and end, for the stages around
//! the grammar that look at text which may not parse.

use std::ops::Range;

/// Comments that may stand inside each other.
const MAX_COMMENT_DEPTH: usize = 16;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Letters, digits and underscores, no digit first.
    Word,
    /// Starts with a digit; letters glued to it belong to it.
    Number,
    /// A string literal.
    Text,
    /// A `///` line.
    Doc,
    /// `//!` or `/** */`: comments in Rust that the language refuses.
    RustDoc,
    /// `/*` without an end, or with too many inside each other.
    OpenComment,
    /// Anything else: an operator, a bracket, a foreign character.
    Sign,
}

/// One token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Token {
    /// What it is.
    pub(super) kind: Kind,
    /// First byte.
    pub(super) start: usize,
    /// One past the last byte.
    pub(super) end: usize,
}

impl Token {
    /// The characters of the token.
    pub(super) fn text(self, source: &str) -> &str {
        source.get(self.start..self.end).unwrap_or("")
    }
}

/// The tokens of a stretch of text, without white space and plain comments.
pub(super) fn tokens(text: &str, stretch: Range<usize>) -> impl Iterator<Item = Token> {
    let mut at = stretch.start;
    std::iter::from_fn(move || {
        loop {
            let rest = text.get(at..stretch.end)?;
            let rest_start = at + (rest.len() - rest.trim_start().len());
            let rest = rest.trim_start();
            let (kind, length) = lex(rest)?;
            at = rest_start + length;
            if let Some(kind) = kind {
                return Some(Token { kind, start: rest_start, end: at });
            }
        }
    })
}

/// Kind (none for a plain comment) and length of the token that `rest` starts with; nothing at the end.
fn lex(rest: &str) -> Option<(Option<Kind>, usize)> {
    let first = rest.chars().next()?;
    if rest.starts_with("//") {
        return Some(line_comment(rest));
    }
    if rest.starts_with("/*") {
        return Some(block_comment(rest));
    }
    let (kind, length) = match first {
        '"' => text_literal(rest),
        '0'..='9' => (Kind::Number, number(rest)),
        c if c.is_ascii_alphabetic() || c == '_' => (Kind::Word, word(rest)),
        c => (Kind::Sign, sign(rest).unwrap_or(c.len_utf8())),
    };
    Some((Some(kind), length))
}

fn line_comment(rest: &str) -> (Option<Kind>, usize) {
    let length = rest.find('\n').unwrap_or(rest.len());
    let kind = match rest.as_bytes() {
        [_, _, b'!', ..] => Some(Kind::RustDoc),
        [_, _, b'/', b'/', ..] => None,
        [_, _, b'/', ..] => Some(Kind::Doc),
        _ => None,
    };
    (kind, length)
}

fn block_comment(rest: &str) -> (Option<Kind>, usize) {
    let bytes = rest.as_bytes();
    let (mut depth, mut at) = (0usize, 0);
    while at + 1 < bytes.len() && depth <= MAX_COMMENT_DEPTH {
        match &bytes[at..at + 2] {
            b"/*" => (depth, at) = (depth + 1, at + 2),
            b"*/" => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            let documents = matches!(bytes, [_, _, b'!', ..])
                || matches!(bytes, [_, _, b'*', c, ..] if !b"*/".contains(c));
            return (documents.then_some(Kind::RustDoc), at);
        }
    }
    (Some(Kind::OpenComment), 2)
}

fn text_literal(rest: &str) -> (Kind, usize) {
    match rest[1..].find(['"', '\\', '\n']) {
        Some(end) if rest.as_bytes()[end + 1] == b'"' => (Kind::Text, end + 2),
        _ => (Kind::Sign, 1),
    }
}

fn word(rest: &str) -> usize {
    rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len())
}

fn number(rest: &str) -> usize {
    let bytes = rest.as_bytes();
    let digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        let exponent_sign =
            matches!(byte, b'+' | b'-') && matches!(bytes[at - 1], b'e' | b'E') && digit(at + 1);
        let fraction = byte == b'.' && digit(at + 1);
        if !(byte.is_ascii_alphanumeric() || byte == b'_' || exponent_sign || fraction) {
            break;
        }
        at += 1;
    }
    at
}

fn sign(rest: &str) -> Option<usize> {
    ["==", "<=", ">=", "=>", "->", "~=", "::", ".."]
        .iter()
        .find(|sign| rest.starts_with(**sign))
        .map(|sign| sign.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(text: &str) -> Vec<&str> {
        tokens(text, 0..text.len()).map(|token| token.text(text)).collect()
    }

    #[test]
    fn tokens_cover_every_kind_and_skip_comments() {
        assert_eq!(
            texts("a_1 = 3um .. 1e-3*\"x y\" /* /* in */ out */ // end\n/// doc\n∇"),
            ["a_1", "=", "3um", "..", "1e-3", "*", "\"x y\"", "/// doc", "∇"]
        );
        assert_eq!(texts("\"open"), ["\"", "open"]);
        assert_eq!(texts("0..1"), ["0", "..", "1"]);
        assert_eq!(texts("/*"), ["/*"]);
        assert_eq!(texts("/**/ //// x\n/***/ a"), ["a"]);
    }

    #[test]
    fn comments_that_rust_takes_for_documentation_are_told_apart() {
        let kinds = |text: &str| tokens(text, 0..text.len()).map(|token| token.kind).collect::<Vec<_>>();
        assert_eq!(kinds("//! x\n/** y */ /*! z */"), [Kind::RustDoc; 3]);
        assert_eq!(kinds(&"/*".repeat(40))[0], Kind::OpenComment);
    }
}
