//! The syntax tree: one node for every form that a model file can take, each with its [`Span`].
//!
//! The tree says what was written, nothing more: names are not resolved, units not looked up, functions not
//! expanded. A file with syntax errors still gives a tree of what could be read; the names that the unreadable parts
//! would have declared are in [`File::broken`], so that later stages do not complain about each use of them.

#![allow(clippy::large_enum_variant, reason = "a tree is built once and then visited by reference")]

mod block;
mod expr;
mod item;
mod walk;

pub use block::*;
pub use expr::*;
pub use item::*;

use crate::source::Span;

/// A name or word as written.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Ident {
    /// The characters.
    pub text: String,
    /// Where they stand.
    pub span: Span,
}

/// A string literal, without its quotes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Text {
    /// The characters between the quotes (there are no escapes).
    pub value: String,
    /// The literal with its quotes.
    pub span: Span,
}

/// `a` or `a.b.c`: a path of the geometry and its label, a part and its state, or a plain name.
#[derive(Clone, Debug, PartialEq)]
pub struct Dotted {
    /// At least one name.
    pub parts: Vec<Ident>,
    /// From the first to the last.
    pub span: Span,
}

impl Dotted {
    /// The names joined by dots.
    pub fn text(&self) -> String {
        self.parts.iter().map(|part| part.text.as_str()).collect::<Vec<_>>().join(".")
    }
}
