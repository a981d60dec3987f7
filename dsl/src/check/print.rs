//! The checked model as text: every item with its types, numbers in coherent units. For reading, not for compiling again.

mod expr;

use super::dae::{Owner, owners};
use super::domain::piece_words;
use super::unit::{type_text, words};
use crate::model::{
    Action, Bounds, Check, Column, Domain, Event, Every, Expr, Field, Frame, Function, Model, Param, Path,
    Piece, SegmentKind, Shape, Start, State, Statement, StatementKind, Sweep, Trigger, Turn, Type, Values,
};
use std::fmt::Write;

impl Model {
    /// The whole model, item by item.
    #[must_use]
    pub fn print(&self) -> String {
        let mut text = format!("model {}\n", self.name);
        let frame = match self.coordinates.frame {
            Frame::Axisymmetric => "axisymmetric",
            Frame::PlaneStrain => "plane_strain",
        };
        let _ = writeln!(text, "coordinates {frame}({})\n", self.coordinates.names.join(", "));
        for item in self.items() {
            text.push_str(&item);
            text.push('\n');
        }
        text
    }

    fn items(&self) -> Vec<String> {
        let mut items: Vec<String> = self.params.iter().map(|param| self.param(param)).collect();
        items.extend(self.lets.iter().map(|item| {
            format!("let {}: {} = {}", item.name, self.ty(&item.value.ty), self.expr(&item.value))
        }));
        items.extend(self.functions.iter().map(|function| self.function(function)));
        items.extend(self.geometry.paths.iter().map(|path| self.path(path)));
        items.extend(self.geometry.regions.iter().map(|region| {
            let boundary = region.boundary.iter().map(|piece| self.piece(*piece)).collect::<Vec<_>>();
            format!("region {} = loop({})", region.name, boundary.join(", "))
        }));
        items.extend(self.mesh_settings());
        items.extend(self.fields.iter().map(|field| self.field(field)));
        items.extend(self.state_items());
        items.extend(self.pairs.iter().map(|pair| {
            let (first, second) = (self.domain(&pair.first), self.domain(&pair.second));
            format!("pair {} = {first} against {second} within {}", pair.name, self.expr(&pair.search))
        }));
        items.extend(self.blocks.iter().map(|block| {
            let statements =
                block.statements.iter().map(|statement| format!("    {}\n", self.statement(statement)));
            format!("physics {} {{\n{}}}", block.name, statements.collect::<String>())
        }));
        items.extend(self.events.iter().map(|event| self.event(event)));
        items.push(self.solve_settings());
        items.extend(self.outputs());
        items.extend(self.sweep_items());
        items.extend(self.tests.iter().map(|test| {
            let run = if test.needs_run { " after a run" } else { "" };
            format!("test \"{}\"{run} {{\n{}}}", test.title, self.checks(&test.checks, 1))
        }));
        items
    }

    fn ty(&self, ty: &Type) -> String {
        words(&self.units, ty)
    }

    fn param(&self, param: &Param) -> String {
        let ty = Type::Value(Shape::Scalar, param.dimension);
        let bounds = match &param.bounds {
            None => String::new(),
            Some(Bounds::Range(low, high)) => format!(" in {} .. {}", self.expr(low), self.expr(high)),
            Some(Bounds::Set(items)) => format!(" in {{{}}}", self.list(items)),
        };
        format!("param {}: {} = {}{bounds}", param.name, self.ty(&ty), self.expr(&param.default))
    }

    fn function(&self, function: &Function) -> String {
        let arguments =
            function.arguments.iter().map(|(id, ty)| format!("{}: {}", self.locals[id.0], type_text(ty)));
        let head = format!(
            "fn {}({}) -> {}",
            function.name,
            arguments.collect::<Vec<_>>().join(", "),
            type_text(&function.result.ty)
        );
        let lets: String = function
            .lets
            .iter()
            .map(|(id, value)| format!("    let {} = {}\n", self.locals[id.0], self.expr(value)))
            .collect();
        match lets.is_empty() {
            true => format!("{head} = {}", self.expr(&function.result)),
            false => format!("{head} = {{\n{lets}    {}\n}}", self.expr(&function.result)),
        }
    }

