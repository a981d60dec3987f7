//! Vectors that are stored lie in the plane of the model: what would act out of it, or hold or start a field there, is refused, as it would
//! change nothing.

use crate::check::walk::deep;
use crate::diagnostic::{Code, Diagnostic};
use crate::lower::{Lowered, Lowering};
use crate::model::{Expr, ExprKind, FieldId, Frame, Model, Shape, Type};
use crate::scalar::Id;
use crate::source::Span;

/// Refuses a load whose quantity is a component out of the plane, or that has such a component itself where its quantity has none.
///
/// `of` and `with` are the quantity and the load, each with its components.
pub(super) fn load(
    lowering: &Lowering<'_>,
    (of, quantity): (&Expr, &[Id]),
    (with, force): (&Expr, &[Id]),
) -> Lowered<()> {
    let is_zero = |id: &Id| lowering.pool.as_constant(*id) == Some(0.0);
    match &of.ty {
        Type::Value(Shape::Scalar, _) if quantity.iter().all(is_zero) => {
            match read_across(lowering.model, of) {
                Some(vector) => Err(outside(lowering.model, of.span, &vector)),
                None => Ok(()),
            }
        }
        Type::Value(Shape::Vector, _) => {
            let across = across(lowering.model);
            let acts = |ids: &[Id]| ids.get(across).is_some_and(|id| !is_zero(id));
            if acts(force) && !acts(quantity) {
                Err(outside(lowering.model, with.span, "what the load works on"))
            } else {
                Ok(())
            }
        }
        _ => Ok(()),
    }
}

/// Refuses an energy or a weak form of which nothing is left, as it is made of a component out of the plane.
pub(super) fn integrand(lowering: &Lowering<'_>, of: &Expr, is_zero: bool) -> Lowered<()> {
    match read_across(lowering.model, of).filter(|_| is_zero) {
        Some(vector) => Err(outside(lowering.model, of.span, &vector)),
        None => Ok(()),
    }
}

/// Refuses values of a vector field out of the plane: the component itself where one is named, else one of `values` that is not zero.
pub(super) fn field(
    lowering: &Lowering<'_>,
    (field, component): (FieldId, Option<usize>),
    values: &[Id],
    span: Span,
) -> Lowered<()> {
    let model = lowering.model;
    let across = across(model);
    let named = component == Some(across);
    let valued = component.is_none()
        && values.get(across).is_some_and(|&id| lowering.pool.as_constant(id) != Some(0.0));
    if model.fields[field.0].shape == Shape::Vector && (named || valued) {
        return Err(outside(model, span, &format!("`{}`", model.fields[field.0].name)));
    }
    Ok(())
}

/// The tensor index that is not in the plane.
fn across(model: &Model) -> usize {
    3 - model.coordinates.frame.axes().iter().sum::<usize>()
}

/// The vector of which an expression takes the component out of the plane, if it does.
fn read_across(model: &Model, e: &Expr) -> Option<String> {
    let across = across(model);
    let mut found = None;
    deep(model, e, &mut |e| match &e.kind {
        ExprKind::Component(vector, i) if *i == across => {
            found = Some(match vector.kind {
                ExprKind::Field(field) | ExprKind::Test(field) => format!("`{}`", model.fields[field.0].name),
                _ => String::from("a vector"),
            });
        }
        _ => {}
    });
    found
}

fn outside(model: &Model, span: Span, what: &str) -> Box<Diagnostic> {
    let [a, b] = &model.coordinates.names;
    let (kind, normal) = match model.coordinates.frame {
        Frame::Axisymmetric => ("axisymmetric", "theta"),
        Frame::PlaneStrain => ("plane", "z"),
    };
    let message =
        format!("the model is {kind}: {what} has the components .{a} and .{b}; .{normal} is always 0");
    Box::new(
        Diagnostic::error(Code::OutOfPlane, span, message)
            .help(format!("write `.{a}` or `.{b}`, or a vector whose component .{normal} is 0")),
    )
}
