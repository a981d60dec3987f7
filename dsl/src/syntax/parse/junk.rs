//! What stands where no item or statement can be read: what it was meant to be, and where reading goes on.
//!
//! The first word of the junk suggests a rule. Parsing by that rule fails again, and the place of the failure and
//! what was expected there choose the words; the usual slips have words of their own.

use std::ops::Range;

use ansatz_units::Unit;
use pest::error::{Error, ErrorVariant, InputLocation};

use super::{Builder, Rule, words};
use crate::diagnostic::{Code, Diagnostic, did_you_mean};
use crate::source::Span;
use crate::syntax::ast::Ident;
use crate::syntax::token::{Kind, Token, tokens};

/// Where junk can stand, by what belongs there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    File,
    Geometry,
    Settings,
    Physics,
    Output,
    Test,
}

impl Place {
    const ALL: [Place; 6] =
        [Self::File, Self::Geometry, Self::Settings, Self::Physics, Self::Output, Self::Test];

    /// The words that lead a statement here, and its rule.
    fn leads(self) -> &'static [(&'static str, Rule)] {
        match self {
            Self::File => &[
                ("model", Rule::model),
                ("use", Rule::use_std),
                ("extend", Rule::extend),
                ("units", Rule::units),
                ("coordinates", Rule::coords),
                ("param", Rule::param),
                ("let", Rule::let_),
                ("fn", Rule::fn_),
                ("geometry", Rule::geometry),
                ("mesh", Rule::mesh),
                ("field", Rule::field),
                ("state", Rule::state),
                ("local", Rule::local),
                ("moving", Rule::moving),
                ("physics", Rule::physics),
                ("event", Rule::event),
                ("solve", Rule::solve),
                ("output", Rule::output),
                ("sweep", Rule::sweep),
                ("test", Rule::test),
                ("replace", Rule::replace),
                ("drop", Rule::drop),
            ],
            Self::Geometry => &[("let", Rule::let_), ("path", Rule::gpath), ("region", Rule::region)],
            Self::Settings => &[],
            Self::Physics => &[
                ("let", Rule::let_),
                ("energy", Rule::energy),
                ("residual", Rule::residual),
                ("load", Rule::load),
                ("hold", Rule::hold),
                ("tie", Rule::tie),
            ],
            Self::Output => {
                &[("fields", Rule::fields), ("table", Rule::table), ("checkpoint", Rule::checkpoint)]
            }
            Self::Test => &[("let", Rule::let_), ("for", Rule::each), ("expect", Rule::expect)],
        }
    }

    fn rule(self, word: &str) -> Option<Rule> {
        self.leads().iter().find(|(lead, _)| *lead == word).map(|&(_, rule)| rule)
    }

    /// The rule of statements that start with a word of the user.
    fn free(self) -> Option<Rule> {
        match self {
            Self::Settings => Some(Rule::setting),
            Self::Physics => Some(Rule::equation),
            _ => None,
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::File => "at the top of a file",
            Self::Geometry => "in `geometry { .. }`",
            Self::Settings => "in `mesh { .. }` or `solve { .. }`",
            Self::Physics => "in `physics name { .. }`",
            Self::Output => "in `output { .. }`",
            Self::Test => "in `test \"..\" { .. }`",
        }
    }
}

/// Where in the parsed text an error lies.
pub(super) fn offset(error: &Error<Rule>) -> usize {
    match error.location {
        InputLocation::Pos(at) => at,
        InputLocation::Span((start, _)) => start,
    }
}

