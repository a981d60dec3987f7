//! What is known where: before the run, at one time, at the points of a domain, after the run.

use crate::model::{Builtin, Domain, Expr, ExprKind, Piece};

/// What an expression may be made of, beyond parameters and numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ingredient {
    Field,
    State,
    Time,
    Coordinate,
    Region,
    Gap,
    Test,
    Functional,
    Measure,
    Run,
    Held,
}

/// What is known at one kind of place.
#[derive(Clone, Copy)]
pub(super) struct Context<'c> {
    pub(super) known: &'static [Ingredient],
    pub(super) domain: Option<&'c Domain>,
}

impl Context<'_> {
    /// Before the run, and before there is a mesh.
    pub(super) const CONSTANT: Context<'static> = Context { known: &[], domain: None };
    /// One number at each time.
    pub(super) const GLOBAL: Context<'static> = Context {
        known: &[Ingredient::State, Ingredient::Time, Ingredient::Functional, Ingredient::Measure],
        domain: None,
    };
    /// Conditions of events.
    pub(super) const EVENT: Context<'static> = Context {
        known: &[
            Ingredient::State,
            Ingredient::Time,
            Ingredient::Functional,
            Ingredient::Measure,
            Ingredient::Held,
        ],
        domain: None,
    };
    /// One number of a finished run.
    pub(super) const RESULT: Context<'static> = Context {
        known: &[
            Ingredient::State,
            Ingredient::Time,
            Ingredient::Functional,
            Ingredient::Measure,
            Ingredient::Run,
        ],
        domain: None,
    };
    /// Tests: no time of their own.
    pub(super) const TEST: Context<'static> =
        Context { known: &[Ingredient::Measure, Ingredient::Run], domain: None };
    /// The start of a state.
    pub(super) const START: Context<'static> = Context { known: &[Ingredient::Measure], domain: None };

    /// Sizes of cells: on surfaces of a pair they may follow the gap.
    pub(super) fn mesh_size(domain: Option<&Domain>) -> Context<'_> {
        match domain {
            Some(domain) if matches!(domain.pieces.first(), Some(Piece::Pair(..))) => {
                Context { known: &[Ingredient::Gap], domain: Some(domain) }
            }
            _ => Context::CONSTANT,
        }
    }

    /// The start of a field.
    pub(super) fn field_start(domain: &Domain) -> Context<'_> {
        Context {
            known: &[Ingredient::Coordinate, Ingredient::Region, Ingredient::Measure],
            domain: Some(domain),
        }
    }

    /// At the points of a domain.
    pub(super) fn on(domain: &Domain) -> Context<'_> {
        Context {
            known: &[
                Ingredient::Field,
                Ingredient::State,
                Ingredient::Time,
                Ingredient::Coordinate,
                Ingredient::Region,
                Ingredient::Gap,
                Ingredient::Functional,
                Ingredient::Measure,
            ],
            domain: Some(domain),
        }
    }

    /// In a weak form.
    pub(super) fn weak(domain: &Domain) -> Context<'_> {
        Context {
            known: &[
                Ingredient::Field,
                Ingredient::State,
                Ingredient::Time,
                Ingredient::Coordinate,
                Ingredient::Region,
                Ingredient::Gap,
                Ingredient::Functional,
                Ingredient::Measure,
                Ingredient::Test,
            ],
            domain: Some(domain),
        }
    }
}

/// The ingredient that `e` itself is.
pub(super) fn ingredient(e: &Expr) -> Option<Ingredient> {
    Some(match &e.kind {
        ExprKind::Field(_) => Ingredient::Field,
        ExprKind::Test(_) => Ingredient::Test,
        ExprKind::State(_) => Ingredient::State,
        ExprKind::Time => Ingredient::Time,
        ExprKind::Coordinate(_)
        | ExprKind::Normal(_)
        | ExprKind::Builtin(Builtin::Along | Builtin::Hoop, _) => Ingredient::Coordinate,
        ExprKind::MatchRegion(..) => Ingredient::Region,
        ExprKind::Gap(_) | ExprKind::PairNormal(_) => Ingredient::Gap,
        ExprKind::Reduce(..) | ExprKind::Force(..) | ExprKind::AtPoint(..) => Ingredient::Functional,
        ExprKind::Measure(_) => Ingredient::Measure,
        ExprKind::ReduceRun(..) | ExprKind::AtTime(..) | ExprKind::AtEvent(..) | ExprKind::OutcomeIs(_) => {
            Ingredient::Run
        }
        ExprKind::Held(..) => Ingredient::Held,
        _ => return None,
    })
}
