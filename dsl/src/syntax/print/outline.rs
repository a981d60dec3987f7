//! A file as an indented outline: one line for each item or statement, one for each of its parts.

use std::fmt::Write as _;

use super::expr::{
    arg_to_string, bounds_to_string, expr_to_string, list, range_to_string, set_to_string, type_to_string,
    typed_to_string,
};
use crate::syntax::ast::{
    Action, Axis, BodyItem, Bounds, Check, CheckKind, Column, Curve, Dotted, DropName, Equation, Every, Expr,
    File, Function, Geometry, GeometryItem, GeometryKind, Ident, Item, ItemKind, Let, Local, Motion, Output,
    OutputKind, Over, Path, Region, Replacement, Setting, SettingValue, Start, Statement, StatementKind,
    Tolerance, Trigger, Turn, TypeExpr,
};

/// The file as an indented outline.
pub fn outline(file: &File) -> String {
    let mut out = Outline { text: String::new(), depth: 0 };
    file.items.iter().for_each(|item| out.item(item));
    if !file.broken.is_empty() {
        out.line(&format!("broken: {}", names(&file.broken)));
    }
    out.text
}

struct Outline {
    text: String,
    depth: usize,
}

impl Outline {
    fn line(&mut self, text: &str) {
        // Writing to a `String` cannot fail.
        let _ = writeln!(self.text, "{:indent$}{text}", "", indent = 2 * self.depth);
    }

    fn inside(&mut self, body: impl FnOnce(&mut Self)) {
        self.depth += 1;
        body(self);
        self.depth -= 1;
    }

    fn docs(&mut self, docs: &str) {
        docs.lines().for_each(|line| self.line(&format!("/// {line}")));
    }

    fn part(&mut self, name: &str, value: Option<String>) {
        if let Some(value) = value {
            self.inside(|out| out.line(&format!("{name}: {value}")));
        }
    }

    fn expr(&mut self, name: &str, value: Option<&Expr>) {
        self.part(name, value.map(expr_to_string));
    }

    fn ty(&mut self, ty: Option<&TypeExpr>) {
        self.part("type", ty.map(type_to_string));
    }

    fn bounds(&mut self, bounds: Option<&Bounds>) {
        self.part("in", bounds.map(bounds_to_string));
    }

    fn start(&mut self, start: Option<&Start>) {
        match start {
            None => {}
            Some(Start::Value(value)) => self.expr("start", Some(value)),
            Some(Start::Guess(value)) => self.expr("guess", Some(value)),
        }
    }

    fn item(&mut self, item: &Item) {
        self.docs(&item.docs);
        self.item_kind(&item.kind);
    }

