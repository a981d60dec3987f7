//! What varies a field gives it virtual work in every statement, or virtual power in every statement: the rows of one unknown add up.
//! Weak forms in other dimensions, such as those of heat, are left to their author.

use super::physics::energy;
use super::{domain, unit};
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::model::{Domain, Expr, ExprKind, FieldId, Model, Shape, StatementKind, Type};
use crate::source::Span;
use ansatz_units::Dimension;
use std::collections::{BTreeMap, BTreeSet};

/// Reports statements of virtual work next to statements of virtual power.
pub(super) fn check(model: &Model, sink: &mut Sink) {
    let mut known: BTreeMap<FieldId, (Dimension, Span)> = BTreeMap::new();
    for statement in model.blocks.iter().flat_map(|block| &block.statements) {
        let Some((fields, work, span)) = varied(model, &statement.kind) else { continue };
        if ![energy(), energy() / Dimension::TIME].contains(&work) {
            continue;
        }
        for field in fields {
            let &mut (wanted, first) = known.entry(field).or_insert((work, span));
            if wanted != work {
                let name = &model.fields[field.0].name;
                let message = format!("this cannot be added to what another statement says of `{name}`");
                sink.push(
                    Diagnostic::error(Code::LoadDimension, span, message)
                        .here(format!("its integral is {}", words(work)))
                        .label(first, format!("the integral of this is {}", words(wanted)))
                        .help("all statements that vary a field are terms of one equation"),
                );
                break;
            }
        }
    }
}

/// The fields that a statement varies, the dimension of its integral, and where it says so.
fn varied(model: &Model, statement: &StatementKind) -> Option<(BTreeSet<FieldId>, Dimension, Span)> {
    let (of, integrand, place, span, tests) = match statement {
        StatementKind::Energy(density, place) => {
            (density, dimension(density)?, place.as_ref(), density.span, false)
        }
        StatementKind::Residual(form, place) => (form, dimension(form)?, Some(place), form.span, true),
        StatementKind::Load(of, with, place) => {
            (of, dimension(of)? * dimension(with)?, place.as_ref(), with.span, false)
        }
        StatementKind::Hold(..) | StatementKind::Tie(..) | StatementKind::Equation(..) => return None,
    };
    let mut fields = BTreeSet::new();
    super::walk::deep(model, of, &mut |e| match &e.kind {
        ExprKind::Test(field) if tests => drop(fields.insert(*field)),
        ExprKind::Field(field) if !tests => drop(fields.insert(*field)),
        _ => {}
    });
    let measure = |place: &Domain| domain::kind(place).measure();
    Some((fields, place.map_or(integrand, |place| integrand * measure(place)), span))
}

fn dimension(e: &Expr) -> Option<Dimension> {
    if let Type::Value(_, dimension) = e.ty { Some(dimension) } else { None }
}

fn words(dimension: Dimension) -> String {
    unit::type_text(&Type::Value(Shape::Scalar, dimension))
}
