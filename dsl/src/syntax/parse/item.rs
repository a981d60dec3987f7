//! Items from pairs.

use super::{Builder, Node, Nodes, Rule, block};
use crate::syntax::ast::{
    Action, Axis, BodyItem, Bounds, Column, Coordinates, Dotted, Drop, DropName, Event, Every, Expr, Field,
    Function, Geometry, Import, Item, ItemKind, Keyword, Let, Local, Motion, Moving, Param, Part, Physics,
    Replacement, Start, State, Sweep, Test, Trigger,
};

impl<'s> Builder<'s> {
    /// `item`: documentation and what it documents.
    pub(super) fn item(&self, node: Node<'s>) -> Option<Item> {
        let mut nodes = node.nodes();
        let docs = docs(&mut nodes);
        let inner = nodes.next()?;
        let span = inner.span();
        let kind = match inner.rule() {
            Rule::replace => ItemKind::Replace(Box::new(self.replacement(inner.only()?)?)),
            Rule::drop => ItemKind::Drop(self.drop_item(inner)?),
            _ => self.item_kind(inner)?,
        };
        Some(Item { docs, kind, span })
    }

    fn replacement(&self, node: Node<'s>) -> Option<Replacement> {
        Some(match node.rule() {
            Rule::gpath => Replacement::Path(self.path(node)?),
            Rule::region => Replacement::Region(self.region(node)?),
            _ => Replacement::Item(self.item_kind(node)?),
        })
    }

    fn drop_item(&self, node: Node<'s>) -> Option<Drop> {
        let mut nodes = node.nodes();
        let kind = Keyword::from_text(nodes.next()?.text())?;
        let name = nodes.next()?;
        let name = match name.rule() {
            Rule::string => DropName::Text(self.quoted(&name)),
            _ => DropName::Name(self.dotted(name)),
        };
        Some(Drop { kind, name })
    }

    fn item_kind(&self, node: Node<'s>) -> Option<ItemKind> {
        let rule = node.rule();
        let mut nodes = node.clone().nodes();
        Some(match rule {
            Rule::model => ItemKind::Model(nodes.ident()?),
            Rule::use_std => ItemKind::Import(import(nodes)),
            Rule::use_part => ItemKind::Part(self.part(nodes)?),
            Rule::extend => ItemKind::Extend(self.quoted(&nodes.next()?)),
            Rule::coords => {
                ItemKind::Coordinates(Coordinates { kind: nodes.ident()?, args: self.args(nodes.next()?)? })
            }
            Rule::units => ItemKind::Units(nodes.map(|unit| unit.ident()).collect()),
            Rule::param => ItemKind::Param(self.param(nodes)?),
            Rule::let_ => ItemKind::Let(self.let_(node)?),
            Rule::fn_ => ItemKind::Fn(self.function(nodes)?),
            Rule::geometry => ItemKind::Geometry(self.geometry(nodes)?),
            Rule::mesh => ItemKind::Mesh(self.children(&block::SETTINGS, nodes)),
            Rule::solve => ItemKind::Solve(self.children(&block::SETTINGS, nodes)),
            Rule::field => ItemKind::Field(self.field(nodes)?),
            Rule::state => ItemKind::State(self.state(nodes)?),
            Rule::local => ItemKind::Local(self.local(node)?),
            Rule::moving => ItemKind::Moving(self.moving(nodes)?),
            Rule::physics => {
                let name = nodes.ident()?;
                ItemKind::Physics(Physics { name, statements: self.children(&block::PHYSICS, nodes) })
            }
            Rule::event => ItemKind::Event(self.event(nodes)?),
            Rule::output => ItemKind::Output(self.children(&block::OUTPUT, nodes)),
            Rule::sweep => ItemKind::Sweep(self.sweep(nodes)?),
            Rule::test => {
                let title = self.quoted(&nodes.next()?);
                ItemKind::Test(Test { title, checks: self.children(&block::TEST, nodes) })
            }
            _ => return None,
        })
    }

