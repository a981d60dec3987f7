//! The results folder of a run: tables, field frames, pictures, plots and the summary `run.json`. Whatever is written is complete at
//! any moment, so that a run that ends early leaves readable results.

mod arrows;
mod canvas;
mod frames;
mod joint;
mod layer;
mod plot;
mod snapshot;
mod table;
mod vtu;

pub mod progress;
pub mod results;
pub mod summary;

use crate::error::Error;
use crate::generated::{Action, Event};
use std::path::Path;

/// What an event warns of, text by text.
fn warnings(event: &Event) -> impl Iterator<Item = &'static str> {
    event.actions.iter().filter_map(|action| match action {
        Action::Warn(text) => Some(*text),
        Action::Stop | Action::Set(..) | Action::Remesh => None,
    })
}

/// The error of a file that cannot be written.
fn cannot_write(path: &Path, cause: &dyn std::fmt::Display) -> Error {
    Error::Output { path: path.to_path_buf(), cause: cause.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generated::Trigger;

    #[test]
    fn an_event_warns_of_all_its_texts_in_order() {
        let actions = &[Action::Warn("low"), Action::Stop, Action::Warn("lower")];
        let event = Event { name: "empty", doc: "", trigger: Trigger::EveryStep, actions };
        assert_eq!(warnings(&event).collect::<Vec<_>>(), ["low", "lower"]);
    }
}
