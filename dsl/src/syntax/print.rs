//! The syntax tree as text again: expressions with as few parentheses as they need, files as an indented outline.
//!
//! Expressions print so that they parse to the same tree; labels and help lines quote them. The outline is what
//! `ansatz expand --stage ast` shows.

mod expr;
mod outline;

pub use expr::{bounds_to_string, expr_to_string, number_to_string, type_to_string};
pub use outline::outline;
