//! Events: when a condition turns true inside a step, and what has fired.
//!
//! The statement of a `when` event is "the condition has held for its duration, and so does `also`". The event fires when that turns from false
//! to true; it can fire again after it was false. What is true at the start does not turn true there. Conditions are looked at at the ends
//! of steps; of a condition that is true at one end and false at the other, one crossing is located by root finding.

use super::root::turning_point;
use super::schedule::Schedule;
use crate::generated::{Action, Event, Trigger};

/// Accuracy of a located crossing, as a part of the step.
const LOCATED: f64 = 1e-6;

/// Globals over one step: at its ends, and interpolated between them.
pub struct StepView<'a> {
    /// Start and end.
    pub times: (f64, f64),
    /// Globals at the start.
    pub start: &'a [f64],
    /// Globals at the end.
    pub end: &'a [f64],
    /// Globals at a time between.
    pub between: &'a mut dyn FnMut(f64) -> Vec<f64>,
}

impl StepView<'_> {
    fn at(&mut self, time: f64) -> Vec<f64> {
        if time <= self.times.0 {
            self.start.to_vec()
        } else if time >= self.times.1 {
            self.end.to_vec()
        } else {
            (self.between)(time)
        }
    }

    /// Where `f` turns positive between `low` and `high`, given that it is not at `low` and is at `high`.
    fn turning_point(&mut self, low: f64, high: f64, f: impl Fn(&[f64]) -> f64) -> f64 {
        let tolerance = LOCATED * (self.times.1 - self.times.0);
        let ends = (f(&self.at(low)), f(&self.at(high)));
        turning_point((low, high), ends, tolerance, |time| f(&self.at(time)))
    }
}

/// What is remembered of a `when` event between steps.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Held {
    /// Time since which the condition has held.
    since: Option<f64>,
    /// Whether the statement was true at the last point.
    holds: bool,
}

/// Condition, duration, further condition.
#[derive(Clone, Copy)]
struct When {
    condition: fn(&[f64]) -> f64,
    duration: fn(&[f64]) -> f64,
    also: fn(&[f64]) -> f64,
}

impl When {
    fn start(&self, time: f64, g: &[f64]) -> Held {
        let since = ((self.condition)(g) > 0.0).then_some(time);
        Held { since, holds: since.is_some() && (self.duration)(g) <= 0.0 && (self.also)(g) > 0.0 }
    }

    /// Memory at the end of a step, and when the event fired in it.
    fn follow(&self, held: Held, step: &mut StepView<'_>) -> (Held, Option<f64>) {
        let condition = self.condition;
        let (start, end) = step.times;
        let after = condition(step.end) > 0.0;
        let (since, until) = match (held.since, after) {
            (None, false) => return (Held { since: None, holds: false }, None),
            (None, true) => (step.turning_point(start, end, condition), end),
            (Some(since), true) => (since, end),
            (Some(since), false) => (since, step.turning_point(start, end, |g| -condition(g))),
        };
        let ripe = since + (self.duration)(step.end);
        let first = (ripe <= until).then(|| self.first_moment(ripe.max(start), until, step)).flatten();
        let holds = after && ripe <= end && (self.also)(step.end) > 0.0;
        (Held { since: after.then_some(since), holds }, first.filter(|_| !held.holds))
    }

    /// First moment in [`low`, `high`] at which `also` is true.
    fn first_moment(&self, low: f64, high: f64, step: &mut StepView<'_>) -> Option<f64> {
        let also = self.also;
        if also(&step.at(low)) > 0.0 {
            return Some(low);
        }
        (also(&step.at(high)) > 0.0).then(|| step.turning_point(low, high, also))
    }
}

/// One event's memory.
#[derive(Clone)]
enum Watch {
    When(When, Held),
    Step,
    Periodic(Schedule),
}

/// An event that fired at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Firing {
    /// Index of the event.
    pub event: usize,
    /// When.
    pub time: f64,
}

