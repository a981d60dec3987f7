//! States against equations: counted and matched. A state without an equation gets its balance from the energies in which it occurs.
//!
//! The matching is a maximum bipartite one (Kuhn's augmenting paths) between equations and the states in them, their rates included.

use super::walk::deep;
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::model::{BlockId, Expr, ExprKind, FieldId, Model, StateId, StatementKind};
use crate::source::{SourceMap, Span};
use std::collections::BTreeSet;

/// What determines a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// An equation: the statement of that number in that block.
    Equation(BlockId, usize),
    /// The energies and loads in which it occurs: it is varied in them.
    Energy,
}

/// An equation and the states in it.
struct Equation {
    block: BlockId,
    statement: usize,
    span: Span,
    states: BTreeSet<StateId>,
}

/// Equations, energies and the matching between equations and states.
struct System {
    equations: Vec<Equation>,
    /// States that occur in an energy or in a quantity that a load works on.
    varied: BTreeSet<StateId>,
    /// The equation of each state.
    matched: Vec<Option<usize>>,
}

/// What determines each state, by [`StateId`]; every state of a checked model has an owner.
#[must_use]
pub fn owners(model: &Model) -> Vec<Owner> {
    let system = System::new(model);
    let owner = |equation: &Option<usize>| match equation {
        Some(at) => Owner::Equation(system.equations[*at].block, system.equations[*at].statement),
        None => Owner::Energy,
    };
    system.matched.iter().map(owner).collect()
}

/// Reports states that nothing determines and equations that determine nothing.
pub(super) fn check(model: &Model, sources: &SourceMap, sink: &mut Sink) {
    let system = System::new(model);
    let undetermined: Vec<StateId> = (0..model.states.len())
        .map(StateId)
        .filter(|id| system.matched[id.0].is_none() && !system.varied.contains(id))
        .collect();
    let idle: Vec<usize> =
        (0..system.equations.len()).filter(|at| !system.matched.contains(&Some(*at))).collect();
    let count = format!(
        "{}, {}",
        counted(model.states.len(), "state", "states"),
        counted(system.equations.len(), "equation", "equations")
    );
    for id in &undetermined {
        let state = &model.states[id.0];
        let code = match system.equations.iter().any(|equation| equation.states.contains(id)) {
            _ if !idle.is_empty() => Code::Unmatched,
            true => Code::TooFewEquations,
            false => Code::Unbalanced,
        };
        let message = format!("{count}: nothing determines `{}`", state.name);
        let mut diagnostic = Diagnostic::error(code, state.span, message);
        for equation in system.equations.iter().filter(|equation| equation.states.contains(id)) {
            let other = system
                .matched
                .iter()
                .position(|at| at.is_some_and(|at| system.equations[at].span == equation.span));
            let other = other
                .map_or(String::new(), |other| format!("this one determines `{}`", model.states[other].name));
            diagnostic = diagnostic.label(equation.span, other);
        }
        sink.push(
            diagnostic.help(
                "write one more equation `a == b;` in a physics block, or an energy with the state in it",
            ),
        );
    }
    for at in idle {
        sink.push(idle_equation(model, &system.equations[at], &count, undetermined.is_empty(), sources));
    }
    fields(model, sink);
    unvaried(model, &system, sink);
}

/// Energies and loads in which nothing varies: without a field, and with states that equations determine.
fn unvaried(model: &Model, system: &System, sink: &mut Sink) {
    for statement in model.blocks.iter().flat_map(|block| &block.statements) {
        let (e, what) = match &statement.kind {
            // The measure of a moved path varies by itself.
            StatementKind::Energy(_, Some(domain)) if domain.current => continue,
            StatementKind::Energy(e, _) => (e, "in this energy"),
            StatementKind::Load(e, ..) => (e, "that this load works on"),
            StatementKind::Residual(..)
            | StatementKind::Hold(..)
            | StatementKind::Tie(..)
            | StatementKind::Equation(..) => continue,
        };
        let mut varies = false;
        deep(model, e, &mut |e| {
            varies |= matches!(e.kind, ExprKind::Field(_) | ExprKind::Gap(_) | ExprKind::PairNormal(_));
        });
        let mut states = BTreeSet::new();
        states_in(model, e, &mut states, &mut BTreeSet::new());
        if varies || states.iter().any(|id| system.matched[id.0].is_none()) {
            continue;
        }
        let mut diagnostic =
            Diagnostic::error(Code::TooManyEquations, e.span, format!("nothing {what} can vary"));
        for id in states {
            let Some(at) = system.matched[id.0] else { continue };
            let text = format!("this determines `{}` already", model.states[id.0].name);
            diagnostic = diagnostic.label(system.equations[at].span, text);
        }
        sink.push(diagnostic.help(
            "energies and loads vary fields, and numbers made from them such as `mean(u.y on D)`; what acts on a state stands in its equation",
        ));
    }
}