impl Builder<'_> {
    /// Reports a stretch of junk. The result is where reading can go on inside it.
    pub(super) fn explain_junk(&self, place: Place, stretch: Range<usize>) -> Option<usize> {
        let text = self.source.text.as_str();
        let mut all = tokens(text, stretch.clone()).skip_while(|token| token.kind == Kind::Doc);
        let documented = tokens(text, stretch.clone()).next().filter(|token| token.kind == Kind::Doc);
        let first = all.next();
        if let Some(doc) = documented
            && (first.is_none() || !matches!(place, Place::File | Place::Geometry))
        {
            self.report(stray_doc(self.span(doc.start, doc.end)));
            return first.map(|token| token.start);
        }
        let first = first?;
        let (diagnostic, at) = self.explain_statement(place, first, all.next(), first.start..stretch.end);
        let next = match diagnostic.code {
            Code::MissingSemicolon => self.token_at(at, stretch.end).map(|token| token.start),
            _ => self.resume(place, at, stretch.clone()),
        };
        self.report(diagnostic);
        self.declare_broken(self.declared(place, first.start..next.unwrap_or(stretch.end)));
        next
    }

    fn explain_statement(
        &self,
        place: Place,
        first: Token,
        second: Option<Token>,
        stretch: Range<usize>,
    ) -> (Diagnostic, usize) {
        let text = self.source.text.as_str();
        let (word, span) = (first.text(text), self.span(first.start, first.end));
        if word == ";" {
            return (self.lone_semicolon(first), first.end);
        }
        if let Some(rule) = place.rule(word) {
            return self.explain(self.choose(rule, &stretch), stretch);
        }
        if let Some(other) = Place::ALL.into_iter().find(|other| other.rule(word).is_some()) {
            let message = format!("`{word}` does not belong {}", place.words());
            let help = format!("it stands {}", other.words());
            return (Diagnostic::error(Code::Misplaced, span, message).help(help), first.end);
        }
        let leads = place.leads().iter().map(|&(lead, _)| lead);
        let like_equation = second.is_none_or(|token| token.kind == Kind::Sign);
        match place.free() {
            Some(rule) if place.leads().is_empty() || like_equation => self.explain(rule, stretch),
            _ if first.kind == Kind::Word => {
                let message = format!("nothing starts with `{word}` {}", place.words());
                let diagnostic = Diagnostic::error(Code::UnknownKeyword, span, message);
                let diagnostic =
                    match (did_you_mean(word, leads.clone()), second.map(|token| token.text(text))) {
                        (Some(close), _) => diagnostic.help(format!("did you mean `{close}`?")),
                        (None, Some("=")) => {
                            diagnostic.help(format!("to name a value write `let {word} = ..;`"))
                        }
                        (None, _) => diagnostic
                            .help(format!("what can start here: {}", leads.collect::<Vec<_>>().join(", "))),
                    };
                (diagnostic, first.end)
            }
            Some(rule) => self.explain(rule, stretch),
            None => {
                let message = format!("`{word}` cannot stand {}", place.words());
                (Diagnostic::error(Code::Expected, span, message), first.end)
            }
        }
    }

    /// Where one word leads two forms, the one that the next tokens fit.
    fn choose(&self, rule: Rule, stretch: &Range<usize>) -> Rule {
        let mut rest = tokens(&self.source.text, stretch.clone()).skip(1);
        let second = rest.next();
        let third = rest.next().map(|token| token.text(&self.source.text));
        match rule {
            Rule::use_std if second.is_some_and(|token| token.kind == Kind::Text) => Rule::use_part,
            Rule::gpath if matches!(third, Some("," | "." | ";")) => Rule::paths,
            Rule::region if matches!(third, Some("," | "." | ";")) => Rule::regions,
            rule => rule,
        }
    }

    fn lone_semicolon(&self, token: Token) -> Diagnostic {
        let span = self.span(token.start, token.end);
        let message = match self.source.text[..token.start].trim_end().ends_with('}') {
            true => "a block `{ .. }` does not end with `;`",
            false => "nothing stands before this `;`",
        };
        Diagnostic::error(Code::Expected, span, message).help("remove the `;`")
    }

    /// The names that the declarations in a stretch would have made.
    fn declared(&self, place: Place, stretch: Range<usize>) -> Vec<Ident> {
        let text = self.source.text.as_str();
        let all: Vec<Token> = tokens(text, stretch).collect();
        let first = all.first().map_or("", |first| first.text(text));
        let imports = first == "use";
        let unknown = place == Place::File && Place::ALL.into_iter().all(|place| place.rule(first).is_none());
        let names = all.windows(2).filter(|pair| {
            let [before, word] = [pair[0].text(text), pair[1].text(text)];
            let declares = matches!(
                before,
                "model"
                    | "param"
                    | "let"
                    | "fn"
                    | "field"
                    | "state"
                    | "local"
                    | "physics"
                    | "event"
                    | "sweep"
                    | "path"
                    | "region"
                    | "by"
            );
            let second = pair[0].start == all[0].start;
            pair[1].kind == Kind::Word && (declares || imports || unknown && second) && !is_reserved(word)
        });
        names
            .map(|pair| Ident {
                text: pair[1].text(text).to_owned(),
                span: self.span(pair[1].start, pair[1].end),
            })
            .collect()
    }

    /// The next line behind `at`, outside braces, that starts like a statement of this place.
    fn resume(&self, place: Place, at: usize, stretch: Range<usize>) -> Option<usize> {
        let text = self.source.text.as_str();
        let mut depth = 0usize;
        tokens(text, stretch).find_map(|token| {
            let word = token.text(text);
            match word {
                "{" => depth += 1,
                "}" => depth = depth.saturating_sub(1),
                _ => {}
            }
            let line = text[..token.start].rfind('\n').map_or(0, |newline| newline + 1);
            let leads_line = text[line..token.start].trim().is_empty();
            let fits = depth == 0 && token.start > at && leads_line && place.rule(word).is_some();
            fits.then_some(token.start)
        })
    }

    fn token_at(&self, at: usize, end: usize) -> Option<Token> {
        tokens(&self.source.text, at..end).next()
    }

    /// Parses the stretch by `rule` for the place and the expectations of the failure, and words them.
    pub(super) fn explain(&self, rule: Rule, stretch: Range<usize>) -> (Diagnostic, usize) {
        let (at, expected) = match self.run(rule, stretch.clone()) {
            Ok(_) => (stretch.start, Vec::new()),
            Err(error) => {
                let at = stretch.start + offset(&error);
                match error.variant {
                    ErrorVariant::ParsingError { mut positives, .. } => {
                        positives.sort();
                        (at, positives)
                    }
                    ErrorVariant::CustomError { .. } => (at, Vec::new()),
                }
            }
        };
        let text = self.source.text.as_str();
        let failure = Failure {
            text,
            rule,
            expected,
            before: tokens(text, stretch.start..at).collect(),
            found: self.token_at(at, stretch.end),
            at,
        };
        (failure.word(self), at)
    }
}