    fn part(&self, mut nodes: Nodes<'s>) -> Option<Part> {
        let (file, name) = (self.quoted(&nodes.next()?), nodes.ident()?);
        let inputs = match nodes.next() {
            None => Vec::new(),
            Some(call) => self.args(call)?,
        };
        Some(Part { file, name, inputs })
    }

    fn param(&self, mut nodes: Nodes<'s>) -> Option<Param> {
        let (name, ty) = self.maybe_typed(&mut nodes)?;
        Some(Param { name, ty, value: self.value(&mut nodes)?, bounds: self.maybe_bounds(&mut nodes)? })
    }

    /// `let_`
    pub(super) fn let_(&self, node: Node<'s>) -> Option<Let> {
        let mut nodes = node.nodes();
        let (name, ty) = self.maybe_typed(&mut nodes)?;
        Some(Let { name, ty, value: self.value(&mut nodes)?? })
    }

    fn function(&self, mut nodes: Nodes<'s>) -> Option<Function> {
        let name = nodes.ident()?;
        let mut params = Vec::new();
        while let Some(param) = nodes.maybe(Rule::farg) {
            params.push(self.typed(param)?);
        }
        let result = self.ty(nodes.next()?)?;
        let body = nodes.next()?;
        if body.rule() == Rule::expr {
            return Some(Function { name, params, result, locals: Vec::new(), value: self.expr(body)? });
        }
        let mut inner = body.nodes();
        let mut locals = Vec::new();
        while let Some(node) = inner.maybe_any(&[Rule::let_, Rule::local]) {
            locals.push(match node.rule() {
                Rule::let_ => BodyItem::Let(self.let_(node)?),
                _ => BodyItem::Local(self.local(node)?),
            });
        }
        Some(Function { name, params, result, locals, value: self.expr(inner.next()?)? })
    }

    fn geometry(&self, mut nodes: Nodes<'s>) -> Option<Geometry> {
        if let Some(file) = nodes.maybe(Rule::string) {
            let file = self.quoted(&file);
            return Some(Geometry::Imported { file, items: self.children(&block::GEOMETRY, nodes) });
        }
        match self.value(&mut nodes)? {
            Some(value) => Some(Geometry::Value(value)),
            None => Some(Geometry::Built(self.children(&block::GEOMETRY, nodes))),
        }
    }

    fn field(&self, mut nodes: Nodes<'s>) -> Option<Field> {
        let (name, ty) = (nodes.ident()?, self.ty(nodes.next()?)?);
        let (space, domain) = (nodes.ident()?, self.domain(&mut nodes)??);
        Some(Field { name, ty, space, domain, start: self.start(&mut nodes)? })
    }

    fn state(&self, mut nodes: Nodes<'s>) -> Option<State> {
        let (name, ty) = (nodes.ident()?, self.ty(nodes.next()?)?);
        Some(State { name, ty, start: self.start(&mut nodes)?, bounds: self.maybe_bounds(&mut nodes)? })
    }

    fn local(&self, node: Node<'s>) -> Option<Local> {
        let mut nodes = node.nodes();
        let (name, ty) = (nodes.ident()?, self.ty(nodes.next()?)?);
        Some(Local {
            name,
            ty,
            domain: self.domain(&mut nodes)?,
            start: self.start(&mut nodes)?,
            bounds: self.maybe_bounds(&mut nodes)?,
            equation: self.equation(nodes.next()?)?,
        })
    }

    fn moving(&self, mut nodes: Nodes<'s>) -> Option<Moving> {
        let domain = self.expr(nodes.next()?)?;
        let motion = match nodes.maybe(Rule::name) {
            Some(name) => {
                Motion::Solved { name: name.ident(), statements: self.children(&block::PHYSICS, nodes) }
            }
            None => Motion::Given(self.expr(nodes.next()?)?),
        };
        Some(Moving { domain, motion })
    }

    fn event(&self, mut nodes: Nodes<'s>) -> Option<Event> {
        let name = nodes.ident()?;
        let trigger = nodes.next()?;
        let trigger = match trigger.rule() {
            Rule::when => Trigger::When(self.expr(trigger.only()?)?),
            _ => Trigger::Every(self.every(trigger)?),
        };
        let actions = nodes.map(|action| self.action(action)).collect::<Option<_>>()?;
        Some(Event { name, trigger, actions })
    }

