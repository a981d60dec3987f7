//! A whole run: steps, events and what they do, output, and the record of it all.

use super::events::{Firing, StepView, Watcher};
use super::integrator::Point;
use super::march::{March, Proposal, Statistics};
use super::output::Outputs;
use super::{ImplicitSystem, Stage};
use crate::error::{Error, SolveError};
use crate::generated::{Action, Event, Frames, Solve, Table};
use crate::observer::{Fired, Observer, Step};
use crate::record::{End, RunRecord};

/// A step is not cut shorter than this part of itself to end at an event.
const SHORTEST_CUT: f64 = 1e-3;

/// What a run does, apart from its equations.
#[derive(Clone, Copy)]
pub struct Plan {
    /// Time span, step sizes and tolerances.
    pub settings: Solve,
    /// Events.
    pub events: &'static [Event],
    /// Tables.
    pub tables: &'static [Table],
    /// Field frames.
    pub frames: &'static [Frames],
}

/// Runs a system from consistent unknowns `y`. A stationary plan (`settings.time` is `None`) is one solve from the guess `y`, at time 0.
///
/// If the equations cannot be solved on the way, the record up to there comes back and holds the error; output up to there was written. Errors:
/// there is no solution at the very start, or the observer fails.
///
/// A step in which an event stops the run or sets a state is solved again so that it ends at the event; should that fail, the event acts at the
/// end of the step in which it fired.
pub fn run(
    system: &mut dyn ImplicitSystem,
    plan: Plan,
    y: Vec<f64>,
    observer: &mut dyn Observer,
) -> Result<RunRecord, Error> {
    let Some((start, end)) = plan.settings.time else { return stationary(system, plan, y, observer) };
    let march = March::new(system, plan.settings, start, y)?;
    let globals = system.observe(march.last());
    let mut run = Run {
        watcher: Watcher::new(plan.events, start, &globals),
        outputs: Outputs::new(plan.tables, plan.frames, start, &globals)?,
        record: RunRecord::new(plan.events),
        system,
        march,
        plan,
        observer,
        globals: globals.clone(),
        number: 0,
    };
    run.record.begin_stretch(start, globals);
    run.outputs.emit(run.system, &run.record, |_| run.march.last().clone(), run.observer)?;
    while run.march.last().time < end {
        let ended = run.step(end)?;
        run.record.count(run.march.statistics());
        if let Some(how) = ended {
            run.record.finish(how);
            break;
        }
    }
    Ok(run.record)
}

fn stationary(
    system: &mut dyn ImplicitSystem,
    plan: Plan,
    mut y: Vec<f64>,
    observer: &mut dyn Observer,
) -> Result<RunRecord, Error> {
    let rates = vec![0.0; y.len()];
    let iterations = system.solve_stage(&Stage { time: 0.0, alpha: 0.0, base: &rates }, &mut y)?;
    let point = Point { time: 0.0, values: y, rates };
    let globals = system.observe(&point);
    observer.step(&Step { number: 1, time: 0.0, size: 0.0, iterations, globals: &globals })?;
    let mut record = RunRecord::new(plan.events);
    let mut outputs = Outputs::new(plan.tables, plan.frames, 0.0, &globals)?;
    record.begin_stretch(0.0, globals);
    record.count(Statistics { accepted: 1, rejected: 0, iterations });
    outputs.emit(system, &record, |_| point.clone(), observer)?;
    Ok(record)
}

struct Run<'a> {
    system: &'a mut dyn ImplicitSystem,
    march: March,
    watcher: Watcher,
    outputs: Outputs,
    record: RunRecord,
    plan: Plan,
    observer: &'a mut dyn Observer,
    /// Globals at the last accepted point.
    globals: Vec<f64>,
    number: usize,
}

/// A step with the globals at its end and what fired in it.
struct Seen {
    proposal: Proposal,
    globals: Vec<f64>,
    watcher: Watcher,
    fired: Vec<Firing>,
}

