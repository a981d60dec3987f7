//! Settings of mesh, pairs, output, events and solver at the default parameters: sizes and intervals are positive, a run ends after it starts.

use super::number;
use crate::check::walk::deep;
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::form::Forms;
use crate::lower::{Lowering, SymbolKind};
use crate::model::{Check, Every, Expr, ExprKind, Model, PairId, Piece, Trigger, Values};
use crate::scalar::eval;

/// A setting by name, the values that it can have, and the help where it has another one.
struct Rule {
    name: &'static str,
    holds: fn(f64) -> bool,
    needs: &'static str,
    help: &'static str,
}

const SIZE: Rule = Rule {
    name: "the size of a mesh",
    holds: positive,
    needs: "a length above 0",
    help: "write the length of an edge, such as a tenth of the smallest thing to resolve",
};
const GROWTH: Rule =
    Rule { name: "`growth`", holds: |x| x > 1.0, needs: "above 1", help: "write e.g. `growth = 1.25`" };
const QUALITY: Rule = Rule {
    name: "`quality`",
    holds: |x| (0.0..1.0).contains(&x),
    needs: "from 0 to 1",
    help: "write e.g. `quality = 0.3`",
};
const SEARCH: Rule = Rule {
    name: "the search distance of a pair",
    holds: positive,
    needs: "a length above 0",
    help: "search as far as the law acts",
};
const INTERVAL: Rule = Rule {
    name: "an interval",
    holds: positive,
    needs: "a time above 0",
    help: "write e.g. `every 0.5 s`, or `every step` for the end of each step",
};
const DURATION: Rule = Rule {
    name: "a duration",
    holds: |x| x >= 0.0 && x.is_finite(),
    needs: "a time of 0 or more",
    help: "write e.g. `for 60 s`, or leave it out where the event fires at once",
};
const STEP: Rule =
    Rule { name: "a time step", holds: positive, needs: "a time above 0", help: "write e.g. `max: 0.1 s`" };
const TOLERANCE: Rule =
    Rule { name: "a tolerance", holds: positive, needs: "above 0", help: "write e.g. `tolerance: 1e-8`" };
const ITERATIONS: Rule = Rule {
    name: "`iterations`",
    holds: |x| x >= 1.0 && x.is_finite() && x.fract() == 0.0,
    needs: "a whole number of at least 1",
    help: "write e.g. `iterations: 25`",
};

/// How often the search distance of a pair is halved to see which sizes its gaps ask for.
const HALVINGS: i32 = 10;

fn positive(x: f64) -> bool {
    x > 0.0 && x.is_finite()
}

/// Reports settings with which no run can start.
pub(super) fn check(forms: &mut Forms<'_>, parameters: &[f64], sink: &mut Sink) {
    let lowering = &mut forms.lowering;
    let model = lowering.model;
    for (rule, e) in rules(model) {
        // What cannot be lowered has been said.
        let Ok(value) = number(lowering, e, parameters) else { continue };
        if !(rule.holds)(value) {
            sink.push(broken(rule, e, &shown(value)));
        }
    }
    for (size, domain) in &model.mesh.sizes {
        for piece in domain.iter().flat_map(|domain| &domain.pieces) {
            if let Piece::Pair(pair, _) = piece {
                check_gap_size(lowering, parameters, size, *pair, sink);
            }
        }
    }
    model.tests.iter().for_each(|test| check_loops(lowering, parameters, &test.checks, sink));
    for order in orders(model) {
        let (low, high) = (number(lowering, order.low, parameters), number(lowering, order.high, parameters));
        if let (Ok(low), Ok(high)) = (low, high)
            && !(order.holds)(low, high)
        {
            let place = bad(order.high, order.message.into()).label(order.low.span, order.label);
            sink.push(place.help(order.help));
        }
    }
}

/// Reports loops of tests that lead nowhere, so that nothing in them is tested.
fn check_loops<'m>(lowering: &mut Lowering<'m>, parameters: &[f64], checks: &'m [Check], sink: &mut Sink) {
    for check in checks {
        let Check::Each(_, values, inner) = check else { continue };
        check_loops(lowering, parameters, inner, sink);
        let Values::Range { from, to, by } = values else { continue };
        let mut value = |e| number(lowering, e, parameters).unwrap_or(f64::NAN);
        // What depends on the variable of another loop is not known here.
        let (way, step) = (value(to) - value(from), value(by));
        if step == 0.0 || way / step < 0.0 {
            let message = format!("this loop has no values: steps of {} do not lead to its end", shown(step));
            sink.push(bad(by, message).label(from.span, "it starts here").label(to.span, "and ends here"));
        }
    }
}

/// Two numbers of which the second follows the first.
struct Order<'m> {
    low: &'m Expr,
    high: &'m Expr,
    holds: fn(f64, f64) -> bool,
    message: &'static str,
    label: &'static str,
    help: &'static str,
}

