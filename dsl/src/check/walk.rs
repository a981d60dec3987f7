//! Walks over expressions of a model, through the `let`s and functions that they use.

use crate::model::{Check, Expr, ExprKind, FunctionId, LetId, Model, Values};
use crate::source::Span;
use std::collections::BTreeSet;

/// A definition that an expression refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Definition {
    Let(LetId),
    Function(FunctionId),
}

impl Definition {
    /// The definition that `e` itself refers to.
    pub(super) fn of(e: &Expr) -> Option<Self> {
        match &e.kind {
            ExprKind::Let(id) => Some(Self::Let(*id)),
            ExprKind::Apply(id, _) | ExprKind::Law(id, _) => Some(Self::Function(*id)),
            _ => None,
        }
    }

    /// The expressions that define it.
    pub(super) fn bodies(self, model: &Model) -> Vec<&Expr> {
        match self {
            Self::Let(id) => vec![&model.lets[id.0].value],
            Self::Function(id) => {
                let function = &model.functions[id.0];
                function.lets.iter().map(|(_, value)| value).chain([&function.result]).collect()
            }
        }
    }

    /// Its name and where it is declared.
    pub(super) fn name(self, model: &Model) -> (&str, Span) {
        match self {
            Self::Let(id) => (&model.lets[id.0].name, model.lets[id.0].span),
            Self::Function(id) => (&model.functions[id.0].name, model.functions[id.0].span),
        }
    }
}

/// Calls `f` on `e` and everything that it is made of, definitions included, each definition once.
pub(crate) fn deep<'m>(model: &'m Model, e: &'m Expr, f: &mut dyn FnMut(&'m Expr)) {
    walk(model, e, &mut BTreeSet::new(), f);
}

fn walk<'m>(model: &'m Model, e: &'m Expr, seen: &mut BTreeSet<Definition>, f: &mut dyn FnMut(&'m Expr)) {
    f(e);
    for child in e.children() {
        walk(model, child, seen, f);
    }
    if let Some(definition) = Definition::of(e)
        && seen.insert(definition)
    {
        for body in definition.bodies(model) {
            walk(model, body, seen, f);
        }
    }
}

/// The expressions of a check, those of loops included.
pub(super) fn check_exprs(check: &Check) -> Vec<&Expr> {
    match check {
        Check::Let(_, value) => vec![value],
        Check::Each(_, values, checks) => {
            let values = match values {
                Values::Range { from, to, by } => vec![from, to, by],
                Values::Set(items) => items.iter().collect(),
            };
            values.into_iter().chain(checks.iter().flat_map(check_exprs)).collect()
        }
        Check::Holds(condition, _) => vec![condition],
        Check::Near { value, expected, tolerance, .. } => vec![value, expected, tolerance],
    }
}

/// Reports functions and `let`s that use themselves; says whether there are none.
pub(super) fn no_circles(model: &Model, sink: &mut crate::diagnostic::Sink) -> bool {
    let mut done = BTreeSet::new();
    let lets = (0..model.lets.len()).map(|i| Definition::Let(LetId(i)));
    let functions = (0..model.functions.len()).map(|i| Definition::Function(FunctionId(i)));
    let mut found = false;
    for start in lets.chain(functions) {
        found |= visit(model, start, &mut Vec::new(), &mut done, sink);
    }
    !found
}

/// Depth-first search; reports each circle where it closes.
fn visit(
    model: &Model,
    node: Definition,
    chain: &mut Vec<Definition>,
    done: &mut BTreeSet<Definition>,
    sink: &mut crate::diagnostic::Sink,
) -> bool {
    use crate::diagnostic::{Code, Diagnostic};
    if let Some(at) = chain.iter().position(|other| *other == node) {
        let names: Vec<&str> = chain[at..].iter().chain([&node]).map(|d| d.name(model).0).collect();
        let (name, span) = node.name(model);
        let message = format!("`{name}` is defined by itself");
        sink.push(Diagnostic::error(Code::Cycle, span, message).help(names.join(" -> ")));
        return true;
    }
    if !done.insert(node) {
        return false;
    }
    chain.push(node);
    let mut found = false;
    for body in node.bodies(model) {
        let mut next = Vec::new();
        shallow(body, &mut next);
        for definition in next {
            found |= visit(model, definition, chain, done, sink);
        }
    }
    chain.pop();
    found
}

/// The definitions that `e` refers to directly.
fn shallow(e: &Expr, into: &mut Vec<Definition>) {
    into.extend(Definition::of(e));
    e.children().into_iter().for_each(|child| shallow(child, into));
}