    fn item_kind(&mut self, item: &ItemKind) {
        match item {
            ItemKind::Model(name) => self.line(&format!("model {}", name.text)),
            ItemKind::Import(import) => {
                let path = import.path.iter().map(|part| part.text.as_str()).collect::<Vec<_>>().join("::");
                self.line(&format!("use {path}"));
                self.part("names", Some(names(&import.names)));
            }
            ItemKind::Part(part) => {
                self.line(&format!("use \"{}\" as {}", part.file.value, part.name.text));
                part.inputs.iter().for_each(|input| self.part("input", Some(arg_to_string(input))));
            }
            ItemKind::Extend(file) => self.line(&format!("extend \"{}\"", file.value)),
            ItemKind::Coordinates(c) => {
                self.line(&format!("coordinates {}({})", c.kind.text, list(&c.args, arg_to_string)));
            }
            ItemKind::Units(units) => self.line(&format!("units {}", names(units))),
            ItemKind::Param(param) => {
                self.line(&format!("param {}", param.name.text));
                self.ty(param.ty.as_ref());
                self.expr("value", param.value.as_ref());
                self.bounds(param.bounds.as_ref());
            }
            ItemKind::Let(let_) => self.let_(let_),
            ItemKind::Fn(function) => self.function(function),
            ItemKind::Geometry(geometry) => self.geometry(geometry),
            ItemKind::Mesh(settings) => self.block("mesh", settings, Self::setting),
            ItemKind::Solve(settings) => self.block("solve", settings, Self::setting),
            ItemKind::Field(field) => {
                self.line(&format!("field {}", field.name.text));
                self.ty(Some(&field.ty));
                self.part("space", Some(field.space.text.clone()));
                self.expr("on", Some(&field.domain));
                self.start(field.start.as_ref());
            }
            ItemKind::State(state) => {
                self.line(&format!("state {}", state.name.text));
                self.ty(Some(&state.ty));
                self.start(state.start.as_ref());
                self.bounds(state.bounds.as_ref());
            }
            ItemKind::Local(local) => self.local(local),
            ItemKind::Moving(moving) => {
                self.line(&format!("moving {}", expr_to_string(&moving.domain)));
                match &moving.motion {
                    Motion::Given(value) => self.expr("by", Some(value)),
                    Motion::Solved { name, statements } => {
                        self.part("by", Some(name.text.clone()));
                        self.inside(|out| statements.iter().for_each(|statement| out.statement(statement)));
                    }
                }
            }
            ItemKind::Physics(physics) => {
                self.block(&format!("physics {}", physics.name.text), &physics.statements, Self::statement);
            }
            ItemKind::Event(event) => {
                self.line(&format!("event {}", event.name.text));
                match &event.trigger {
                    Trigger::When(condition) => self.expr("when", Some(condition)),
                    Trigger::Every(every) => self.every(every),
                }
                event.actions.iter().for_each(|action| self.part("action", Some(action_to_string(action))));
            }
            ItemKind::Output(outputs) => self.block("output", outputs, Self::output),
            ItemKind::Sweep(sweep) => {
                self.line(&format!("sweep {}", sweep.name.text));
                sweep.axes.iter().for_each(|axis| self.part("axis", Some(axis_to_string(axis))));
                self.columns(&sweep.columns);
            }
            ItemKind::Test(test) => {
                self.block(&format!("test \"{}\"", test.title.value), &test.checks, Self::check)
            }
            ItemKind::Replace(replacement) => {
                self.line("replace");
                self.inside(|out| match replacement.as_ref() {
                    Replacement::Item(item) => out.item_kind(item),
                    Replacement::Path(path) => out.path(path),
                    Replacement::Region(region) => out.region(region),
                });
            }
            ItemKind::Drop(drop) => {
                let name = match &drop.name {
                    DropName::Name(name) => name.text(),
                    DropName::Text(text) => format!("\"{}\"", text.value),
                };
                self.line(&format!("drop {} {name}", drop.kind.text()));
            }
        }
    }

    fn block<T>(&mut self, head: &str, statements: &[T], print: impl Fn(&mut Self, &T)) {
        self.line(head);
        self.inside(|out| statements.iter().for_each(|statement| print(out, statement)));
    }

    fn let_(&mut self, let_: &Let) {
        self.line(&format!("let {}", let_.name.text));
        self.ty(let_.ty.as_ref());
        self.expr("value", Some(&let_.value));
    }

    fn local(&mut self, local: &Local) {
        self.line(&format!("local {}", local.name.text));
        self.ty(Some(&local.ty));
        self.expr("on", local.domain.as_ref());
        self.start(local.start.as_ref());
        self.bounds(local.bounds.as_ref());
        self.part("where", Some(equation_to_string(&local.equation)));
    }

    fn function(&mut self, function: &Function) {
        self.line(&format!("fn {}({})", function.name.text, list(&function.params, typed_to_string)));
        self.part("result", Some(type_to_string(&function.result)));
        self.inside(|out| {
            for item in &function.locals {
                match item {
                    BodyItem::Let(let_) => out.let_(let_),
                    BodyItem::Local(local) => out.local(local),
                }
            }
        });
        self.expr("value", Some(&function.value));
    }

    fn geometry(&mut self, geometry: &Geometry) {
        match geometry {
            Geometry::Built(items) => self.block("geometry", items, Self::geometry_item),
            Geometry::Imported { file, items } => {
                self.block(&format!("geometry \"{}\"", file.value), items, Self::geometry_item);
            }
            Geometry::Value(value) => {
                self.line("geometry");
                self.expr("value", Some(value));
            }
        }
    }

    fn geometry_item(&mut self, item: &GeometryItem) {
        self.docs(&item.docs);
        match &item.kind {
            GeometryKind::Let(let_) => self.let_(let_),
            GeometryKind::Path(path) => self.path(path),
            GeometryKind::Region(region) => self.region(region),
            GeometryKind::Regions(names) => self.line(&format!("regions {}", list(names, Dotted::text))),
            GeometryKind::Paths(names) => self.line(&format!("paths {}", list(names, Dotted::text))),
        }
    }

