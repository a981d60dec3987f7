//! What varies a field gives it virtual work in every statement, or virtual power in every statement: the rows of one unknown add up.
//! Weak forms in other dimensions, such as those of heat, are left to their author.

use super::physics::energy;
use super::{domain, unit};
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::model::{Domain, Expr, ExprKind, FieldId, Model, Shape, StatementKind, Type};
use crate::source::Span;
use ansatz_units::Dimension;
use std::collections::{BTreeMap, BTreeSet};

/// For each field the integral of the first statement that gives it virtual work or power, and where it stands.
pub(super) type Balances = BTreeMap<FieldId, (Dimension, Span)>;

/// Whether an integral is virtual work, or virtual power.
pub(super) fn is_work(integral: Dimension) -> bool {
    [energy(), energy() / Dimension::TIME].contains(&integral)
}

/// A statement that gives a field work where the first one gives it power, or the other way round.
struct Clash {
    field: FieldId,
    /// Integral of the statement and where it stands.
    this: (Dimension, Span),
    /// The same of the first one.
    first: (Dimension, Span),
}

/// Reports statements of virtual work next to statements of virtual power.
pub(super) fn check(model: &Model, sink: &mut Sink) {
    for Clash { field, this: (work, span), first: (wanted, first) } in compared(model).1 {
        let name = &model.fields[field.0].name;
        let message = format!("this cannot be added to what another statement says of `{name}`");
        sink.push(
            Diagnostic::error(Code::LoadDimension, span, message)
                .here(format!("its integral is {}", words(work)))
                .label(first, format!("the integral of this is {}", words(wanted)))
                .help("all statements that vary a field are terms of one equation"),
        );
    }
}

/// The balances of a model.
pub(super) fn balances(model: &Model) -> Balances {
    compared(model).0
}

/// The balances, and what does not fit them.
fn compared(model: &Model) -> (Balances, Vec<Clash>) {
    let (mut known, mut clashes) = (Balances::new(), Vec::new());
    for statement in model.blocks.iter().flat_map(|block| &block.statements) {
        let Some((fields, work, span)) = varied(model, &statement.kind) else { continue };
        if !is_work(work) {
            continue;
        }
        for field in fields {
            let first = *known.entry(field).or_insert((work, span));
            if first.0 != work {
                clashes.push(Clash { field, this: (work, span), first });
                break;
            }
        }
    }
    (known, clashes)
}

/// The fields that a statement varies, the dimension of its integral, and where it says so.
pub(super) fn varied(
    model: &Model,
    statement: &StatementKind,
) -> Option<(BTreeSet<FieldId>, Dimension, Span)> {
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

pub(super) fn dimension(e: &Expr) -> Option<Dimension> {
    if let Type::Value(_, dimension) = e.ty { Some(dimension) } else { None }
}

pub(super) fn words(dimension: Dimension) -> String {
    unit::type_text(&Type::Value(Shape::Scalar, dimension))
}
