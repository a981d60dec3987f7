//! Stage 2 of 6: one program from several texts. Input: the main text and a loader for those it names. Output: a [`Program`], the items of
//! the model after `extend`, `replace` and `drop`, with the library modules that it uses. Knows names, no types.

pub mod extend;
mod imports;
pub mod scope;

pub use extend::{Loaded, Loader, assemble};

use crate::syntax::ast;

/// The items of one model, those of its base first, ready to be checked.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// The model's name, from its `model` item.
    pub name: String,
    /// What the `///` lines before `model` say.
    pub docs: String,
    /// All items but `model`, `extend`, `use`, `replace` and `drop`.
    pub items: Vec<ast::Item>,
    /// Names taken from library modules.
    pub imports: Vec<Import>,
    /// Library modules in use, in the order of first use.
    pub modules: Vec<Module>,
    /// Names of items that a variant has dropped, where it does.
    pub dropped: Vec<ast::Ident>,
    /// Names that unreadable parts would have declared.
    pub broken: Vec<ast::Ident>,
}

/// A name that a file takes from a library module.
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    /// The name, as it stands in the `use` item.
    pub name: ast::Ident,
    /// Index into [`Program::modules`].
    pub module: usize,
}

/// A file of the library.
#[derive(Clone, Debug)]
pub struct Module {
    /// Such as `std::solid`.
    pub name: String,
    /// Its functions, with their docs.
    pub functions: Vec<(String, ast::Function)>,
    /// What it takes from other modules.
    pub imports: Vec<Import>,
}
