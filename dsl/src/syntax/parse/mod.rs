//! The parser: the only part of the compiler that names pest rules.
//!
//! [`layout`] first makes sure that the text nests sanely. The grammar then splits it into items
//! and `junk`; [`item`] and [`expr`] build the tree from what was understood, and [`junk`] explains the rest: each
//! stretch of junk is parsed again by the rule that its first word suggests, for the place and the expectations of
//! the failure, and parsing goes on behind it.

mod block;
mod expr;
mod item;
mod junk;
mod words;

pub(super) use junk::is_unit;

use std::cell::{Cell, RefCell};
use std::ops::Range;

use pest::Parser;
use pest::iterators::{Pair, Pairs};
use pest_derive::Parser;

use super::ast::{self, Ident};
use super::layout;
use super::slip;
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::source::{Source, Span};

#[derive(Parser)]
#[grammar = "syntax/grammar.pest"]
struct Grammar;

/// Syntax errors that are explained before the parser stops looking for more.
const MAX_ERRORS: usize = 100;

/// Parses a whole text. Every syntax error goes to `sink`; the tree holds what could be read.
pub fn parse(source: &Source, sink: &mut Sink) -> ast::File {
    let builder = Builder::new(source);
    let mut file = ast::File::default();
    let layout = layout::check(source);
    layout.faults.into_iter().for_each(|fault| builder.report(fault));
    for stretch in layout.readable {
        file.items.extend(builder.body(&block::FILE, stretch));
    }
    let (diagnostics, broken) = builder.finish();
    file.broken = broken;
    diagnostics.into_iter().for_each(|diagnostic| sink.push(diagnostic));
    slip::check(&file, source, sink);
    file
}

/// Parses a text that is one expression, such as a value typed on the command line.
///
/// # Errors
/// Returns nothing where the text is no expression; why goes to `sink`.
pub fn parse_expr(source: &Source, sink: &mut Sink) -> Option<ast::Expr> {
    let builder = Builder::new(source);
    let layout = layout::check(source);
    let expr = if layout.faults.is_empty() { builder.lone_expr() } else { None };
    layout.faults.into_iter().for_each(|fault| builder.report(fault));
    let (diagnostics, _) = builder.finish();
    let expr = if diagnostics.is_empty() { expr } else { None };
    diagnostics.into_iter().for_each(|diagnostic| sink.push(diagnostic));
    expr
}

/// Builds tree nodes from pest's pairs. Building returns `None` where a pair is not made as the grammar says.
struct Builder<'s> {
    source: &'s Source,
    diagnostics: RefCell<Vec<Diagnostic>>,
    broken: RefCell<Vec<Ident>>,
    /// Levels of the expression that is being built.
    depth: Cell<usize>,
}

impl<'s> Builder<'s> {
    fn new(source: &'s Source) -> Self {
        Self { source, diagnostics: RefCell::default(), broken: RefCell::default(), depth: Cell::new(0) }
    }

    fn finish(self) -> (Vec<Diagnostic>, Vec<Ident>) {
        (self.diagnostics.into_inner(), self.broken.into_inner())
    }

    fn report(&self, diagnostic: Diagnostic) {
        self.diagnostics.borrow_mut().push(diagnostic);
    }

    fn declare_broken(&self, names: impl IntoIterator<Item = Ident>) {
        self.broken.borrow_mut().extend(names);
    }

    fn has_room(&self) -> bool {
        self.diagnostics.borrow().len() < MAX_ERRORS
    }

    fn text(&self, range: Range<usize>) -> &'s str {
        self.source.text.get(range).unwrap_or("")
    }

    fn span(&self, start: usize, end: usize) -> Span {
        Span::new(self.source.id, start, end)
    }

    /// Parses the stretch by `rule`. Places in the result count from the start of the stretch.
    fn run(&self, rule: Rule, stretch: Range<usize>) -> Result<Nodes<'s>, pest::error::Error<Rule>> {
        let pairs = Grammar::parse(rule, self.text(stretch.clone()))?;
        Ok(Nodes { pairs, source: self.source, base: stretch.start })
    }

    fn lone_expr(&self) -> Option<ast::Expr> {
        let whole = 0..self.source.text.len();
        match self.run(Rule::only, whole.clone()) {
            Ok(mut nodes) => self.expr(nodes.next()?.nodes().next()?),
            Err(_) => {
                let (fault, _) = self.explain(Rule::only, whole);
                self.report(fault);
                None
            }
        }
    }

    /// The grammar accepted something that the builder does not know: a fault of the compiler, said as such.
    fn disagreement(&self, span: Span) {
        self.report(Diagnostic::error(
            Code::Internal,
            span,
            "the parser could not build this part of the tree",
        ));
    }
}

/// A pair and where its text starts in the source.
#[derive(Clone)]
struct Node<'s> {
    pair: Pair<'s, Rule>,
    source: &'s Source,
    base: usize,
}

impl<'s> Node<'s> {
    fn rule(&self) -> Rule {
        self.pair.as_rule()
    }

    fn text(&self) -> &'s str {
        self.source.text.get(self.range()).unwrap_or("")
    }

    fn range(&self) -> Range<usize> {
        self.base + self.pair.as_span().start()..self.base + end_of(&self.pair)
    }

    fn span(&self) -> Span {
        let range = self.range();
        Span::new(self.source.id, range.start, range.end)
    }

    fn ident(&self) -> Ident {
        Ident { text: self.text().to_owned(), span: self.span() }
    }

    /// The parts, without punctuation and keywords.
    fn nodes(self) -> Nodes<'s> {
        Nodes { pairs: self.pair.into_inner(), source: self.source, base: self.base }
    }

    /// The only part of a rule that just chooses between others.
    fn only(self) -> Option<Node<'s>> {
        self.nodes().next()
    }
}

/// Where the last token of a pair ends. The pair itself reaches over the white space and comments before an optional
/// part that is not there.
fn end_of(pair: &Pair<'_, Rule>) -> usize {
    let own = pair.as_span().end();
    if pair.as_rule() == Rule::junk {
        own
    } else {
        pair.clone().into_inner().last().map_or(own, |last| end_of(&last))
    }
}

/// The parts of a node in order, without punctuation and keywords.
#[derive(Clone)]
struct Nodes<'s> {
    pairs: Pairs<'s, Rule>,
    source: &'s Source,
    base: usize,
}

impl<'s> Iterator for Nodes<'s> {
    type Item = Node<'s>;

    fn next(&mut self) -> Option<Node<'s>> {
        let pair = self.pairs.by_ref().find(|pair| !words::is_mark(pair.as_rule()))?;
        Some(Node { pair, source: self.source, base: self.base })
    }
}

impl<'s> Nodes<'s> {
    /// The next part if `rule` made it; else nothing is taken.
    fn maybe(&mut self, rule: Rule) -> Option<Node<'s>> {
        self.maybe_any(&[rule])
    }

    /// The next part if one of `rules` made it; else nothing is taken.
    fn maybe_any(&mut self, rules: &[Rule]) -> Option<Node<'s>> {
        let mut ahead = self.clone();
        let node = ahead.next().filter(|node| rules.contains(&node.rule()))?;
        *self = ahead;
        Some(node)
    }

    /// The next part, as a name.
    fn ident(&mut self) -> Option<Ident> {
        self.next().map(|node| node.ident())
    }
}
