//! From text to tree: grammar, parser, syntax tree and its printed forms.
//!
//! [`parse`] turns a [`Source`](crate::source::Source) into an [`ast::File`] and reports every syntax error of the
//! text in one go. Only the module of that name knows pest; the rest of the compiler sees the tree.

pub mod ast;
mod layout;
mod parse;
pub mod print;
mod slip;
mod token;

#[cfg(test)]
mod tests;

pub use parse::{parse, parse_expr};
