//! Blocks: the statements inside braces, and how reading goes on behind a broken one.

use std::ops::Range;

use super::item::docs;
use super::junk::Place;
use super::{Builder, Node, Nodes, Rule};
use crate::diagnostic::{Code, Diagnostic};
use crate::syntax::ast::{
    Check, CheckKind, Curve, GeometryItem, GeometryKind, Item, Output, OutputKind, Over, Path, Region,
    Segment, Setting, SettingValue, Statement, StatementKind, Tolerance, Turn,
};

/// One kind of block: how its inside parses alone, and how its statements are built.
pub(super) struct Block<T> {
    /// The rule of the inside alone.
    rule: Rule,
    /// The rule of one statement.
    statement: Rule,
    /// How broken statements in it are explained.
    place: Place,
    build: for<'s> fn(&Builder<'s>, Node<'s>) -> Option<T>,
}

/// The file itself.
pub(super) const FILE: Block<Item> =
    Block { rule: Rule::file, statement: Rule::item, place: Place::File, build: |b, node| b.item(node) };
/// `geometry { .. }`
pub(super) const GEOMETRY: Block<GeometryItem> = Block {
    rule: Rule::geometry_body,
    statement: Rule::gitem,
    place: Place::Geometry,
    build: |b, node| b.geometry_item(node),
};
/// `mesh { .. }`, `solve { .. }`
pub(super) const SETTINGS: Block<Setting> = Block {
    rule: Rule::setting_body,
    statement: Rule::setting,
    place: Place::Settings,
    build: |b, node| b.setting(node),
};
/// `physics n { .. }`, `moving D by n { .. }`
pub(super) const PHYSICS: Block<Statement> = Block {
    rule: Rule::physics_body,
    statement: Rule::stmt,
    place: Place::Physics,
    build: |b, node| b.statement(node),
};
/// `output { .. }`
pub(super) const OUTPUT: Block<Output> = Block {
    rule: Rule::output_body,
    statement: Rule::record_,
    place: Place::Output,
    build: |b, node| b.output(node),
};
/// `test ".." { .. }`
pub(super) const TEST: Block<Check> = Block {
    rule: Rule::test_body,
    statement: Rule::check,
    place: Place::Test,
    build: |b, node| b.check(node),
};

impl<'s> Builder<'s> {
    /// Parses a stretch of text as the inside of a block.
    pub(super) fn body<T>(&self, block: &Block<T>, stretch: Range<usize>) -> Vec<T> {
        match self.run(block.rule, stretch.clone()) {
            Ok(nodes) => self.children(block, self.unwrap_file(nodes)),
            Err(error) => {
                let at = stretch.start + super::junk::offset(&error);
                let message = "the text cannot be read from here";
                self.report(Diagnostic::error(Code::Expected, self.span(at, at), message));
                Vec::new()
            }
        }
    }

