//! Walking the tree: the outermost expressions of a file.

use super::*;

impl File {
    /// Every outermost expression, in the order of writing within each item. [`Expr::children`] leads further in.
    pub fn expressions(&self) -> Vec<&Expr> {
        let mut found = Vec::new();
        self.items.iter().for_each(|item| item_expressions(&item.kind, &mut found));
        found
    }
}

fn item_expressions<'a>(item: &'a ItemKind, found: &mut Vec<&'a Expr>) {
    match item {
        ItemKind::Model(_)
        | ItemKind::Import(_)
        | ItemKind::Extend(_)
        | ItemKind::Units(_)
        | ItemKind::Drop(_) => {}
        ItemKind::Part(part) => arguments(&part.inputs, found),
        ItemKind::Coordinates(coordinates) => arguments(&coordinates.args, found),
        ItemKind::Param(param) => {
            found.extend(&param.value);
            bounds(param.bounds.as_ref(), found);
        }
        ItemKind::Let(let_) => found.push(&let_.value),
        ItemKind::Fn(function) => {
            for item in &function.locals {
                match item {
                    BodyItem::Let(let_) => found.push(&let_.value),
                    BodyItem::Local(local) => local_expressions(local, found),
                }
            }
            found.push(&function.value);
        }
        ItemKind::Geometry(Geometry::Value(value)) => found.push(value),
        ItemKind::Geometry(Geometry::Built(items) | Geometry::Imported { items, .. }) => {
            items.iter().for_each(|item| geometry_expressions(&item.kind, found));
        }
        ItemKind::Mesh(settings) | ItemKind::Solve(settings) => {
            settings.iter().for_each(|setting| setting_expressions(setting, found));
        }
        ItemKind::Field(field) => {
            found.push(&field.domain);
            start(field.start.as_ref(), found);
        }
        ItemKind::State(state) => {
            start(state.start.as_ref(), found);
            bounds(state.bounds.as_ref(), found);
        }
        ItemKind::Local(local) => local_expressions(local, found),
        ItemKind::Moving(moving) => {
            found.push(&moving.domain);
            match &moving.motion {
                Motion::Given(value) => found.push(value),
                Motion::Solved { statements, .. } => statement_expressions(statements, found),
            }
        }
        ItemKind::Physics(physics) => statement_expressions(&physics.statements, found),
        ItemKind::Event(event) => {
            match &event.trigger {
                Trigger::When(condition) => found.push(condition),
                Trigger::Every(how_often) => every(how_often, found),
            }
            event.actions.iter().for_each(|action| arguments(&action.args, found));
        }
        ItemKind::Output(outputs) => {
            outputs.iter().for_each(|output| output_expressions(&output.kind, found))
        }
        ItemKind::Sweep(sweep) => {
            sweep.axes.iter().for_each(|axis| found.extend(&axis.values.items));
            columns(&sweep.columns, found);
        }
        ItemKind::Test(test) => check_expressions(&test.checks, found),
        ItemKind::Replace(replacement) => match replacement.as_ref() {
            Replacement::Item(item) => item_expressions(item, found),
            Replacement::Path(path) => path_expressions(path, found),
            Replacement::Region(region) => found.push(&region.value),
        },
    }
}

fn geometry_expressions<'a>(item: &'a GeometryKind, found: &mut Vec<&'a Expr>) {
    match item {
        GeometryKind::Let(let_) => found.push(&let_.value),
        GeometryKind::Path(path) => path_expressions(path, found),
        GeometryKind::Region(region) => found.push(&region.value),
        GeometryKind::Regions(_) | GeometryKind::Paths(_) => {}
    }
}

fn path_expressions<'a>(path: &'a Path, found: &mut Vec<&'a Expr>) {
    found.push(&path.start);
    for segment in &path.segments {
        if let Curve::Arc { about, .. } = &segment.curve {
            found.push(about);
        }
        found.push(&segment.to);
    }
}

fn setting_expressions<'a>(setting: &'a Setting, found: &mut Vec<&'a Expr>) {
    match &setting.value {
        SettingValue::Expr(value) => found.push(value),
        SettingValue::Range(range) => found.extend([&range.low, &range.high]),
    }
    found.extend(&setting.domain);
}

fn local_expressions<'a>(local: &'a Local, found: &mut Vec<&'a Expr>) {
    found.extend(&local.domain);
    start(local.start.as_ref(), found);
    bounds(local.bounds.as_ref(), found);
    found.extend([&local.equation.left, &local.equation.right]);
}

fn statement_expressions<'a>(statements: &'a [Statement], found: &mut Vec<&'a Expr>) {
    for statement in statements {
        match &statement.kind {
            StatementKind::Let(let_) => found.push(&let_.value),
            StatementKind::Energy { density: value, domain }
            | StatementKind::Residual { form: value, domain } => {
                found.push(value);
                found.extend(domain);
            }
            StatementKind::Load { quantity, force: value, domain }
            | StatementKind::Hold { quantity, value, domain } => {
                found.extend([quantity, value]);
                found.extend(domain);
            }
            StatementKind::Tie { equation, domain } => {
                found.extend([&equation.left, &equation.right]);
                found.extend(domain);
            }
            StatementKind::Equation(equation) => found.extend([&equation.left, &equation.right]),
        }
    }
}

fn output_expressions<'a>(output: &'a OutputKind, found: &mut Vec<&'a Expr>) {
    match output {
        OutputKind::Fields { domain, every: how_often, columns: values } => {
            found.push(domain);
            every(how_often, found);
            columns(values, found);
        }
        OutputKind::Table { every: how_often, columns: values, .. } => {
            every(how_often, found);
            columns(values, found);
        }
        OutputKind::Checkpoint { every: how_often } => every(how_often, found),
    }
}

fn check_expressions<'a>(checks: &'a [Check], found: &mut Vec<&'a Expr>) {
    for check in checks {
        match &check.kind {
            CheckKind::Let(let_) => found.push(&let_.value),
            CheckKind::Expect(claim) => found.push(claim),
            CheckKind::Near {
                left,
                right,
                tolerance: Tolerance::Absolute(within) | Tolerance::Percent(within),
            } => {
                found.extend([left, right, within]);
            }
            CheckKind::Each { over, checks, .. } => {
                match over {
                    Over::Set(set) => found.extend(&set.items),
                    Over::Steps { range, by } => found.extend([&range.low, &range.high, by]),
                }
                check_expressions(checks, found);
            }
        }
    }
}

fn arguments<'a>(args: &'a [Arg], found: &mut Vec<&'a Expr>) {
    args.iter().for_each(|arg| found.extend(arg.parts()));
}

fn columns<'a>(columns: &'a [Column], found: &mut Vec<&'a Expr>) {
    found.extend(columns.iter().map(|column| &column.value));
}

fn every<'a>(every: &'a Every, found: &mut Vec<&'a Expr>) {
    if let Every::Time(time) = every {
        found.push(time);
    }
}

fn start<'a>(start: Option<&'a Start>, found: &mut Vec<&'a Expr>) {
    if let Some(Start::Value(value) | Start::Guess(value)) = start {
        found.push(value);
    }
}

fn bounds<'a>(bounds: Option<&'a Bounds>, found: &mut Vec<&'a Expr>) {
    match bounds {
        None => {}
        Some(Bounds::Range(range)) => found.extend([&range.low, &range.high]),
        Some(Bounds::Set(set)) => found.extend(&set.items),
    }
}
