//! The record of a run: globals at every accepted step, when events fired first, and how the run ended.

use crate::error::SolveError;
use crate::generated::{Event, Record};
use crate::time::events::Firing;
use crate::time::history::{blend, interpolation_weights};
use crate::time::march::Statistics;

/// How a run ended.
#[derive(Clone, Debug)]
pub enum End {
    /// It reached its end time.
    Finished,
    /// An event (by index) stopped it.
    Stopped(usize),
    /// The equations could not be solved any further.
    Diverged(Box<SolveError>),
}

/// Record of a run, finished or not.
#[derive(Clone)]
pub struct RunRecord {
    events: &'static [Event],
    times: Vec<f64>,
    steps: Vec<Vec<f64>>,
    /// Index of the first point of the smooth stretch that each point belongs to.
    stretches: Vec<usize>,
    /// The next point begins a stretch that starts at this one.
    corner: Option<usize>,
    fired: Vec<Firing>,
    statistics: Statistics,
    end: End,
}

impl RunRecord {
    /// An empty record of a run with these events.
    pub fn new(events: &'static [Event]) -> Self {
        Self {
            events,
            times: Vec::new(),
            steps: Vec::new(),
            stretches: Vec::new(),
            corner: None,
            fired: Vec::new(),
            statistics: Statistics::default(),
            end: End::Finished,
        }
    }

    /// Adds the start of a smooth stretch: the start of the run, or what a jump led to.
    pub fn begin_stretch(&mut self, time: f64, globals: Vec<f64>) {
        self.stretches.push(self.times.len());
        self.times.push(time);
        self.steps.push(globals);
    }

    /// Adds the end of an accepted step.
    pub fn push(&mut self, time: f64, globals: Vec<f64>) {
        let begun = self.corner.take().or(self.stretches.last().copied());
        self.stretches.push(begun.unwrap_or(0));
        self.times.push(time);
        self.steps.push(globals);
    }

    /// Notes that the solution may have a kink at the last point: interpolation does not reach across it.
    pub fn corner(&mut self) {
        self.corner = self.times.len().checked_sub(1);
    }

    /// Notes that an event fired.
    pub fn fire(&mut self, firing: Firing) {
        self.fired.push(firing);
    }

    /// What fired, in the order in which it did.
    pub fn fired(&self) -> &[Firing] {
        &self.fired
    }

    /// Notes what the run took so far.
    pub fn count(&mut self, statistics: Statistics) {
        self.statistics = statistics;
    }

    /// What the run took.
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    /// Notes how the run ended.
    pub fn finish(&mut self, end: End) {
        self.end = end;
    }

    /// How the run ended.
    pub fn end(&self) -> &End {
        &self.end
    }

    /// Why the run could not go on, if it could not.
    pub fn failure(&self) -> Option<&SolveError> {
        match &self.end {
            End::Diverged(error) => Some(error),
            End::Finished | End::Stopped(_) => None,
        }
    }

    /// The outcome in one word: `diverged` if the equations could not be solved; else the event that stopped the run; else the documented event
    /// that fired last; else `finished`.
    pub fn outcome(&self) -> &'static str {
        let told = |firing: &&Firing| !self.events[firing.event].doc.is_empty();
        match &self.end {
            End::Diverged(_) => "diverged",
            End::Stopped(event) => self.events[*event].name,
            End::Finished => {
                self.fired.iter().rfind(told).map_or("finished", |firing| self.events[firing.event].name)
            }
        }
    }

    /// Times of the recorded points, ascending; the two sides of a jump have the same time.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Values of functions of the globals at a time. At a recorded time they are those there (before a jump); inside a step they are interpolated
    /// between those at up to three recorded points, with the same weights for all: by a parabola, or by a line where the parabola of any value
    /// would leave the range of its two neighbours, as it does behind a kink. Times outside the run give the values at its nearest end, an empty
    /// record gives none.
    pub fn interpolate(&self, time: f64, values: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
        let (times, points) = self.nodes(time);
        let rows: Vec<Vec<f64>> = points.iter().map(|g| values(g)).collect();
        let beyond = |k: usize| overshoots(times, [&rows[0], &rows[1], &rows[2]].map(|row| row[k]));
        let skip = usize::from(rows.len() == 3 && (0..rows[0].len()).any(beyond));
        let weights = interpolation_weights(&times[skip..], time);
        blend(&weights, rows[skip..].iter().map(Vec::as_slice))
    }

    /// Times and globals of the points that determine the values at a time: one on it, or two around it and the one before.
    fn nodes(&self, time: f64) -> (&[f64], &[Vec<f64>]) {
        let after = self.times.partition_point(|t| *t < time).min(self.times.len().saturating_sub(1));
        let on_point = self.times.get(after).is_none_or(|t| *t <= time);
        if on_point || after == 0 {
            return (
                self.times.get(after..=after).unwrap_or(&[]),
                self.steps.get(after..=after).unwrap_or(&[]),
            );
        }
        let first = after.saturating_sub(2).max(self.stretches[after]).min(after - 1);
        (&self.times[first..=after], &self.steps[first..=after])
    }
}