    fn path(&self, path: &Path) -> String {
        let mut text = format!("path {} = from {}", path.name, self.expr(&path.start));
        for segment in &path.segments {
            let label = segment.label.as_ref().map_or(String::new(), |label| format!(" {label}"));
            let to = self.expr(&segment.to);
            let _ = match &segment.kind {
                SegmentKind::Line => write!(text, "\n    line{label} to {to}"),
                SegmentKind::Arc { about, turn } => {
                    let turn = match turn {
                        Turn::Counterclockwise => "ccw",
                        Turn::Clockwise => "cw",
                    };
                    write!(text, "\n    arc{label} about {} {turn} to {to}", self.expr(about))
                }
            };
        }
        text
    }

    fn mesh_settings(&self) -> Vec<String> {
        let mesh = &self.mesh;
        let sizes = mesh
            .sizes
            .iter()
            .map(|(size, domain)| format!("mesh size = {}{}", self.expr(size), self.on(domain.as_ref())));
        let growth = mesh.growth.iter().map(|e| format!("mesh growth = {}", self.expr(e)));
        let quality = mesh.quality.iter().map(|e| format!("mesh quality = {}", self.expr(e)));
        sizes.chain(growth).chain(quality).collect()
    }

    fn field(&self, field: &Field) -> String {
        let ty = self.ty(&Type::Value(field.shape, field.dimension));
        let (space, domain) = (field.space, self.domain(&field.domain));
        format!("field {}: {ty} in {space:?} on {domain}{}", field.name, self.start(&field.start))
    }

    fn start(&self, start: &Start) -> String {
        match start {
            Start::Value(e) => format!(" = {}", self.expr(e)),
            Start::Guess(e) => format!(" ~ {}", self.expr(e)),
            Start::Solved => String::new(),
        }
    }

    /// States with what determines them.
    fn state_items(&self) -> Vec<String> {
        let owners = owners(self);
        let item = |(state, owner): (&State, Owner)| {
            let ty = self.ty(&Type::Value(Shape::Scalar, state.dimension));
            let bounds = state.bounds.as_ref().map_or(String::new(), |(low, high)| {
                format!(" in {} .. {}", self.expr(low), self.expr(high))
            });
            let owner = match owner {
                Owner::Equation(block, at) => format!("equation {} of {}", at + 1, self.blocks[block.0].name),
                Owner::Energy => "the energies".into(),
            };
            format!("state {}: {ty}{}{bounds}, determined by {owner}", state.name, self.start(&state.start))
        };
        self.states.iter().zip(owners).map(item).collect()
    }

    fn statement(&self, statement: &Statement) -> String {
        match &statement.kind {
            StatementKind::Energy(e, domain) => {
                format!("energy {}{}", self.expr(e), self.on(domain.as_ref()))
            }
            StatementKind::Residual(e, domain) => {
                format!("residual {} on {}", self.expr(e), self.domain(domain))
            }
            StatementKind::Load(q, f, domain) => {
                format!("load {} with {}{}", self.expr(q), self.expr(f), self.on(domain.as_ref()))
            }
            StatementKind::Tie(tie, domain) => {
                let [field, partner] = [tie.field, tie.partner].map(|f| &self.fields[f.0].name);
                let partner = if tie.rate { format!("dt({partner})") } else { partner.clone() };
                format!("tie {field} == {partner} on {}", self.domain(domain))
            }
            StatementKind::Hold(field, component, value, domain) => {
                let component = component.map_or(String::new(), |i| format!(".{}", self.axis(i)));
                let name = &self.fields[field.0].name;
                format!("hold {name}{component} = {} on {}", self.expr(value), self.domain(domain))
            }
            StatementKind::Equation(a, b) => format!("{} == {}", self.expr(a), self.expr(b)),
        }
    }

    fn on(&self, domain: Option<&Domain>) -> String {
        domain.map_or(String::new(), |domain| format!(" on {}", self.domain(domain)))
    }

    fn domain(&self, domain: &Domain) -> String {
        let pieces = domain.pieces.iter().map(|piece| self.piece(*piece)).collect::<Vec<_>>().join(" + ");
        if domain.current { format!("current({pieces})") } else { pieces }
    }

    fn piece(&self, piece: Piece) -> String {
        piece_words(&self.geometry, &self.pairs, piece).replace('`', "")
    }

