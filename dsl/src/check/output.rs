//! `output { .. }`, events and sweeps: what a run records and what it reacts to.

use super::shape::value;
use super::{Checked, Checker, Env, Reported, unit};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{
    Action, Column, EventId, Every, Expr, Frames, ParamId, Shape, Sweep, Table, Trigger, Type,
};
use crate::resolve::scope::{Symbol, Word};
use crate::source::Span;
use crate::syntax::ast::{self, ExprKind as Syntax, OutputKind};
use ansatz_units::Dimension;

impl Checker<'_> {
    /// The statements of an output block, added to those of earlier blocks.
    pub(super) fn output(&mut self, statements: &[ast::Output]) {
        for statement in statements {
            let _ = self.output_statement(statement);
        }
    }

    fn output_statement(&mut self, statement: &ast::Output) -> Checked<()> {
        match &statement.kind {
            OutputKind::Fields { domain, every, columns } => {
                let (domain, every) = (self.domain(domain, &Env::default()), self.every(every));
                let columns = self.columns(columns);
                let frames = Frames { domain: domain?, every: every?, columns };
                self.rest.output.frames.push(frames);
            }
            OutputKind::Table { file, every, columns } => {
                self.file_name(file);
                if self.rest.output.tables.iter().any(|table| table.file == file.value) {
                    let message = format!("there are two tables `{}`", file.value);
                    self.sink.push(Diagnostic::error(Code::DuplicateName, file.span, message));
                }
                let every = self.every(every);
                let columns = self.columns(columns);
                for column in
                    columns.iter().filter(|column| !matches!(column.value.ty, Type::Value(Shape::Scalar, _)))
                {
                    self.need_scalar(&column.value, "a column of a table must be a scalar");
                }
                let table = Table { file: file.value.clone(), every: every?, columns };
                self.rest.output.tables.push(table);
            }
            OutputKind::Checkpoint { every } => self.rest.output.checkpoint = Some(self.every(every)?),
        }
        Ok(())
    }

    /// Reports a name of a table that is no plain one: tables lie in the folder of the results, beside files with names of their own.
    fn file_name(&mut self, file: &ast::Text) {
        let plain = |stem: &str| {
            !stem.is_empty() && !stem.contains(['/', '\\', ':']) && !stem.contains(char::is_control)
        };
        if file.value.strip_suffix(".csv").is_some_and(plain) {
            return;
        }
        let message = format!("a table cannot be called `{}`", file.value);
        self.sink.push(
            Diagnostic::error(Code::BadSetting, file.span, message)
                .help("write a file name without folders that ends in `.csv`: `table \"history.csv\" ..`; `--out DIR` says where it goes"),
        );
    }

    fn every(&mut self, every: &ast::Every) -> Checked<Every> {
        match every {
            ast::Every::Step(_) => Ok(Every::Step),
            ast::Every::Time(e) => {
                self.typed(e, &Type::TIME, "an interval", &Env::default()).map(Every::Time)
            }
        }
    }

    /// The columns that are right; each name once.
    fn columns(&mut self, columns: &[ast::Column]) -> Vec<Column> {
        let mut done: Vec<Column> = Vec::new();
        for column in columns {
            let Ok(checked) = self.column(column) else { continue };
            if done.iter().any(|other| other.name == checked.name) {
                let message = format!("there are two columns `{}`", checked.name);
                let diagnostic = Diagnostic::error(Code::DuplicateName, column.span, message);
                self.sink.push(diagnostic.help("give one of them another name: `name = expr`"));
            }
            done.push(checked);
        }
        done
    }

    fn column(&mut self, column: &ast::Column) -> Checked<Column> {
        let checked = self.settled(&column.value, &Env::default());
        let shown = column.unit.as_ref().map(|written| Ok((self.unit(written)?, written))).transpose();
        let checked = checked?;
        let Some((_, dimension)) = value(&checked.ty) else {
            let words = self.words(&checked.ty);
            return Err(self.report(
                Diagnostic::error(Code::ShapeMismatch, checked.span, "a column holds values")
                    .here(format!("this is {words}")),
            ));
        };
        let unit = match shown? {
            None => (self.units.scale(dimension), unit::unit_text(&self.units, dimension)),
            Some((shown, written)) if shown.dimension == dimension => {
                let text = written.text.trim_start_matches('[').trim_end_matches(']').trim();
                (shown.factor_to_si(), text.to_owned())
            }
            Some((shown, written)) => return Err(self.wrong_unit(&checked, shown.dimension, written.span)),
        };
        Ok(Column { name: self.column_name(column), value: checked, unit })
    }

    fn wrong_unit(&mut self, e: &Expr, shown: Dimension, span: Span) -> Reported {
        let words = self.words(&e.ty);
        self.report(
            Diagnostic::error(Code::UnitDimension, span, format!("this is a unit of {shown}"))
                .label(e.span, format!("this is {words}")),
        )
    }

    /// The heading: the name if there is one, else the text of the value.
    fn column_name(&self, column: &ast::Column) -> String {
        match &column.name {
            Some(name) => name.text.clone(),
            None => self.sources.slice(column.value.span).split_whitespace().collect::<Vec<_>>().join(" "),
        }
    }

    /// When an event fires and what it does.
    pub(super) fn event_item(&mut self, id: EventId, ast: &ast::Event) {
        let env = Env::default();
        let trigger = match &ast.trigger {
            ast::Trigger::When(condition) => self.condition(condition, &env).map(Trigger::When),
            ast::Trigger::Every(ast::Every::Step(_)) => Ok(Trigger::EveryStep),
            ast::Trigger::Every(ast::Every::Time(e)) => {
                self.typed(e, &Type::TIME, "an interval", &env).map(Trigger::Every)
            }
        };
        let actions: Vec<_> = ast.actions.iter().filter_map(|action| self.action(action).ok()).collect();
        let event = &mut self.events[id.0];
        event.actions = actions.into_iter().flatten().collect();
        if let Ok(trigger) = trigger {
            event.trigger = trigger;
        }
    }

    fn action(&mut self, action: &ast::Action) -> Checked<Vec<Action>> {
        match (action.name.text.as_str(), action.args.as_slice()) {
            ("stop", []) => Ok(vec![Action::Stop]),
            ("warn", [ast::Arg { name: None, value: ast::Expr { kind: Syntax::Text(text), .. }, .. }]) => {
                Ok(vec![Action::Warn(text.clone())])
            }
            ("set", args) if !args.is_empty() => args.iter().map(|arg| self.set_state(arg)).collect(),
            ("remesh", [ast::Arg { name: None, value, .. }]) => {
                Ok(vec![Action::Remesh(self.domain(value, &Env::default())?)])
            }
            ("stop", _) => Err(self.wrong_arguments(action, "nothing", "stop")),
            ("warn", _) => Err(self.wrong_arguments(action, "one text", "warn(\"text\")")),
            ("set", _) => Err(self.wrong_arguments(action, "states and their new values", "set(x: value)")),
            ("remesh", _) => Err(self.wrong_arguments(action, "the region that moves", "remesh(D)")),
            (other, _) => Err(self.report(
                Diagnostic::error(
                    Code::UnknownName,
                    action.name.span,
                    format!("there is no action `{other}`"),
                )
                .help_did_you_mean(other, ["stop", "warn", "set", "remesh"])
                .help("the actions are `stop`, `warn(\"text\")`, `set(x: value)` and `remesh(D)`"),
            )),
        }
    }

    fn wrong_arguments(&mut self, action: &ast::Action, takes: &str, form: &str) -> Reported {
        let message = format!("`{}` takes {takes}", action.name.text);
        let diagnostic = Diagnostic::error(Code::MissingArgument, action.span, message);
        self.report(diagnostic.help(format!("write `{form}`")))
    }

    fn set_state(&mut self, arg: &ast::Arg) -> Checked<Action> {
        let Some(name) = &arg.name else {
            return Err(self.report(
                Diagnostic::error(Code::MissingArgument, arg.span, "which state is set?")
                    .help("write `set(x: value)`"),
            ));
        };
        let Some(Symbol::State(id)) = self.symbol(&name.text, &Env::default()) else {
            return Err(self.no_state(name));
        };
        let ty = Type::Value(Shape::Scalar, self.state_dimension(id)?);
        let value = self.typed(&arg.value, &ty, &format!("`{}`", name.text), &Env::default())?;
        Ok(Action::Set(id, value))
    }

    /// `set` of something that is no state.
    fn no_state(&mut self, name: &ast::Ident) -> Reported {
        let states = self.names_of(|symbol| matches!(symbol, Symbol::State(_)));
        let message = format!("there is no state `{}`", name.text);
        let mut diagnostic = Diagnostic::error(Code::UnknownName, name.span, message)
            .help_did_you_mean(&name.text, states.iter().copied());
        if let Some(symbol) = self.symbol(&name.text, &Env::default()) {
            let what = symbol.words();
            diagnostic =
                diagnostic.help(format!("`{}` is {what}; `set` gives a state a new value", name.text));
        }
        let known = if states.is_empty() {
            "the model has no states".into()
        } else {
            format!("the states are `{}`: `set({}: value)`", states.join("`, `"), states[0])
        };
        self.report(diagnostic.help(known))
    }

    /// A sweep over parameters.
    pub(super) fn sweep(&mut self, ast: &ast::Sweep) {
        if self.rest.sweeps.iter().any(|other| other.name == ast.name.text) {
            let message = format!("there are two sweeps `{}`", ast.name.text);
            self.sink.push(Diagnostic::error(Code::DuplicateName, ast.name.span, message));
        }
        let axes: Vec<_> = ast.axes.iter().filter_map(|axis| self.axis(axis).ok()).collect();
        let columns: Vec<_> =
            ast.columns.iter().filter_map(|column| self.sweep_column(column).ok()).collect();
        self.rest.sweeps.push(Sweep { name: ast.name.text.clone(), axes, columns, span: ast.name.span });
    }

    fn sweep_column(&mut self, column: &ast::Column) -> Checked<(String, Option<Expr>)> {
        if self.is_word(&column.value, Word::Outcome, &Env::default()) {
            return Ok((self.column_name(column), None));
        }
        let Column { name, value, .. } = self.column(column)?;
        Ok((name, Some(value)))
    }

    fn axis(&mut self, axis: &ast::Axis) -> Checked<(Vec<ParamId>, Vec<Vec<Expr>>)> {
        let params: Vec<Checked<ParamId>> = axis.names.iter().map(|name| self.swept(name)).collect();
        let params = params.into_iter().collect::<Checked<Vec<_>>>()?;
        let mut types = Vec::new();
        for id in &params {
            types.push(Type::Value(Shape::Scalar, self.param(*id)?.dimension));
        }
        if let ([_], [ty]) = (params.as_slice(), types.as_slice()) {
            let what = format!("a value of `{}`", axis.names[0].text());
            let values = self.set(&axis.values, ty, &what, &Env::default())?;
            return Ok((params, values.into_iter().map(|value| vec![value]).collect()));
        }
        let values: Vec<Checked<Vec<Expr>>> =
            axis.values.items.iter().map(|item| self.swept_tuple(item, axis, &types)).collect();
        Ok((params, values.into_iter().collect::<Checked<_>>()?))
    }

    fn swept(&mut self, name: &ast::Dotted) -> Checked<ParamId> {
        let text = name.text();
        match self.symbol(&text, &Env::default()) {
            Some(Symbol::Param(id)) => Ok(id),
            Some(Symbol::Broken) => Err(Reported),
            Some(other) => {
                let message = format!("`{text}` is {}, and sweeps run over parameters", other.words());
                Err(self.report(Diagnostic::error(Code::WrongKind, name.span, message)))
            }
            None => {
                let params = self.names_of(|symbol| matches!(symbol, Symbol::Param(_)));
                let diagnostic = Diagnostic::error(
                    Code::UnknownName,
                    name.span,
                    format!("there is no parameter `{text}`"),
                )
                .help_did_you_mean(&text, params);
                Err(self.report(diagnostic))
            }
        }
    }

    /// One tuple of an axis with several parameters.
    fn swept_tuple(&mut self, item: &ast::Expr, axis: &ast::Axis, types: &[Type]) -> Checked<Vec<Expr>> {
        let (items, own) = match &item.kind {
            Syntax::Tuple { items, unit } if items.len() == types.len() => (items, unit.as_ref()),
            _ => {
                let message = format!("{} values are needed here", types.len());
                return Err(self.report(Diagnostic::error(Code::ShapeMismatch, item.span, message)));
            }
        };
        let unit = own.or(axis.values.unit.as_ref());
        let values = self.members(items, unit, &Env::default())?;
        let values = values
            .into_iter()
            .zip(types)
            .zip(&axis.names)
            .map(|((value, ty), name)| self.expect(value, ty, &format!("a value of `{}`", name.text())));
        let values: Vec<Checked<Expr>> = values.collect();
        values.into_iter().collect()
    }
}