    fn path(&mut self, path: &Path) {
        self.line(&format!("path {}", path.name.text));
        self.expr("from", Some(&path.start));
        for segment in &path.segments {
            let curve = match &segment.curve {
                Curve::Line => String::from("line"),
                Curve::Arc { about, turn } => {
                    let turn = if *turn == Turn::Clockwise { "cw" } else { "ccw" };
                    format!("arc about {} {turn}", expr_to_string(about))
                }
            };
            let label = segment.label.as_ref().map_or("segment", |label| label.text.as_str());
            self.part(label, Some(format!("{curve} to {}", expr_to_string(&segment.to))));
        }
    }

    fn region(&mut self, region: &Region) {
        self.line(&format!("region {}", region.name.text));
        self.expr("value", Some(&region.value));
    }

    fn setting(&mut self, setting: &Setting) {
        let value = match &setting.value {
            SettingValue::Expr(value) => expr_to_string(value),
            SettingValue::Range(range) => range_to_string(range),
        };
        self.line(&format!("{} = {value}", setting.name.text));
        self.expr("on", setting.domain.as_ref());
    }

    fn statement(&mut self, statement: &Statement) {
        let (line, domain) = match &statement.kind {
            StatementKind::Let(let_) => return self.let_(let_),
            StatementKind::Energy { density, domain } => {
                (format!("energy {}", expr_to_string(density)), domain)
            }
            StatementKind::Residual { form, domain } => {
                (format!("residual {}", expr_to_string(form)), domain)
            }
            StatementKind::Load { quantity, force, domain } => {
                (format!("load {} with {}", expr_to_string(quantity), expr_to_string(force)), domain)
            }
            StatementKind::Hold { quantity, value, domain } => {
                (format!("hold {} = {}", expr_to_string(quantity), expr_to_string(value)), domain)
            }
            StatementKind::Tie { equation, domain } => {
                (format!("tie {}", equation_to_string(equation)), domain)
            }
            StatementKind::Equation(equation) => (equation_to_string(equation), &None),
        };
        self.line(&line);
        self.expr("on", domain.as_ref());
    }

    fn output(&mut self, output: &Output) {
        match &output.kind {
            OutputKind::Fields { domain, every, columns } => {
                self.line("fields");
                self.expr("on", Some(domain));
                self.every(every);
                self.columns(columns);
            }
            OutputKind::Table { file, every, columns } => {
                self.line(&format!("table \"{}\"", file.value));
                self.every(every);
                self.columns(columns);
            }
            OutputKind::Checkpoint { every } => {
                self.line("checkpoint");
                self.every(every);
            }
        }
    }

    fn every(&mut self, every: &Every) {
        let every = match every {
            Every::Step(_) => String::from("step"),
            Every::Time(time) => expr_to_string(time),
        };
        self.part("every", Some(every));
    }

    fn columns(&mut self, columns: &[Column]) {
        for column in columns {
            let name = column.name.as_ref().map_or(String::new(), |name| format!("{} = ", name.text));
            let unit = column.unit.as_ref().map_or(String::new(), |unit| format!(" as {}", unit.text));
            self.part("column", Some(format!("{name}{}{unit}", expr_to_string(&column.value))));
        }
    }

    fn check(&mut self, check: &Check) {
        match &check.kind {
            CheckKind::Let(let_) => self.let_(let_),
            CheckKind::Each { name, over, checks } => {
                let over = match over {
                    Over::Set(set) => set_to_string(set),
                    Over::Steps { range, by } => {
                        format!("{} by {}", range_to_string(range), expr_to_string(by))
                    }
                };
                self.block(&format!("for {} in {over}", name.text), checks, Self::check);
            }
            CheckKind::Expect(claim) => self.line(&format!("expect {}", expr_to_string(claim))),
            CheckKind::Near { left, right, tolerance } => {
                self.line(&format!("expect {} ~= {}", expr_to_string(left), expr_to_string(right)));
                match tolerance {
                    Tolerance::Absolute(within) => self.expr("within", Some(within)),
                    Tolerance::Percent(within) => {
                        self.part("within", Some(format!("{} %", expr_to_string(within))))
                    }
                }
            }
        }
    }
}

fn names(names: &[Ident]) -> String {
    list(names, |name| name.text.clone())
}

fn equation_to_string(equation: &Equation) -> String {
    format!("{} == {}", expr_to_string(&equation.left), expr_to_string(&equation.right))
}

fn action_to_string(action: &Action) -> String {
    match action.args.as_slice() {
        [] => action.name.text.clone(),
        args => format!("{}({})", action.name.text, list(args, arg_to_string)),
    }
}

fn axis_to_string(axis: &Axis) -> String {
    format!("{} in {}", list(&axis.names, Dotted::text), set_to_string(&axis.values))
}
