//! Claims about every expression of a checked model.

use super::check;
use super::walk::deep;
use crate::diagnostic::{Sink, render};
use crate::model::{Expr, Model, Start, StatementKind, Type};
use crate::resolve::{Loaded, assemble};
use crate::source::SourceMap;

const DRY: &str = include_str!("../../../models/dry/model.ansatz");

fn dry() -> Model {
    let (mut sources, mut sink) = (SourceMap::new(), Sink::new());
    let id = sources.add("dry", DRY);
    let mut load = |_: &str, _: &str| -> Result<Loaded, String> { Err("no other file".into()) };
    let program = assemble(id, &mut sources, &mut load, &mut sink);
    let model = check(&program, &sources, &mut sink);
    model.unwrap_or_else(|| panic!("{}", render(&sink.finish(), &sources)))
}

/// Expressions of lets, functions, statements, starts, geometry and tests.
fn roots(model: &Model) -> Vec<&Expr> {
    let mut roots: Vec<&Expr> = model.lets.iter().map(|item| &item.value).collect();
    roots.extend(model.params.iter().map(|param| &param.default));
    roots.extend(
        model.functions.iter().flat_map(|f| f.lets.iter().map(|(_, value)| value).chain([&f.result])),
    );
    for path in &model.geometry.paths {
        roots.push(&path.start);
        roots.extend(path.segments.iter().map(|segment| &segment.to));
    }
    for statement in model.blocks.iter().flat_map(|block| &block.statements) {
        match &statement.kind {
            StatementKind::Energy(e, _) | StatementKind::Residual(e, _) | StatementKind::Hold(_, _, e, _) => {
                roots.push(e)
            }
            StatementKind::Tie(..) => {}
            StatementKind::Load(a, b, _) | StatementKind::Equation(a, b) => roots.extend([a, b]),
        }
    }
    let starts =
        model.fields.iter().map(|field| &field.start).chain(model.states.iter().map(|state| &state.start));
    roots.extend(starts.filter_map(|start| match start {
        Start::Value(e) | Start::Guess(e) => Some(e),
        Start::Solved => None,
    }));
    roots.extend(model.tests.iter().flat_map(|test| &test.checks).flat_map(super::walk::check_exprs));
    roots
}

#[test]
fn no_literal_zero_is_left_without_a_type() {
    let model = dry();
    let mut count = 0;
    for root in roots(&model) {
        deep(&model, root, &mut |e| {
            count += 1;
            assert_ne!(e.ty, Type::Zero, "{:?}", &DRY.get(e.span.range()));
        });
    }
    assert!(count > 1000, "{count} expressions");
}

#[test]
fn lets_use_only_those_before_them() {
    let model = dry();
    for (at, item) in model.lets.iter().enumerate() {
        deep(&model, &item.value, &mut |e| {
            if let crate::model::ExprKind::Let(id) = e.kind {
                assert!(id.0 < at, "`{}` uses a later `let`", item.name);
            }
        });
    }
}

#[test]
fn checking_twice_gives_the_same_model() {
    assert_eq!(dry().print(), dry().print());
}
