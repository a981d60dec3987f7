//! Weak forms: every residual is linear in its test functions.

use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::model::{Arithmetic, Builtin, Expr, ExprKind, LocalId, Model, Reduction, StatementKind};
use crate::source::Span;
use std::collections::BTreeMap;

/// How often test functions multiply in a term; `None` for 0, which has every degree.
type Degree = Option<usize>;

/// Why an expression has no degree.
struct Fault {
    span: Span,
    why: &'static str,
}

/// Degrees of the arguments of the functions around an expression.
type Arguments = BTreeMap<LocalId, Degree>;

/// Reports residuals that are not linear in test functions.
pub(super) fn check(model: &Model, sink: &mut Sink) {
    for statement in model.blocks.iter().flat_map(|block| &block.statements) {
        let StatementKind::Residual(form, _) = &statement.kind else { continue };
        let fault = match degree(model, form, &Arguments::new()) {
            Ok(None | Some(1)) => continue,
            Ok(Some(0)) => Fault { span: form.span, why: "this term has no test function" },
            Ok(Some(_)) => Fault { span: form.span, why: "test functions are multiplied here" },
            Err(fault) => fault,
        };
        sink.push(
            Diagnostic::error(Code::NotLinear, fault.span, "a residual is linear in its test functions")
                .here(fault.why)
                .help("every term contains one `test(u)`, or something linear in it such as `grad(test(u))`"),
        );
    }
}

fn degree(model: &Model, e: &Expr, arguments: &Arguments) -> Result<Degree, Fault> {
    let of = |e: &Expr| degree(model, e, arguments);
    match &e.kind {
        ExprKind::Number(value) => Ok((*value != 0.0).then_some(0)),
        ExprKind::Test(_) => Ok(Some(1)),
        ExprKind::Local(id) => Ok(arguments.get(id).copied().unwrap_or(Some(0))),
        ExprKind::Let(id) => of(&model.lets[id.0].value),
        ExprKind::Negate(a)
        | ExprKind::Component(a, _)
        | ExprKind::Component2(a, ..)
        | ExprKind::Member(a, _)
        | ExprKind::Frozen(a)
        | ExprKind::Rate(a)
        | ExprKind::Reduce(Reduction::Mean | Reduction::Integral, a, _) => of(a),
        ExprKind::Tuple(items) => common(items.iter().map(|item| (item, of(item)))),
        ExprKind::Triple(items) => common(items.iter().map(|item| (item, of(item)))),
        ExprKind::Record(items) => common(items.iter().map(|item| (item, of(item)))),
        ExprKind::Arithmetic(op, a, b) => match op {
            Arithmetic::Add | Arithmetic::Sub => common([(a.as_ref(), of(a)), (b.as_ref(), of(b))]),
            Arithmetic::Mul => product(of(a)?, of(b)?),
            Arithmetic::Div => {
                none(b, of(b)?)?;
                of(a)
            }
            Arithmetic::Pow => {
                none(a, of(a)?)?;
                none(b, of(b)?)
            }
        },
        ExprKind::Builtin(builtin, items) => builtin_degree(*builtin, items, &of),
        ExprKind::Apply(id, items) => {
            let function = &model.functions[id.0];
            let mut inner = Arguments::new();
            for ((local, _), item) in function.arguments.iter().zip(items) {
                inner.insert(*local, of(item)?);
            }
            for (local, value) in &function.lets {
                let value = degree(model, value, &inner)?;
                inner.insert(*local, value);
            }
            degree(model, &function.result, &inner).map_err(|fault| Fault { span: e.span, ..fault })
        }
        ExprKind::MatchValue { scrutinee, arms, otherwise, .. } => {
            none(scrutinee, of(scrutinee)?)?;
            let values = arms.iter().map(|arm| &arm.value).chain([otherwise.as_ref()]);
            common(values.map(|value| (value, of(value))))
        }
        ExprKind::MatchRegion(arms, otherwise) => {
            let values = arms.iter().map(|(_, value)| value).chain(otherwise.as_deref());
            common(values.map(|value| (value, of(value))))
        }
        _ => {
            for child in e.children() {
                none(child, of(child)?)?;
            }
            Ok(Some(0))
        }
    }
}

fn builtin_degree(
    builtin: Builtin,
    items: &[Expr],
    of: &dyn Fn(&Expr) -> Result<Degree, Fault>,
) -> Result<Degree, Fault> {
    match builtin {
        Builtin::Trace
        | Builtin::Transpose
        | Builtin::Sym
        | Builtin::Dev
        | Builtin::Diag
        | Builtin::Grad
        | Builtin::Div
        | Builtin::Along
        | Builtin::Hoop
        | Builtin::Perp => common(items.iter().map(|item| (item, of(item)))),
        Builtin::Dot | Builtin::Inner | Builtin::Outer | Builtin::Cross => {
            items.iter().try_fold(Some(0), |sum, item| product(sum, of(item)?))
        }
        _ => {
            for item in items {
                none(item, of(item)?)?;
            }
            Ok(Some(0))
        }
    }
}

/// Terms of a sum have one degree.
fn common<'e>(items: impl IntoIterator<Item = (&'e Expr, Result<Degree, Fault>)>) -> Result<Degree, Fault> {
    let mut sum = None;
    for (item, degree) in items {
        match (sum, degree?) {
            (_, None) => {}
            (None, found) => sum = found,
            (Some(a), Some(b)) if a == b => {}
            (Some(a), Some(b)) => {
                let why = if a.min(b) == 0 {
                    "one part has a test function, the other has none"
                } else {
                    "test functions are multiplied here"
                };
                return Err(Fault { span: item.span, why });
            }
        }
    }
    Ok(sum)
}

fn product(a: Degree, b: Degree) -> Result<Degree, Fault> {
    Ok(a.zip(b).map(|(a, b)| a + b))
}

/// Requires that `e` has no test function.
fn none(e: &Expr, degree: Degree) -> Result<Degree, Fault> {
    match degree {
        None | Some(0) => Ok(Some(0)),
        Some(_) => {
            Err(Fault { span: e.span, why: "a test function enters here in a way that is not linear" })
        }
    }
}