/// Every pair of settings that have an order.
fn orders(model: &Model) -> Vec<Order<'_>> {
    let (solve, rising) = (&model.solve, |low, high| low < high);
    let time = solve.time.iter().map(|(low, high)| Order {
        low,
        high,
        holds: |low, high| low < high && (high - low).is_finite(),
        message: "the time of a run must end after it starts",
        label: "it starts here",
        help: "write `0 s .. 250 s`",
    });
    let steps = solve.min_step.iter().zip(&solve.max_step).map(|(low, high)| Order {
        low,
        high,
        // A step that is not positive has been said.
        holds: |low, high| low <= high || high <= 0.0,
        message: "the largest step is smaller than the smallest one",
        label: "the smallest step",
        help: "write e.g. `max: 0.1 s, min: 1e-6 s`",
    });
    let states =
        model.states.iter().filter_map(|state| state.bounds.as_ref()).map(move |(low, high)| Order {
            low,
            high,
            holds: rising,
            message: "the range of a state must end above its start",
            label: "it starts here",
            help: "write the smaller bound first: `in 0 .. 1`",
        });
    time.chain(steps).chain(states).collect()
}

/// Every setting that is a number of parameters alone, with its rule.
fn rules(model: &Model) -> Vec<(&'static Rule, &Expr)> {
    let mut found: Vec<(&Rule, &Expr)> = Vec::new();
    let on_pair = |pieces: &[Piece]| matches!(pieces, [Piece::Pair(..), ..]);
    let plain =
        model.mesh.sizes.iter().filter(|(_, domain)| !domain.as_ref().is_some_and(|d| on_pair(&d.pieces)));
    found.extend(plain.map(|(size, _)| (&SIZE, size)));
    found.extend(model.mesh.growth.iter().map(|e| (&GROWTH, e)));
    found.extend(model.mesh.quality.iter().map(|e| (&QUALITY, e)));
    found.extend(model.pairs.iter().map(|pair| (&SEARCH, &pair.search)));
    let output = &model.output;
    let intervals = output.frames.iter().map(|frames| &frames.every);
    let intervals = intervals.chain(output.tables.iter().map(|table| &table.every)).chain(&output.checkpoint);
    found.extend(intervals.filter_map(|every| match every {
        Every::Time(time) => Some((&INTERVAL, time)),
        Every::Step => None,
    }));
    for event in &model.events {
        match &event.trigger {
            Trigger::Every(time) => found.push((&INTERVAL, time)),
            Trigger::When(condition) => deep(model, condition, &mut |e| {
                if let ExprKind::Held(_, duration) = &e.kind {
                    found.push((&DURATION, duration));
                }
            }),
            Trigger::EveryStep => {}
        }
    }
    let solve = &model.solve;
    found.extend(solve.max_step.iter().chain(&solve.min_step).map(|e| (&STEP, e)));
    found.extend([(&TOLERANCE, &solve.step_tolerance), (&TOLERANCE, &solve.newton_tolerance)]);
    found.push((&ITERATIONS, &solve.newton_iterations));
    found
}

/// Reports a size between the surfaces of a pair that is no length at some gap within the search distance.
fn check_gap_size<'m>(
    lowering: &mut Lowering<'m>,
    parameters: &[f64],
    size: &'m Expr,
    pair: PairId,
    sink: &mut Sink,
) {
    let search = number(lowering, &lowering.model.pairs[pair.0].search, parameters);
    let (Ok(search), Ok(id)) = (search, lowering.scalar_on_pair(size, pair)) else { return };
    for gap in (0..=HALVINGS).map(|k| search * 0.5_f64.powi(k)) {
        let value = eval(&lowering.pool, &[id], &|symbol| match lowering.symbols.kind(symbol) {
            SymbolKind::Parameter(param) => parameters.get(param.0).copied().unwrap_or(f64::NAN),
            _ => gap,
        })[0];
        if !(SIZE.holds)(value) {
            let at = format!("{} at a gap of {}", shown(value), shown(gap));
            return sink.push(broken(&SIZE, size, &at));
        }
    }
}

fn broken(rule: &Rule, e: &Expr, value: &str) -> Diagnostic {
    bad(e, format!("{} is {}, and this is {value}", rule.name, rule.needs)).help(rule.help)
}

fn bad(e: &Expr, message: String) -> Diagnostic {
    Diagnostic::error(Code::BadSetting, e.span, message).here("with the default parameters")
}

/// A number in the units of the model, without the noise of its last digits.
fn shown(x: f64) -> String {
    if x.is_infinite() {
        return String::from("infinite");
    }
    format!("{x:.6e}").parse::<f64>().unwrap_or(x).to_string()
}