/// Part of its largest value by which a parabola may leave the range of its neighbours unseen.
const OVERSHOOT: f64 = 1e-3;

/// Whether the parabola through three points leaves the range of the last two between them.
fn overshoots(times: &[f64], values: [f64; 3]) -> bool {
    let slope = |k: usize| (values[k + 1] - values[k]) / (times[k + 1] - times[k]);
    let last = times[2] - times[1];
    let bend = (slope(1) - slope(0)).abs() / (times[2] - times[0]) * last * last;
    let rise = (values[2] - values[1]).abs();
    let size = values.iter().fold(0.0f64, |size, x| size.max(x.abs()));
    rise < bend && (bend - rise).powi(2) > 4.0 * OVERSHOOT * size * bend
}

impl Record for RunRecord {
    fn event_time(&self, name: &str) -> Option<f64> {
        let event = self.events.iter().position(|event| event.name == name)?;
        self.fired.iter().find(|firing| firing.event == event).map(|firing| firing.time)
    }

    fn steps(&self) -> &[Vec<f64>] {
        &self.steps
    }

    fn at(&self, time: f64) -> Vec<f64> {
        let (times, points) = self.nodes(time);
        blend(&interpolation_weights(times, time), points.iter().map(Vec::as_slice))
    }

    fn outcome(&self) -> &str {
        self.outcome()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generated::Trigger;

    const fn event(name: &'static str, doc: &'static str) -> Event {
        Event { name, doc, trigger: Trigger::EveryStep, actions: &[] }
    }

    static EVENTS: [Event; 3] = [event("touched", ""), event("passed", "got through"), event("stuck", "")];

    fn parabola() -> RunRecord {
        let mut record = RunRecord::new(&EVENTS);
        record.begin_stretch(0.0, vec![0.0, 0.0]);
        [1.0, 1.5, 3.0f64].iter().for_each(|&t| record.push(t, vec![t, t * t]));
        record.begin_stretch(3.0, vec![3.0, 100.0]);
        record.push(4.0, vec![4.0, 102.0]);
        record.push(5.0, vec![5.0, 102.0]);
        record
    }

    #[test]
    fn inside_a_stretch_a_parabola_is_exact_and_its_first_step_linear() {
        let record = parabola();
        assert!((record.at(2.0)[1] - 4.0).abs() < 1e-14);
        assert_eq!(record.at(0.5), vec![0.5, 0.5]);
        assert_eq!(record.at(3.5), vec![3.5, 101.0]);
    }

    #[test]
    fn at_a_jump_and_outside_the_run_points_count() {
        let record = parabola();
        assert_eq!(record.at(3.0)[1], 9.0);
        assert_eq!(record.at(-1.0)[1], 0.0);
        assert_eq!(record.at(9.0)[1], 102.0);
        assert_eq!(RunRecord::new(&EVENTS).at(1.0), Vec::<f64>::new());
    }

    #[test]
    fn linear_relations_of_values_hold_in_between() {
        let record = parabola();
        for time in [0.3, 1.2, 2.9, 3.1, 4.6] {
            let values = |g: &[f64]| {
                let (a, b) = ((g[0] + 1.0).ln(), g[1].sin());
                vec![a, b, 2.0 * a - b]
            };
            let row = record.interpolate(time, values);
            assert!((row[2] - (2.0 * row[0] - row[1])).abs() < 1e-14);
        }
    }

    #[test]
    fn a_row_is_as_smooth_as_its_values_and_stays_above_a_kink() {
        let mut record = RunRecord::new(&EVENTS);
        record.begin_stretch(0.0, vec![0.0]);
        [1.0, 2.0].iter().for_each(|&t| record.push(t, vec![t]));
        let (square, clipped) = (|g: &[f64]| g[0] * g[0], |g: &[f64]| (1.0 - g[0]).max(0.0));
        assert_eq!(record.interpolate(1.5, |g| vec![square(g)]), vec![2.25]);
        assert_eq!(record.interpolate(1.5, |g| vec![square(g), clipped(g)]), vec![2.5, 0.0], "all by a line");
    }

    #[test]
    fn the_outcome_names_what_happened() {
        let mut record = parabola();
        assert_eq!(record.outcome(), "finished");
        record.fire(Firing { event: 0, time: 1.0 });
        assert_eq!(record.outcome(), "finished", "an event without documentation is no outcome");
        [2.0, 2.5].iter().for_each(|&time| record.fire(Firing { event: 1, time }));
        assert_eq!((record.outcome(), record.event_time("passed")), ("passed", Some(2.0)));
        record.finish(End::Stopped(2));
        assert_eq!(record.outcome(), "stuck");
    }
}
