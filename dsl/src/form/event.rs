//! Events: when they fire and what they do.

use super::Builder;
use super::observe::observed;
use super::output::When;
use crate::lower::{Condition, Lowered, Lowering, unsupported};
use crate::model::{self, Expr, ExprKind, StateId};
use crate::scalar::Id;

/// A named event.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Event {
    pub name: String,
    pub doc: String,
    pub trigger: Trigger,
    pub actions: Vec<Action>,
}

/// When an event fires.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub enum Trigger {
    /// When `condition` has been positive for `duration` while `also` is positive.
    When { condition: Id, duration: Id, also: Id },
    /// After steps or at times.
    Every(When),
}

/// What an event does.
#[derive(Clone, Debug)]
pub enum Action {
    /// End the run.
    Stop,
    /// Record a message.
    Warn(String),
    /// Give a state a new value.
    Set(StateId, Id),
    /// Mesh moving regions anew.
    Remesh,
}

impl Event {
    /// Scalars to be evaluated.
    pub(super) fn roots(&self) -> Vec<Id> {
        let mut roots = match &self.trigger {
            Trigger::When { condition, duration, also } => vec![*condition, *duration, *also],
            Trigger::Every(When::Time(time)) => vec![*time],
            Trigger::Every(When::Step) => Vec::new(),
        };
        roots.extend(
            self.actions
                .iter()
                .filter_map(|action| if let Action::Set(_, value) = action { Some(*value) } else { None }),
        );
        roots
    }
}

impl<'m> Builder<'m> {
    /// Lowers all events.
    pub(super) fn events(&mut self, rows: &[usize]) -> Vec<Event> {
        let events = &self.lowering.model.events;
        events
            .iter()
            .filter_map(|event| self.attempt(|lowering| lower_event(lowering, rows, event)))
            .collect()
    }
}

fn lower_event<'m>(lowering: &mut Lowering<'m>, rows: &[usize], event: &'m model::Event) -> Lowered<Event> {
    lowering.name_after(&event.name);
    let trigger = match &event.trigger {
        model::Trigger::When(condition) => when(lowering, rows, condition)?,
        model::Trigger::EveryStep => Trigger::Every(When::Step),
        model::Trigger::Every(time) => Trigger::Every(When::Time(lowering.global_scalar(time)?)),
    };
    let mut actions = Vec::new();
    for action in &event.actions {
        actions.push(match action {
            model::Action::Stop => Action::Stop,
            model::Action::Warn(text) => Action::Warn(text.clone()),
            model::Action::Remesh(_) => Action::Remesh,
            model::Action::Set(state, value) => {
                let value = lowering.global_scalar(value)?;
                Action::Set(*state, observed(lowering, rows, value)?)
            }
        });
    }
    Ok(Event { name: event.name.clone(), doc: event.doc.clone(), trigger, actions })
}

/// Splits `a for T and b` into what must last and what must hold besides.
fn when<'m>(lowering: &mut Lowering<'m>, rows: &[usize], condition: &'m Expr) -> Lowered<Trigger> {
    let mut parts = Vec::new();
    conjuncts(condition, &mut parts);
    let held = parts.iter().position(|part| matches!(part.kind, ExprKind::Held(..)));
    let (lasting, duration) = match held.map(|k| &parts.remove(k).kind) {
        Some(ExprKind::Held(lasting, duration)) => (vec![&**lasting], Some(&**duration)),
        _ => (std::mem::take(&mut parts), None),
    };
    let zero = lowering.pool.zero();
    Ok(Trigger::When {
        condition: margin(lowering, rows, &lasting)?,
        duration: duration.map_or(Ok(zero), |duration| lowering.global_scalar(duration))?,
        also: margin(lowering, rows, &parts)?,
    })
}

fn conjuncts<'m>(condition: &'m Expr, parts: &mut Vec<&'m Expr>) {
    match &condition.kind {
        ExprKind::And(a, b) => {
            conjuncts(a, parts);
            conjuncts(b, parts);
        }
        _ => parts.push(condition),
    }
}

/// A scalar that is positive where all conditions hold; 1 if there are none.
fn margin<'m>(lowering: &mut Lowering<'m>, rows: &[usize], conditions: &[&'m Expr]) -> Lowered<Id> {
    let mut all: Option<Id> = None;
    for expr in conditions {
        let condition: Condition = lowering.global_condition(expr)?;
        let margin = condition.margin(&mut lowering.pool).ok_or_else(|| {
            unsupported(expr.span, "an event cannot wait for an equality; compare with `<` or `>`")
        })?;
        let margin = observed(lowering, rows, margin)?;
        all = Some(all.map_or(margin, |all| lowering.pool.min(all, margin)));
    }
    Ok(all.unwrap_or_else(|| lowering.pool.one()))
}
