//! Progress of a run in the terminal: simulated time, step size, iterations, the first columns of the first table, time left. An event is told
//! when it fires first; how often it did, at the end.

use crate::error::Error;
use crate::generated::{Column, Program};
use crate::observer::{Fired, Observer, Step};
use crate::settings::{counted, display};
use crate::simulator::complain;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;

/// Columns shown beside the bar.
const COLUMNS: usize = 4;
/// Ticks of the bar over the whole run.
const TICKS: f64 = 10_000.0;
/// Parts of the run after which a line is printed when there is no terminal.
const LINES: f64 = 20.0;

/// A progress bar in a terminal, a line now and then elsewhere.
pub struct Progress {
    program: &'static Program,
    span: (f64, f64),
    bar: ProgressBar,
    terminal: bool,
    printed: f64,
    /// How often each event has fired, and when it did last.
    firings: Vec<(usize, f64)>,
}

impl Progress {
    /// For a run from `span.0` to `span.1` [internal time].
    pub fn new(program: &'static Program, span: (f64, f64)) -> Self {
        let bar = ProgressBar::new(TICKS as u64);
        let template = "{bar:30} {percent:>3} % {msg}, {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        let firings = vec![(0, span.0); program.events.len()];
        let terminal = std::io::stderr().is_terminal();
        Self { program, span, bar, terminal, printed: f64::NEG_INFINITY, firings }
    }

    fn say(&self, text: &str) {
        if self.terminal { self.bar.println(text) } else { complain(text) }
    }

    fn time(&self, time: f64) -> String {
        format!("{:.2} {}", time, self.program.base_units[2])
    }

    fn values(&self, g: &[f64]) -> String {
        let columns = self.program.tables.first().map_or(&[][..], |t| t.columns);
        let interesting = columns.iter().filter(|c| (c.value)(g) != g[self.program.layout.time]);
        let shown = |c: &Column| format!("{} {}", c.name, with_unit((c.value)(g) / c.unit_value, c.unit));
        interesting.take(COLUMNS).map(shown).collect::<Vec<_>>().join(", ")
    }
}

impl Observer for Progress {
    fn step(&mut self, step: &Step<'_>) -> Result<(), Error> {
        let part = (step.time - self.span.0) / (self.span.1 - self.span.0);
        let values = self.values(step.globals);
        let text = format!(
            "t {}, step {:.2e}, {}, {values}",
            self.time(step.time),
            step.size,
            counted(step.iterations, "iteration")
        );
        self.bar.set_position((part * TICKS) as u64);
        self.bar.set_message(text.clone());
        if !self.terminal && part - self.printed >= 1.0 / LINES {
            self.printed = part;
            self.say(&text);
        }
        Ok(())
    }

    fn fired(&mut self, fired: &Fired) -> Result<(), Error> {
        let (count, last) = &mut self.firings[fired.event];
        (*count, *last) = (*count + 1, fired.time);
        if *count > 1 {
            return Ok(());
        }
        let event = &self.program.events[fired.event];
        let doc = if event.doc.is_empty() { String::new() } else { format!(": {}", event.doc) };
        self.say(&format!("{} at t = {}{doc}", event.name, self.time(fired.time)));
        super::warnings(event).for_each(|text| self.say(&format!("warning: {text}")));
        Ok(())
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        for (event, (count, last)) in self.program.events.iter().zip(&self.firings) {
            if *count > 1 {
                self.say(&format!("{} fired {count} times, last at t = {}", event.name, self.time(*last)));
            }
        }
        self.bar.finish_and_clear();
    }
}

/// A number with four digits and its unit, as a person reads it.
pub fn with_unit(value: f64, unit: &str) -> String {
    let rounded: f64 = format!("{value:.4e}").parse().unwrap_or(value);
    if unit == "1" { display(rounded) } else { format!("{} {unit}", display(rounded)) }
}
