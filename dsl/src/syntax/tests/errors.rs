//! What is said about texts that do not parse: one snapshot for each kind of slip.

use super::{outcome, rendered};
use crate::diagnostic::Code;

/// Codes of a text, in order of place.
fn codes(text: &str) -> Vec<&'static str> {
    outcome(text).1.iter().map(|diagnostic| diagnostic.code.id()).collect()
}

/// Names that the broken parts of a text would have declared.
fn broken(text: &str) -> Vec<String> {
    outcome(text).0.broken.into_iter().map(|name| name.text).collect()
}

macro_rules! says {
    ($($name:ident: $text:expr;)*) => {
        $(#[test]
        fn $name() {
            let text = $text;
            insta::assert_snapshot!(stringify!($name), format!("{text}\n----\n{}", rendered(text)));
        })*
    };
}

says! {
    a_missing_semicolon_is_asked_for_where_it_belongs: "model a\nparam r = 3 um;\nphysics p {\n    tau == a\n    b == c;\n}";
    units_of_several_names_need_brackets: "param rho = 1000 kg/m^3;\nparam mu = 2 kg m;\nlet f = 9 kg*m/s^2;";
    a_unit_is_set_off_by_white_space: "param a = 3um;\nparam b = 1_000;\nparam c = .5;";
    words_of_the_language_are_no_names: "param load = 3;\nlet match = 3;";
    equals_signs_are_not_interchangeable: "physics p {\n    tau = hill(v);\n    hold u == 0 on wall;\n}\nlet x == 3;\nlet y = a = b;";
    unknown_keywords_suggest_known_ones: "phyiscs p {\n    energy W on D;\n}\nfoo = 3;\nphysics q { enrgy W on D; }";
    a_brace_left_open_does_not_hide_the_items_behind_it: "physics p {\n    energy W on D;\nparam a = 3 um;\nlet b = ;";
    comparisons_do_not_chain: "let x = a < b < c;\nphysics p { a == b == c; }";
    units_come_from_a_closed_list: "units;\nunits um, ums;\nparam a = 3 kpa;\nparam b = 3 [furlong/s];\nlet c = 2 x;";
    statements_are_sent_to_their_block: "energy W on D;\nphysics p { param a = 3; }";
    documentation_stands_before_items: "physics p {\n    /// stray\n    energy W on D;\n}\n//! inner\n/** block */ let a = 1;\n/// lost";
    foreign_characters_have_their_spelling: "let a = b && c;\nlet F' = 3;\nlet g = !a;\nlet d = ∇u;";
    expectations_are_listed: "let a = (1 + 2;\nevent e on z;\nfield u: Vector[Length] on solid;\nextend dry;\nlet s = {1, 2};";
    drops_and_events_show_their_form: "drop physics;\ndrop tie v;\nevent a every 1 s when x > 2 => stop;\nevent b when x > 2 and every 1 s;";
    blocks_do_not_end_with_a_semicolon: "physics p { energy W on D; };\n}";
    nothing_follows_a_quantity_directly: "param a = 3 um^n;\nparam b = 5 min(1, 2);\nparam c = (a) um;\nlet d = x@f(t);";
    numbers_and_exponents_have_limits: "let b = 1e999;\nlet c = 3 [m^1000];\nlet d = 1 [((m^9)^9)^9];";
    nesting_has_a_limit: "let a = ((((((((((((((((((((((((((((((((((((((((((((((((((1;";
}

#[test]
fn all_errors_of_a_file_come_in_one_go() {
    let text = "param = 3;\nlet a = 1\nlet b = 2;\nphysics p {\n    energy on D;\n    hold u = 0 on w;\n    load x;\n}\nlet c = +;\nsweep s: a in 1 => b;";
    assert_eq!(codes(text), ["P002", "P001", "P002", "P002", "P002", "P002"]);
    assert_eq!(outcome(text).0.items.len(), 2, "`let b` and the block `p` are read");
}

#[test]
fn names_of_broken_items_are_kept_and_names_of_whole_ones_are_not() {
    assert_eq!(broken("model m\nparam r = 3 um;\nlet q = ;\nfn f(a: ) -> T = a;"), ["m", "q", "f"]);
    assert_eq!(broken("parm r = 3;\nenergy W on D;\nuse std::solid{F};"), ["r", "std", "solid", "F"]);
}

#[test]
fn a_unit_like_name_that_is_declared_divides() {
    for text in [
        "param m = 2 kg;\nlet a = 3 kg/m;",
        "fn f(s: Length) -> Length = 2 um*s;",
        "extend \"b\";\nlet a = 3 kg/m;",
    ] {
        assert_eq!(codes(text), [""; 0], "{text}");
    }
    assert_eq!(codes("let a = 3 kg/m;"), [Code::UnitNeedsBrackets.id()]);
}

#[test]
fn long_texts_of_errors_come_to_an_end() {
    let count = outcome(&"param\n".repeat(2000)).1.len();
    assert!((50..=200).contains(&count), "{count} errors");
}
