//! Statements that say again, or otherwise, what another one says: of two only one would count, without a word.
//!
//! Holds may meet: the last one wins in a point, and on a part of what an earlier one holds. What would hold nowhere is reported.

use super::domain::piece_words;
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::model::{Action, Domain, FieldId, Model, Piece, StatementKind};
use crate::source::Span;

/// A `hold`: the field, the component if one is meant, and where.
struct Held<'m> {
    field: FieldId,
    component: Option<usize>,
    domain: &'m Domain,
    span: Span,
}

/// A `tie` by the field that it takes from the unknowns, and the one that this follows.
struct Tied<'m> {
    field: FieldId,
    partner: FieldId,
    domain: &'m Domain,
    span: Span,
}

/// Reports what is said twice.
pub(super) fn check(model: &Model, sink: &mut Sink) {
    let (mut holds, mut ties) = (Vec::new(), Vec::new());
    for statement in model.blocks.iter().flat_map(|block| &block.statements) {
        let span = statement.span;
        match &statement.kind {
            StatementKind::Hold(field, component, _, domain) => {
                holds.push(Held { field: *field, component: *component, domain, span });
            }
            StatementKind::Tie(tie, domain) => {
                ties.push(Tied { field: tie.field, partner: tie.partner, domain, span });
            }
            _ => {}
        }
    }
    for (at, tie) in ties.iter().enumerate() {
        tied_twice(model, &ties[..at], tie, sink);
        held_and_tied(model, &holds, tie, sink);
    }
    for (at, hold) in holds.iter().enumerate() {
        hidden_hold(model, hold, &holds[at + 1..], sink);
    }
    moved_twice(model, sink);
    for event in &model.events {
        done_twice(model, &event.actions, sink);
    }
}

/// `message` at `span`, and where it was said first.
fn repeated(span: Span, message: String, first: Span, label: &str) -> Diagnostic {
    Diagnostic::error(Code::Repeated, span, message).label(first, label)
}

fn words(model: &Model, piece: Piece) -> String {
    piece_words(&model.geometry, &model.pairs, piece)
}

fn tied_twice(model: &Model, before: &[Tied<'_>], tie: &Tied<'_>, sink: &mut Sink) {
    let others = before.iter().filter(|other| other.field == tie.field);
    let shared = others.filter_map(|other| Some((other, model.shared(other.domain, tie.domain)?)));
    if let Some((first, piece)) = shared.into_iter().next() {
        let message =
            format!("`{}` is tied on {} twice", model.fields[tie.field.0].name, words(model, piece));
        sink.push(repeated(tie.span, message, first.span, "first here").help("keep one of the two"));
    }
}

/// The tied unknowns have left the equations, so that nothing can be held.
fn held_and_tied(model: &Model, holds: &[Held<'_>], tie: &Tied<'_>, sink: &mut Sink) {
    for hold in holds.iter().filter(|hold| hold.field == tie.field) {
        let Some(piece) = model.shared(hold.domain, tie.domain) else { continue };
        let [name, partner] = [tie.field, tie.partner].map(|field| &model.fields[field.0].name);
        let here = words(model, piece);
        let message = format!("`{name}` is held and tied on {here}, where the tie wins");
        sink.push(repeated(hold.span, message, tie.span, "tied here").help(format!(
            "hold `{partner}`, which `{name}` follows, or name in the `hold` only what is not tied"
        )));
    }
}

/// A hold behind which a later one leaves nothing.
fn hidden_hold(model: &Model, hold: &Held<'_>, later: &[Held<'_>], sink: &mut Sink) {
    let hides = |other: &&Held<'_>| {
        other.field == hold.field
            && (other.component.is_none() || other.component == hold.component)
            && model.outside(hold.domain, other.domain).is_none()
    };
    if let Some(other) = later.iter().find(hides) {
        let name = &model.fields[hold.field.0].name;
        let message = format!("`{name}` is held here already, and the last `hold` wins");
        sink.push(
            repeated(other.span, message, hold.span, "this one has no effect")
                .help("keep one of the two; a variant writes `replace physics NAME { .. }`"),
        );
    }
}

fn moved_twice(model: &Model, sink: &mut Sink) {
    for (at, moving) in model.moving.iter().enumerate() {
        if let Some(first) = model.moving[..at].iter().find(|other| other.region == moving.region) {
            let message = format!("{} moves already", words(model, Piece::Region(moving.region)));
            sink.push(repeated(moving.span, message, first.span, "first here").help("keep one of the two"));
        }
    }
}

/// Actions of one event that repeat each other.
fn done_twice(model: &Model, actions: &[Action], sink: &mut Sink) {
    for (at, action) in actions.iter().enumerate() {
        for before in &actions[..at] {
            let (message, span, first) = match (before, action) {
                (Action::Remesh(first), Action::Remesh(domain)) => {
                    let Some(piece) = model.shared(first, domain) else { continue };
                    (format!("{} is meshed anew twice", words(model, piece)), domain.span, first.span)
                }
                (Action::Set(state, first), Action::Set(other, value)) if state == other => {
                    (format!("`{}` is set twice", model.states[state.0].name), value.span, first.span)
                }
                _ => continue,
            };
            sink.push(repeated(span, message, first, "first here").help("keep one of the two"));
        }
    }
}
