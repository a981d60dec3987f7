//! Whether the pieces of a `match` meet at their breakpoints, judged by numbers.
//!
//! Every function is lowered with free arguments. At each breakpoint one argument is solved for (Newton), the others take a few values of
//! their kind, and the two pieces are compared there: their values for `C0`, their derivatives by that argument too for `C1`.

use super::values_of;
use crate::derive;
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::form::size_of_kind;
use crate::lower::{Lowering, SymbolKind, Value};
use crate::model::{Arm, Expr, ExprKind, Function, Shape, Smoothness, StateId, StatementKind, Type};
use crate::scalar::{Id, Symbol, symbols_of};

/// Largest difference of two pieces that counts as none, relative to the values around.
const TOLERANCE: f64 = 1e-9;
/// Factors on the size of each argument that is not solved for.
const SAMPLES: [f64; 3] = [0.3, 0.9, 1.7];
/// Steps of Newton's method towards a breakpoint.
const STEPS: usize = 40;

/// Checks the `match`es of all functions, and those of lets and equations that stand on states alone.
pub(super) fn check(lowering: &mut Lowering<'_>, parameters: &[f64], sink: &mut Sink) {
    let model = lowering.model;
    for function in &model.functions {
        let lets = function.lets.iter().map(|(_, value)| value);
        let matches = matches_in(lets.chain([&function.result]));
        if matches.is_empty() {
            continue;
        }
        let Some(sizes) = bind(lowering, function, parameters) else { continue };
        for one in &matches {
            check_match(lowering, parameters, &sizes, one, sink);
        }
    }
    let equations = model.blocks.iter().flat_map(|block| &block.statements).filter_map(|statement| {
        match &statement.kind {
            StatementKind::Equation(a, b) => Some([a, b]),
            _ => None,
        }
    });
    let sizes = state_sizes(lowering, parameters);
    for one in matches_in(model.lets.iter().map(|item| &item.value).chain(equations.flatten())) {
        check_match(lowering, parameters, &sizes, &one, sink);
    }
}

/// All matches in expressions that promise something.
fn matches_in<'m>(exprs: impl Iterator<Item = &'m Expr>) -> Vec<Match<'m>> {
    let mut found = Vec::new();
    exprs.for_each(|expr| find(expr, &mut found));
    found
}

/// The symbol of each state, and its size.
fn state_sizes(lowering: &mut Lowering<'_>, parameters: &[f64]) -> Vec<(Symbol, f64)> {
    let model = lowering.model;
    let sizes = model.states.iter().enumerate().map(|(state, definition)| {
        let symbol = lowering.symbols.symbol(SymbolKind::State(StateId(state)));
        (symbol, size_of_kind(model, definition.dimension, parameters))
    });
    sizes.collect()
}

struct Match<'m> {
    scrutinee: &'m Expr,
    arms: &'m [Arm],
    otherwise: &'m Expr,
    smoothness: Smoothness,
}

/// All matches under an expression that promise something.
fn find<'m>(expr: &'m Expr, found: &mut Vec<Match<'m>>) {
    use ExprKind as K;
    match &expr.kind {
        K::MatchValue { scrutinee, arms, otherwise, smoothness } => {
            if *smoothness != Smoothness::Jumps {
                found.push(Match { scrutinee, arms, otherwise, smoothness: *smoothness });
            }
            arms.iter().for_each(|arm| find(&arm.value, found));
            find(otherwise, found);
        }
        K::Negate(a) | K::Component(a, _) | K::Component2(a, ..) | K::Rate(a) | K::Frozen(a) => {
            find(a, found)
        }
        K::Arithmetic(_, a, b) => {
            find(a, found);
            find(b, found);
        }
        K::Builtin(_, list) | K::Apply(_, list) | K::ApplyLocal(_, list) => {
            list.iter().for_each(|a| find(a, found))
        }
        _ => {}
    }
}

