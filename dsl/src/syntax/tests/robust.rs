//! No text makes the parser panic, overflow its stack or run for ever.

use proptest::prelude::*;

use super::{DRY, FORMS, outcome, rendered};
use crate::diagnostic::Sink;
use crate::source::Source;
use crate::syntax::parse_expr;

/// A stack that a deep recursion would run through soon.
const STACK: usize = 2 << 20;

fn survives(text: String) {
    let run = move || {
        let errors = outcome(&text).1.len();
        let mut sink = Sink::new();
        parse_expr(&Source::new("expr", text), &mut sink);
        errors
    };
    let thread = std::thread::Builder::new().stack_size(STACK).spawn(run).unwrap();
    assert!(thread.join().is_ok());
}

#[test]
fn deep_nesting_ends_in_an_error_not_in_an_overflow() {
    for part in [
        "(",
        "[",
        "{",
        "-",
        "not ",
        "match ",
        "1^",
        "1+",
        "f(",
        "a.b@",
        "(a, ",
        "fn(",
        "fn(A) -> ",
        "/*",
        "/* ",
        "Tensor[",
        "1 [(",
        "match a { else => ",
        "{ { ",
        "for x in {1} { ",
        "x == ",
        "a and ",
        "a < ",
        "min(a on ",
    ] {
        let deep = part.repeat(4_000);
        for before in ["let a = ", "let a: ", "physics p { ", "test \"t\" { ", ""] {
            survives(format!("{before}{deep}"));
        }
    }
    survives(format!("let a = {}1{};", "(".repeat(40), ")".repeat(40)));
    survives(format!("let a = {}1{};", "(1^-".repeat(47), ")".repeat(47)));
}

#[test]
fn long_flat_texts_are_read() {
    let sum = vec!["x"; 200].join(" + ");
    assert!(outcome(&format!("let a = {sum};")).1.is_empty());
    let items = "let a = 1;\n".repeat(5000);
    assert_eq!(outcome(&items).0.items.len(), 5000);
}

/// A text with pieces of it removed, doubled or replaced.
fn mutated(text: &'static str) -> impl Strategy<Value = String> {
    let pieces = prop::sample::select(vec![
        "", "", ";", "{", "}", "(", ")", "=", "==", "/// x\n", "//", "/*", "\"", " on ", "match ", "'", "∇",
        "\n", "..", " um ", "^",
    ]);
    let edit = (any::<prop::sample::Index>(), 0usize..12, pieces);
    prop::collection::vec(edit, 1..6).prop_map(move |edits| {
        let mut text = text.to_owned();
        for (at, length, piece) in edits {
            let boundary = |mut at: usize| {
                while !text.is_char_boundary(at) {
                    at -= 1;
                }
                at
            };
            let start = boundary(at.index(text.len() + 1));
            let end = boundary((start + length).min(text.len()));
            text.replace_range(start..end.max(start), piece);
        }
        text
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_characters_are_survived(text in any::<String>()) {
        rendered(&text);
    }

    #[test]
    fn any_tokens_are_survived(tokens in prop::collection::vec(prop::sample::select(vec![
        "param", "let", "x", "=", "==", ";", "{", "}", "(", ")", "[", "]", "3", "um", "^", "physics", "energy", "on", "in", "..",
        "match", "else", "=>", "<", ",", ":", "fn", "->", "@", ".", "\"t\"", "test", "expect", "for", "///\n", "\n", "-", "/",
    ]), 0..60)) {
        rendered(&tokens.join(" "));
    }

    #[test]
    fn any_change_of_a_model_is_survived_and_errors_lie_inside_the_text(text in mutated(DRY)) {
        for diagnostic in outcome(&text).1 {
            prop_assert!(diagnostic.primary.end as usize <= text.len());
        }
        rendered(&text);
    }

    #[test]
    fn any_change_of_the_other_forms_is_survived(text in mutated(FORMS)) {
        rendered(&text);
    }
}