    fn action(&self, node: Node<'s>) -> Option<Action> {
        let span = node.span();
        let mut nodes = node.nodes();
        let name = nodes.ident()?;
        let args = match nodes.next() {
            None => Vec::new(),
            Some(call) => self.args(call)?,
        };
        Some(Action { name, args, span })
    }

    /// `every`
    pub(super) fn every(&self, node: Node<'s>) -> Option<Every> {
        let inner = node.only()?;
        Some(match inner.rule() {
            Rule::step => Every::Step(inner.span()),
            _ => Every::Time(self.expr(inner)?),
        })
    }

    fn sweep(&self, mut nodes: Nodes<'s>) -> Option<Sweep> {
        let name = nodes.ident()?;
        let mut axes = Vec::new();
        while let Some(axis) = nodes.maybe(Rule::axis) {
            axes.push(self.axis(axis)?);
        }
        Some(Sweep { name, axes, columns: self.columns(nodes)? })
    }

    fn axis(&self, node: Node<'s>) -> Option<Axis> {
        let span = node.span();
        let mut nodes = node.nodes();
        let mut names: Vec<Dotted> = Vec::new();
        while let Some(name) = nodes.maybe(Rule::dotted) {
            names.push(self.dotted(name));
        }
        Some(Axis { names, values: self.set(nodes.next()?)?, span })
    }

    /// The columns to the end of the statement.
    pub(super) fn columns(&self, nodes: Nodes<'s>) -> Option<Vec<Column>> {
        nodes.map(|column| self.column(column)).collect()
    }

    fn column(&self, node: Node<'s>) -> Option<Column> {
        let span = node.span();
        let mut nodes = node.nodes();
        let name = nodes.maybe(Rule::ident).map(|name| name.ident());
        let value = self.expr(nodes.next()?)?;
        let unit = match nodes.next() {
            None => None,
            Some(unit) => Some(self.unit_expr(unit)?),
        };
        Some(Column { name, value, unit, span })
    }

    /// An optional `= value`: `Some(None)` where none is written, as in the optional parts below.
    pub(super) fn value(&self, nodes: &mut Nodes<'s>) -> Option<Option<Expr>> {
        self.inner_expr(nodes, Rule::value)
    }

    /// An optional `on DOMAIN`.
    pub(super) fn domain(&self, nodes: &mut Nodes<'s>) -> Option<Option<Expr>> {
        self.inner_expr(nodes, Rule::on)
    }

    fn inner_expr(&self, nodes: &mut Nodes<'s>, rule: Rule) -> Option<Option<Expr>> {
        match nodes.maybe(rule) {
            None => Some(None),
            Some(node) => self.expr(node.only()?).map(Some),
        }
    }

    fn start(&self, nodes: &mut Nodes<'s>) -> Option<Option<Start>> {
        match self.value(nodes)? {
            Some(value) => Some(Some(Start::Value(value))),
            None => Some(self.inner_expr(nodes, Rule::guess)?.map(Start::Guess)),
        }
    }

    fn maybe_bounds(&self, nodes: &mut Nodes<'s>) -> Option<Option<Bounds>> {
        match nodes.maybe(Rule::bounds) {
            None => Some(None),
            Some(bounds) => self.bounds(bounds).map(Some),
        }
    }
}

/// The text of the `///` lines that lead `nodes`.
pub(super) fn docs(nodes: &mut Nodes<'_>) -> String {
    let mut lines = Vec::new();
    while let Some(line) = nodes.maybe(Rule::doc) {
        lines.push(line.text().trim_start_matches('/').trim());
    }
    lines.join("\n")
}

fn import(nodes: Nodes<'_>) -> Import {
    let mut path = Vec::new();
    for node in nodes {
        match node.rule() {
            Rule::use_list => return Import { path, names: node.nodes().map(|name| name.ident()).collect() },
            _ => path.push(node.ident()),
        }
    }
    let names = if path.len() > 1 { path.pop().into_iter().collect() } else { Vec::new() };
    Import { path, names }
}
