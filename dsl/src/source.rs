//! Source texts and places in them: what every later stage points at when it has something to say.
//!
//! A model is compiled from several texts (the file itself, what it extends, the parts and library files that it
//! uses). [`SourceMap`] owns them all; a [`Span`] names one text and a stretch of bytes in it and is small enough
//! to be copied into every node of every tree.

/// Which text of a [`SourceMap`] a span lies in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceId(pub u16);

/// A half-open stretch of bytes `start .. end` in one text. Ordered by text, then by place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// The text.
    pub source: SourceId,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The stretch `start .. end` of `source`; an `end` before `start` gives an empty span at `start`.
    pub fn new(source: SourceId, start: usize, end: usize) -> Self {
        let clamp = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        Self { source, start: clamp(start), end: clamp(end.max(start)) }
    }

    /// The smallest span that covers both; `self` where the two lie in different texts.
    pub fn to(self, other: Span) -> Span {
        if self.source != other.source {
            return self;
        }
        Span { source: self.source, start: self.start.min(other.start), end: self.end.max(other.end) }
    }

    /// The empty span just behind this one.
    pub fn after(self) -> Span {
        Span { start: self.end, ..self }
    }

    /// The byte range.
    pub fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// One-based line and column, the column counted in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

/// One text and the name that messages show for it.
#[derive(Clone, Debug)]
pub struct Source {
    /// Its number in the map.
    pub id: SourceId,
    /// The path as the user wrote it, or a label such as `std::solid`.
    pub name: String,
    /// The whole text.
    pub text: String,
}

impl Source {
    /// A text that stands alone, as number 0.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { id: SourceId(0), name: name.into(), text: text.into() }
    }

    /// The text under `span`; empty where the span does not fit this text.
    pub fn slice(&self, span: Span) -> &str {
        self.text.get(span.range()).unwrap_or("")
    }

    /// The span of the whole text.
    pub fn span(&self) -> Span {
        Span::new(self.id, 0, self.text.len())
    }

    /// Line and column of a byte; a place past the end counts as the end.
    pub fn position(&self, byte: u32) -> Position {
        let mut end = (byte as usize).min(self.text.len());
        while !self.text.is_char_boundary(end) {
            end -= 1;
        }
        let before = &self.text[..end];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Position {
            line: before.bytes().filter(|&b| b == b'\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }
}

/// What some editors write before a text in UTF-8.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// Every text of one compilation, in the order in which they were read.
#[derive(Clone, Debug, Default)]
pub struct SourceMap {
    sources: Vec<Source>,
}

impl SourceMap {
    /// An empty map.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a text, without the byte order mark that some editors put first, and gives it the next number. Numbers past `u16::MAX` all fall on the last one.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<String>) -> SourceId {
        let id = SourceId(u16::try_from(self.sources.len()).unwrap_or(u16::MAX));
        let mut text: String = text.into();
        if text.starts_with(BYTE_ORDER_MARK) {
            text.remove(0);
        }
        self.sources.push(Source { id, name: name.into(), text });
        id
    }

    /// The text with this number, if the map holds it.
    pub fn get(&self, id: SourceId) -> Option<&Source> {
        self.sources.get(usize::from(id.0))
    }

    /// The text shown under this name, if it has been read already.
    pub fn find(&self, name: &str) -> Option<&Source> {
        self.sources.iter().find(|source| source.name == name)
    }

    /// All texts, in order.
    pub fn iter(&self) -> impl Iterator<Item = &Source> {
        self.sources.iter()
    }

    /// The characters under `span`; empty for a span of another map.
    pub fn slice(&self, span: Span) -> &str {
        self.get(span.source).map_or("", |source| source.slice(span))
    }

    /// `name:line:column` of where `span` starts.
    pub fn locate(&self, span: Span) -> String {
        match self.get(span.source) {
            Some(source) => {
                let at = source.position(span.start);
                format!("{}:{}:{}", source.name, at.line, at.column)
            }
            None => String::from("unknown place"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_count_lines_and_characters_from_one() {
        let source = Source::new("a", "ab\nµd\n");
        assert_eq!(source.position(0), Position { line: 1, column: 1 });
        assert_eq!(source.position(5), Position { line: 2, column: 2 });
        assert_eq!(
            source.position(4),
            Position { line: 2, column: 1 },
            "inside a character counts as its start"
        );
        assert_eq!(source.position(99), Position { line: 3, column: 1 });
    }

    #[test]
    fn a_span_that_does_not_fit_reads_as_empty() {
        let mut map = SourceMap::new();
        let id = map.add("a", "abc");
        assert_eq!(map.slice(Span::new(id, 1, 3)), "bc");
        assert_eq!(map.slice(Span::new(id, 1, 9)), "");
        assert_eq!(map.slice(Span::new(SourceId(7), 0, 1)), "");
        assert_eq!(map.locate(Span::new(id, 2, 3)), "a:1:3");
    }

    #[test]
    fn joining_spans_covers_both_and_never_leaves_a_text() {
        let id = SourceId(0);
        assert_eq!(Span::new(id, 5, 7).to(Span::new(id, 1, 2)), Span::new(id, 1, 7));
        assert_eq!(Span::new(id, 5, 7).to(Span::new(SourceId(1), 1, 2)), Span::new(id, 5, 7));
        assert_eq!(Span::new(id, 5, 3), Span::new(id, 5, 5));
    }
}