/// Gives the arguments of a function variables, and each variable a size; `None` if one is a law or a record.
fn bind<'m>(
    lowering: &mut Lowering<'m>,
    function: &'m Function,
    parameters: &[f64],
) -> Option<Vec<(Symbol, f64)>> {
    let mut sizes = Vec::new();
    for (local, ty) in &function.arguments {
        let Type::Value(shape, dimension) = ty else { return None };
        let count = match shape {
            Shape::Scalar => 1,
            Shape::Vector => 3,
            Shape::Tensor => 9,
        };
        let variables: Vec<Id> = (0..count).map(|_| lowering.fresh()).collect();
        let size = size_of_kind(lowering.model, *dimension, parameters);
        sizes.extend(symbols_of(&lowering.pool, &variables).into_iter().map(|symbol| (symbol, size)));
        lowering.set_local(*local, Value::from_components(&variables));
    }
    for (local, value) in &function.lets {
        lowering.set_local_let(*local, value);
    }
    Some(sizes)
}

fn check_match<'m>(
    lowering: &mut Lowering<'m>,
    parameters: &[f64],
    sizes: &[(Symbol, f64)],
    one: &Match<'m>,
    sink: &mut Sink,
) {
    let Ok(x) = lowering.global_scalar(one.scrutinee) else { return };
    let Some(&(solved, size)) =
        sizes.iter().find(|(symbol, _)| symbols_of(&lowering.pool, &[x]).contains(symbol))
    else {
        return;
    };
    let above = one.arms.iter().skip(1).map(|arm| &arm.value).chain([one.otherwise]);
    let mut faults = Vec::new();
    let mut largest = [0.0_f64; 2];
    for (arm, above) in one.arms.iter().zip(above) {
        let (Ok(bound), Ok(below), Ok(above)) = (
            lowering.global_scalar(&arm.bound),
            lowering.global_scalar(&arm.value),
            lowering.global_scalar(above),
        ) else {
            continue;
        };
        let difference = lowering.pool.sub(x, bound);
        let slope = derive::derivative(&mut lowering.pool, &[difference, below, above], solved);
        for factor in SAMPLES {
            let mut variables: Vec<(Symbol, f64)> =
                sizes.iter().map(|&(symbol, size)| (symbol, factor * size)).collect();
            if !solve(lowering, parameters, &mut variables, (solved, size), [difference, slope[0]]) {
                continue;
            }
            let found = values_of(lowering, &[below, above, slope[1], slope[2]], parameters, &variables);
            for (order, pair) in found.chunks(2).enumerate() {
                let size = pair[0].abs().max(pair[1].abs());
                largest[order] = largest[order].max(if size.is_finite() { size } else { 0.0 });
                faults.push((arm, order, pair[0], pair[1]));
            }
        }
    }
    let promised = usize::from(one.smoothness == Smoothness::C1);
    let broken = faults
        .into_iter()
        .find(|&(_, order, a, b)| order <= promised && (a - b).abs() > TOLERANCE * largest[order]);
    if let Some((arm, order, below, above)) = broken {
        let what = if order == 0 { "values" } else { "slopes" };
        let message = format!(
            "the {what} of the pieces do not meet at this bound: {below:.6e} below, {above:.6e} above"
        );
        let help = if order == 0 {
            "write `jumps` behind the `match` if the jump is meant"
        } else {
            "leave `C1` out if the kink is meant"
        };
        sink.push(Diagnostic::error(Code::Discontinuous, arm.bound.span, message).help(help));
    }
}

/// Moves one variable to where the difference is zero; whether it got there.
fn solve(
    lowering: &Lowering<'_>,
    parameters: &[f64],
    variables: &mut [(Symbol, f64)],
    (solved, size): (Symbol, f64),
    [difference, slope]: [Id; 2],
) -> bool {
    for _ in 0..STEPS {
        let now = values_of(lowering, &[difference, slope], parameters, variables);
        let step = now[0] / now[1];
        if !step.is_finite() {
            return false;
        }
        variables.iter_mut().filter(|(symbol, _)| *symbol == solved).for_each(|(_, value)| *value -= step);
        if step.abs() <= 1e-14 * size {
            return true;
        }
    }
    false
}
