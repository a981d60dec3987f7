//! What each rule is called in a message, and which rules only punctuate.

use super::Rule;
use crate::syntax::ast::Keyword;

/// Rules that only punctuate: the tree does not keep them.
pub(super) fn is_mark(rule: Rule) -> bool {
    keyword(rule).is_some() || punctuation(rule).is_some() || rule == Rule::EOI
}

/// The keyword that a rule stands for.
fn keyword(rule: Rule) -> Option<&'static str> {
    Some(match rule {
        Rule::K_MODEL => "model",
        Rule::K_USE => "use",
        Rule::K_EXTEND => "extend",
        Rule::K_UNITS => "units",
        Rule::K_COORDINATES => "coordinates",
        Rule::K_PARAM => "param",
        Rule::K_LET => "let",
        Rule::K_FN => "fn",
        Rule::K_GEOMETRY => "geometry",
        Rule::K_MESH => "mesh",
        Rule::K_FIELD => "field",
        Rule::K_STATE => "state",
        Rule::K_LOCAL => "local",
        Rule::K_MOVING => "moving",
        Rule::K_PHYSICS => "physics",
        Rule::K_EVENT => "event",
        Rule::K_SOLVE => "solve",
        Rule::K_OUTPUT => "output",
        Rule::K_SWEEP => "sweep",
        Rule::K_TEST => "test",
        Rule::K_REPLACE => "replace",
        Rule::K_DROP => "drop",
        Rule::K_PATH => "path",
        Rule::K_REGION => "region",
        Rule::K_FROM => "from",
        Rule::K_LINE => "line",
        Rule::K_ARC => "arc",
        Rule::K_TO => "to",
        Rule::K_ABOUT => "about",
        Rule::K_ENERGY => "energy",
        Rule::K_LOAD => "load",
        Rule::K_RESIDUAL => "residual",
        Rule::K_HOLD => "hold",
        Rule::K_TIE => "tie",
        Rule::K_EXPECT => "expect",
        Rule::K_FIELDS => "fields",
        Rule::K_TABLE => "table",
        Rule::K_CHECKPOINT => "checkpoint",
        Rule::K_EVERY => "every",
        Rule::K_WHEN => "when",
        Rule::K_ON => "on",
        Rule::K_IN => "in",
        Rule::K_AS => "as",
        Rule::K_BY => "by",
        Rule::K_WITH => "with",
        Rule::K_WHERE => "where",
        Rule::K_WITHIN => "within",
        Rule::K_MATCH => "match",
        Rule::K_ELSE => "else",
        Rule::K_FOR => "for",
        _ => return None,
    })
}

/// The sign that a rule stands for.
fn punctuation(rule: Rule) -> Option<&'static str> {
    Some(match rule {
        Rule::semi => ";",
        Rule::comma => ",",
        Rule::colon => ":",
        Rule::path_sep => "::",
        Rule::dot => ".",
        Rule::dots => "..",
        Rule::open => "{",
        Rule::close => "}",
        Rule::lparen => "(",
        Rule::rparen => ")",
        Rule::lbracket => "[",
        Rule::rbracket => "]",
        Rule::eq => "=",
        Rule::near => "~=",
        Rule::tilde => "~",
        Rule::fat => "=>",
        Rule::thin => "->",
        _ => return None,
    })
}

/// Rules that can only follow a complete expression.
pub(super) fn continues_expr(rule: Rule) -> bool {
    use Rule::{add, and, at, call, div, ge, gt, lasting, le, lt, member, mul, or, pow, sub};
    matches!(rule, add | and | at | call | div | ge | gt | lasting | le | lt | member | mul | or | pow | sub)
}

/// Rules that start an expression.
pub(super) fn starts_expr(rule: Rule) -> bool {
    use Rule::{arith, expr, group, hole, match_, neg, not, num, number, record};
    matches!(rule, arith | expr | group | hole | match_ | neg | not | num | number | record)
}

/// The words for a rule in "expected ..".
fn words(rule: Rule) -> String {
    if let Some(text) = keyword(rule).or_else(|| punctuation(rule)) {
        return format!("`{text}`");
    }
    let words = match rule {
        rule if starts_expr(rule) => "an expression",
        Rule::eqeq => "`==`",
        Rule::name | Rule::label => "a new name",
        Rule::ident | Rule::dotted | Rule::key => "a name",
        Rule::string => "a text in quotes",
        Rule::usym | Rule::uprod | Rule::ufac | Rule::brac | Rule::bare | Rule::unit | Rule::uone => "a unit",
        Rule::uexp => "an integer exponent",
        Rule::ty | Rule::tyfac | Rule::shaped | Rule::law | Rule::rec_ty | Rule::shape => "a type",
        Rule::farg => "an argument `name: Type`",
        Rule::arg | Rule::named => "an argument",
        Rule::arm => "an arm `bound => value`",
        Rule::value => "`= value`",
        Rule::guess => "`~ guess`",
        Rule::times => "`= low .. high`",
        Rule::range => "a range `low .. high`",
        Rule::set => "a set `{a, b}`",
        Rule::bounds => "`in low .. high`",
        Rule::on | Rule::within => "`on DOMAIN`",
        Rule::every => "`every TIME`",
        Rule::when => "`when CONDITION`",
        Rule::eqn => "an equation `a == b`",
        Rule::seg => "`line` or `arc`",
        Rule::turn => "`ccw` or `cw`",
        Rule::column => "a column",
        Rule::axis => "an axis `name in {a, b}`",
        Rule::action => "an action",
        Rule::block => "a block `{ .. }`",
        Rule::kind => "the keyword of an item",
        Rule::percent => "`%`",
        Rule::step => "`step`",
        Rule::otherwise => "`else`",
        _ => "",
    };
    words.to_owned()
}

/// The words of the language with which what a rule expects can start: `line` and `arc`, `every`; of a kind, those of all items.
pub(super) fn spelt(rules: &[Rule]) -> Vec<String> {
    let leading = |quoted: &str| quoted.split(' ').next().unwrap_or_default().to_owned();
    let quoted = rules.iter().map(|&rule| words(rule)).collect::<Vec<_>>().join(" ");
    let mut all: Vec<String> = quoted.split('`').skip(1).step_by(2).map(leading).collect();
    all.retain(|word| word.chars().all(char::is_alphabetic));
    if rules.contains(&Rule::kind) {
        all.extend(Keyword::ALL.map(|keyword| keyword.text().to_owned()));
    }
    all
}

/// "`;`, `on DOMAIN` or an operator" for a set of expected rules; "something else" where nothing can be named.
pub(super) fn list(rules: &[Rule]) -> String {
    let operators = rules.iter().any(|&rule| continues_expr(rule));
    let mut all: Vec<String> = Vec::new();
    for rule in rules.iter().copied().filter(|&rule| !continues_expr(rule)) {
        // Where an expression may start, the names and texts among its first tokens need no mention of their own.
        let covered = matches!(rule, Rule::ident | Rule::string | Rule::lparen)
            && rules.iter().any(|&r| starts_expr(r));
        let text = words(rule);
        if !covered && !text.is_empty() && !all.contains(&text) {
            all.push(text);
        }
    }
    if operators {
        all.retain(|text| text != "`==`" && text != "a unit" && text != "`(`" && text != "`.`");
        all.push(String::from("an operator"));
    }
    match all.split_last() {
        None => String::from("something else"),
        Some((only, [])) => only.clone(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
    }
}
