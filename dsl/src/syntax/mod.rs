//! From text to tree: grammar, parser, syntax tree and its printed forms.
//!
//! [`parse::parse`] turns a [`Source`](crate::source::Source) into an [`ast::File`] and reports every syntax error
//! of the text in one go. Only `parse` knows pest; the rest of the compiler sees the tree.

pub mod ast;
