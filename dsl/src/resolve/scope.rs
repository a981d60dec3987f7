//! What a name stands for: the names that a text declares, and the words that the language gives.

use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::model::{BlockId, EventId, FieldId, ParamId, PathId, RegionId, StateId};
use crate::source::Span;
use crate::syntax::ast::Ident;
use std::collections::BTreeMap;

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symbol {
    /// A parameter.
    Param(ParamId),
    /// A `let` of the file or its geometry, by position: a value, a domain or a pair.
    Let(usize),
    /// A function, by position.
    Function(usize),
    /// A field.
    Field(FieldId),
    /// A state.
    State(StateId),
    /// A path.
    Path(PathId),
    /// A region.
    Region(RegionId),
    /// A physics block.
    Block(BlockId),
    /// An event.
    Event(EventId),
    /// In-plane coordinate 0 or 1.
    Coordinate(usize),
    /// A word of the language.
    Word(Word),
    /// Its declaration is wrong and has been reported: uses of it say nothing.
    Broken,
}

impl Symbol {
    /// What it is, in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Param(_) => "a parameter",
            Self::Let(_) => "a `let`",
            Self::Function(_) => "a function",
            Self::Field(_) => "a field",
            Self::State(_) => "a state",
            Self::Path(_) => "a path",
            Self::Region(_) => "a region",
            Self::Block(_) => "a physics block",
            Self::Event(_) => "an event",
            Self::Coordinate(_) => "a coordinate",
            Self::Word(_) => "a word of the language",
            Self::Broken => "a name with an error",
        }
    }
}

/// Names that the language gives to every model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Word {
    /// `t`
    Time,
    /// `pi`
    Pi,
    /// `I`
    Identity,
    /// `position`, the reference position.
    Position,
    /// `axis`
    Axis,
    /// `region`, what a `match region` looks at.
    Region,
    /// `run`
    Run,
    /// `outcome`
    Outcome,
}

impl Word {
    /// All of them with their spelling.
    pub const ALL: [(&'static str, Word); 8] = [
        ("t", Word::Time),
        ("pi", Word::Pi),
        ("I", Word::Identity),
        ("position", Word::Position),
        ("axis", Word::Axis),
        ("region", Word::Region),
        ("run", Word::Run),
        ("outcome", Word::Outcome),
    ];

    /// The word spelt so.
    #[must_use]
    pub fn find(name: &str) -> Option<Word> {
        Self::ALL.into_iter().find(|(text, _)| *text == name).map(|(_, word)| word)
    }
}

/// The names of one text.
#[derive(Clone, Debug, Default)]
pub struct Scope {
    names: BTreeMap<String, (Symbol, Span)>,
}

impl Scope {
    /// Gives a name its meaning. A name that is a word of the language or is declared already is reported and keeps what it stood for.
    pub fn declare(&mut self, name: &Ident, symbol: Symbol, sink: &mut Sink) {
        if Word::find(&name.text).is_some() {
            let message = format!("`{}` is a word of the language", name.text);
            return sink
                .push(Diagnostic::error(Code::ReservedName, name.span, message).help("choose another name"));
        }
        let Some((_, first)) = self.names.get(&name.text) else {
            self.names.insert(name.text.clone(), (symbol, name.span));
            return;
        };
        let message = format!("`{}` is declared twice", name.text);
        let diagnostic =
            Diagnostic::error(Code::DuplicateName, name.span, message).label(*first, "already declared here");
        sink.push(if first.source == name.span.source {
            diagnostic
        } else {
            diagnostic.help("to change what the base declares, write `replace` before the item")
        });
    }

    /// Gives a name its meaning, whatever it stood for.
    pub fn set(&mut self, name: &Ident, symbol: Symbol) {
        self.names.insert(name.text.clone(), (symbol, name.span));
    }

    /// What a name stands for, words of the language included.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<Symbol> {
        let own = self.names.get(name).map(|(symbol, _)| *symbol);
        own.or_else(|| Word::find(name).map(Symbol::Word))
    }

    /// Where a name is declared.
    #[must_use]
    pub fn place(&self, name: &str) -> Option<Span> {
        self.names.get(name).map(|(_, span)| *span)
    }

    /// All declared names with their meaning, sorted.
    pub fn iter(&self) -> impl Iterator<Item = (&str, Symbol)> {
        self.names.iter().map(|(name, (symbol, _))| (name.as_str(), *symbol))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::SourceId;

    fn name(text: &str, source: u16) -> Ident {
        Ident { text: text.into(), span: Span::new(SourceId(source), 0, 1) }
    }

    #[test]
    fn the_first_declaration_wins_and_words_are_no_names() {
        let (mut scope, mut sink) = (Scope::default(), Sink::new());
        scope.declare(&name("a", 0), Symbol::Param(ParamId(0)), &mut sink);
        assert!(sink.is_empty());
        scope.declare(&name("a", 1), Symbol::Let(0), &mut sink);
        scope.declare(&name("pi", 0), Symbol::Let(1), &mut sink);
        let codes: Vec<Code> = sink.iter().map(|d| d.code).collect();
        assert_eq!(codes, [Code::DuplicateName, Code::ReservedName]);
        assert_eq!(scope.get("a"), Some(Symbol::Param(ParamId(0))));
        assert_eq!(scope.get("pi"), Some(Symbol::Word(Word::Pi)));
        assert_eq!(scope.get("b"), None);
    }
}