/// A failed parse: what came before, what was found, what was expected.
struct Failure<'s> {
    text: &'s str,
    rule: Rule,
    expected: Vec<Rule>,
    before: Vec<Token>,
    found: Option<Token>,
    at: usize,
}

impl Failure<'_> {
    fn expects(&self, rules: &[Rule]) -> bool {
        self.expected.iter().any(|rule| rules.contains(rule))
    }

    fn expects_more(&self) -> bool {
        self.expected.iter().any(|&rule| words::continues_expr(rule))
    }

    fn expects_expr(&self) -> bool {
        self.expected.iter().any(|&rule| words::starts_expr(rule))
    }

    fn found_text(&self) -> &str {
        self.found.map_or("", |token| token.text(self.text))
    }

    fn found_kind(&self) -> Option<Kind> {
        self.found.map(|token| token.kind)
    }

    fn word(&self, builder: &Builder<'_>) -> Diagnostic {
        let span = match self.found {
            Some(token) => builder.span(token.start, token.end),
            None => {
                let end = self.before.last().map_or(self.at, |token| token.end);
                builder.span(end, end)
            }
        };
        let slips = [
            Self::foreign,
            Self::malformed_number,
            Self::reserved_name,
            Self::wrong_equals,
            Self::chained,
            Self::wrong_unit,
            Self::missing_semicolon,
        ];
        slips.into_iter().find_map(|slip| slip(self, builder, span)).unwrap_or_else(|| self.generic(span))
    }

    fn generic(&self, span: Span) -> Diagnostic {
        let found = match (self.found_kind(), self.found_text()) {
            (None, _) => String::from("the end"),
            (Some(Kind::Doc), _) => return stray_doc(span),
            (_, text) => format!("`{text}`"),
        };
        let message = format!("expected {}, found {found}", words::list(&self.expected));
        let mut diagnostic = Diagnostic::error(Code::Expected, span, message);
        if self.found_kind() == Some(Kind::Word) && !is_reserved(self.found_text()) {
            let spelt = words::spelt(&self.expected);
            diagnostic = diagnostic.help_did_you_mean(self.found_text(), spelt.iter().map(String::as_str));
        }
        match self.number_before() {
            Some(number) if self.expects(&[Rule::uexp]) => {
                diagnostic.help(format!("a power of a quantity needs parentheses: `({number})^..`"))
            }
            Some(number) if self.found_text() == "(" => diagnostic
                .help(format!("`{number}` is a quantity; to multiply by a call write `*` between them")),
            _ if self.found_text() == "{" && self.expects_expr() => {
                diagnostic.help("a set `{..}` is no value: it stands only behind `in`")
            }
            _ if self.rule == Rule::drop => diagnostic
                .help("write `drop KIND NAME;`, such as `drop physics drag;` or `drop test \"title\";`")
                .help("blocks without a name and single statements are not dropped but replaced: `replace mesh { .. }`"),
            _ if self.rule == Rule::event && ["when", "every"].contains(&self.found_text()) => {
                diagnostic.help("an event is either `every` time or `when` a condition turns true")
            }
            _ => diagnostic,
        }
    }

    /// The number and the unit that were read last, a `^` behind them aside.
    fn number_before(&self) -> Option<&str> {
        let mut back = self.before.iter().rev().filter(|token| token.text(self.text) != "^");
        let unit = back.next().filter(|token| is_unit(token.text(self.text)))?;
        let number = back.next().filter(|token| token.kind == Kind::Number)?;
        self.text.get(number.start..unit.end)
    }

    /// A character that is no token of the language, alone or glued to a word.
    fn foreign(&self, builder: &Builder<'_>, _: Span) -> Option<Diagnostic> {
        let found = self.found?;
        let rest = match found.kind {
            Kind::Sign => &self.text[found.start..],
            Kind::Word => {
                self.text[found.end..].strip_prefix(['\'', '"', '#']).map(|_| &self.text[found.end..])?
            }
            _ => return None,
        };
        let c = rest.chars().next().filter(|&c| !"()[]{}<>=+-*/^,;:.@~%".contains(c))?;
        let start = self.text.len() - rest.len();
        let message = format!("`{c}` is no character of the language");
        let diagnostic =
            Diagnostic::error(Code::ForeignCharacter, builder.span(start, start + c.len_utf8()), message);
        Some(match c {
            '&' => diagnostic.help("conditions are joined with `and`"),
            '|' => diagnostic.help("conditions are joined with `or`"),
            '!' => diagnostic.help("a condition is turned round with `not`"),
            '\'' => diagnostic.help("names are letters, digits and `_`"),
            '"' => diagnostic.help("a text stands on one line, between quotes, set off by white space"),
            c if !c.is_ascii() => diagnostic.help("names are letters a to z, digits and `_`"),
            _ => diagnostic,
        })
    }

    fn malformed_number(&self, _: &Builder<'_>, span: Span) -> Option<Diagnostic> {
        let text = self.found_text();
        let error = |message: String| Diagnostic::error(Code::MalformedNumber, span, message);
        if self.found_kind() == Some(Kind::Number)
            && text.contains(|c: char| c.is_ascii_alphabetic() || c == '_')
        {
            let split = text.find(|c: char| c.is_ascii_alphabetic() || c == '_')?;
            let (digits, tail) = text.split_at(split);
            let diagnostic = error(format!("`{text}` is no number"));
            return match tail {
                tail if is_unit(tail) => {
                    Some(diagnostic.help(format!("write `{digits} {tail}`, with a space")))
                }
                tail if tail.starts_with('_') => Some(diagnostic.help("digits are not grouped")),
                _ if text.parse::<f64>().is_ok() => None,
                _ => Some(diagnostic),
            };
        }
        let digit_next = || self.text[self.found?.end..].chars().next().filter(char::is_ascii_digit);
        if text == "." && self.expects_expr() && digit_next().is_some() {
            let digits = tokens(self.text, self.found?.end..self.text.len()).next()?.text(self.text);
            return Some(
                error(String::from("a number starts with a digit")).help(format!("write `0.{digits}`")),
            );
        }
        None
    }

    fn reserved_name(&self, _: &Builder<'_>, span: Span) -> Option<Diagnostic> {
        let word = self.found_text();
        if !self.expects(&[Rule::name, Rule::label]) || !is_reserved(word) {
            return None;
        }
        let message = format!("`{word}` is a word of the language and cannot be declared as a name");
        Some(
            Diagnostic::error(Code::ReservedName, span, message)
                .help(format!("choose another name, such as `{word}_0`")),
        )
    }

    /// `=` where `==` is meant, and the reverse.
    fn wrong_equals(&self, builder: &Builder<'_>, span: Span) -> Option<Diagnostic> {
        let gives = self.expects(&[Rule::eq, Rule::value, Rule::times]);
        let earlier = self.before.iter().find(|token| token.text(self.text) == "==");
        let equation = match (self.found_text(), earlier) {
            ("==", _) if gives => Some(span),
            ("on" | ";", Some(token)) if gives => Some(builder.span(token.start, token.end)),
            _ => None,
        };
        if let Some(span) = equation {
            let message = "a value is given with `=`; `==` is an equation";
            return Some(Diagnostic::error(Code::EquationForValue, span, message).help("write `=`"));
        }
        if self.found_text() == "=" && (self.expects(&[Rule::eqeq]) || self.expects_more()) {
            let equation = matches!(self.rule, Rule::equation | Rule::tie | Rule::local);
            let message = match equation {
                true => "an equation is written `==`; `=` gives a value",
                false => "values are compared with `==`; `=` gives a value",
            };
            return Some(Diagnostic::error(Code::ValueForEquation, span, message).help("write `==`"));
        }
        None
    }

    fn chained(&self, _: &Builder<'_>, span: Span) -> Option<Diagnostic> {
        let sign = self.found_text();
        let compares = matches!(sign, "==" | "<" | "<=" | ">" | ">=");
        if !compares || !self.expects_more() || self.expects(&[Rule::eqeq]) {
            return None;
        }
        let message =
            format!("`{sign}` cannot follow here: an equation has two sides, comparisons do not chain");
        Some(Diagnostic::error(Code::ChainedComparison, span, message))
    }

    /// A word behind a number that is no unit, or a unit that needs brackets.
    fn wrong_unit(&self, _: &Builder<'_>, span: Span) -> Option<Diagnostic> {
        let word = self.found_text();
        if self.found_kind() != Some(Kind::Word) || is_reserved(word) {
            return None;
        }
        let unknown = |message: String| {
            let diagnostic = Diagnostic::error(Code::UnknownUnit, span, message);
            Some(diagnostic.help_unit(word))
        };
        if self.expects(&[Rule::usym, Rule::uprod, Rule::ufac]) && !self.expects_more() {
            return unknown(format!("`{word}` is no unit"));
        }
        let mut back = self.before.iter().rev();
        let last = back.next()?;
        let same_line = !self.text[last.end..self.at].contains('\n');
        if !same_line || !self.expects_more() {
            return None;
        }
        if last.kind == Kind::Number && is_unit(word) {
            let message =
                "an exponent or call behind a unit needs parentheses around the number and its unit";
            let help = format!("write `({} {word})`, or a unit such as `[{word}^2]`", last.text(self.text));
            return Some(Diagnostic::error(Code::UnitNeedsBrackets, span, message).help(help));
        }
        if last.kind == Kind::Number {
            let diagnostic = unknown(format!("`{word}` behind a number is no unit"))?;
            return Some(diagnostic.help(format!("to multiply write `{}*{word}`", last.text(self.text))));
        }
        let number = back.next().filter(|token| token.kind == Kind::Number)?;
        if is_unit(last.text(self.text)) && is_unit(word) {
            let message = "a unit of more than one name stands in brackets";
            let (digits, unit) = (number.text(self.text), last.text(self.text));
            let help = format!("write `{digits} [{unit}*{word}]`");
            return Some(Diagnostic::error(Code::UnitNeedsBrackets, span, message).help(help));
        }
        None
    }

    fn missing_semicolon(&self, builder: &Builder<'_>, span: Span) -> Option<Diagnostic> {
        let last = self.before.last()?;
        let next_line = self.text[last.end..self.at].contains('\n');
        let ends = self.found.is_none() || next_line || self.found_text() == "}";
        if !self.expects(&[Rule::semi]) || !ends {
            return None;
        }
        let place = builder.span(last.end, last.end);
        let diagnostic =
            Diagnostic::error(Code::MissingSemicolon, place, "expected `;`").here("write `;` here");
        Some(if self.found.is_some() { diagnostic.label(span, "before this") } else { diagnostic })
    }
}

fn stray_doc(span: Span) -> Diagnostic {
    Diagnostic::error(Code::DocComment, span, "`///` documents an item that follows it, and none does")
        .help("write `//` for a remark")
}

/// Words that cannot be declared as names.
fn is_reserved(word: &str) -> bool {
    let joining = "and or not for in on as by with within where when every match else";
    let leading = "from path region line arc to about ccw cw energy load hold tie residual expect";
    let among = |list: &str| list.split(' ').any(|reserved| reserved == word);
    Place::File.rule(word).is_some() || among(joining) || among(leading)
}

/// Whether `word` is a unit symbol.
pub(in crate::syntax) fn is_unit(word: &str) -> bool {
    Unit::find(word).is_some()
}