    fn unwrap_file(&self, mut nodes: Nodes<'s>) -> Nodes<'s> {
        match nodes.next() {
            Some(file) => file.nodes(),
            None => nodes,
        }
    }

    /// Builds the statements of a block and explains what is none. Behind a broken statement reading goes on at the
    /// next line that starts like a statement of this block.
    pub(super) fn children<T>(&self, block: &Block<T>, nodes: Nodes<'s>) -> Vec<T> {
        let mut built = Vec::new();
        let mut stack = vec![nodes];
        while let Some(nodes) = stack.last_mut() {
            let Some(node) = nodes.next() else {
                stack.pop();
                continue;
            };
            let (rule, span) = (node.rule(), node.span());
            if rule == block.statement {
                match (block.build)(self, node) {
                    Some(statement) => built.push(statement),
                    None => self.disagreement(span),
                }
            } else if rule == Rule::closer {
                let message = "this `}` closes nothing";
                self.report(Diagnostic::error(Code::UnbalancedBracket, span, message));
            } else if self.has_room() {
                let end = node.range().end;
                if let Some(start) = self.explain_junk(block.place, node.range())
                    && let Ok(more) = self.run(block.rule, start..end)
                {
                    stack.push(self.unwrap_file(more));
                }
            }
        }
        built
    }

    fn geometry_item(&self, node: Node<'s>) -> Option<GeometryItem> {
        let mut nodes = node.nodes();
        let docs = docs(&mut nodes);
        let inner = nodes.next()?;
        let span = inner.span();
        let kind = match inner.rule() {
            Rule::let_ => GeometryKind::Let(self.let_(inner)?),
            Rule::gpath => GeometryKind::Path(self.path(inner)?),
            Rule::region => GeometryKind::Region(self.region(inner)?),
            Rule::regions => GeometryKind::Regions(inner.nodes().map(|name| self.dotted(name)).collect()),
            _ => GeometryKind::Paths(inner.nodes().map(|name| self.dotted(name)).collect()),
        };
        Some(GeometryItem { docs, kind, span })
    }

    /// `gpath`
    pub(super) fn path(&self, node: Node<'s>) -> Option<Path> {
        let mut nodes = node.nodes();
        let (name, start) = (nodes.ident()?, self.expr(nodes.next()?)?);
        let segments = nodes.map(|segment| self.segment(segment)).collect::<Option<_>>()?;
        Some(Path { name, start, segments })
    }

    fn segment(&self, node: Node<'s>) -> Option<Segment> {
        let span = node.span();
        let mut nodes = node.nodes();
        let label = match nodes.maybe(Rule::label) {
            None => None,
            Some(label) => label.nodes().ident(),
        };
        let first = self.expr(nodes.next()?)?;
        let Some(turn) = nodes.next() else {
            return Some(Segment { label, curve: Curve::Line, to: first, span });
        };
        let turn = if turn.text() == "ccw" { Turn::CounterClockwise } else { Turn::Clockwise };
        Some(Segment { label, curve: Curve::Arc { about: first, turn }, to: self.expr(nodes.next()?)?, span })
    }

    /// `region`
    pub(super) fn region(&self, node: Node<'s>) -> Option<Region> {
        let mut nodes = node.nodes();
        Some(Region { name: nodes.ident()?, value: self.value(&mut nodes)?? })
    }

    fn setting(&self, node: Node<'s>) -> Option<Setting> {
        let span = node.span();
        let mut nodes = node.nodes();
        let name = nodes.ident()?;
        let value = match nodes.maybe(Rule::times) {
            Some(times) => SettingValue::Range(self.range(times.only()?)?),
            None => SettingValue::Expr(self.value(&mut nodes)??),
        };
        Some(Setting { name, value, domain: self.domain(&mut nodes)?, span })
    }

    fn statement(&self, node: Node<'s>) -> Option<Statement> {
        let inner = node.only()?;
        let (rule, span) = (inner.rule(), inner.span());
        let mut nodes = inner.clone().nodes();
        let kind = match rule {
            Rule::let_ => StatementKind::Let(self.let_(inner)?),
            Rule::energy => {
                StatementKind::Energy { density: self.expr(nodes.next()?)?, domain: self.domain(&mut nodes)? }
            }
            Rule::residual => {
                StatementKind::Residual { form: self.expr(nodes.next()?)?, domain: self.domain(&mut nodes)? }
            }
            Rule::load => StatementKind::Load {
                quantity: self.expr(nodes.next()?)?,
                force: self.expr(nodes.next()?)?,
                domain: self.domain(&mut nodes)?,
            },
            Rule::hold => StatementKind::Hold {
                quantity: self.expr(nodes.next()?)?,
                value: self.value(&mut nodes)??,
                domain: self.domain(&mut nodes)?,
            },
            Rule::tie => StatementKind::Tie {
                equation: self.equation(nodes.next()?)?,
                domain: self.domain(&mut nodes)?,
            },
            _ => StatementKind::Equation(self.equation(nodes.next()?)?),
        };
        Some(Statement { kind, span })
    }

    fn output(&self, node: Node<'s>) -> Option<Output> {
        let inner = node.only()?;
        let (rule, span) = (inner.rule(), inner.span());
        let mut nodes = inner.nodes();
        let kind = match rule {
            Rule::fields => OutputKind::Fields {
                domain: self.domain(&mut nodes)??,
                every: self.every(nodes.next()?)?,
                columns: self.columns(nodes)?,
            },
            Rule::table => OutputKind::Table {
                file: self.quoted(&nodes.next()?),
                every: self.every(nodes.next()?)?,
                columns: self.columns(nodes)?,
            },
            _ => OutputKind::Checkpoint { every: self.every(nodes.next()?)? },
        };
        Some(Output { kind, span })
    }

    fn check(&self, node: Node<'s>) -> Option<Check> {
        let inner = node.only()?;
        let (rule, span) = (inner.rule(), inner.span());
        let kind = match rule {
            Rule::let_ => CheckKind::Let(self.let_(inner)?),
            Rule::each => self.each(inner.nodes())?,
            _ => self.expect(inner.nodes())?,
        };
        Some(Check { kind, span })
    }

    fn each(&self, mut nodes: Nodes<'s>) -> Option<CheckKind> {
        let name = nodes.ident()?;
        let first = nodes.next()?;
        let over = match first.rule() {
            Rule::set => Over::Set(self.set(first)?),
            _ => Over::Steps { range: self.range(first)?, by: self.expr(nodes.next()?)? },
        };
        Some(CheckKind::Each { name, over, checks: self.children(&TEST, nodes) })
    }

    fn expect(&self, mut nodes: Nodes<'s>) -> Option<CheckKind> {
        let left = self.expr(nodes.next()?)?;
        let Some(right) = nodes.next() else { return Some(CheckKind::Expect(left)) };
        let (right, within) = (self.expr(right)?, self.expr(nodes.next()?)?);
        let percent = nodes.next().is_some();
        let tolerance = if percent { Tolerance::Percent(within) } else { Tolerance::Absolute(within) };
        Some(CheckKind::Near { left, right, tolerance })
    }
}
