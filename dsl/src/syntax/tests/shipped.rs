//! The shipped models parse, and every expression in them survives printing and parsing.

use super::{parsed, skeleton};
use crate::diagnostic::Sink;
use crate::source::Source;
use crate::syntax::ast::{Expr, ItemKind, Keyword};
use crate::syntax::parse_expr;
use crate::syntax::print::expr_to_string;

/// The shipped dry-contact model.
pub(super) const DRY: &str = include_str!("../../../../models/dry/model.ansatz");
/// Every form that the dry-contact model has no use for.
pub(super) const FORMS: &str = include_str!("forms.ansatz");

#[test]
fn the_shipped_models_parse() {
    let words: Vec<&str> = Keyword::ALL.map(Keyword::text).into_iter().take(20).collect();
    let begins_item = |line: &&str| words.contains(&line.split([' ', '{']).next().unwrap());
    assert_eq!(parsed(DRY).items.len(), DRY.lines().filter(begins_item).count());
    assert_eq!(parsed(FORMS).items.len(), 42);
}

#[test]
fn every_kind_of_item_occurs_in_the_texts_of_these_tests() {
    let mut words: Vec<&str> = Vec::new();
    for text in [DRY, FORMS] {
        let file = parsed(text);
        words.extend(file.items.iter().map(|item| text[item.span.range()].split([' ', '{']).next().unwrap()));
    }
    for keyword in Keyword::ALL.map(Keyword::text).into_iter().take(20).chain(["replace", "drop"]) {
        assert!(words.contains(&keyword), "{keyword} does not occur");
    }
}

#[test]
fn every_expression_survives_printing_and_parsing() {
    let mut count = 0;
    for text in [DRY, FORMS] {
        let file = parsed(text);
        let mut open: Vec<&Expr> = file.expressions();
        while let Some(expr) = open.pop() {
            let printed = expr_to_string(expr);
            let source = Source::new("printed", printed.as_str());
            let mut sink = Sink::new();
            let again = parse_expr(&source, &mut sink).unwrap_or_else(|| panic!("{printed} does not parse"));
            assert_eq!(skeleton(&again), skeleton(expr), "{printed}");
            open.extend(expr.children());
            count += 1;
        }
    }
    assert!(count > 1000, "only {count} expressions were seen");
}

#[test]
fn spans_hold_the_text_of_their_node_and_nothing_behind_it() {
    let text = "param a = 3 um   // a comment\n  ;\nlet b = (a + 1 um) /* x */ ;\n";
    let file = parsed(text);
    let values: Vec<&str> = file.expressions().iter().map(|expr| &text[expr.span.range()]).collect();
    assert_eq!(values, ["3 um", "(a + 1 um)"]);
    let param = &file.items[0];
    assert!(matches!(&param.kind, ItemKind::Param(param) if &text[param.name.span.range()] == "a"));
    assert_eq!(&text[param.span.range()], "param a = 3 um   // a comment\n  ;");
}