impl Run<'_> {
    /// One accepted step and what its events do. How the run ended, if it did.
    fn step(&mut self, end: f64) -> Result<Option<End>, Error> {
        let limit = self.watcher.next_act().map_or(end, |time| time.min(end));
        let seen = match self.march.propose(self.system, limit) {
            Ok(proposal) => self.look(proposal),
            Err(error) => return Ok(Some(End::Diverged(Box::new(error)))),
        };
        let seen = self.cut_at_event(seen);
        let fired = self.take(seen)?;
        let anew = fired.iter().any(|f| remeshes(&self.plan.events[f.event]));
        let ended = self.act(fired)?;
        if ended.is_some() || self.march.last().time >= end {
            return Ok(ended);
        }
        Ok(self.renew(anew).err().map(|error| End::Diverged(Box::new(error))))
    }

    /// Lets the system prepare the next step.
    fn renew(&mut self, anew: bool) -> Result<(), SolveError> {
        if let Some(transfer) = self.system.renew(self.march.last(), anew)? {
            self.march.carry(&transfer, self.system.groups());
        }
        Ok(())
    }

    /// Looks for events in a proposed step.
    fn look(&mut self, proposal: Proposal) -> Seen {
        let globals = self.system.observe(&proposal.end);
        let mut watcher = self.watcher.clone();
        let (march, system) = (&self.march, &mut self.system);
        let mut between = |time: f64| system.observe(&march.interpolate(&proposal, time));
        let mut view = StepView {
            times: (march.last().time, proposal.end.time),
            start: &self.globals,
            end: &globals,
            between: &mut between,
        };
        let fired = watcher.follow(&mut view);
        Seen { proposal, globals, watcher, fired }
    }

    /// If an event acts or a condition turns true inside the step, solves the step anew to end there.
    fn cut_at_event(&mut self, seen: Seen) -> Seen {
        let Some(&first) = seen.fired.iter().find(|f| self.watcher.cuts(f.event)) else { return seen };
        let (start, end) = (self.march.last().time, seen.proposal.end.time);
        let until = first.time.max(start + SHORTEST_CUT * (end - start));
        if until >= end {
            return seen;
        }
        let Ok(shorter) = self.march.propose_until(self.system, until) else { return seen };
        let mut cut = self.look(shorter);
        cut.fired.retain(|f| f.event != first.event);
        cut.fired.push(Firing { event: first.event, time: until });
        cut.watcher.mark(first.event);
        cut
    }

    /// Accepts a step: tells the observer, records, writes output. What fired in it.
    fn take(&mut self, seen: Seen) -> Result<Vec<Firing>, Error> {
        let Seen { proposal, globals, watcher, fired } = seen;
        let time = proposal.end.time;
        self.number += 1;
        self.watcher = watcher;
        self.observer.step(&Step {
            number: self.number,
            time,
            size: proposal.size,
            iterations: proposal.iterations,
            globals: &globals,
        })?;
        self.record.push(time, globals.clone());
        self.globals = globals;
        self.tell(&fired)?;
        let march = &self.march;
        let point = |time: f64| march.interpolate(&proposal, time);
        self.outputs.emit(self.system, &self.record, point, self.observer)?;
        if fired.iter().any(|f| self.watcher.cuts(f.event)) {
            self.record.corner();
        }
        self.march.accept(proposal);
        Ok(fired)
    }

    fn tell(&mut self, fired: &[Firing]) -> Result<(), Error> {
        for &firing in fired {
            self.record.fire(firing);
            self.observer.fired(&Fired { event: firing.event, time: firing.time })?;
        }
        Ok(())
    }

    /// Does what the fired events ask for: ends the run, or sets states and starts anew from there. Events that turn true by such a jump act as
    /// well, each once.
    fn act(&mut self, mut fired: Vec<Firing>) -> Result<Option<End>, Error> {
        let mut done: Vec<usize> = Vec::new();
        loop {
            if let Some(stop) = fired.iter().find(|f| stops(&self.plan.events[f.event])) {
                return Ok(Some(End::Stopped(stop.event)));
            }
            fired.retain(|f| !done.contains(&f.event));
            done.extend(fired.iter().map(|f| f.event));
            let values = self.values_to_set(&fired);
            if values.is_empty() {
                return Ok(None);
            }
            let before = self.globals.clone();
            if let Err(error) = self.jump(&values) {
                return Ok(Some(End::Diverged(Box::new(error))));
            }
            fired = self.watcher.jump(self.march.last().time, &before, &self.globals);
            self.tell(&fired)?;
        }
    }

    fn values_to_set(&self, fired: &[Firing]) -> Vec<(usize, f64)> {
        let actions = fired.iter().flat_map(|f| self.plan.events[f.event].actions);
        let set = |action: &Action| match action {
            Action::Set(state, value) => Some((*state, value(&self.globals))),
            Action::Stop | Action::Warn(_) | Action::Remesh => None,
        };
        actions.filter_map(set).collect()
    }

    fn jump(&mut self, values: &[(usize, f64)]) -> Result<(), SolveError> {
        let Point { time, values: mut y, .. } = self.march.last().clone();
        self.system.set_states(time, &mut y, values)?;
        self.march.restart(self.system, time, y)?;
        self.globals = self.system.observe(self.march.last());
        self.record.begin_stretch(time, self.globals.clone());
        Ok(())
    }
}

fn stops(event: &Event) -> bool {
    event.actions.iter().any(|action| matches!(action, Action::Stop))
}

fn remeshes(event: &Event) -> bool {
    event.actions.iter().any(|action| matches!(action, Action::Remesh))
}
