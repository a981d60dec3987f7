//! The results folder of a run.

use super::frames::FrameWriter;
use super::plot;
use super::summary::{self, Run};
use super::table::TableWriter;
use crate::error::Error;
use crate::generated::Program;
use crate::mesh::Mesh;
use crate::observer::{Frame, Observer};
use std::path::{Path, PathBuf};

/// Writes tables and frames while the run goes on, plots and the summary at its end.
pub struct Results {
    folder: PathBuf,
    program: &'static Program,
    tables: Vec<TableWriter>,
    /// Rows of each table so far, for the plots.
    rows: Vec<Vec<Vec<f64>>>,
    frames: Option<FrameWriter>,
    wants_frames: bool,
}

impl Results {
    /// Makes the folder, which may exist; files of an earlier run in it are overwritten.
    ///
    /// # Errors
    /// [`Error::Output`] when the folder cannot be made or a file in it not written.
    pub fn create(folder: &Path, program: &'static Program) -> Result<Self, Error> {
        std::fs::create_dir_all(folder).map_err(|e| super::cannot_write(folder, &e))?;
        remove_frames(folder)?;
        let tables =
            program.tables.iter().map(|t| TableWriter::create(folder, t)).collect::<Result<_, _>>()?;
        let rows = vec![Vec::new(); program.tables.len()];
        Ok(Self { folder: folder.to_path_buf(), program, tables, rows, frames: None, wants_frames: true })
    }

    /// Whether field frames and pictures are written.
    pub fn keep_frames(&mut self, wanted: bool) {
        self.wants_frames = wanted;
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Waits for the frames, draws the plots and writes `run.json`.
    ///
    /// # Errors
    /// [`Error::Output`] when a file cannot be written.
    pub fn finish(&mut self, parameters: &[f64], mesh: &Mesh, run: &Run) -> Result<(), Error> {
        let frames = self.frames.take().map_or(Ok(()), |mut f| f.finish());
        for (table, rows) in self.program.tables.iter().zip(&self.rows) {
            plot::write(&self.folder, table, rows)?;
        }
        summary::write(&self.folder.join("run.json"), self.program, parameters, mesh, run)?;
        frames
    }
}

impl Observer for Results {
    fn begin(&mut self, mesh: &Mesh) -> Result<(), Error> {
        if self.wants_frames {
            self.frames = Some(FrameWriter::start(self.folder.clone(), self.program, mesh)?);
        }
        Ok(())
    }

    fn row(&mut self, table: usize, values: &[f64]) -> Result<(), Error> {
        self.rows[table].push(values.to_vec());
        self.tables[table].row(values)
    }

    fn wants_frames(&self) -> bool {
        self.wants_frames
    }

    fn frame(&mut self, frame: Frame) -> Result<(), Error> {
        self.frames.as_mut().map_or(Ok(()), |writer| writer.send(frame))
    }
}

/// Frames and pictures of an earlier run would mix with those of this one.
fn remove_frames(folder: &Path) -> Result<(), Error> {
    let entries = std::fs::read_dir(folder).map_err(|e| super::cannot_write(folder, &e))?;
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if is_numbered_frame(&name) {
            std::fs::remove_file(entry.path()).map_err(|e| super::cannot_write(&entry.path(), &e))?;
        }
    }
    Ok(())
}

/// `fields_00012.vtu`, `strain_zz_00012.png`.
fn is_numbered_frame(name: &str) -> bool {
    let stem = name.strip_suffix(".vtu").or_else(|| name.strip_suffix(".png"));
    let number = stem.and_then(|s| s.rsplit_once('_')).map(|(_, number)| number);
    number.is_some_and(|n| n.len() == 5 && n.bytes().all(|b| b.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::is_numbered_frame;

    #[test]
    fn only_files_that_runs_write_are_removed() {
        assert!(is_numbered_frame("fields_00012.vtu"));
        assert!(is_numbered_frame("strain_zz_00000.png"));
        assert!(!is_numbered_frame("notes_2026.png"));
        assert!(!is_numbered_frame("fields_00012.csv"));
    }
}