/// Watches the events of a model.
#[derive(Clone)]
pub struct Watcher {
    events: &'static [Event],
    watches: Vec<Watch>,
}

impl Watcher {
    /// Starts watching at a time with these globals.
    pub fn new(events: &'static [Event], time: f64, g: &[f64]) -> Self {
        let watch = |event: &Event| match event.trigger {
            Trigger::When { condition, duration, also } => {
                let when = When { condition, duration, also };
                Watch::When(when, when.start(time, g))
            }
            Trigger::EveryStep => Watch::Step,
            Trigger::Every(period) => {
                let mut schedule = Schedule::multiples(period(g), time);
                schedule.take(time);
                Watch::Periodic(schedule)
            }
        };
        Self { events, watches: events.iter().map(watch).collect() }
    }

    /// Follows a step; what fired, by time, events of one time in the order of the model.
    pub fn follow(&mut self, step: &mut StepView<'_>) -> Vec<Firing> {
        let mut fired = Vec::new();
        for (event, watch) in self.watches.iter_mut().enumerate() {
            let times = match watch {
                Watch::When(when, held) => {
                    let (next, time) = when.follow(*held, step);
                    *held = next;
                    time.into_iter().collect()
                }
                Watch::Step => vec![step.times.1],
                Watch::Periodic(schedule) => schedule.take(step.times.1),
            };
            fired.extend(times.into_iter().map(|time| Firing { event, time }));
        }
        fired.sort_by(|a, b| a.time.total_cmp(&b.time));
        fired
    }

    /// Takes note that an event fired at the end of a step, whatever its condition says there.
    pub fn mark(&mut self, event: usize) {
        if let Watch::When(_, held) = &mut self.watches[event] {
            held.holds = true;
        }
    }

    /// Follows a jump of the globals at one time: conditions that turn true by it fire.
    pub fn jump(&mut self, time: f64, before: &[f64], after: &[f64]) -> Vec<Firing> {
        let mut never = |_: f64| after.to_vec();
        let mut step = StepView { times: (time, time), start: before, end: after, between: &mut never };
        let mut fired = Vec::new();
        for (event, watch) in self.watches.iter_mut().enumerate() {
            if let Watch::When(when, held) = watch {
                let (next, turned) = when.follow(*held, &mut step);
                *held = next;
                fired.extend(turned.map(|time| Firing { event, time }));
            }
        }
        fired
    }

    /// Whether an event ends the run or sets something, so that a step must end where it fires.
    pub fn acts(&self, event: usize) -> bool {
        self.events[event].actions.iter().any(|action| !matches!(action, Action::Warn(_)))
    }

    /// Whether a step must end where an event fires: where it acts, and where its condition turns true, since the solution may have a kink there.
    pub fn cuts(&self, event: usize) -> bool {
        self.acts(event) || matches!(self.watches[event], Watch::When(..))
    }

