//! The tests that need no run: laws are evaluated at the default parameters.

use super::{defaults, values_of};
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::form::Forms;
use crate::lower::{Condition, Lowered, Lowering};
use crate::model::{Check, Expr, Test, Values};
use crate::scalar::{Id, Symbol, symbols_of};
use crate::source::{SourceMap, Span};
use std::fmt::Write;

/// Results of the tests that need no run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LawTests {
    /// One line per test, and one per expectation that does not hold.
    pub text: String,
    /// Number of expectations that do not hold.
    pub failed: usize,
}

/// Most points of a loop.
const MOST_POINTS: usize = 1_000_000;

/// Runs all tests that need no run. What does not hold is a warning.
pub fn law_tests(forms: &mut Forms<'_>, sources: &SourceMap, sink: &mut Sink) -> LawTests {
    let mut results = LawTests::default();
    let model = forms.lowering.model;
    let parameters = defaults(&mut forms.lowering);
    for test in model.tests.iter().filter(|test| !test.needs_run) {
        match run(&mut forms.lowering, &parameters, test) {
            Ok(outcome) => outcome.report(test, sources, &mut results, sink),
            Err(problem) => sink.push(*problem),
        }
    }
    results
}

/// A check, ready to be evaluated.
enum Ready {
    Each(Symbol, Points, Vec<Ready>),
    Holds(Condition, Span),
    Near { value: Vec<Id>, expected: Vec<Id>, tolerance: Id, percent: bool, span: Span },
}

/// Points of a loop.
enum Points {
    Range([Id; 3]),
    Set(Vec<Id>),
}

#[derive(Default)]
struct Outcome {
    count: usize,
    /// First failure of each expectation, and how often it failed.
    failures: Vec<(Span, String, usize)>,
}

fn run<'m>(lowering: &mut Lowering<'m>, parameters: &[f64], test: &'m Test) -> Lowered<Outcome> {
    let checks = lower_all(lowering, &test.checks)?;
    let mut outcome = Outcome::default();
    let mut runner = Runner { lowering, parameters, variables: Vec::new() };
    runner.run(&checks, &mut outcome);
    Ok(outcome)
}

fn lower_all<'m>(lowering: &mut Lowering<'m>, checks: &'m [Check]) -> Lowered<Vec<Ready>> {
    let mut lowered = Vec::new();
    for check in checks {
        lowered.push(match check {
            Check::Let(local, value) => {
                lowering.set_local_let(*local, value);
                continue;
            }
            Check::Each(local, values, body) => {
                let points = match values {
                    Values::Range { from, to, by } => Points::Range([
                        lowering.global_scalar(from)?,
                        lowering.global_scalar(to)?,
                        lowering.global_scalar(by)?,
                    ]),
                    Values::Set(set) => Points::Set(
                        set.iter().map(|value| lowering.global_scalar(value)).collect::<Lowered<_>>()?,
                    ),
                };
                let variable = lowering.fresh();
                lowering.set_local(*local, crate::lower::Value::Scalar(variable));
                let symbol = symbols_of(&lowering.pool, &[variable]).into_iter().next();
                let symbol = symbol
                    .ok_or_else(|| crate::lower::internal(Span::default(), "a variable without a symbol"))?;
                Ready::Each(symbol, points, lower_all(lowering, body)?)
            }
            Check::Holds(condition, span) => Ready::Holds(lowering.global_condition(condition)?, *span),
            Check::Near { value, expected, tolerance, percent, span } => Ready::Near {
                value: components(lowering, value)?,
                expected: components(lowering, expected)?,
                tolerance: lowering.global_scalar(tolerance)?,
                percent: *percent,
                span: *span,
            },
        });
    }
    Ok(lowered)
}

fn components<'m>(lowering: &mut Lowering<'m>, expr: &'m Expr) -> Lowered<Vec<Id>> {
    let value = lowering.global(expr)?;
    Ok(value.components(&mut lowering.pool))
}

struct Runner<'a, 'm> {
    lowering: &'a Lowering<'m>,
    parameters: &'a [f64],
    variables: Vec<(Symbol, f64)>,
}

impl Runner<'_, '_> {
    fn values(&self, ids: &[Id]) -> Vec<f64> {
        values_of(self.lowering, ids, self.parameters, &self.variables)
    }

    fn run(&mut self, checks: &[Ready], outcome: &mut Outcome) {
        for check in checks {
            match check {
                Ready::Each(symbol, points, body) => {
                    for value in self.points(points) {
                        self.variables.push((*symbol, value));
                        self.run(body, outcome);
                        self.variables.pop();
                    }
                }
                Ready::Holds(condition, span) => {
                    let holds = condition.truth(&|id| self.values(&[id])[0]);
                    outcome.note(*span, holds, || String::from("it does not hold"));
                }
                Ready::Near { value, expected, tolerance, percent, span } => {
                    let (found, wanted) = (self.values(value), self.values(expected));
                    let size = wanted.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
                    let tolerance = self.values(&[*tolerance])[0] * if *percent { 0.01 * size } else { 1.0 };
                    let at = |values: &[f64], k: usize| {
                        values.get(k).or(values.first()).copied().unwrap_or(f64::NAN)
                    };
                    let far = (0..found.len().max(wanted.len())).find(|&k| {
                        let distance = (at(&found, k) - at(&wanted, k)).abs();
                        distance.is_nan() || distance > tolerance
                    });
                    outcome.note(*span, far.is_none(), || {
                        let k = far.unwrap_or(0);
                        format!(
                            "found {:e}, expected {:e} within {tolerance:e}",
                            at(&found, k),
                            at(&wanted, k)
                        )
                    });
                }
            }
        }
    }

    fn points(&self, points: &Points) -> Vec<f64> {
        match points {
            Points::Set(set) => self.values(set),
            Points::Range(ids) => {
                let [from, to, by] = [0, 1, 2].map(|k| self.values(ids)[k]);
                let count = ((to - from) / by * (1.0 + 1e-12)).floor();
                let count =
                    if count.is_finite() && count >= 0.0 { (count as usize).min(MOST_POINTS) + 1 } else { 0 };
                (0..count).map(|k| from + k as f64 * by).collect()
            }
        }
    }
}

impl Outcome {
    fn note(&mut self, span: Span, holds: bool, what: impl FnOnce() -> String) {
        self.count += 1;
        if holds {
            return;
        }
        match self.failures.iter_mut().find(|(known, ..)| *known == span) {
            Some((.., times)) => *times += 1,
            None => self.failures.push((span, what(), 1)),
        }
    }

    fn report(self, test: &Test, sources: &SourceMap, results: &mut LawTests, sink: &mut Sink) {
        let failed: usize = self.failures.iter().map(|(.., times)| times).sum();
        results.failed += failed;
        let verdict = if failed == 0 { String::from("ok") } else { format!("{failed} FAILED") };
        // Writing to a string cannot fail.
        let _ = writeln!(
            results.text,
            "test \"{}\": {} of {} hold, {verdict}",
            test.title,
            self.count - failed,
            self.count
        );
        for (span, what, times) in self.failures {
            let _ = writeln!(
                results.text,
                "  {} {}: {what} ({times} times)",
                sources.locate(span),
                sources.slice(span)
            );
            let message = format!("the expectation fails: {what}");
            sink.push(Diagnostic::warning(Code::Failed, span, message).label(test.span, "in this test"));
        }
    }
}
