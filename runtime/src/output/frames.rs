//! Field frames on disk, written by a thread of their own while the run goes on: a .vtu file each, the .pvd list, and pictures.

use super::joint::Joint;
use super::layer::{Layer, scalars};
use super::snapshot::{self, Shown};
use super::vtu::{self, Grid};
use crate::error::Error;
use crate::generated::{Domain, Frames, Program};
use crate::mesh::Mesh;
use crate::observer::Frame;
use crate::system::{domain_nodes, path_edges, region_cells};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;

/// Frames that may wait for the writer.
const WAITING: usize = 8;

/// Writes the frames of a run.
pub struct FrameWriter {
    sender: Option<SyncSender<Frame>>,
    thread: Option<JoinHandle<Result<(), Error>>>,
}

impl FrameWriter {
    /// Starts the thread; files go to `folder`.
    pub fn start(folder: PathBuf, program: &'static Program, mesh: &Mesh) -> Result<Self, Error> {
        let mut writer = Writer::new(folder, program, mesh)?;
        let (sender, receiver) = sync_channel::<Frame>(WAITING);
        let thread = std::thread::spawn(move || {
            receiver.into_iter().try_for_each(|frame| writer.write(frame))?;
            writer.joint.finish()
        });
        Ok(Self { sender: Some(sender), thread: Some(thread) })
    }

    /// Queues a frame; waits if the writer is behind.
    pub fn send(&mut self, frame: Frame) -> Result<(), Error> {
        let accepted = self.sender.as_ref().is_some_and(|s| s.send(frame).is_ok());
        if accepted { Ok(()) } else { self.finish() }
    }

    /// Waits until all is written.
    pub fn finish(&mut self) -> Result<(), Error> {
        self.sender = None;
        let stopped = || Error::Model(String::from("the writer of field frames stopped"));
        self.thread.take().map_or(Ok(()), |t| t.join().unwrap_or_else(|_| Err(stopped())))
    }
}

impl Drop for FrameWriter {
    /// Frames in the queue still reach the disk when a run ends by an error.
    fn drop(&mut self) {
        let _ = self.finish();
    }
}

/// What the thread keeps.
struct Writer {
    folder: PathBuf,
    program: &'static Program,
    /// Grid of each statement on the first mesh.
    grids: Vec<Arc<Grid>>,
    /// Time and file of each statement's frames so far.
    series: Vec<Vec<(f64, String)>>,
    pictures: Vec<Vec<String>>,
    joint: Joint,
}

impl Writer {
    fn new(folder: PathBuf, program: &'static Program, mesh: &Mesh) -> Result<Self, Error> {
        let on_mesh = |f: &Frames| grid(mesh, f.domain).map(Arc::new);
        Ok(Self {
            grids: program.frames.iter().map(on_mesh).collect::<Result<_, _>>()?,
            series: vec![Vec::new(); program.frames.len()],
            pictures: picture_names(program),
            joint: Joint::new(&folder, program),
            folder,
            program,
        })
    }

    fn write(&mut self, frame: Frame) -> Result<(), Error> {
        let domain = self.program.frames[frame.frame].domain;
        let grid = match &frame.mesh {
            Some(mesh) => Arc::new(grid(mesh, domain)?),
            None => self.grids[frame.frame].clone(),
        };
        let layer = Layer::new(self.program, grid, &frame);
        let number = self.series[frame.frame].len();
        self.store(&frame, &layer)?;
        let caption = snapshot::at_time(frame.time, self.program.base_units[2]);
        for column in scalars(&self.program.frames[frame.frame]) {
            let name = &self.pictures[frame.frame][column];
            let file = self.folder.join(format!("{name}_{number:05}.png"));
            snapshot::write(&file, &[Shown { layer: &layer, scalar: Some(column) }], &caption)?;
        }
        self.joint.add(frame.frame, frame.time, layer)
    }

    /// Writes the file of a frame and the list of all.
    fn store(&mut self, frame: &Frame, layer: &Layer) -> Result<(), Error> {
        let stem = match self.grids.len() {
            1 => String::from("fields"),
            _ => format!("fields{}", frame.frame),
        };
        let series = &mut self.series[frame.frame];
        let file = format!("{stem}_{:05}.vtu", series.len());
        vtu::write(&self.folder.join(&file), &layer.grid, &layer.data)?;
        series.push((frame.time, file));
        vtu::write_series(&self.folder.join(format!("{stem}.pvd")), series)
    }
}

fn grid(mesh: &Mesh, domain: Domain) -> Result<Grid, Error> {
    let nodes = domain_nodes(mesh, domain)?;
    let position = |n: u32| nodes.binary_search(&n).unwrap_or(0) as u32;
    let mut grid =
        Grid { points: nodes.iter().map(|&n| mesh.nodes[n as usize]).collect(), ..Grid::default() };
    match domain {
        Domain::Cells(regions) => {
            for region in regions {
                for cell in region_cells(mesh, region)? {
                    grid.cells.push(mesh.cells[cell].map(position));
                    grid.regions.push(mesh.cell_region[cell]);
                }
            }
        }
        Domain::Edges(paths) | Domain::Ends(paths) => {
            for path in paths {
                grid.edges.extend(path_edges(mesh, path)?.into_iter().map(|edge| edge.map(position)));
            }
        }
    }
    grid.outline = outline(&grid);
    Ok(grid)
}

/// Edges `[start, end, middle]` with one cell, or between two regions.
fn outline(grid: &Grid) -> Vec<[u32; 3]> {
    let mut edges: BTreeMap<u32, ([u32; 3], Vec<u16>)> = BTreeMap::new();
    for (cell, &region) in grid.cells.iter().zip(&grid.regions) {
        for (a, b, middle) in [(0, 1, 3), (1, 2, 4), (2, 0, 5)] {
            edges
                .entry(cell[middle])
                .or_insert(([cell[a], cell[b], cell[middle]], Vec::new()))
                .1
                .push(region);
        }
    }
    let border = |regions: &[u16]| regions.len() == 1 || regions[0] != regions[1];
    edges.into_values().filter(|(_, regions)| border(regions)).map(|(edge, _)| edge).collect()
}

/// Names of the pictures of each statement's columns; with the statement's number before those that another statement has too.
fn picture_names(program: &Program) -> Vec<Vec<String>> {
    let holders =
        |name: &str| program.frames.iter().filter(|f| f.columns.iter().any(|c| c.name == name)).count();
    let picture = |frame: usize, name: &str| {
        if holders(name) > 1 { format!("fields{frame}_{name}") } else { String::from(name) }
    };
    let of_frames = |(k, f): (usize, &Frames)| f.columns.iter().map(|c| picture(k, c.name)).collect();
    program.frames.iter().enumerate().map(of_frames).collect()
}
