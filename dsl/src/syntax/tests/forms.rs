//! What texts parse to: precedence, and the traps of the grammar.

use super::{FORMS, outcome, parsed, skeleton};
use crate::diagnostic::Sink;
use crate::source::Source;
use crate::syntax::ast::{ExprKind, ItemKind, TypeKind};
use crate::syntax::print::{expr_to_string, outline, type_to_string};
use crate::syntax::{ast, parse_expr};

fn expr(text: &str) -> ast::Expr {
    let mut sink = Sink::new();
    parse_expr(&Source::new("expr", text), &mut sink).unwrap_or_else(|| panic!("{text}: {:?}", sink.finish()))
}

fn refused(text: &str) {
    let mut sink = Sink::new();
    assert!(parse_expr(&Source::new("expr", text), &mut sink).is_none(), "{text} parses");
    assert!(sink.has_errors());
}

#[test]
fn operators_bind_in_the_documented_order() {
    for (text, tree) in [
        ("a + b*c^d^e", "(+ a (* b (^ c (^ d e))))"),
        ("-a^2", "(Neg (^ a 2.0))"),
        ("a^-b*c", "(* (^ a (Neg b)) c)"),
        ("-a*b", "(* (Neg a) b)"),
        ("a - b - c", "(- (- a b) c)"),
        ("a/b*c", "(* (/ a b) c)"),
        ("u.z@t.x^2", "(^ (@ (.z u) (.x t)) 2.0)"),
        ("f(a).x@(1 s)", "(@ (.x (call[] f a)) 1.0s)"),
        ("not a < b and c or d", "(or (and (Not (< a b)) c) d)"),
        ("a > 0 for 60 s and t > 1 s", "(and (for (> a 0.0) 60.0s) (> t 1.0s))"),
        ("a == b + c", "(== a (+ b c))"),
    ] {
        assert_eq!(skeleton(&expr(text)), tree, "{text}");
    }
}

#[test]
fn printing_drops_parentheses_that_say_nothing_and_keeps_the_others() {
    for (text, printed) in [
        ("((a)*(b)) + (c)", "a*b + c"),
        ("(a + b)*c", "(a + b)*c"),
        ("a - (b - c)", "a - (b - c)"),
        ("(a^b)^c", "(a^b)^c"),
        ("a^(b^c)", "a^b^c"),
        ("(-a)^2", "(-a)^2"),
        ("(3 um)^2", "(3 um)^2"),
        ("(a@t).z", "(a@t).z"),
        ("(not a) and b", "not a and b"),
        ("(2).x", "(2).x"),
    ] {
        assert_eq!(expr_to_string(&expr(text)), printed);
    }
}

#[test]
fn a_unit_belongs_to_the_literal_before_it_and_names_elsewhere_are_free() {
    assert_eq!(skeleton(&expr("3 K*K")), "(* 3.0K K)");
    assert_eq!(skeleton(&expr("4 um^2")), "4.0um^2");
    assert_eq!(skeleton(&expr("(1, 2) um")), "(tuple[um] 1.0 2.0)");
    assert_eq!(skeleton(&expr("min(h, T)")), "(call[,] min h T)");
    let ExprKind::Number(number) = expr("3 [kg*(m/s)^2/mol]").kind else { panic!("a number") };
    let factors: Vec<(String, i32)> =
        number.unit.into_iter().flat_map(|unit| unit.factors).map(|f| (f.symbol.text, f.exponent)).collect();
    assert_eq!(factors, [("kg", 1), ("m", 2), ("s", -2), ("mol", -1)].map(|(s, e)| (String::from(s), e)));
}

#[test]
fn what_may_not_follow_a_unit_is_refused() {
    for text in ["3 um^n", "4 [um]^2", "5 min(a)", "3um", "0x1f", "1_000", "(a) um", "5eV", "1.", ".5"] {
        refused(text);
    }
}

#[test]
fn a_division_does_not_eat_the_slash_of_documentation() {
    let file = parsed("let a = b\n/c; /// about d\nlet d = 2;");
    assert_eq!(file.items.len(), 2);
    assert_eq!(file.items[1].docs, "about d");
    let (file, diagnostics) = outcome("let a = b\n/// about c\nlet c = 2;");
    assert_eq!(diagnostics.len(), 1, "the missing `;` is the only fault");
    assert_eq!(file.items.len(), 1, "`c` is read");
}

#[test]
fn only_three_slashes_document() {
    assert_eq!(parsed("/// one\n/// two\n// no\n//// no\nlet a = 1;").items[0].docs, "one\ntwo");
}

#[test]
fn joining_words_name_arguments_but_nothing_else() {
    assert_eq!(skeleton(&expr("revolve(g, by: 90 deg, on: a)")), "(call[,by,on] revolve g 90.0deg a)");
    refused("by + 1");
    refused("a.match");
    assert_eq!(
        skeleton(&expr("test(u) + residual")),
        "(+ (call[] test u) residual)",
        "leading words can be used"
    );
}

#[test]
fn words_that_begin_like_keywords_are_names() {
    for name in ["order", "notch", "inner", "format", "matches", "online", "elsewhere", "fortune", "C1_a"] {
        assert_eq!(skeleton(&expr(name)), name);
    }
    assert_eq!(
        parsed("let parameter = 1; let letter = parameter; fn fnord(a: Length) -> Length = a;").items.len(),
        3
    );
}

#[test]
fn types_keep_their_form() {
    let file = parsed("let a: Energy*Length^-3 = 0; let b: Tensor = 0; let c: Vector[1/Area] = 0;");
    let types: Vec<&ast::TypeExpr> = file
        .items
        .iter()
        .filter_map(|item| if let ItemKind::Let(let_) = &item.kind { let_.ty.as_ref() } else { None })
        .collect();
    assert_eq!(
        types.iter().map(|ty| type_to_string(ty)).collect::<Vec<_>>(),
        ["Energy*Length^-3", "Tensor", "Vector[1/Area]"]
    );
    assert!(matches!(types[1].kind, TypeKind::Shaped { element: None, .. }));
}

#[test]
fn the_outline_shows_every_form() {
    insta::assert_snapshot!(outline(&parsed(FORMS)));
}
