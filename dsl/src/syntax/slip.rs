//! Slips that parse but mean something else: `1000 kg/m^3` divides a mass by the cube of something called `m`.

use super::ast::{BinaryOp, Expr, ExprKind, File, ItemKind};
use super::parse::is_unit;
use super::token::{Kind, Token, tokens};
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::source::Source;

/// Reports units of several names without brackets. Names of other files are not known here, so a file that extends
/// another is left to the resolver.
pub(super) fn check(file: &File, source: &Source, sink: &mut Sink) {
    if file.items.iter().any(|item| matches!(item.kind, ItemKind::Extend(_))) {
        return;
    }
    let mut open = file.expressions();
    while let Some(expr) = open.pop() {
        match unbracketed(expr, source) {
            Some((name, _)) if is_declared(&name, source) => open.extend(expr.children()),
            Some((_, diagnostic)) => sink.push(diagnostic),
            None => open.extend(expr.children()),
        }
    }
}

/// A number with a unit, multiplied or divided by names of units, and the first such name.
fn unbracketed(expr: &Expr, source: &Source) -> Option<(String, Diagnostic)> {
    let ExprKind::Binary { op: op @ (BinaryOp::Mul | BinaryOp::Div), left, right, .. } = &expr.kind else {
        return None;
    };
    let name = unit_name(right)?;
    let (digits, unit, first) = match unbracketed_number(left) {
        Some((digits, unit)) => (digits, unit, None),
        None => {
            let (first, inner) = unbracketed(left, source)?;
            let bracketed = inner.help.first()?.strip_prefix("write `")?.strip_suffix("]`")?.to_owned();
            let (digits, unit) = bracketed.split_once(" [")?;
            (digits.to_owned(), unit.to_owned(), Some(first))
        }
    };
    let first = first.unwrap_or(name);
    let written = source.slice(expr.span);
    let verb = if *op == BinaryOp::Mul { "times" } else { "divided by" };
    let message = format!(
        "`{written}` means {digits} {unit} {verb} something called `{first}`, and no `{first}` is declared"
    );
    let help = format!("write `{digits} [{unit}{}{}]`", op.symbol(), source.slice(right.span));
    Some((first, Diagnostic::error(Code::UnitNeedsBrackets, expr.span, message).help(help)))
}

fn unbracketed_number(expr: &Expr) -> Option<(String, String)> {
    match &expr.kind {
        ExprKind::Number(number) => {
            let unit = number.unit.as_ref().filter(|unit| !unit.text.starts_with('['))?;
            Some((number.text.clone(), unit.text.clone()))
        }
        _ => None,
    }
}

/// The unit that `expr` would be: a name from the list, perhaps with an exponent.
fn unit_name(expr: &Expr) -> Option<String> {
    match &expr.kind {
        ExprKind::Name(name) if is_unit(name) => Some(name.clone()),
        ExprKind::Binary { op: BinaryOp::Pow, left, right, .. }
            if matches!(right.kind, ExprKind::Number(_)) =>
        {
            unit_name(left)
        }
        _ => None,
    }
}

/// Whether a name like this is declared anywhere in the text, or may be: behind a keyword, before a colon, among
/// coordinates or imports.
fn is_declared(name: &str, source: &Source) -> bool {
    let text = source.text.as_str();
    let all: Vec<Token> = tokens(text, 0..text.len()).filter(|token| token.kind != Kind::Doc).collect();
    let mut listing = false;
    (0..all.len()).any(|i| {
        let near = |at: Option<usize>| at.and_then(|at| all.get(at)).map_or("", |token| token.text(text));
        match all[i].text(text) {
            "use" | "coordinates" => listing = true,
            ";" => listing = false,
            _ => {}
        }
        let keywords =
            ["param", "let", "fn", "field", "state", "local", "path", "region", "physics", "by", "for"];
        all[i].text(text) == name
            && (listing || near(Some(i + 1)) == ":" || keywords.contains(&near(i.checked_sub(1))))
    })
}
