//! Claims about the syntax: what parses, what it parses to, and what is said about what does not.

mod errors;
mod forms;
mod robust;
mod shipped;

use super::ast::{Arg, Expr, ExprKind, File, On, Pattern};
use super::parse;
use crate::diagnostic::{Diagnostic, Sink, render};
use crate::source::{Source, SourceMap};
use shipped::{DRY, FORMS};

/// The tree and the diagnostics of a text.
fn outcome(text: &str) -> (File, Vec<Diagnostic>) {
    let mut sink = Sink::new();
    let file = parse(&Source::new("model.ansatz", text), &mut sink);
    (file, sink.finish())
}

/// The tree of a text without errors.
fn parsed(text: &str) -> File {
    let (file, diagnostics) = outcome(text);
    assert!(diagnostics.is_empty(), "{}", rendered(text));
    file
}

/// The diagnostics of a text as the user sees them.
fn rendered(text: &str) -> String {
    let mut sources = SourceMap::new();
    sources.add("model.ansatz", text);
    render(&outcome(text).1, &sources)
}

/// The structure of an expression, without places, fully in prefix form.
fn skeleton(expr: &Expr) -> String {
    let parts = || expr.children().into_iter().map(skeleton).collect::<Vec<_>>().join(" ");
    match &expr.kind {
        ExprKind::Number(number) => match &number.unit {
            None => format!("{:?}", number.value),
            Some(unit) => format!("{:?}{}", number.value, unit.text),
        },
        ExprKind::Text(text) => format!("{text:?}"),
        ExprKind::Name(name) => name.clone(),
        ExprKind::Hole => String::from("_"),
        ExprKind::Member { member, .. } => format!("(.{} {})", member.text, parts()),
        ExprKind::Call { args, .. } => {
            let marks: Vec<String> = args.iter().map(mark).collect();
            format!("(call[{}] {})", marks.join(","), parts())
        }
        ExprKind::At { .. } => format!("(@ {})", parts()),
        ExprKind::Tuple { unit, .. } => {
            format!("(tuple[{}] {})", unit.as_ref().map_or("", |unit| &unit.text), parts())
        }
        ExprKind::Record(fields) => {
            let names: Vec<&str> = fields.iter().map(|field| field.name.text.as_str()).collect();
            format!("(record[{}] {})", names.join(","), parts())
        }
        ExprKind::Unary { op, .. } => format!("({op:?} {})", parts()),
        ExprKind::Binary { op, .. } => format!("({} {})", op.symbol(), parts()),
        ExprKind::Compare { op, .. } => format!("({} {})", op.symbol(), parts()),
        ExprKind::Logic { op, .. } => format!("({} {})", op.symbol(), parts()),
        ExprKind::Lasting { .. } => format!("(for {})", parts()),
        ExprKind::Match(m) => {
            let patterns: Vec<String> = m
                .arms
                .iter()
                .map(|arm| match &arm.pattern {
                    Pattern::Less(_) => String::from("<"),
                    Pattern::LessEqual(_) => String::from("<="),
                    Pattern::Region(region) => region.text(),
                    Pattern::Else(_) => String::from("else"),
                })
                .collect();
            format!("(match[{} {:?}] {})", patterns.join(","), m.smoothness, parts())
        }
    }
}

fn mark(arg: &Arg) -> String {
    let on = match &arg.on {
        None => "",
        Some(On::Domain(_)) => " on",
        Some(On::Times(_)) => " on..",
    };
    format!("{}{on}", arg.name.as_ref().map_or("", |name| name.text.as_str()))
}