    /// Next time at which a periodic event acts.
    pub fn next_act(&self) -> Option<f64> {
        let time = |(event, watch): (usize, &Watch)| match watch {
            Watch::Periodic(schedule) if self.acts(event) => schedule.next(),
            _ => None,
        };
        self.watches.iter().enumerate().filter_map(time).min_by(f64::total_cmp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Globals: time, and a signal of time.
    fn watch(event: Event, steps: &[f64], signal: fn(f64) -> f64) -> Vec<f64> {
        let events: &'static [Event] = Box::leak(Box::new([event]));
        let globals = |time: f64| vec![time, signal(time)];
        let mut watcher = Watcher::new(events, steps[0], &globals(steps[0]));
        let mut fired = Vec::new();
        for pair in steps.windows(2) {
            let (start, end) = (globals(pair[0]), globals(pair[1]));
            let mut between = |time: f64| globals(time);
            let mut step =
                StepView { times: (pair[0], pair[1]), start: &start, end: &end, between: &mut between };
            fired.extend(watcher.follow(&mut step).iter().map(|f| f.time));
        }
        fired
    }

    fn when(duration: fn(&[f64]) -> f64, also: fn(&[f64]) -> f64) -> Event {
        let trigger = Trigger::When { condition: |g| g[1], duration, also };
        Event { name: "event", doc: "", trigger, actions: &[] }
    }

    const AT_ONCE: fn(&[f64]) -> f64 = |_| 0.0;
    const ALWAYS: fn(&[f64]) -> f64 = |_| 1.0;

    fn assert_times(found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        found.iter().zip(expected).for_each(|(a, b)| assert!((a - b).abs() < 2e-6, "{found:?}"));
    }

    #[test]
    fn a_condition_fires_at_every_crossing_upwards() {
        let steps: Vec<f64> = (0..=12).map(f64::from).collect();
        let fired = watch(when(AT_ONCE, ALWAYS), &steps, |t| -(t + 0.5).cos());
        let half_turn = std::f64::consts::PI;
        assert_times(&fired, &[0.5 * half_turn - 0.5, 2.5 * half_turn - 0.5]);
    }

    #[test]
    fn what_is_true_at_the_start_does_not_turn_true() {
        assert_times(&watch(when(AT_ONCE, ALWAYS), &[0.0, 1.0, 2.0], |_| 1.0), &[]);
    }

    #[test]
    fn a_duration_counts_from_the_crossing_and_from_the_start() {
        let steps: Vec<f64> = (0..=12).map(|k| 0.7 * f64::from(k)).collect();
        assert_times(&watch(when(|_| 3.0, ALWAYS), &steps, |t| t - 1.3), &[4.3]);
        assert_times(&watch(when(|_| 3.0, ALWAYS), &steps, |_| 1.0), &[3.0]);
    }

    #[test]
    fn an_interruption_starts_the_duration_again() {
        let steps: Vec<f64> = (0..=80).map(|k| 0.1 * f64::from(k)).collect();
        let signal = |t: f64| if (2.0..2.5).contains(&t) { -1.0 } else { 1.0 };
        assert_times(&watch(when(|_| 2.25, ALWAYS), &steps, signal), &[4.75]);
    }

    #[test]
    fn a_duration_may_end_in_the_step_that_breaks_the_condition() {
        let signal = |t: f64| if t < 2.9 { 1.0 } else { -1.0 };
        assert_times(&watch(when(|_| 2.5, ALWAYS), &[0.0, 1.0, 2.0, 3.0], signal), &[2.5]);
        assert_times(&watch(when(|_| 2.95, ALWAYS), &[0.0, 1.0, 2.0, 3.0], signal), &[]);
    }

    #[test]
    fn the_further_condition_delays_the_firing() {
        let steps: Vec<f64> = (0..=10).map(f64::from).collect();
        assert_times(&watch(when(|_| 2.0, |g| g[0] - 6.25), &steps, |t| t - 1.5), &[6.25]);
        assert_times(&watch(when(|_| 2.0, |g| g[0] - 2.25), &steps, |t| t - 1.5), &[3.5]);
    }

    #[test]
    fn periodic_events_fire_after_the_start_only() {
        let event = Event { name: "event", doc: "", trigger: Trigger::Every(|_| 0.5), actions: &[] };
        assert_times(&watch(event, &[0.0, 1.0, 1.6], |_| 0.0), &[0.5, 1.0, 1.5]);
    }

    #[test]
    fn a_jump_can_make_a_condition_true() {
        let events: &'static [Event] = Box::leak(Box::new([when(AT_ONCE, ALWAYS)]));
        let mut watcher = Watcher::new(events, 0.0, &[0.0, -1.0]);
        assert_eq!(watcher.jump(2.0, &[2.0, -1.0], &[2.0, 1.0]), vec![Firing { event: 0, time: 2.0 }]);
        assert_eq!(watcher.jump(2.0, &[2.0, 1.0], &[2.0, 2.0]), vec![]);
    }
}