    fn event(&self, event: &Event) -> String {
        let trigger = match &event.trigger {
            Trigger::When(condition) => format!("when {}", self.expr(condition)),
            Trigger::EveryStep => "every step".into(),
            Trigger::Every(time) => format!("every {}", self.expr(time)),
        };
        let actions = event.actions.iter().map(|action| match action {
            Action::Stop => "stop".into(),
            Action::Warn(text) => format!("warn(\"{text}\")"),
            Action::Set(id, value) => format!("set({}: {})", self.states[id.0].name, self.expr(value)),
            Action::Remesh(domain) => format!("remesh({})", self.domain(domain)),
        });
        let actions = actions.collect::<Vec<String>>().join(", ");
        let arrow = if actions.is_empty() { "" } else { " => " };
        format!("event {} {trigger}{arrow}{actions}", event.name)
    }

    fn solve_settings(&self) -> String {
        let solve = &self.solve;
        let time = match &solve.time {
            Some((from, to)) => format!("from {} to {}", self.expr(from), self.expr(to)),
            None => "stationary".into(),
        };
        let step = |name: &str, e: &Option<Expr>| {
            e.as_ref().map_or(String::new(), |e| format!(", {name} step {}", self.expr(e)))
        };
        format!(
            "solve {time}, {:?} to {}{}{}, Newton to {} in {}",
            solve.integrator,
            self.expr(&solve.step_tolerance),
            step("largest", &solve.max_step),
            step("smallest", &solve.min_step),
            self.expr(&solve.newton_tolerance),
            self.expr(&solve.newton_iterations),
        )
    }

    fn outputs(&self) -> Vec<String> {
        let columns = |columns: &[Column]| {
            columns
                .iter()
                .map(|column| {
                    format!("\n    {} [{}] = {}", column.name, column.unit.1, self.expr(&column.value))
                })
                .collect::<String>()
        };
        let output = &self.output;
        let frames = output.frames.iter().map(|frames| {
            format!(
                "fields on {} every {}:{}",
                self.domain(&frames.domain),
                self.every(&frames.every),
                columns(&frames.columns)
            )
        });
        let tables = output.tables.iter().map(|table| {
            format!("table \"{}\" every {}:{}", table.file, self.every(&table.every), columns(&table.columns))
        });
        let checkpoint =
            output.checkpoint.iter().map(|every| format!("checkpoint every {}", self.every(every)));
        frames.chain(tables).chain(checkpoint).collect()
    }

    fn every(&self, every: &Every) -> String {
        match every {
            Every::Step => "step".into(),
            Every::Time(time) => self.expr(time),
        }
    }

    fn sweep_items(&self) -> Vec<String> {
        let item = |sweep: &Sweep| {
            let axes = sweep.axes.iter().map(|(params, values)| {
                let names =
                    params.iter().map(|id| self.params[id.0].name.as_str()).collect::<Vec<_>>().join(", ");
                let values = values.iter().map(|tuple| self.list(tuple)).collect::<Vec<_>>().join("; ");
                format!("{names} in {{{values}}}")
            });
            let columns = sweep.columns.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ");
            format!("sweep {}: {} => {columns}", sweep.name, axes.collect::<Vec<_>>().join(", "))
        };
        self.sweeps.iter().map(item).collect()
    }

    fn checks(&self, checks: &[Check], depth: usize) -> String {
        checks.iter().map(|check| format!("{}{}\n", "    ".repeat(depth), self.check(check, depth))).collect()
    }

    fn check(&self, check: &Check, depth: usize) -> String {
        match check {
            Check::Let(id, value) => format!("let {} = {}", self.locals[id.0], self.expr(value)),
            Check::Each(id, values, checks) => {
                let values = match values {
                    Values::Range { from, to, by } => {
                        format!("{} .. {} by {}", self.expr(from), self.expr(to), self.expr(by))
                    }
                    Values::Set(items) => format!("{{{}}}", self.list(items)),
                };
                let inner = self.checks(checks, depth + 1);
                format!("for {} in {values} {{\n{inner}{}}}", self.locals[id.0], "    ".repeat(depth))
            }
            Check::Holds(condition, _) => format!("expect {}", self.expr(condition)),
            Check::Near { value, expected, tolerance, percent, .. } => {
                let percent = if *percent { " %" } else { "" };
                format!(
                    "expect {} ~= {} within {}{percent}",
                    self.expr(value),
                    self.expr(expected),
                    self.expr(tolerance)
                )
            }
        }
    }
}