fn counted(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

fn idle_equation(
    model: &Model,
    equation: &Equation,
    count: &str,
    too_many: bool,
    sources: &SourceMap,
) -> Diagnostic {
    let text = sources.slice(equation.span);
    if equation.states.is_empty() {
        return Diagnostic::error(Code::Unmatched, equation.span, "there is no state in this equation")
            .help("a condition on fields is a `hold` or a `residual`");
    }
    let code = if too_many { Code::TooManyEquations } else { Code::Unmatched };
    let names: Vec<String> =
        equation.states.iter().map(|id| format!("`{}`", model.states[id.0].name)).collect();
    let subject = if names.len() == 1 { "is" } else { "are" };
    Diagnostic::error(code, equation.span, format!("{count}: nothing is left for this one to determine"))
        .help(format!(
            "{} {subject} determined by other equations already; `{}` is one too many",
            names.join(", "),
            text.trim_end_matches(';')
        ))
}

/// Every field is varied in an energy, or worked on by a load, or tested.
fn fields(model: &Model, sink: &mut Sink) {
    let mut used: BTreeSet<FieldId> = BTreeSet::new();
    for statement in model.blocks.iter().flat_map(|block| &block.statements) {
        match &statement.kind {
            StatementKind::Energy(e, _) | StatementKind::Load(e, ..) => deep(model, e, &mut |e| {
                if let ExprKind::Field(id) = e.kind {
                    used.insert(id);
                }
            }),
            StatementKind::Residual(e, _) => deep(model, e, &mut |e| {
                if let ExprKind::Test(id) = e.kind {
                    used.insert(id);
                }
            }),
            StatementKind::Hold(..) | StatementKind::Tie(..) | StatementKind::Equation(..) => {}
        }
    }
    for (at, field) in model.fields.iter().enumerate().filter(|(at, _)| !used.contains(&FieldId(*at))) {
        let _ = at;
        let message = format!("nothing determines field `{}`", field.name);
        sink.push(
            Diagnostic::error(Code::Unbalanced, field.span, message).help(format!(
                "write an energy with `{0}` in it, or a residual with `test({0})`",
                field.name
            )),
        );
    }
}

impl System {
    fn new(model: &Model) -> Self {
        let mut equations = Vec::new();
        let mut varied = BTreeSet::new();
        let mut rates = BTreeSet::new();
        for (block, statements) in
            model.blocks.iter().enumerate().map(|(at, block)| (BlockId(at), &block.statements))
        {
            for (statement, item) in statements.iter().enumerate() {
                match &item.kind {
                    StatementKind::Equation(a, b) => {
                        let mut states = BTreeSet::new();
                        states_in(model, a, &mut states, &mut rates);
                        states_in(model, b, &mut states, &mut rates);
                        equations.push(Equation { block, statement, span: item.span, states });
                    }
                    StatementKind::Energy(e, _) | StatementKind::Load(e, ..) => {
                        states_in(model, e, &mut varied, &mut BTreeSet::new());
                    }
                    StatementKind::Residual(..) | StatementKind::Hold(..) | StatementKind::Tie(..) => {}
                }
            }
        }
        let mut system = Self { equations, varied, matched: vec![None; model.states.len()] };
        system.assign(&rates);
        system
    }

    /// Matches first the states that no energy balances; among them those with a rate and those in many equations.
    fn assign(&mut self, rates: &BTreeSet<StateId>) {
        let mut order: Vec<StateId> = (0..self.matched.len()).map(StateId).collect();
        let uses =
            |id: StateId| self.equations.iter().filter(|equation| equation.states.contains(&id)).count();
        order.sort_by_key(|id| {
            (self.varied.contains(id), !rates.contains(id), std::cmp::Reverse(uses(*id)), *id)
        });
        for id in order {
            self.augment(id, &mut BTreeSet::new());
        }
    }

    /// Finds an equation for a state, moving other states to other equations where that helps.
    fn augment(&mut self, id: StateId, tried: &mut BTreeSet<usize>) -> bool {
        for at in 0..self.equations.len() {
            if !self.equations[at].states.contains(&id) || !tried.insert(at) {
                continue;
            }
            let holder = self.matched.iter().position(|matched| *matched == Some(at));
            if holder.is_none_or(|holder| self.augment(StateId(holder), tried)) {
                self.matched[id.0] = Some(at);
                return true;
            }
        }
        false
    }
}

/// The states in an expression, and those of which it takes the rate.
fn states_in(model: &Model, e: &Expr, states: &mut BTreeSet<StateId>, rates: &mut BTreeSet<StateId>) {
    deep(model, e, &mut |e| match &e.kind {
        ExprKind::State(id) => {
            states.insert(*id);
        }
        ExprKind::Rate(inner) => deep(model, inner, &mut |e| {
            if let ExprKind::State(id) = e.kind {
                rates.insert(id);
            }
        }),
        _ => {}
    });
}
