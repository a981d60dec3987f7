//! Stage 5 of 6: from statements to what is assembled. Input: the model, lowered expression by expression. Output: [`Forms`]: integrals
//! with fluxes and tangents, equations of states, functionals, observables, outputs, all in point or global symbols. Knows no element.
//!
//! - `vary`: the rule of variation; every energy, load and weak form becomes a [`Term`].
//! - `physics`: the statements of the blocks; `pair`: those on contact pairs.
//! - `plane`: what acts out of the plane is refused.
//! - `states`: equations of states; `balance`: those that energies give.
//! - `observe`: which scalars are rows of the system (functionals) and which are only looked at (observables).
//! - `rates`: which fields have a history.
//! - `settings`: what depends on parameters alone.
//! - `output`, `event`, `expect`: tables, frames, events, run-time tests.

mod balance;
mod degree;
mod event;
mod expect;
mod observe;
mod output;
mod pair;
mod physics;
mod plane;
pub mod print;
mod rates;
pub mod settings;
mod states;
mod vary;

use crate::diagnostic::Diagnostic;
use crate::lower::{Lowered, Lowering, Part, Region, SymbolKind};
use crate::model::{BlockId, FieldId, Model, Tie};
use crate::scalar::Id;
use crate::source::Span;

pub use event::{Action, Event, Trigger};
pub use expect::{Expectation, RunTest};
pub use observe::{Functional, FunctionalKind};
pub use output::{Column, FrameColumn, Frames, PointForm, PointInput, Table, When};
pub use pair::{Contact, GapEnergy, PairLoad};
pub use states::{Equation, StateSystem, size_of_kind};
pub use vary::Term;

/// Everything that is to be emitted, apart from geometry and parameters, which the model has.
#[derive(Debug)]
pub struct Forms<'m> {
    /// The pool and the meaning of its symbols.
    pub lowering: Lowering<'m>,
    /// What depends on parameters alone.
    pub settings: settings::Settings,
    /// Integrals of the balance.
    pub terms: Vec<Term>,
    /// Prescribed components.
    pub holds: Vec<Hold>,
    /// Fields that follow others.
    pub ties: Vec<TieOn>,
    /// Energies of gaps.
    pub gap_energies: Vec<GapEnergy>,
    /// Loads on contact pairs.
    pub pair_loads: Vec<PairLoad>,
    /// Loads on functionals.
    pub couplings: Vec<Coupling>,
    /// Equations of the states.
    pub states: StateSystem,
    /// Scalars that are rows of the system.
    pub functionals: Vec<Functional>,
    /// Quantities that only outputs and events read, each after those it reads.
    pub observables: Vec<usize>,
    /// Start of each field.
    pub starts: Vec<Vec<Id>>,
    /// Displacement field of each pair.
    pub displacements: Vec<FieldId>,
    /// Events.
    pub events: Vec<Event>,
    /// Tables.
    pub tables: Vec<Table>,
    /// Frames.
    pub frames: Vec<Frames>,
    /// Tests that read a finished run.
    pub tests: Vec<RunTest>,
}

/// `tie` of two fields.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct TieOn {
    pub tie: Tie,
    pub region: Region,
    pub span: Span,
}

/// `hold` of one component.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Hold {
    pub field: FieldId,
    /// Stored component.
    pub component: usize,
    pub region: Region,
    pub value: Id,
    pub span: Span,
}

/// Virtual work `coefficient * delta quantity`, on the left side.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Coupling {
    pub block: BlockId,
    pub quantity: usize,
    pub coefficient: Id,
    pub span: Span,
}

/// Builds all forms of a model.
///
/// # Errors
/// Everything that the compiler cannot do, in order of place.
pub fn build(model: &Model) -> Result<Forms<'_>, Vec<Diagnostic>> {
    let mut builder = Builder { lowering: Lowering::new(model), problems: Vec::new() };
    let settings = builder.settings();
    let physics = builder.physics();
    let functionals = builder.functionals(&physics);
    let states = builder.states(&physics.differences);
    let rows: Vec<usize> = functionals.iter().map(|functional| functional.quantity).collect();
    let starts = builder.starts();
    let displacements = builder.displacements();
    let events = builder.events(&rows);
    let (tables, frames) = builder.outputs(&rows);
    let tests = builder.run_tests(&rows);
    let mut roots: Vec<Id> = events.iter().flat_map(Event::roots).collect();
    roots.extend(tables.iter().flat_map(Table::roots));
    roots.extend(frames.iter().flat_map(Frames::roots));
    roots.extend(tests.iter().flat_map(RunTest::roots));
    roots.extend(builder.run_roots());
    let observables = builder.observables(&rows, &roots);
    let Builder { lowering, problems } = builder;
    let settings = match settings {
        Some(settings) if problems.is_empty() => settings,
        _ => return Err(problems),
    };
    let physics::Physics { terms, holds, ties, gap_energies, pair_loads, couplings, .. } = physics;
    Ok(Forms {
        lowering,
        settings,
        terms,
        holds,
        ties,
        gap_energies,
        pair_loads,
        couplings,
        states,
        functionals,
        observables,
        starts,
        displacements,
        events,
        tables,
        frames,
        tests,
    })
}

impl Forms<'_> {
    /// An integral as a term that nobody varies.
    pub fn plain_term(&mut self, name: &str, span: Span, part: Part) -> Term {
        let origin = vary::Origin { name: name.to_owned(), block: None, span };
        vary::plain(&mut self.lowering, origin, part.region, part.density)
    }

    /// `d root / d unknown + alpha d root / d (rate of the unknown)` of every root.
    pub fn derivatives_with_rate(&mut self, roots: &[Id], unknown: SymbolKind) -> Vec<Id> {
        vary::with_rate(&mut self.lowering, roots, unknown, vary::rate_of(unknown))
    }
}

/// Forms in the making; problems are collected so that all are reported.
struct Builder<'m> {
    lowering: Lowering<'m>,
    problems: Vec<Diagnostic>,
}

impl<'m> Builder<'m> {
    /// What `make` gives, or nothing and a problem more.
    fn attempt<T>(&mut self, make: impl FnOnce(&mut Lowering<'m>) -> Lowered<T>) -> Option<T> {
        match make(&mut self.lowering) {
            Ok(value) => Some(value),
            Err(problem) => {
                self.problems.push(*problem);
                None
            }
        }
    }

    fn states(&mut self, differences: &[(Id, Span)]) -> StateSystem {
        StateSystem::new(&mut self.lowering, differences)
    }
}
