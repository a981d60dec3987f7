//! Pictures of several regions at one time: the bodies by one scalar, the fluid between them by another.

use super::layer::{Layer, scalars};
use super::snapshot::{self, Shown};
use crate::error::Error;
use crate::generated::{Domain, Program};
use std::path::{Path, PathBuf};

/// Part of a time by which two times may differ and still be one.
const SAME_TIME: f64 = 1e-9;

/// Gathers the layers of one time and draws them together, each region by the first scalar of its statement, paths as lines.
pub struct Joint {
    folder: PathBuf,
    time_unit: &'static str,
    members: Vec<Member>,
    time: f64,
    layers: Vec<(usize, Layer)>,
    drawn: usize,
}

/// A statement that is drawn.
struct Member {
    frame: usize,
    /// Column of its colours.
    scalar: Option<usize>,
    /// Whether there is no picture without it.
    needed: bool,
}

impl Joint {
    /// Nothing gathered yet; pictures go to `folder`.
    pub fn new(folder: &Path, program: &Program) -> Self {
        Self {
            folder: folder.to_path_buf(),
            time_unit: program.base_units[2],
            members: members(program),
            time: f64::NEG_INFINITY,
            layers: Vec::new(),
            drawn: 0,
        }
    }

    /// Takes the layer of a statement; times come in order. The picture of an earlier time is complete.
    pub fn add(&mut self, frame: usize, time: f64, layer: Layer) -> Result<(), Error> {
        if time - self.time > SAME_TIME * time.abs() {
            self.finish()?;
            self.time = time;
        }
        if self.members.iter().any(|member| member.frame == frame) {
            self.layers.push((frame, layer));
        }
        Ok(())
    }

    /// Draws what was gathered, if every region is there.
    pub fn finish(&mut self) -> Result<(), Error> {
        let layers = std::mem::take(&mut self.layers);
        let layer = |frame: usize| layers.iter().find(|(of, _)| *of == frame).map(|(_, layer)| layer);
        let mut shown = Vec::new();
        for &Member { frame, scalar, needed } in &self.members {
            match layer(frame) {
                Some(layer) => shown.push(Shown { layer, scalar }),
                None if needed => return Ok(()),
                None => {}
            }
        }
        if shown.is_empty() {
            return Ok(());
        }
        let file = self.folder.join(format!("fields_{:05}.png", self.drawn));
        self.drawn += 1;
        snapshot::write(&file, &shown, &snapshot::at_time(self.time, self.time_unit))
    }
}

/// Statements on regions that do not overlap those before, and those on paths; none if there is but one region to draw, or nothing to colour.
fn members(program: &Program) -> Vec<Member> {
    let mut covered: Vec<&str> = Vec::new();
    let mut members = Vec::new();
    for (frame, frames) in program.frames.iter().enumerate() {
        match frames.domain {
            Domain::Cells(regions) if !regions.iter().any(|region| covered.contains(region)) => {
                covered.extend(regions);
                members.push(Member { frame, scalar: scalars(frames).next(), needed: true });
            }
            Domain::Edges(_) => members.push(Member { frame, scalar: None, needed: false }),
            Domain::Cells(_) | Domain::Ends(_) => {}
        }
    }
    let several = members.iter().filter(|member| member.needed).count() > 1;
    let coloured = members.iter().any(|member| member.scalar.is_some());
    if several && coloured { members } else { Vec::new() }
}
